// Sine and cosine as the doubles nearest to them.
#pragma once

#include "kds/arithmetic/ball.hpp"
#include "kds/arithmetic/double_double.hpp"
#include "kds/arithmetic/sine_cosine.hpp"

#include <array>
#include <cmath>

namespace kds {

/// The doubles nearest to what sine_cosine<Ball<DoubleDouble>>(angle) says, which are its `middle.high`, bit for bit.
///
/// Nearly always the first terms of the series in double-doubles and the others in doubles tell to which double the
/// result rounds; where they do not, one of some thousand times, double-doubles do. Made of + - * alone.
///
/// Cost: a fourth of that in double-doubles.
SineCosine<double> rounded_sine_cosine(const Ball<DoubleDouble>& angle);

// ---------------------------------------------------------------------------------------------------------------

namespace detail {

/// A number within `error` of high + low.
struct Approximation {
  DoubleDouble value;
  double error;

  /// Whether all numbers within `error` round to value.high: those at either end do. Half of the error pays for the
  /// rounding of the two sums.
  bool rounds_surely() const {
    return value.high + (value.low + error) == value.high && value.high + (value.low - error) == value.high;
  }
};

/// a + b for |a| >= |b|, up to 2^-104 of it.
inline DoubleDouble sum_of_falling(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble high = fast_two_sum(a.high, b.high);
  return fast_two_sum(high.high, high.low + (a.low + b.low));
}

/// c_1 + z (c_2 + z (c_3 + ...)), the terms from the third on in doubles.
///
/// Error bound, with u = 2^-53 and z < 0.618, as in near_zero(): the terms from c_3 to c_9 err by 2.3 u c_3, their
/// product with z by u z c_3 more, and by as much again for the low part of z; what is left out is below z^7 c_10. For
/// the sine, with |c_3| < 2^-12 and c_10 < 2^-65, that is below 2^-63, for the cosine, with |c_3| < 2^-9.4 and c_10 <
/// 2^-61, below 2^-61; either once more times z. Double-doubles err by less than 2^-100.
inline DoubleDouble shortened_series(const std::array<DoubleDouble, 13>& c, const DoubleDouble& z) {
  const double rest = z.high * series<3, 9>(c, z.high);
  return sum_of_falling(c[0], z * sum_of_falling(c[1], rest));
}

/// The sine and the cosine of r, |r| from 2^-60 to 0.786.
struct ApproximateSineCosine {
  Approximation sine, cosine;
};
inline ApproximateSineCosine approximately_near_zero(const DoubleDouble& r) {
  const DoubleDouble z = r * r;
  const double square = z.high * z.high;
  constexpr double of_sine = 0x1p-62, of_cosine = 0x1p-60;  // twice the bounds
  constexpr double of_others = 0x1p-95;                     // and of all that double-doubles do
  const DoubleDouble sine = sum_of_falling(r, r * (z * shortened_series(sine_series, z)));
  const DoubleDouble cosine = sum_of_falling(1.0, z * shortened_series(cosine_series, z));
  return {{sine, std::abs(r.high) * (of_sine * square + of_others)}, {cosine, of_cosine * square + of_others}};
}

}  // namespace detail

inline SineCosine<double> rounded_sine_cosine(const Ball<DoubleDouble>& angle) {
  if (std::abs(angle.middle.high) <= greatest_angle) {
    const detail::ReducedAngle reduced = detail::reduced(angle.middle);
    if (std::abs(reduced.remainder.high) >= 0x1p-60) {
      const auto [sine, cosine] = detail::approximately_near_zero(reduced.remainder);
      if (sine.rounds_surely() && cosine.rounds_surely()) {
        const SineCosine<double> rounded{sine.value.high, cosine.value.high};
        return detail::turned_by_quadrants(rounded, reduced.quadrant);
      }
    }
  }
  const auto a = sine_cosine<Ball<DoubleDouble>>(angle);
  return {a.sine.middle.high, a.cosine.middle.high};
}

}  // namespace kds
