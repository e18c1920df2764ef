// The distance of two points on straight paths, in twice the working precision.
#pragma once

#include "certificates/point_motion.hpp"
#include "kds/arithmetic/ball.hpp"
#include "kds/arithmetic/double_double.hpp"
#include "kds/arithmetic/two_double_doubles.hpp"

#include <limits>

namespace kds::certificates {

/// |b(t) - a(t)|^2 - (radius_a + radius_b)^2, with a bound on its error; a NaN or an infinite bound where numbers are
/// out of range.
///
/// In double-double, without a bound for each step: two axes at a time, and one bound for all, in a third of the time
/// (docs/benchmarks.md, "Relative motion"). With u = 2^-53, m the
/// sum of magnitudes of an axis (positions and what is moved by), M that of all axes, R the sum of the radii. Elapsed
/// times, sums of two and products of two doubles are exact. The low part of a position is a sum of two errors and a
/// product, known to 6 u^2 m; that of the difference, at most 4 u m, to 13 u^2 m. The square leaves out that of the low
/// part and rounds what it adds, so that it is known to 59 u^2 m^2, with a low part of at most 9 u m^2; that of the sum
/// of the radii to 6 u^2 R^2. The high parts are added without error; the three remainders (at most u (M^2 + R^2) each)
/// and the low parts are added with six roundings, together 44 u^2 M^2 + 14 u^2 R^2. In all that is below 2^-99 (128
/// u^2) times M^2 + R^2, with room for the rounding of the bound. Within the range below underflow is negligible
/// against that.
inline Ball<DoubleDouble> extended_square_gap(const PointMotion<1>& a, const PointMotion<1>& b, double radius_a,
                                              double radius_b, double t);

// ---------------------------------------------------------------------------------------------------------------

namespace detail {

/// On two axes: the square of the distance, and a bound on the coordinates.
struct SquareParts {
  TwoDoubleDoubles square;
  Two size;

  [[gnu::always_inline]] inline SquareParts(Two a0, Two a1, const DoubleDouble& since_a, Two b0, Two b1,
                                            const DoubleDouble& since_b) {
    const TwoDoubleDoubles moved_a = two_product(a1, both(since_a.high));
    const TwoDoubleDoubles moved_b = two_product(b1, both(since_b.high));
    const TwoDoubleDoubles at_a = two_sum(a0, moved_a.high);
    const TwoDoubleDoubles at_b = two_sum(b0, moved_b.high);
    const TwoDoubleDoubles r = two_sum(at_b.high, -at_a.high);
    const Two low_a = at_a.low + (moved_a.low + a1 * since_a.low);
    const Two low_b = at_b.low + (moved_b.low + b1 * since_b.low);
    const Two low = r.low + (low_b - low_a);
    square = two_product(r.high, r.high);
    square.low += 2 * r.high * low;
    size = magnitude(a0) + magnitude(moved_a.high) + magnitude(b0) + magnitude(moved_b.high);
  }
};

}  // namespace detail

inline Ball<DoubleDouble> extended_square_gap(const PointMotion<1>& a, const PointMotion<1>& b, double radius_a,
                                              double radius_b, double t) {
  const auto& [a0, a1] = a.coefficients;
  const auto& [b0, b1] = b.coefficients;
  const DoubleDouble since_a = two_sum(t, -a.start);
  const DoubleDouble since_b = two_sum(t, -b.start);
  const detail::SquareParts xy(Two{a0[0], a0[1]}, Two{a1[0], a1[1]}, since_a, Two{b0[0], b0[1]}, Two{b1[0], b1[1]},
                               since_b);
  const detail::SquareParts z(Two{a0[2], 0}, Two{a1[2], 0}, since_a, Two{b0[2], 0}, Two{b1[2], 0}, since_b);
  const DoubleDouble radii = two_sum(radius_a, radius_b);
  const DoubleDouble own = two_product(radii.high, radii.high);

  const double size = xy.size[0] + xy.size[1] + z.size[0];
  const double magnitude = size * size + radii.high * radii.high;
  if (!(magnitude > 0x1p-600 && magnitude < 0x1p600)) return {0.0, std::numeric_limits<double>::infinity()};
  const DoubleDouble x_and_y = two_sum(xy.square.high[0], xy.square.high[1]);
  const DoubleDouble all = two_sum(x_and_y.high, z.square.high[0]);
  const DoubleDouble gap = two_sum(all.high, -own.high);
  const double of_squares = xy.square.low[0] + xy.square.low[1] + z.square.low[0];
  const double of_radii = own.low + 2 * radii.high * radii.low;
  return {two_sum(gap.high, (of_squares - of_radii) + (x_and_y.low + all.low + gap.low)), 0x1p-99 * magnitude};
}

}  // namespace kds::certificates
