// Numbers in less memory, for what decides costs only.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace kds::collision {

/// A double without the last 32 bits of its mantissa: with an error of less than 2^-20 of it, towards 0.
class CoarseNumber {
 public:
  CoarseNumber() = default;
  CoarseNumber(double x) : bits_(static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(x) >> 32)) {}
  operator double() const { return std::bit_cast<double>(std::uint64_t{bits_} << 32); }
  CoarseNumber& operator*=(double factor) { return *this = *this * factor; }

 private:
  std::uint32_t bits_ = 0;
};

/// Counts one more, up to the greatest number that there is.
template <class Small>
void count_one(Small& count) {
  count = static_cast<Small>(count + (count < std::numeric_limits<Small>::max() ? 1 : 0));
}

/// The same by so many.
template <class Small>
void add_up_to_most(Small& count, std::uint32_t more) {
  static_assert(std::is_unsigned_v<Small> && sizeof(Small) < sizeof more);
  const std::uint32_t room = std::numeric_limits<Small>::max() - std::uint32_t{count};
  count = static_cast<Small>(count + (more < room ? more : room));
}

}  // namespace kds::collision
