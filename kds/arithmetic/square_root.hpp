// The square root of a double-double, with its error bound.
#pragma once

#include "kds/arithmetic/ball.hpp"

#include <cmath>
#include <limits>

namespace kds {

namespace detail {

/// The root of a number h + l > 0, to 2^-103 of it, where nothing overflows or loses bits.
///
/// Error bound, with u = 2^-53 and x = sqrt(h) rounded: a - x^2 = p is at most 3.1 u x^2, and sqrt(a) = x + p / (2 x) -
/// p^2 / (8 x^3) + ...: what is left out is below 1.3 u^2 x. p is known to 2^-102 of itself, so p / (2 x), at most 1.6
/// u x, to 2.1 u of itself with the quotient: 3.4 u^2 x. The last sum is exact. In all less than 5 u^2 x < 2^-103 x.
inline DoubleDouble rounded_root(const DoubleDouble& a) {
  const double x = std::sqrt(a.high);
  const DoubleDouble rest = a - two_product(x, x);
  return fast_two_sum(x, rest.high / (2 * x));
}

}  // namespace detail

/// The root of the number meant, which is >= 0. The radius r of a becomes r / sqrt(a), since the root of the number
/// meant differs by r over the sum of both roots. Where a is too small or too large for its low part, or may be zero,
/// nothing is decided: the radius is infinite.
inline Ball<DoubleDouble> square_root(const Ball<DoubleDouble>& a) {
  if (a.is_zero()) return {};
  const double high = a.middle.high;
  if (!(high >= Ball<double>::tiny && high <= 0x1p1000 && a.radius <= 0x1p-60 * high)) {
    return {DoubleDouble(0.0), std::numeric_limits<double>::infinity()};
  }
  const DoubleDouble root = detail::rounded_root(a.middle);
  return {root, 0x1p-102 * root.high + a.radius / root.high};
}

}  // namespace kds
