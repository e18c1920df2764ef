// Motion of one value: a polynomial in the time since its own start.
#pragma once

#include "kds/arithmetic/ball.hpp"
#include "kds/arithmetic/compensated.hpp"
#include "kds/arithmetic/exact.hpp"
#include "kds/arithmetic/unrolled.hpp"
#include "kds/polynomial.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>

namespace kds {

/// x(t) = c0 + c1 (t - start) + c2 (t - start)^2 + ...: [Coming06] Equation 1, written about its own start.
///
/// Law (epochs): a motion is never evaluated with a large absolute t, so a clock at 1e9 is as good as one at 0. The
/// coefficients and the start are taken as exact; c2 is half the acceleration. The degree of a certificate of motions,
/// and so that of a motion, is limited by first_crossing(): 31.
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

/// a - b in the arithmetic of Number: exact in DoubleDouble and Exact, with its error bound in Ball<double>.
template <class Number>
Number difference(double a, double b);
template <>
inline Exact difference<Exact>(double a, double b) {
  return Exact(a) - Exact(b);
}
template <>
inline double difference<double>(double a, double b) {
  return a - b;
}
template <>
inline Ball<double> difference<Ball<double>>(double a, double b) {
  const double d = a - b;
  return {d, rounding_unit<double> * std::abs(d)};
}
template <>
inline Ball<DoubleDouble> difference<Ball<DoubleDouble>>(double a, double b) {
  return {two_sum(a, -b), 0.0};
}

namespace detail {

/// p(x + shift) in balls, for degrees where the running bound of Ball's own operations would cost more than the
/// numbers: the errors e_i of the coefficients go through the same shift as the coefficients, by |shift|.
///
/// Error bound, with u = 2^-53 and n the degree. Repeated synthetic division gives c'_j as a sum of binomial(i, j) c_i
/// shift^(i-j); each summand goes through at most 2 n roundings where its index falls and n where it stays, and the
/// shift itself is known to 2 u, which counts as another 2 n: at most 5 n u |c_i|, besides the radius r_i of the
/// coefficient. So e_i = r_i + 5.1 n u |c_i| suffices. Underflow loses at most 2^-1075 a step, for which each e_i has
/// 2^-1010. A coefficient keeps its radius, which may be 0, if all higher ones are exactly zero, since nothing is added
/// to it.
template <int Degree, class Scalar>
Polynomial<Degree, Ball<double>> shifted_balls(const Polynomial<Degree, Scalar>& p, double shift) {
  std::array<double, std::size_t{Degree} + 1> c;
  std::array<double, std::size_t{Degree} + 1> e;
  std::array<double, std::size_t{Degree} + 1> kept;
  double added = 0;
  unrolled<Degree + 1>([&](auto k) {
    constexpr std::size_t i = Degree - k;
    const Ball<double> ball(p.c[i]);
    c[i] = ball.middle;
    e[i] = ball.radius + 5.1 * Degree * 0x1p-53 * std::abs(ball.middle) + 0x1p-1010;
    kept[i] = added == 0 ? ball.radius : -1.0;
    added += std::abs(ball.middle) + ball.radius;
  });
  const double distance = std::abs(shift);
  unrolled<Degree>([&](auto k) {
    unrolled<Degree - k>([&](auto steps) {
      constexpr std::size_t i = Degree - 1 - steps;
      c[i] += shift * c[i + 1];
      e[i] += distance * e[i + 1];
    });
  });
  Polynomial<Degree, Ball<double>> result;
  // The last summand is negligible for a finite number, and makes the radius infinite or NaN where the number
  // overflows.
  unrolled<Degree + 1>([&](auto i) { result.c[i] = {c[i], kept[i] < 0 ? e[i] + 0x1p-80 * std::abs(c[i]) : kept[i]}; });
  return result;
}

}  // namespace detail

/// p(x + shift) as a polynomial in x. Scalar is double (exact coefficients) or Number itself.
template <class Number, int Degree, class Scalar>
Polynomial<Degree, Number> taylor_shift(const Polynomial<Degree, Scalar>& p, const Number& shift) {
  Polynomial<Degree, Number> shifted;
  if constexpr (Degree == 1) {
    shifted.c[1] = Number(p.c[1]);
    shifted.c[0] = shift * p.c[1] + p.c[0];
  } else if constexpr (Degree == 2) {
    const Number bend = shift * p.c[2];
    shifted.c[2] = Number(p.c[2]);
    shifted.c[1] = bend * 2.0 + p.c[1];
    shifted.c[0] = shift * (bend + p.c[1]) + p.c[0];
  } else {
    for (std::size_t i = 0; i <= Degree; ++i) shifted.c[i] = Number(p.c[i]);
    if constexpr (std::is_same_v<Number, Ball<double>>) {
      if (shift.is_zero()) return shifted;
      if (shift.radius <= 0x1p-52 * std::abs(shift.middle)) return detail::shifted_balls(p, shift.middle);
    }
    // Repeated synthetic division by (x - shift).
    for (int k = 0; k < Degree; ++k) {
      for (int i = Degree - 1; i >= k; --i) {
        const auto j = static_cast<std::size_t>(i);
        shifted.c[j] = shifted.c[j] + shift * shifted.c[j + 1];
      }
    }
  }
  return shifted;
}

/// The motion as a polynomial in (t - epoch), in the arithmetic of Number.
template <class Number, int Degree>
Polynomial<Degree, Number> about(const Motion<Degree>& motion, double epoch) {
  return taylor_shift<Number>(motion.position, difference<Number>(epoch, motion.start));
}

/// a - b as a polynomial in (t - epoch), in the arithmetic of Number. Motions with a common start, the usual case, are
/// subtracted first and shifted once.
template <class Number, int Degree>
Polynomial<Degree, Number> difference_about(const Motion<Degree>& a, const Motion<Degree>& b, double epoch) {
  if (a.start != b.start) return about<Number>(a, epoch) - about<Number>(b, epoch);
  Polynomial<Degree, Number> relative;
  for (std::size_t i = 0; i <= Degree; ++i) relative.c[i] = difference<Number>(a.position.c[i], b.position.c[i]);
  return taylor_shift<Number>(relative, difference<Number>(epoch, a.start));
}

/// a - b at t, in double-doubles: the first coefficient of difference_about(), at less cost.
template <int Degree>
Ball<DoubleDouble> extended_difference(const Motion<Degree>& a, const Motion<Degree>& b, double t) {
  if (a.start != b.start) {
    return compensated_value(a.position, two_sum(t, -a.start)) - compensated_value(b.position, two_sum(t, -b.start));
  }
  Polynomial<Degree, DoubleDouble> relative;
  for (std::size_t i = 0; i <= Degree; ++i) relative.c[i] = two_sum(a.position.c[i], -b.position.c[i]);
  return compensated_value(relative, two_sum(t, -a.start));
}

/// The polynomial p(-x), exactly.
template <int Degree>
Polynomial<Degree> mirrored(const Polynomial<Degree>& p) {
  Polynomial<Degree> result = p;
  for (std::size_t i = 1; i <= Degree; i += 2) result.c[i] = 0.0 - p.c[i];  // never -0
  return result;
}

/// The same motion in time that runs backwards: reversed(m)(-t) = m(t), exactly. Twice gives the motion itself (with
/// zeros for negative zeros, which are equal to them).
template <int Degree>
Motion<Degree> reversed(const Motion<Degree>& motion) {
  return {mirrored(motion.position), 0.0 - motion.start};
}

/// The same motion restarted at t: equal up to the rounding of its new coefficients.
template <int Degree>
Motion<Degree> restarted(const Motion<Degree>& motion, double t) {
  return {about<double>(motion, t), t};
}

}  // namespace kds
