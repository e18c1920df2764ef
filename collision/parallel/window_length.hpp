// How long windows are.
#pragma once

#include <algorithm>
#include <cstddef>

namespace kds::collision {

/// The length of the windows of a ParallelWorld: as long as what is unknown or wrong stays clear of the cells, with
/// some room to spare. Changes nothing but the cost.
class WindowLength {
 public:
  explicit WindowLength(double first = 0) : length_(first) {}

  double seconds() const { return length_; }

  /// A window of this length held, and `used` of the halo was needed, in [0, 1].
  void held(double length, double used) {
    failures_ = 0;
    const double next = length * std::clamp(aim / std::max(used, least_used), 0.5, 2.0);
    // One that ended early says how long one might be, but shorter ones come of that only if it was full.
    if (length < length_ && next < length_) {
      if (used > aim) length_ = next;
      return;
    }
    length_ = next;
  }
  void failed() {
    ++failures_;
    length_ /= 2;
  }
  std::size_t failures() const { return failures_; }  ///< since a window last held

 private:
  static constexpr double aim = 0.7;  ///< of the halo; the minimum of the cost is flat from 0.6 to 0.85
  static constexpr double least_used = 0.05;

  double length_;
  std::size_t failures_ = 0;
};

}  // namespace kds::collision
