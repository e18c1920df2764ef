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
};

inline TwoDoubleDoubles two_sum(Two a, Two b) {
  const Two sum = a + b;
  return {sum, detail::sum_error(a, b, sum)};
}

inline TwoDoubleDoubles two_product(Two a, Two b) {
  const Two product = a * b;
  return {product, detail::product_error(a, b, product)};
}

}  // namespace kds
