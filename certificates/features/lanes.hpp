// Four doubles at a time.
#pragma once

#include "kds/arithmetic/two.hpp"

#include <cstddef>

namespace kds::certificates {

using kds::greater;
using kds::lesser;

struct Lanes {
  Two low, high;

  Lanes() = default;
  Lanes(Two l, Two h) : low(l), high(h) {}
  Lanes(double a, double b, double c, double d) : low{a, b}, high{c, d} {}
  explicit Lanes(double x) : low{x, x}, high{x, x} {}

  double operator[](std::size_t i) const { return i < 2 ? low[i] : high[i - 2]; }

  friend Lanes operator-(Lanes a) { return {-a.low, -a.high}; }
  friend Lanes operator+(Lanes a, Lanes b) { return {a.low + b.low, a.high + b.high}; }
  friend Lanes operator-(Lanes a, Lanes b) { return {a.low - b.low, a.high - b.high}; }
  friend Lanes operator*(Lanes a, Lanes b) { return {a.low * b.low, a.high * b.high}; }
  friend Lanes operator/(Lanes a, Lanes b) { return {a.low / b.low, a.high / b.high}; }
};

inline Lanes absolute(Lanes x) { return {magnitude(x.low), magnitude(x.high)}; }
inline Lanes lesser(Lanes x, Lanes y) { return {lesser(x.low, y.low), lesser(x.high, y.high)}; }
inline Lanes greater(Lanes x, Lanes y) { return {greater(x.low, y.low), greater(x.high, y.high)}; }

/// x where a > b, else y.
inline Lanes where_greater(Lanes a, Lanes b, Lanes x, Lanes y) {
  return {a.low > b.low ? x.low : y.low, a.high > b.high ? x.high : y.high};
}

/// Lanes 1, 2, 3, 0.
inline Lanes next(Lanes x) {
  return {__builtin_shufflevector(x.low, x.high, 1, 2), __builtin_shufflevector(x.high, x.low, 1, 2)};
}

inline double sum_of(Lanes x) {
  const Two sums = x.low + x.high;
  return sums[0] + sums[1];
}
inline double lowest(Lanes x) {
  const Two m = lesser(x.low, x.high);
  return m[0] < m[1] ? m[0] : m[1];
}
inline double highest(Lanes x) {
  const Two m = greater(x.low, x.high);
  return m[0] > m[1] ? m[0] : m[1];
}

}  // namespace kds::certificates
