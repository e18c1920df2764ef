// The clock of benchmarks: CPU time of this thread, which others on the machine do not lengthen.
#pragma once

#include <ctime>

namespace kds::benchmarks {

/// Seconds of CPU time that the calling thread has used.
inline double thread_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace kds::benchmarks
