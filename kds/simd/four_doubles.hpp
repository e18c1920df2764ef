// Four doubles at a time, in two registers.
#pragma once

#include "kds/simd/two_doubles.hpp"

#include <cstddef>

namespace kds {

/// Four doubles that are computed with at once, as two vectors of two.
struct FourDoubles {
  Two low, high;

  FourDoubles() = default;
  FourDoubles(Two l, Two h) : low(l), high(h) {}
  FourDoubles(double a, double b, double c, double d) : low{a, b}, high{c, d} {}
  explicit FourDoubles(double x) : low{x, x}, high{x, x} {}

  double operator[](std::size_t i) const { return i < 2 ? low[i] : high[i - 2]; }

  friend FourDoubles operator-(FourDoubles a) { return {-a.low, -a.high}; }
  friend FourDoubles operator+(FourDoubles a, FourDoubles b) { return {a.low + b.low, a.high + b.high}; }
  friend FourDoubles operator-(FourDoubles a, FourDoubles b) { return {a.low - b.low, a.high - b.high}; }
  friend FourDoubles operator*(FourDoubles a, FourDoubles b) { return {a.low * b.low, a.high * b.high}; }
  friend FourDoubles operator/(FourDoubles a, FourDoubles b) { return {a.low / b.low, a.high / b.high}; }
};

inline FourDoubles magnitude(FourDoubles x) { return {magnitude(x.low), magnitude(x.high)}; }
/// Lane by lane; where one is not a number the second.
inline FourDoubles lesser(FourDoubles x, FourDoubles y) { return {lesser(x.low, y.low), lesser(x.high, y.high)}; }
inline FourDoubles greater(FourDoubles x, FourDoubles y) { return {greater(x.low, y.low), greater(x.high, y.high)}; }

/// x where a > b, else y.
inline FourDoubles where_greater(FourDoubles a, FourDoubles b, FourDoubles x, FourDoubles y) {
  return {a.low > b.low ? x.low : y.low, a.high > b.high ? x.high : y.high};
}

/// Lanes 1, 2, 3, 0.
inline FourDoubles next(FourDoubles x) {
  return {__builtin_shufflevector(x.low, x.high, 1, 2), __builtin_shufflevector(x.high, x.low, 1, 2)};
}

inline double sum_of(FourDoubles x) {
  const Two sums = x.low + x.high;
  return sums[0] + sums[1];
}
inline double lowest(FourDoubles x) {
  const Two m = lesser(x.low, x.high);
  return m[0] < m[1] ? m[0] : m[1];
}
inline double highest(FourDoubles x) {
  const Two m = greater(x.low, x.high);
  return m[0] > m[1] ? m[0] : m[1];
}

}  // namespace kds
