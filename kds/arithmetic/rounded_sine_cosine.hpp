// Sine and cosine as the doubles nearest to them.
#pragma once

#include "kds/arithmetic/ball.hpp"
#include "kds/arithmetic/double_double.hpp"
#include "kds/arithmetic/sine_cosine.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace kds {

/// The doubles nearest to what sine_cosine<Ball<DoubleDouble>>(angle) says, which are its `middle.high`, bit for bit.
///
/// Nearly always a table of sines and cosines and short series in doubles tell to which double the result rounds; where
/// they do not, one of some hundred times, double-doubles do. Made of + - * alone.
///
/// Cost: a fifth of that in double-doubles.
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

/// Sine and cosine of the angles j / 32, j from 0 to 26: all that are nearest to one up to 0.79.
struct SinesOfTable {
  static constexpr double steps = 32;  ///< a radian
  std::array<SineCosine<DoubleDouble>, 27> entries;
};
inline const SinesOfTable& sines_of_table() {
  static const SinesOfTable made = [] {
    SinesOfTable table;
    for (std::size_t j = 0; j < table.entries.size(); ++j) {
      const auto a = sine_cosine<Ball<DoubleDouble>>(Ball<DoubleDouble>(static_cast<double>(j) / SinesOfTable::steps));
      table.entries[j] = {a.sine.middle, a.cosine.middle};
    }
    return table;
  }();
  return made;
}

/// The sine and the cosine of r, |r| from 2^-60 to 0.786.
struct ApproximateSineCosine {
  Approximation sine, cosine;
};

/// By those of the nearest angle a of the table, and of d = r - a, |d| <= 2^-6 (1 + 2^-40): sin r = sin a + (cos a d +
/// (cos a s - sin a c)), cos r = cos a - (sin a d + (sin a s + cos a c)), where s = sin d - d and c = 1 - cos d.
///
/// Error bound, with u = 2^-53. a is short, and d is exact but for 2^-106 of it. c <= 2^-13 is summed in doubles: it
/// errs by 3 u of itself for its roundings, by 2^-65 for what d is besides its leading double, and by 2^-76 for what
/// the series leaves out. s <= d z / 6 errs by 3 u of itself, and by d z^4 / 9!. The products of d and the leading
/// numbers of the table are exact; those of its low parts are rounded below 2^-106. What stands in the outer brackets,
/// without the exact product, is below 2^-12 for the cosine and below 2^-12 sin a + d z / 2 for the sine, and its three
/// sums err by u of it each. In all less than 2^-63 for the cosine, 2^-63 sin a + d (2^-52 z + 2^-100) for the sine.
inline ApproximateSineCosine approximately_near_zero(const DoubleDouble& r) {
  constexpr double to_integer = 0x1.8p52;                                            // a sum with it has the unit 1
  constexpr double of_both = 0x1p-62, of_small_sine = 0x1p-51, of_others = 0x1p-95;  // twice the bounds, at least
  const double sign = r.high < 0 ? -1 : 1;
  const double j = (sign * r.high * SinesOfTable::steps + to_integer) - to_integer;
  const auto& [sine, cosine] = sines_of_table().entries[static_cast<std::size_t>(j)];
  const DoubleDouble d = fast_two_sum(sign * r.high - j / SinesOfTable::steps, sign * r.low);
  const double z = d.high * d.high;
  const double s = d.low + d.high * (z * series<1, 3>(sine_series, z));
  const double c = -(z * series<1, 4>(cosine_series, z));
  const DoubleDouble along = two_product(cosine.high, d.high), across = two_product(sine.high, d.high);
  const double more = along.low + ((cosine.low * d.high + sine.low) + (cosine.high * s - sine.high * c));
  const double less = across.low + ((sine.low * d.high - cosine.low) + (sine.high * s + cosine.high * c));
  const DoubleDouble up = fast_two_sum(sine.high, along.high), down = fast_two_sum(cosine.high, -across.high);
  const DoubleDouble of_sine = fast_two_sum(up.high, up.low + more);
  const double sine_error = of_both * sine.high + std::abs(d.high) * (of_small_sine * z + of_others);
  return {{{sign * of_sine.high, sign * of_sine.low}, sine_error}, {fast_two_sum(down.high, down.low - less), of_both}};
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
