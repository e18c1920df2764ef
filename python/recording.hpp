// What a world records of itself, if it has been told to.
#pragma once

#include "collision/body_id.hpp"
#include "io/output_file.hpp"

#include <optional>
#include <stdexcept>
#include <string>

namespace kds_python {

/// A WorldRecorder or PeriodicRecorder, or none. It stands between a world and its listener, so it is there before the
/// world, and for as long.
template <class Recorder>
class Recording {
 public:
  using World = typename Recorder::World;
  using Listener = typename Recorder::Listener;

  Recording() = default;
  template <class Options>
  Recording(bool wanted, const Options& options, Listener& listener) : listener_(&listener) {
    if (wanted) listener_ = &recorder_.emplace(options, &listener);
  }
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  /// The listener of the world.
  Listener* listener() { return listener_; }

  /// After a change that the caller has made: of a body, of which bodies there are, of all.
  void look(const World& world, kds::collision::BodyId id) {
    if (recorder_) recorder_->look(world, id);
  }
  void look(const World& world) {
    if (recorder_) recorder_->look(world);
  }
  void start_again(const World& world) {
    if (recorder_) recorder_->start_again(world);
  }

  void write_replay(const World& world, const std::string& file, const std::string& title) {
    write(file, recorder("write_replay").page(world, title));
  }
  void write_gltf(const World& world, const std::string& file, const std::string& title, double frames_per_second) {
    write(file, recorder("write_gltf").gltf(world, title, frames_per_second));
  }
  void write_vtk(const World& world, const std::string& file, double frames_per_second) {
    recorder("write_vtk").write_vtk(world, file, frames_per_second);
  }

 private:
  Recorder& recorder(const char* function) {
    if (recorder_) return *recorder_;
    throw std::logic_error(std::string(function) +
                           ": nothing is recorded; worlds record that are made with record=True");
  }
  static void write(const std::string& file, const std::string& text) {
    kds::io::OutputFile output(file);
    output.write(text);
    output.close();
    output.commit();
  }

  std::optional<Recorder> recorder_;
  Listener* listener_ = nullptr;
};

}  // namespace kds_python
