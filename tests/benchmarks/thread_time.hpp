// The clocks of benchmarks. CPU time of this thread is the usual one: other programs that wait for the same core do not
// lengthen it.
#pragma once

#include <ctime>

namespace kds::benchmarks {

/// Seconds of CPU time that the calling thread has used.
inline double thread_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Seconds that have passed, for work that several threads share.
inline double wall_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace kds::benchmarks
