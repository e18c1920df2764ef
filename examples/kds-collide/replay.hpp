// A run as a page: a self-contained HTML file that plays the motion in 3D.
#pragma once

#include "examples/kds-collide/events.hpp"
#include "examples/kds-collide/scene.hpp"

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds_collide {

/// three.js is not where it should be; the message is one line and names the package.
struct ReplayError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Keeps the motion pieces and contacts of a run: what the page needs to show any instant of it.
class ReplayRecorder final : public EventSink {
 public:
  explicit ReplayRecorder(const Scene& scene);
  void on_event(const Event& event) override;
  void on_motion(std::uint32_t body, const MotionPiece& piece) override;

  /// The page's data, as JSON: see replay.html for what it means.
  std::string to_json(const std::string& title) const;

 private:
  const Scene& scene_;
  std::vector<std::vector<MotionPiece>> motion_;  ///< of each body; starts ascend
  std::vector<Event> touches_;                    ///< contacts, separations, overlaps
  std::vector<Event> rests_;                      ///< contacts that begin and cease to last
};

/// The page: viewer, three.js and data in one text. Throws ReplayError where three.js is not found in `three_folder`.
std::string replay_page(const std::string& data, const std::filesystem::path& three_folder);

/// Where the build found three.js.
std::filesystem::path default_three_folder();

}  // namespace kds_collide
