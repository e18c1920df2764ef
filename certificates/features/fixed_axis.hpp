// How long a fixed direction separates a moving patch from the origin.
#pragma once

#include "certificates/features/closest_point.hpp"
#include "certificates/vectors.hpp"

#include <cmath>
#include <limits>

namespace kds::certificates {

/// The margin that an axis of 1-norm 1 keeps: a bound on everything that is rounded.
///
/// axis . corner(s), computed as a polynomial of s, differs from what is meant by at most paths.error for the patch,
/// and by less than 52 x 2^-53 size for the arithmetic: 3 for the coefficients, 1 for taking off the margin, and for
/// quadratic paths 4 roundings of moving to s and 8 for the root, of coefficients whose parts sum to 4 size. Where
/// features have a thickness it is one more of these parts. See docs/features.md, "Rounding".
template <int Degree>
double axis_margin(const PatchPaths<Degree>& paths, double thickness) {
  return paths.error + 64 * half_ulp * (paths.size + thickness);
}

namespace detail {

/// Per lane the first root of c0 + c1 h + c2 h^2, which is positive at 0, and a number above 1 if there is none: a
/// closed form without cancellation, so that it is the exact root for coefficients changed by a few roundings each.
inline double first_root(double c0, double c1, double c2) {
  constexpr double none = std::numeric_limits<double>::infinity();
  const double discriminant = c1 * c1 - 4 * c0 * c2;
  if (!(discriminant >= 0)) return none;
  const double root = std::sqrt(discriminant);
  if (c1 > 0) return c2 < 0 ? (c1 + root) / (-2 * c2) : none;
  const double denominator = root - c1;
  return denominator > 0 ? 2 * c0 / denominator : none;
}

}  // namespace detail

/// The last r up to which, from s on, `axis` certifiably keeps all corners of the patch farther than the margin and
/// `thickness` from the origin; infinity if that is up to the end of time, s if it does not do so now. Any axis may
/// be tried: one that does not separate the two gives s.
template <int Degree>
double separated_until(const PatchPaths<Degree>& paths, double margin, double thickness, const Eigen::Vector3d& axis,
                       double s) {
  constexpr double none = std::numeric_limits<double>::infinity();
  double least = margin * (std::abs(axis[0]) + std::abs(axis[1]) + std::abs(axis[2]));
  if (thickness > 0) least += thickness * norm(axis);  // their roundings are in the margin
  const Lanes level(least);
  const Lanes height = detail::dot(axis, paths.c[0]) - level;
  const Lanes rate = detail::dot(axis, paths.c[1]);
  if constexpr (Degree == 1) {
    if (!(lowest(height + rate * Lanes(s)) > 0)) return s;
    const Lanes zero(0.0);
    return lowest(where_greater(zero, rate, height / -rate, Lanes(none)));
  } else {
    const Lanes bend = detail::dot(axis, paths.c[2]);
    const Lanes c0 = height + (rate + bend * Lanes(s)) * Lanes(s);
    const Lanes c1 = rate + bend * Lanes(2 * s);
    if (!(lowest(c0) > 0)) return s;
    double h = none;
    for (std::size_t k = 0; k < 4; ++k) h = std::min(h, detail::first_root(c0[k], c1[k], bend[k]));
    return s + h;
  }
}

/// Whether a coordinate axis separates the patch from the origin, by more than the margin, for all of [0, 1]: the boxes
/// around the two features' paths are apart.
template <int Degree>
bool boxes_apart(const PatchPaths<Degree>& paths, double margin) {
  for (std::size_t d = 0; d < 3; ++d) {
    const Lanes start = paths.c[0][d];
    const Lanes bent = start + paths.c[1][d] * Lanes(1.0 / Degree);  // the control point between, for degree 2
    Lanes high = greater(start, bent);
    Lanes low = lesser(start, bent);
    if constexpr (Degree == 2) {
      const Lanes end = start + paths.c[1][d] + paths.c[2][d];
      high = greater(high, end);
      low = lesser(low, end);
    }
    if (highest(high) < -margin || lowest(low) > margin) return true;
  }
  return false;
}

}  // namespace kds::certificates
