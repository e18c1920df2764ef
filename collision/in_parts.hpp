// Work on independent parts of an array by several threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace kds::collision {

/// How many threads to use for this many items, at most `most` (0: as many as the machine has), so that each has enough
/// work to be worth its start.
inline std::size_t threads_for(std::size_t items, std::size_t most) {
  constexpr std::size_t items_per_thread = 4096;  // some 0.1 us each; to begin and end a thread takes some 50 us
  if (most == 1 || items < 2 * items_per_thread) return 1;
  if (most == 0) most = std::max<std::size_t>(std::thread::hardware_concurrency(), 1);
  return std::min(items / items_per_thread, most);
}

/// Calls work(i) for each i in [0, tasks) in up to `threads` threads, of which this is one; a thread that has finished
/// a task takes the next. No task may depend on what another one changes. Returns when all are done; if some threw,
/// throws the exception of the lowest of them.
template <class Work>
void in_turn(std::size_t tasks, std::size_t threads, const Work& work) {
  std::vector<std::exception_ptr> failures(tasks);
  std::atomic<std::size_t> next{0};
  const auto run = [&] {
    for (std::size_t task = next++; task < tasks; task = next++) {
      try {
        work(task);
      } catch (...) {
        failures[task] = std::current_exception();
      }
    }
  };
  {
    std::vector<std::jthread> others;
    for (std::size_t i = 1; i < std::min(threads, tasks); ++i) others.emplace_back(run);
    run();
  }
  for (const auto& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
}

/// Cuts [0, items) into `threads` parts of equal size, in order, and calls work(part, begin, end) for parts 0, 1 ...,
/// each in a thread of its own; this thread does the last part. No part may depend on what another one changes. Returns
/// when all are done; if some threw, throws the exception of the lowest of them.
template <class Work>
void in_parts(std::size_t items, std::size_t threads, const Work& work) {
  if (threads <= 1) return work(std::size_t{0}, std::size_t{0}, items);
  std::vector<std::exception_ptr> failures(threads);
  const auto run = [&](std::size_t part) {
    try {
      work(part, items * part / threads, items * (part + 1) / threads);
    } catch (...) {
      failures[part] = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> others;
    others.reserve(threads - 1);
    for (std::size_t part = 0; part + 1 < threads; ++part) others.emplace_back(run, part);
    run(threads - 1);
  }
  for (const auto& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
}

}  // namespace kds::collision
