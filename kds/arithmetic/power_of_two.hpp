// Powers of two as doubles, for scales: multiplying by one is exact except for overflow and underflow.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace kds {

/// 2^exponent, without a library call where that is a normal number; infinity or 0 where it is outside the doubles.
constexpr double power_of_two(int exponent) {
  constexpr int bias = 1023;  // of the exponent of a double
  return exponent > -bias && exponent <= bias ? std::bit_cast<double>(static_cast<std::uint64_t>(exponent + bias) << 52)
                                              : std::ldexp(1.0, exponent);
}

}  // namespace kds
