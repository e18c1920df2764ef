// Two doubles at a time.
#pragma once

#include "kds/arithmetic/double_double.hpp"

#include <cmath>
#include <cstdint>
#include <limits>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace kds {

/// The compiler's own vectors: an SSE or NEON register, or two numbers where there are none. Each lane is computed as a
/// double alone would be.
using Two = double __attribute__((vector_size(16)));
/// What comparisons of them give: all bits set, or none.
using TwoBits = std::int64_t __attribute__((vector_size(16)));

inline Two both(double x) { return Two{x, x}; }
inline TwoBits bits(Two x) { return reinterpret_cast<TwoBits>(x); }
inline Two number(TwoBits x) { return reinterpret_cast<Two>(x); }

inline Two magnitude(Two x) { return number(bits(x) & std::numeric_limits<std::int64_t>::max()); }

/// Lane by lane; where one is not a number the second.
inline Two lesser(Two x, Two y) { return x < y ? x : y; }
inline Two greater(Two x, Two y) { return x > y ? x : y; }

inline Two square_root(Two x) {
#ifdef __SSE2__
  return _mm_sqrt_pd(x);
#else
  return Two{std::sqrt(x[0]), std::sqrt(x[1])};
#endif
}

/// A double-double in each lane.
struct TwoDoubleDoubles {
  Two high, low;

  DoubleDouble operator[](int lane) const { return {high[lane], low[lane]}; }
};

inline TwoDoubleDoubles two_sum(Two a, Two b) {
  const Two sum = a + b;
  const Two b_part = sum - a;
  const Two a_part = sum - b_part;
  return {sum, (a - a_part) + (b - b_part)};
}

inline TwoDoubleDoubles two_product(Two a, Two b) {
  const Two product = a * b;
#if defined(__FMA__) || defined(FP_FAST_FMA)
  return {product, Two{__builtin_fma(a[0], b[0], -product[0]), __builtin_fma(a[1], b[1], -product[1])}};
#else
  constexpr double splitter = 134217729.0;  // 2^27 + 1
  const Two a_scaled = splitter * a;
  const Two a_high = a_scaled - (a_scaled - a);
  const Two a_low = a - a_high;
  const Two b_scaled = splitter * b;
  const Two b_high = b_scaled - (b_scaled - b);
  const Two b_low = b - b_high;
  return {product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low};
#endif
}

}  // namespace kds
