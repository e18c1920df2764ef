// Motion of one value: a polynomial in the time since its own start.
#pragma once

#include "kds/ball.hpp"
#include "kds/exact.hpp"
#include "kds/polynomial.hpp"

#include <cmath>

namespace kds {

/// x(t) = c0 + c1 (t - start) + c2 (t - start)^2 + ...: [Paper] Equation 1, written about its own start.
///
/// Law (epochs): a motion is never evaluated with a large absolute t, so a clock at 1e9 is as good as one at 0. The
/// coefficients and the start are taken as exact; c2 is half the acceleration.
template <int Degree>
struct Motion {
  static constexpr int degree = Degree;

  Polynomial<Degree> position;  ///< in units of length, length/s, length/s^2 ...
  double start = 0;             ///< s

  /// The value at t, rounded.
  double operator()(double t) const { return position(t - start); }

  friend bool operator==(const Motion&, const Motion&) = default;
};

/// Whether every number of the motion is finite.
template <int Degree>
bool is_finite(const Motion<Degree>& motion) {
  for (const double c : motion.position.c) {
    if (!std::isfinite(c)) return false;
  }
  return std::isfinite(motion.start);
}

/// later - earlier in the arithmetic of Number: exact in DoubleDouble and Exact, with its error bound in Ball<double>.
template <class Number>
Number difference(double later, double earlier);
template <>
inline Exact difference<Exact>(double later, double earlier) {
  return Exact(later) - Exact(earlier);
}
template <>
inline double difference<double>(double later, double earlier) {
  return later - earlier;
}
template <>
inline Ball<double> difference<Ball<double>>(double later, double earlier) {
  const double d = later - earlier;
  return {d, rounding_unit<double> * std::abs(d)};
}
template <>
inline Ball<DoubleDouble> difference<Ball<DoubleDouble>>(double later, double earlier) {
  return {two_sum(later, -earlier), 0.0};
}

/// The motion as a polynomial in (t - epoch), in the arithmetic of Number (a Taylor shift by epoch - start).
template <class Number, int Degree>
Polynomial<Degree, Number> about(const Motion<Degree>& motion, double epoch) {
  Polynomial<Degree, Number> shifted;
  for (std::size_t i = 0; i <= Degree; ++i) shifted.c[i] = Number(motion.position.c[i]);
  if constexpr (Degree >= 1) {
    const auto& c = motion.position.c;
    const Number shift = difference<Number>(epoch, motion.start);
    if constexpr (Degree == 1) {
      shifted.c[0] = shift * c[1] + c[0];
    } else if constexpr (Degree == 2) {
      const Number bend = shift * c[2];
      shifted.c[1] = bend * 2.0 + c[1];
      shifted.c[0] = shift * (bend + c[1]) + c[0];
    } else {
      // Repeated synthetic division by (x - shift).
      for (int k = 0; k < Degree; ++k) {
        for (int i = Degree - 1; i >= k; --i) {
          const auto j = static_cast<std::size_t>(i);
          shifted.c[j] = shifted.c[j] + shift * shifted.c[j + 1];
        }
      }
    }
  }
  return shifted;
}

/// The same motion restarted at t: equal up to the rounding of its new coefficients.
template <int Degree>
Motion<Degree> restarted(const Motion<Degree>& motion, double t) {
  return {about<double>(motion, t), t};
}

}  // namespace kds
