// What is done to saved bytes to see whether they are looked at before they are relied on.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <vector>

namespace kds::tests {

/// What the bytes from some place on are overwritten with; nothing: one more is added to the byte.
struct Damage {
  const char* name;
  std::vector<unsigned char> bytes;

  std::vector<char> of(std::vector<char> whole, std::size_t at) const {
    if (bytes.empty()) ++whole[at];
    const std::size_t length = std::min(bytes.size(), whole.size() - at);
    if (length > 0) std::memcpy(&whole[at], bytes.data(), length);
    return whole;
  }
};

inline std::vector<Damage> all_damages() {
  return {{"zero", {0}},
          {"all bits", {0xff}},
          {"a large index", {0, 0, 0, 0x40}},
          {"the greatest index", {0xff, 0xff, 0xff, 0xff}},
          {"a NaN", {0, 0, 0, 0, 0, 0, 0xf8, 0x7f}},
          {"minus infinity", {0, 0, 0, 0, 0, 0, 0xf0, 0xff}},
          {"one more", {}}};
}

}  // namespace kds::tests
