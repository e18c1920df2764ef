// Decisions and numbers drawn from bytes, so that whoever makes the bytes - a random generator, a fuzzer that looks at
// coverage, a person with a failure to look into - makes the scenario.
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace kds::fuzz {

/// Reads bytes in turn; behind the end all are 0.
class Bytes {
 public:
  explicit Bytes(std::span<const std::uint8_t> data) : data_(data) {}

  bool empty() const { return data_.empty(); }

  std::uint8_t byte() {
    if (data_.empty()) return 0;
    const std::uint8_t first = data_.front();
    data_ = data_.subspan(1);
    return first;
  }

  /// In 0 ... n - 1. Precondition: 1 <= n <= 256.
  std::size_t below(std::size_t n) { return byte() % n; }
  int integer(int low, int high) { return low + static_cast<int>(below(static_cast<std::size_t>(high - low + 1))); }
  bool one_in(std::size_t n) { return below(n) == n - 1; }

  /// A number of the size of 1: of few bits, so that such numbers often meet, or (one in four) of all bits.
  double number() {
    switch (below(4)) {
      case 0:
        return integer(-8, 8);
      case 1:
        return integer(-128, 127) / 16.0;
      case 2:
        return 0;
      default:
        return (static_cast<double>(word() >> 11) * 0x1p-53 - 0.5) * 16;
    }
  }

  /// A double of any bits, but of a size within 2^-most ... 2^most, or 0.
  double wide(int most) {
    const double fraction = 1 + static_cast<double>(word() >> 12) * 0x1p-52;
    const double size = std::ldexp(fraction, static_cast<int>(word() % static_cast<unsigned>(2 * most)) - most);
    return one_in(2) ? -size : size;
  }

 private:
  std::uint64_t word() {
    std::uint64_t result = 0;
    for (int i = 0; i < 8; ++i) result = result << 8 | byte();
    return result;
  }

  std::span<const std::uint8_t> data_;
};

}  // namespace kds::fuzz
