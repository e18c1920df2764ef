// Four floats or eight, for code that is written for either: the functions of four_floats.hpp and eight_wide.hpp have
// the same names.
#pragma once

#include "kds/simd/eight_wide.hpp"
#include "kds/simd/four_floats.hpp"

namespace kds {

// `Floats`: FourFloats, or EightFloats in a file that is compiled for processors with AVX2. Then all that is made of it
// has to be inlined: kds/simd/four_wide.hpp says why.

/// What comparisons of them give.
template <class Floats>
using BitsOf = decltype(Floats{} < Floats{});

/// How many there are.
template <class Floats>
inline constexpr int lanes_of_floats = sizeof(Floats) / sizeof(float);

/// A number in each lane.
template <class Floats>
[[gnu::always_inline]] inline Floats all(float x) {
  return x - Floats{};
}

/// Bit i if a comparison holds in lane i.
[[gnu::always_inline]] inline unsigned set_of_lanes(FourFloatsBits x) { return set_of_four(x); }

/// Three of the four floats from a place on in each of four rows: lane i of x, y and z is from the i-th.
[[gnu::always_inline]] inline void read_three(const float* const* rows, int place, FourFloats& x, FourFloats& y,
                                              FourFloats& z) {
  FourFloats of[4];
  for (int i = 0; i < 4; ++i) __builtin_memcpy(&of[i], rows[i] + place, sizeof of[i]);
  const FourFloats low_01 = __builtin_shufflevector(of[0], of[1], 0, 4, 1, 5);
  const FourFloats low_23 = __builtin_shufflevector(of[2], of[3], 0, 4, 1, 5);
  x = __builtin_shufflevector(low_01, low_23, 0, 1, 4, 5);
  y = __builtin_shufflevector(low_01, low_23, 2, 3, 6, 7);
  z = __builtin_shufflevector(__builtin_shufflevector(of[0], of[1], 2, 6, 3, 7),
                              __builtin_shufflevector(of[2], of[3], 2, 6, 3, 7), 0, 1, 4, 5);
}

}  // namespace kds
