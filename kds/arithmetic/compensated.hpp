// The value of a polynomial in twice the working precision, at little more than the cost of one in doubles.
#pragma once

#include "kds/arithmetic/ball.hpp"
#include "kds/polynomial.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace kds {

/// p(x), with a bound on its error, for coefficients that are exact: doubles, or double-doubles such as differences of
/// doubles. x is a double-double taken as exact, such as the difference of two times.
///
/// Horner's rule in doubles; beside it, off the critical path, runs Horner's rule on the rounding errors of its steps,
/// which are doubles themselves [Graillat09].
///
/// Error bound. Write u = 2^-53, x = h + l with |l| <= u |h|, n for the degree, s_i for the partial results and m_i for
/// the same with magnitudes in place of numbers, so that |s_i| <= m_i up to (1 + u)^2n. Step i makes the errors
/// pi (of the product, <= u m_i) and sigma (of the sum, <= u m_i), and leaves out s_(i+1) l (<= u m_i) and the low part
/// of the coefficient (<= u m_i). The second Horner's rule sums these, at most 4 u m_i a step and u m_n at the start,
/// with three roundings each, two more in every later step, and one for the product with l, which it omits: a relative
/// error of at most (3 n + 4) u on a sum of magnitudes of at most (4 n + 1) u m_0, since m_i |h|^i <= m_0. That is
///     |error| <= (3 n + 4) (4 n + 1) u^2 m_0 <= 20 n (n + 1) u^2 m_0,
/// and the difference (at least 5 u^2 m_0) pays for the powers of 1 + u that were left out.
/// Underflow may cost 2^-1072 a step, and |h|^n times that in the end: below 2^-745 for |h|^n <= 2^320 and degrees up
/// to 100, which is within the bound if m_0 >= 2^-600. So |h| may be 2^40 for degrees up to 8, and for higher ones the
/// greatest power of two whose power n is at most 2^320. Beyond these limits, and where something overflows, nothing is
/// decided: the result is 0 with an infinite radius, or not a number. Degrees above 100 do not compile.
template <int Degree, class Coefficient>
Ball<DoubleDouble> compensated_value(const Polynomial<Degree, Coefficient>& p, const DoubleDouble& x);

// ---------------------------------------------------------------------------------------------------------------

namespace detail {

inline double high_part(double a) { return a; }
inline double high_part(const DoubleDouble& a) { return a.high; }
inline double low_part(double) { return 0; }
inline double low_part(const DoubleDouble& a) { return a.low; }

}  // namespace detail

template <int Degree, class Coefficient>
Ball<DoubleDouble> compensated_value(const Polynomial<Degree, Coefficient>& p, const DoubleDouble& x) {
  static_assert(Degree <= 100, "the bound on underflow is derived for degrees up to 100");
  constexpr double farthest = static_cast<double>(std::uint64_t{1} << (Degree <= 8 ? 40 : 320 / Degree));
  const double h = x.high;
  double s = detail::high_part(p.c[Degree]);
  double error = detail::low_part(p.c[Degree]);
  double magnitudes = std::abs(s);
  for (std::size_t i = Degree; i-- > 0;) {
    const DoubleDouble product = two_product(s, h);
    const DoubleDouble sum = two_sum(product.high, detail::high_part(p.c[i]));
    const double lost = ((product.low + sum.low) + detail::low_part(p.c[i])) + s * x.low;
    error = error * h + lost;
    magnitudes = magnitudes * std::abs(h) + std::abs(detail::high_part(p.c[i]));
    s = sum.high;
  }
  constexpr double bound = 20.0 * Degree * (Degree + 1) * 0x1p-106;
  if (!(std::abs(h) <= farthest && (magnitudes >= 0x1p-600 || Degree == 0))) {
    return {DoubleDouble(0.0), std::numeric_limits<double>::infinity()};
  }
  return {two_sum(s, error), bound * magnitudes};
}

}  // namespace kds
