// Measures in a process of its own, which can be ended.
#pragma once

#include <poll.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <exception>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace speed {

/// Waits for a child to end, and ends it when it has used so much CPU time; whether it was ended. Not by a timer of the
/// child's own: Linux then keeps the clock of its CPU time in steps of some milliseconds.
inline bool ended_after(double cpu_seconds, pid_t child) {
  const int handle = static_cast<int>(syscall(SYS_pidfd_open, child, 0));
  if (handle < 0) throw std::runtime_error("pidfd_open: needs Linux 5.3");
  clockid_t clock{};
  clock_getcpuclockid(child, &clock);
  bool ended = false;
  for (double used = 0; !ended;) {
    pollfd waiting{handle, POLLIN, 0};
    const double wait_ms = std::clamp(1e3 * (cpu_seconds - used), 1.0, 60e3);
    if (poll(&waiting, 1, static_cast<int>(wait_ms)) > 0) break;
    std::timespec now{};
    if (clock_gettime(clock, &now) != 0) break;
    used = static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
    ended = used >= cpu_seconds;
  }
  if (ended) kill(child, SIGKILL);
  close(handle);
  return ended;
}

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
    int status = 0;
    try {
      new (memory) Result(work());
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s\n", error.what());
      status = 1;
    }
    _exit(status);  // without destructors, which belong to the parent
  }
  const bool too_long = ended_after(cpu_seconds, child);
  int status = 0;
  waitpid(child, &status, 0);
  std::optional<Result> result;
  const bool ended_well = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  if (ended_well) result = *static_cast<const Result*>(memory);
  munmap(memory, sizeof(Result));
  if (!ended_well && !too_long) {
    throw std::runtime_error("a measured run failed" +
                             (WIFSIGNALED(status) ? " by signal " + std::to_string(WTERMSIG(status)) : std::string()));
  }
  return result;
}

}  // namespace speed
