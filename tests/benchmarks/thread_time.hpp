// The clocks of benchmarks. CPU time of this thread is the usual one: other programs that wait for the same core do not
// lengthen it.
#pragma once

#include <algorithm>
#include <ctime>
#include <limits>

namespace kds::benchmarks {

/// Seconds of CPU time that the calling thread has used.
inline double thread_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Seconds of CPU time that a call takes, the least of some rounds. Reading the clock takes about a microsecond, so
/// that calls of a few are timed together: as many of them as take a hundred.
template <class Call>
double seconds_of_call(int rounds, const Call& call) {
  constexpr double enough = 1e-4;
  double least = std::numeric_limits<double>::infinity();
  int calls = 1;
  for (int round = 0; round < rounds;) {
    const double start = thread_seconds();
    for (int i = 0; i < calls; ++i) call();
    const double took = thread_seconds() - start;
    least = std::min(least, took / calls);
    if (took >= enough) {
      ++round;
    } else {
      calls *= 2;
    }
  }
  return least;
}

/// Seconds that have passed, for work that several threads share.
inline double wall_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace kds::benchmarks
