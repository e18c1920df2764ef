// How much memory a process has taken at the most.
#pragma once

#include <malloc.h>

#include <cstdint>
#include <fstream>
#include <string>

namespace speed {

/// Begins anew: what was freed before goes back to the system and the peak is what is held now.
inline void reset_peak_memory() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << 5;  // proc(5): the peak resident set size becomes the present one
}

/// Bytes of the greatest resident set since then; 0 where the system does not tell.
inline std::uint64_t peak_memory() {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word) {
    if (word != "VmHWM:") continue;
    std::uint64_t kib = 0;
    status >> kib;
    return kib * 1024;
  }
  return 0;
}

}  // namespace speed
