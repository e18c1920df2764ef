// Some vectors side by side, coordinate by coordinate, in floats.
#pragma once

#include "kds/simd/float_lanes.hpp"

namespace kds::collision {

using kds::all, kds::signed_by, kds::where;

/// `Floats`: FourFloats, or EightFloats in a file that is compiled for processors with such registers
/// (kds/simd/float_lanes.hpp).
template <class Floats>
struct FloatVectors {
  Floats x, y, z;
};

/// A vector in each lane, of three numbers.
template <class Floats>
[[gnu::always_inline]] inline FloatVectors<Floats> all(const float* v) {
  return {all<Floats>(v[0]), all<Floats>(v[1]), all<Floats>(v[2])};
}

/// See read_three().
template <class Floats>
[[gnu::always_inline]] inline FloatVectors<Floats> vectors_at(const float* const* rows, int place) {
  FloatVectors<Floats> v;
  read_three(rows, place, v.x, v.y, v.z);
  return v;
}

template <class Floats>
[[gnu::always_inline]] inline FloatVectors<Floats> operator+(const FloatVectors<Floats>& a,
                                                             const FloatVectors<Floats>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Floats>
[[gnu::always_inline]] inline FloatVectors<Floats> operator-(const FloatVectors<Floats>& a,
                                                             const FloatVectors<Floats>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Floats>
[[gnu::always_inline]] inline FloatVectors<Floats> operator*(Floats factor, const FloatVectors<Floats>& a) {
  return {factor * a.x, factor * a.y, factor * a.z};
}
template <class Floats>
[[gnu::always_inline]] inline Floats dot(const FloatVectors<Floats>& a, const FloatVectors<Floats>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Floats>
[[gnu::always_inline]] inline FloatVectors<Floats> cross(const FloatVectors<Floats>& a, const FloatVectors<Floats>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class Floats>
[[gnu::always_inline]] inline FloatVectors<Floats> magnitudes(const FloatVectors<Floats>& v) {
  return {magnitude(v.x), magnitude(v.y), magnitude(v.z)};
}

/// Those of a where a comparison holds, else those of b.
template <class Floats>
[[gnu::always_inline]] inline FloatVectors<Floats> where(BitsOf<Floats> holds, const FloatVectors<Floats>& a,
                                                         const FloatVectors<Floats>& b) {
  return {where(holds, a.x, b.x), where(holds, a.y, b.y), where(holds, a.z, b.z)};
}
/// Those of a where a comparison holds, else 0.
template <class Floats>
[[gnu::always_inline]] inline FloatVectors<Floats> where(BitsOf<Floats> holds, const FloatVectors<Floats>& a) {
  return {where(holds, a.x), where(holds, a.y), where(holds, a.z)};
}
/// Turned round where a number is negative.
template <class Floats>
[[gnu::always_inline]] inline FloatVectors<Floats> signed_by(Floats number, const FloatVectors<Floats>& a) {
  return {signed_by(number, a.x), signed_by(number, a.y), signed_by(number, a.z)};
}

/// For how much of the time from 0 to 1 each of some functions f is surely positive: f and f' at the beginning are f0
/// and f1, f'' is at least `bend` there, and the third derivative at most `third`. 0 where f is not positive.
///
/// Method: f >= f0 + f1 s - c s^2, where c = max(-bend, 0) / 2 + third s / 6, in which s may be replaced by any bound
/// on the answer: the root for third = 0, and 1.
///
/// Rounding: roots of these parabolas are made of sums of numbers of one sign, so that they err by less than 16 u, u =
/// 2^-24. What is above a concave function that is positive at the beginning is positive before its root: 2^-16 of the
/// time is charged.
template <class Floats>
[[gnu::always_inline]] inline Floats positive_part(Floats f0, Floats f1, Floats bend, Floats third) {
  const Floats one = all<Floats>(1), none = Floats{};
  const Floats size = magnitude(f1), square = f1 * f1, four_f0 = 4.0F * f0, two_f0 = f0 + f0;
  const BitsOf<Floats> falls = f1 < none;
  const auto root = [&](Floats c) __attribute__((always_inline)) {
    const Floats q = size + square_root(square + c * four_f0);
    return where(falls, two_f0, q) / where(falls, q, c + c);
  };
  const Floats c2 = 0.5F * greater(none - bend, none);
  const Floats latest = lesser(root(c2), one);  // also where it is 0 / 0: f0 for all times
  const Floats part = lesser(root(c2 + (1.0F / 6) * third * latest) * (1 - 0x1p-16F), one);
  return where(f0 > none, part);
}

}  // namespace kds::collision
