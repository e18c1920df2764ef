// Four floats at a time: three coordinates or axes, and a fourth that is left 0.
#pragma once

#include "kds/arithmetic/double_double.hpp"
#include "kds/arithmetic/two.hpp"

#include <array>
#include <cstdint>

namespace kds::collision {

/// The compiler's own vectors: one SSE or NEON register, or four numbers where there are none.
using Lanes = float __attribute__((vector_size(16)));
using LaneBits = std::int32_t __attribute__((vector_size(16)));

inline Lanes splat(float x) { return Lanes{x, x, x, x}; }

template <class Vector>
Lanes lanes(const Vector& v) {
  return Lanes{static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]), 0};
}

// Not to be hidden by those below.
using kds::greater;
using kds::lesser;
using kds::magnitude;

inline Lanes magnitude(Lanes x) {
  const LaneBits without_sign{0x7fffffff, 0x7fffffff, 0x7fffffff, 0x7fffffff};
  return reinterpret_cast<Lanes>(reinterpret_cast<LaneBits>(x) & without_sign);
}

/// Lane by lane; the second where either is not a number.
inline Lanes lesser(Lanes x, Lanes y) { return x < y ? x : y; }
inline Lanes greater(Lanes x, Lanes y) { return x > y ? x : y; }

/// (x1, x2, x0, x3) and (x2, x0, x1, x3): the next coordinate, and the one after it.
inline Lanes next_lanes(Lanes x) { return __builtin_shufflevector(x, x, 1, 2, 0, 3); }
inline Lanes last_lanes(Lanes x) { return __builtin_shufflevector(x, x, 2, 0, 1, 3); }

inline float lowest(Lanes x) {
  x = lesser(x, __builtin_shufflevector(x, x, 2, 3, 0, 1));
  x = lesser(x, __builtin_shufflevector(x, x, 1, 0, 3, 2));
  return x[0];
}
inline float highest(Lanes x) {
  x = greater(x, __builtin_shufflevector(x, x, 2, 3, 0, 1));
  x = greater(x, __builtin_shufflevector(x, x, 1, 0, 3, 2));
  return x[0];
}

/// Lane i of the result is the sum of the lanes of the i-th vector; the last lane 0.
inline Lanes sums(Lanes a, Lanes b, Lanes c) {
  const Lanes zero{};
  const Lanes ab = __builtin_shufflevector(a, b, 0, 4, 1, 5) + __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Lanes c0 = __builtin_shufflevector(c, zero, 0, 4, 1, 5) + __builtin_shufflevector(c, zero, 2, 6, 3, 7);
  return __builtin_shufflevector(ab, c0, 0, 1, 4, 5) + __builtin_shufflevector(ab, c0, 2, 3, 6, 7);
}

}  // namespace kds::collision
