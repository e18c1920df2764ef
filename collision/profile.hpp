// Where the time of a run goes.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <utility>

namespace kds::collision {

/// Kinds of work ([Paper] Figure 8).
enum class Work : std::size_t {
  update,  ///< recomputing bounding volumes, telling the structures of new motions
  sort,    ///< swaps and sorting
  prune,   ///< keeping the set of active pairs
  test,    ///< dynamic intersection tests
  other,   ///< response, callbacks, the clock
};

/// Seconds by kind of work. Each instant is charged to one kind: the innermost that is being done.
class Profile {
 public:
  using Clock = std::chrono::steady_clock;

  double seconds(Work work) const { return seconds_[static_cast<std::size_t>(work)]; }

  /// Begins other work and says what was being done.
  Work change_to(Work work) {
    const Clock::time_point now = Clock::now();
    seconds_[static_cast<std::size_t>(current_)] += std::chrono::duration<double>(now - since_).count();
    since_ = now;
    return std::exchange(current_, work);
  }

 private:
  std::array<double, 5> seconds_{};
  Work current_ = Work::other;
  Clock::time_point since_ = Clock::now();
};

/// Charges the rest of a scope to one kind of work. Without a profile it costs nothing.
class Stopwatch {
 public:
  Stopwatch(Profile* profile, Work work) : profile_(profile) {
    if (profile_) before_ = profile_->change_to(work);
  }
  ~Stopwatch() {
    if (profile_) profile_->change_to(before_);
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  Profile* profile_;
  Work before_ = Work::other;
};

}  // namespace kds::collision
