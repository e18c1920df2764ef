// What a harness is and how it fails.
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

namespace kds::fuzz {

/// Something is not as it must be.
struct Failure : std::logic_error {
  using std::logic_error::logic_error;
};

inline void require(bool fact, const char* what) {
  if (!fact) throw Failure(what);
}
inline void require(bool fact, const std::string& what) {
  if (!fact) throw Failure(what);
}

/// Each program defines one: runs the scenario that the bytes stand for. Throws, or crashes, if something is wrong.
void run(std::span<const std::uint8_t> input);

}  // namespace kds::fuzz
