// Where the time of a run goes.
#pragma once

#include <array>
#include <cstddef>
#include <ctime>
#include <utility>

namespace kds::collision {

/// Kinds of work ([Coming06] Figure 8).
enum class Work : std::size_t {
  update,  ///< recomputing bounding volumes, giving new motions to the structures
  sort,    ///< swaps and sorting
  prune,   ///< keeping the set of active pairs
  test,    ///< dynamic intersection tests
  other,   ///< response, callbacks, the clock
};

/// CPU seconds, by kind of work, of the thread that calls change_to(). Each instant is charged to one kind, that of the
/// innermost work. Reading the clock costs some 0.3 us.
class Profile {
 public:
  /// Up to the last change of work.
  double seconds(Work work) const { return seconds_[static_cast<std::size_t>(work)]; }

  /// Begins another kind of work and returns the previous one.
  Work change_to(Work work) {
    const double now = cpu_seconds();
    seconds_[static_cast<std::size_t>(current_)] += now - since_;
    since_ = now;
    return std::exchange(current_, work);
  }

 private:
  static double cpu_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  }

  std::array<double, 5> seconds_{};
  Work current_ = Work::other;
  double since_ = cpu_seconds();
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
