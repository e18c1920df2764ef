// Operations that the compiler's own vectors do not have, for any processor.
#pragma once

#include "kds/simd/vectors.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

/// These functions exist under these names for every processor, and give the same bits (tests/kds/simd).
namespace kds::simd::portable {

inline Two square_root(Two x) { return Two{std::sqrt(x[0]), std::sqrt(x[1])}; }
inline FourFloats square_root(FourFloats x) {
  return FourFloats{std::sqrt(x[0]), std::sqrt(x[1]), std::sqrt(x[2]), std::sqrt(x[3])};
}

/// Lane by lane; where one is not a number, or both are zero, the second.
inline Two lesser(Two x, Two y) { return x < y ? x : y; }
inline Two greater(Two x, Two y) { return x > y ? x : y; }
inline FourFloats lesser(FourFloats x, FourFloats y) { return x < y ? x : y; }
inline FourFloats greater(FourFloats x, FourFloats y) { return x > y ? x : y; }

/// Bit i is the sign of lane i: set in the lanes for which a comparison holds.
inline unsigned set_of_two(TwoBits x) { return unsigned{x[0] < 0} | unsigned{x[1] < 0} << 1; }
inline unsigned set_of_four(FourFloatsBits x) {
  unsigned set = 0;
  for (int i = 0; i < 4; ++i) set |= unsigned{x[i] < 0} << i;
  return set;
}

/// Precondition: eight numbers, none a NaN, at the beginning of a cache line.
inline LeastOfEight least_of_eight(const double* numbers) {
  const double least = *std::min_element(numbers, numbers + 8);
  unsigned who = 0;
  for (std::size_t i = 0; i < 8; ++i) who |= numbers[i] == least ? 3u << (2 * i) : 0;
  return {least, who};
}

/// Bit i if none of the i-th eight bytes exceeds the same of `limits`. Precondition: four of them, at a multiple of 16
/// bytes.
inline std::uint64_t within_limits(const EightBytes* four, EightBytes limits) {
  using Bytes = signed char __attribute__((vector_size(8)));
  Bytes most;
  std::memcpy(&most, &limits, sizeof most);
  std::uint64_t within = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    Bytes bytes;
    std::memcpy(&bytes, &four[i], sizeof bytes);
    const auto over = bytes > most;
    std::uint64_t any = 0;
    std::memcpy(&any, &over, sizeof any);
    within |= std::uint64_t{any == 0} << i;
  }
  return within;
}

}  // namespace kds::simd::portable
