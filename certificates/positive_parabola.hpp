// How long a parabola stays positive.
#pragma once

#include "kds/certificate.hpp"

#include <cmath>

namespace kds::certificates {

/// An s, rounded down, such that c0 + c1 x + c2 x^2 > 0 for all x in [0, s); near the first root, `never` if there is
/// none, 0 unless c0 > 0.
///
/// Rounding: the discriminant is changed by eight times its rounding error, to the safe side, so that a double root is
/// found early; the quotient is reduced by far more than its rounding error. Where products are so small that they
/// might lose digits, or vanish, x is counted in a larger unit.
inline double positive_for(double c0, double c1, double c2) {
  if (!(c0 > 0)) return 0;
  if (c1 >= 0 && c2 >= 0) return never;
  const double square = c1 * c1;
  const double product = 4 * c0 * c2;
  const double sum = square + std::abs(product);
  if (sum < 0x1p-900) [[unlikely]]
    return 0x1p200 * positive_for(c0, 0x1p200 * c1, 0x1p400 * c2);
  const double rounding = 0x1p-49 * sum;
  double s;
  if (c1 > 0) {  // It rises first.
    s = (c1 + std::sqrt(square - product - rounding)) / (-2 * c2);
  } else {
    const double discriminant = square - product + rounding;
    if (discriminant < 0) return never;
    s = 2 * c0 / (std::sqrt(discriminant) - c1);
  }
  s *= 1 - 0x1p-40;
  return s >= 0 ? s : 0;  // 0 for a NaN, which numbers that are too large leave
}

}  // namespace kds::certificates
