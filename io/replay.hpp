// A run as a page: a self-contained HTML file that plays the motion in 3D.
#pragma once

#include "certificates/point_motion.hpp"
#include "io/events.hpp"
#include "io/scene.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "kds/turning/spin.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::io {

/// three.js is not where it should be; the message is one line and names the package.
struct ReplayError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A piece of a motion as it is recorded: a path of any degree that worlds have, and an orientation that turns.
/// collision::motion_as() makes it of the motions of all worlds, exactly.
struct RecordedPiece {
  static constexpr int degree = 5;

  kds::certificates::PointMotion<degree> path{};
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< at the start
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();       ///< rad/s

  double start() const { return path.start; }  ///< s
  kds::Spin spin() const { return {{angular_velocity[0], angular_velocity[1], angular_velocity[2]}, path.start}; }
  /// How many coefficients of the path there are, without zeros at the end: of a body at rest one.
  std::size_t terms() const;

  friend const kds::certificates::PointMotion<degree>& path_of(const RecordedPiece& piece) { return piece.path; }
};

/// The motion pieces and contacts of a run: what the page needs to show any instant of it. Bodies are named by their
/// places in a scene.
class Record {
 public:
  void on_event(const Event& event);
  /// Pieces may come in any order of their starts; of several with one start the last counts.
  void on_motion(std::uint32_t body, const RecordedPiece& piece);
  /// Drops the pieces of a body that start after a time (s).
  void forget_after(std::uint32_t body, double time);
  /// From `time` on the body is not there.
  void on_removal(std::uint32_t body, double time);

  /// The pieces of a body's motion that are to be drawn, up to a thousandth of its size.
  std::vector<RecordedPiece> drawn(const Scene& scene, std::uint32_t place) const;
  /// When the body is removed, `never` if it is not. Precondition, here and above: it has been recorded.
  double end(std::uint32_t place) const { return bodies_[place].end; }

  /// The page's data, as JSON: see replay_page/record.js for what it means.
  std::string to_json(const Scene& scene, const std::string& title) const;

 private:
  struct Body {
    std::vector<RecordedPiece> motion;  ///< starts ascend
    double end = kds::never;
  };
  Body& body(std::uint32_t place);

  std::vector<Body> bodies_;
  std::vector<Event> touches_;  ///< contacts, separations, overlaps, passes
  std::vector<Event> walls_;
  std::vector<Event> rests_;  ///< contacts that begin and cease to last
};

/// Keeps the record of a scene's run. (Of worlds of one's own: world_recorder.hpp, periodic_recorder.hpp.)
class ReplayRecorder final : public EventSink {
 public:
  explicit ReplayRecorder(const Scene& scene);
  void on_event(const Event& event) override { record_.on_event(event); }
  void on_motion(std::uint32_t body, const MotionPiece& piece) override;

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
