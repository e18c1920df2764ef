// A run as a page: a self-contained HTML file that plays the motion in 3D.
#pragma once

#include "io/events.hpp"
#include "io/scene.hpp"
#include "kds/arithmetic/lattice.hpp"

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::io {

/// three.js is not where it should be; the message is one line and names the package.
struct ReplayError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The motion pieces and contacts of a run: what the page needs to show any instant of it. Bodies are named by their
/// places in a scene.
class Record {
 public:
  void on_event(const Event& event);
  /// Pieces may come in any order of their starts; of several with one start the last counts.
  void on_motion(std::uint32_t body, const MotionPiece& piece);
  /// From `time` on the body is not there.
  void on_removal(std::uint32_t body, double time);

  /// The pieces of a body's motion that are to be drawn, up to a thousandth of its size.
  std::vector<MotionPiece> drawn(const Scene& scene, std::uint32_t place) const;
  /// When the body is removed, `never` if it is not. Precondition, here and above: it has been recorded.
  double end(std::uint32_t place) const { return bodies_[place].end; }

  /// The page's data, as JSON: see replay_page/record.js for what it means.
  std::string to_json(const Scene& scene, const std::string& title) const;

 private:
  struct Body {
    std::vector<MotionPiece> motion;  ///< starts ascend
    double end = kds::never;
  };
  Body& body(std::uint32_t place);

  std::vector<Body> bodies_;
  std::vector<Event> touches_;  ///< contacts, separations, overlaps, passes
  std::vector<Event> walls_;
  std::vector<Event> rests_;    ///< contacts that begin and cease to last
};

/// Keeps the record of a scene's run. (Of a world of one's own: WorldRecorder, in world_recorder.hpp.)
class ReplayRecorder final : public EventSink {
 public:
  explicit ReplayRecorder(const Scene& scene);
  void on_event(const Event& event) override { record_.on_event(event); }
  void on_motion(std::uint32_t body, const MotionPiece& piece) override { record_.on_motion(body, piece); }

  std::string to_json(const std::string& title) const { return record_.to_json(scene_, title); }
  const Record& record() const { return record_; }

 private:
  const Scene& scene_;
  Record record_;
};

/// The page: viewer, three.js and data in one text. Throws ReplayError where three.js is not found in `three_folder`.
std::string replay_page(const std::string& data, const std::filesystem::path& three_folder);

/// Where the build found three.js.
std::filesystem::path default_three_folder();

}  // namespace kds::io
