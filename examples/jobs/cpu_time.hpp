// CPU time, by kind of work.
#pragma once

#include <ctime>
#include <utility>

namespace jobs {

/// CPU seconds of this thread, charged to one kind of work after another.
class CpuTime {
 public:
  /// Adds what has passed since the last call, or the beginning.
  void charge(double& to) {
    const double now = seconds();
    to += now - std::exchange(since_, now);
  }

 private:
  static double seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  }

  double since_ = seconds();
};

}  // namespace jobs
