// Four vectors side by side, coordinate by coordinate, in floats.
#pragma once

#include "collision/lanes.hpp"
#include "kds/simd/four_floats.hpp"

namespace kds::collision {

struct FourVectors {
  FourFloats x, y, z;

  friend FourVectors operator+(const FourVectors& a, const FourVectors& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend FourVectors operator-(const FourVectors& a, const FourVectors& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend FourVectors operator*(FourFloats factor, const FourVectors& a) {
    return {factor * a.x, factor * a.y, factor * a.z};
  }
};

inline FourFloats dot(const FourVectors& a, const FourVectors& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline FourVectors cross(const FourVectors& a, const FourVectors& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline FourVectors magnitudes(const FourVectors& v) { return {magnitude(v.x), magnitude(v.y), magnitude(v.z)}; }

/// One vector four times.
inline FourVectors four_times(Lanes v) { return {splat(v[0]), splat(v[1]), splat(v[2])}; }
/// Four vectors.
inline FourVectors side_by_side(Lanes a, Lanes b, Lanes c, Lanes d) {
  const Lanes ab = __builtin_shufflevector(a, b, 0, 4, 1, 5), cd = __builtin_shufflevector(c, d, 0, 4, 1, 5);
  const Lanes ab_z = __builtin_shufflevector(a, b, 2, 6, 3, 7), cd_z = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  return {__builtin_shufflevector(ab, cd, 0, 1, 4, 5), __builtin_shufflevector(ab, cd, 2, 3, 6, 7),
          __builtin_shufflevector(ab_z, cd_z, 0, 1, 4, 5)};
}

using kds::signed_by, kds::where;

/// Those of a where a comparison holds, else those of b.
inline FourVectors where(FourFloatsBits holds, const FourVectors& a, const FourVectors& b) {
  return {where(holds, a.x, b.x), where(holds, a.y, b.y), where(holds, a.z, b.z)};
}
/// Those of a where a comparison holds, else 0.
inline FourVectors where(FourFloatsBits holds, const FourVectors& a) {
  return {where(holds, a.x), where(holds, a.y), where(holds, a.z)};
}
/// Turned round where a number is negative.
inline FourVectors signed_by(FourFloats number, const FourVectors& a) {
  return {signed_by(number, a.x), signed_by(number, a.y), signed_by(number, a.z)};
}

/// For how much of the time from 0 to 1 each of four functions f is surely positive: f and f' at the beginning are f0
/// and f1, f'' is at least `bend` there, and the third derivative at most `third`. 0 where f is not positive.
///
/// Method: f >= f0 + f1 s - c s^2, where c = max(-bend, 0) / 2 + third s / 6, in which s may be replaced by any bound
/// on the answer: the root for third = 0, and 1.
///
/// Rounding: roots of these parabolas are made of sums of numbers of one sign, so that they err by less than 16 u, u =
/// 2^-24. What is above a concave function that is positive at the beginning is positive before its root: 2^-16 of the
/// time is charged.
inline FourFloats positive_part(FourFloats f0, FourFloats f1, FourFloats bend, FourFloats third) {
  const FourFloats one = splat(1);
  const auto root = [&](FourFloats c) {
    const FourFloats q = magnitude(f1) + square_root(f1 * f1 + splat(4) * c * f0);
    return where(f1 < splat(0), (f0 + f0) / q, q / (c + c));
  };
  const FourFloats c2 = splat(0.5F) * greater(splat(0) - bend, splat(0));
  const FourFloats latest = lesser(root(c2), one);  // also where it is 0 / 0: f0 for all times
  const FourFloats part = lesser(root(c2 + splat(1.0F / 6) * third * latest) * splat(1 - 0x1p-16F), one);
  return where(f0 > splat(0), part);
}

}  // namespace kds::collision
