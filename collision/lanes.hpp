// Three coordinates or axes in four floats, the fourth left 0.
#pragma once

#include "kds/simd/four_floats.hpp"

namespace kds::collision {

using Lanes = FourFloats;

template <class Vector>
Lanes lanes(const Vector& v) {
  return Lanes{static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]), 0};
}

/// (x1, x2, x0, x3) and (x2, x0, x1, x3): the next coordinate, and the one after it.
inline Lanes next_lanes(Lanes x) { return __builtin_shufflevector(x, x, 1, 2, 0, 3); }
inline Lanes last_lanes(Lanes x) { return __builtin_shufflevector(x, x, 2, 0, 1, 3); }

/// Lane i of the result is the sum of the lanes of the i-th vector; the last lane 0.
inline Lanes sums(Lanes a, Lanes b, Lanes c) {
  const Lanes zero{};
  const Lanes ab = __builtin_shufflevector(a, b, 0, 4, 1, 5) + __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Lanes c0 = __builtin_shufflevector(c, zero, 0, 4, 1, 5) + __builtin_shufflevector(c, zero, 2, 6, 3, 7);
  return __builtin_shufflevector(ab, c0, 0, 1, 4, 5) + __builtin_shufflevector(ab, c0, 2, 3, 6, 7);
}

}  // namespace kds::collision
