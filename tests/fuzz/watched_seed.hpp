// What the programs that run seeds share: which seed runs, for whoever reports a crash or that it takes too long, and
// how numbers are read.
#pragma once

#include <sys/time.h>

#include <charconv>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string_view>

namespace kds::fuzz {

inline volatile std::uint64_t now_running = 0;

extern "C" inline void tell_seed(int signal) {
  std::fprintf(stderr, "seed %llu %s\n", static_cast<unsigned long long>(now_running),
               signal == SIGVTALRM ? "takes too long" : "crashes");
  if (signal == SIGVTALRM) std::_Exit(3);
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

inline void watch_seeds() {
  for (const int signal : {SIGABRT, SIGFPE, SIGILL, SIGVTALRM}) std::signal(signal, tell_seed);
#if !defined(__SANITIZE_ADDRESS__)  // which reports it better
  std::signal(SIGSEGV, tell_seed);
#endif
}

/// After so many seconds of the processor the seed takes too long; 0: none does.
inline void set_alarm(int seconds) {
  const itimerval timer{{0, 0}, {seconds, 0}};
  setitimer(ITIMER_VIRTUAL, &timer, nullptr);
}

/// A number and nothing else.
inline std::optional<std::uint64_t> number(std::string_view text) {
  std::uint64_t result = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), result);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return result;
}

inline double seconds_from(const char* variable, double otherwise) {
  const char* const wished = std::getenv(variable);
  return wished ? std::strtod(wished, nullptr) : otherwise;
}

}  // namespace kds::fuzz
