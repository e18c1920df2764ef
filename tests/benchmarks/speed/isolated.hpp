// Measures in a process of its own, which can be ended.
#pragma once

#include <sys/mman.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstdio>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace speed {

/// What `work` returns, computed in a child process; nothing if it needed more than `cpu_seconds`, set-up and all.
/// Each run begins with the same heap, whatever ran before, and what one takes in memory is gone with it. Throws
/// std::runtime_error where the child failed; it has said why.
template <class Work, class Result = std::invoke_result_t<Work>>
std::optional<Result> isolated(double cpu_seconds, Work work) {
  static_assert(std::is_trivially_copyable_v<Result>, "comes back through shared memory");
  void* memory = mmap(nullptr, sizeof(Result), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::runtime_error("no shared memory for a child process");
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no child process");
  if (child == 0) {
    itimerval limit{};
    limit.it_value.tv_sec = static_cast<time_t>(cpu_seconds);
    limit.it_value.tv_usec = static_cast<suseconds_t>(1e6 * (cpu_seconds - std::floor(cpu_seconds))) + 1;
    setitimer(ITIMER_PROF, &limit, nullptr);  // ends the process by SIGPROF
    int status = 0;
    try {
      new (memory) Result(work());
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s\n", error.what());
      status = 1;
    }
    _exit(status);  // without destructors, which belong to the parent
  }
  int status = 0;
  waitpid(child, &status, 0);
  std::optional<Result> result;
  const bool ended_well = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  if (ended_well) result = *static_cast<const Result*>(memory);
  munmap(memory, sizeof(Result));
  if (!ended_well && !(WIFSIGNALED(status) && WTERMSIG(status) == SIGPROF)) {
    throw std::runtime_error("a measured run failed" +
                             (WIFSIGNALED(status) ? " by signal " + std::to_string(WTERMSIG(status)) : std::string()));
  }
  return result;
}

}  // namespace speed
