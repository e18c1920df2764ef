// How long windows are.
#pragma once

#include <algorithm>
#include <cstddef>

namespace kds::collision {

/// The length of the windows of a ParallelWorld: as long as what is unknown or wrong stays clear of the cells. What is
/// unknown comes nearer at the speed of bodies, and what is wrong at that of the news of their contacts: so much of the
/// halo is used a second. A window is run in steps, and ends when with the next one it might not hold. Changes nothing
/// but the cost.
class WindowLength {
 public:
  /// `seconds`: how long a window may be, about.
  explicit WindowLength(double seconds = 0) : seconds_(seconds), step_(seconds / steps) {}

  double seconds() const { return seconds_; }
  double step() const { return step_; }

  /// Whether a window of which this much has been run, and that has used so much of the halo, in [0, 1], may go on.
  /// Then step() is that of the next step.
  bool goes_on(double elapsed, double used) {
    const double least = seconds_ / steps / 2;
    step_ = std::max(seconds_ / steps, elapsed / 2);
    if (used > 0) step_ = std::min(step_, elapsed * (most_used / used - 1));
    return step_ >= least;
  }

  void held(double elapsed, double used) {
    failures_ = 0;
    if (elapsed > 0 && used > 0) {
      rate_ = std::max(used / elapsed, forget * rate_);
      seconds_ = std::min(most_growth * std::max(seconds_, elapsed), most_used / rate_);
    }
    step_ = seconds_ / steps;
  }
  void failed() {
    ++failures_;
    seconds_ /= 2;
    step_ = seconds_ / steps;
  }
  std::size_t failures() const { return failures_; }  ///< since a window last held

 private:
  static constexpr double steps = 4;  ///< at first; more find the end of a window better, and each costs a comparison
  static constexpr double most_used = 0.85;  ///< of the halo: with one step more. A window that fails costs a division
  static constexpr double forget = 0.8;      ///< what fast bodies have used counts for some windows
  static constexpr double most_growth = 2;   ///< from window to window

  double seconds_;
  double step_;
  double rate_ = 0;  ///< of the halo, in a second
  std::size_t failures_ = 0;
};

}  // namespace kds::collision
