// The motion of one point as seen from another along a direction, in doubles.
#pragma once

#include "certificates/point_motion.hpp"
#include "kds/arithmetic/ball.hpp"
#include "kds/arithmetic/compensated.hpp"
#include "kds/polynomial.hpp"

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>

namespace kds::certificates {

/// axis . (b(t) - a(t)) as a polynomial in (t - epoch): what relative_motion<Ball<double>> and the products with the
/// axis give, with one error bound for each coefficient instead of one for each operation, in 0.6 of the time for
/// parabolas, 0.9 for lines (docs/benchmarks.md, "Relative motion"). A coefficient that is zero whatever the roundings
/// has the radius 0.
///
/// Error bound, with u = 2^-53. The elapsed times are known to u; a coordinate of a path is a sum of at most three
/// products, known to 6 u of the sum of their magnitudes, m; the difference of two adds u. The product with the axis
/// and the sum over the coordinates add 3 u: 10 u of sum |axis[d]| m[d] in all, for which 16 u is charged, since the
/// bound itself is rounded. Underflow takes less than 2^-1000. Paths of degree 3 and above use relative_motion()
/// itself.
template <int Degree>
Polynomial<Degree, Ball<double>> along_axis(const PointMotion<Degree>& a, const PointMotion<Degree>& b,
                                            const Eigen::Vector3d& axis, double epoch);

/// axis . (b(t) - a(t)) at t alone, in double-doubles.
template <int Degree>
Ball<DoubleDouble> extended_along_axis(const PointMotion<Degree>& a, const PointMotion<Degree>& b,
                                       const Eigen::Vector3d& axis, double t);

// ---------------------------------------------------------------------------------------------------------------

namespace detail {

inline constexpr double along_axis_unit = 16 * 0x1p-53;
inline constexpr double along_axis_lost = 0x1p-1000;

/// One coordinate of b - a about an epoch: coefficients, bounds on their magnitudes, and whether they may be other than
/// zero.
template <int Degree>
struct RelativeCoordinate {
  std::array<double, std::size_t{Degree} + 1> c;
  std::array<double, std::size_t{Degree} + 1> magnitude;
  std::array<bool, std::size_t{Degree} + 1> present;
};

/// The coefficients of c0 + c1 x + c2 x^2 about x = h.
template <int Degree>
void shift(std::array<double, std::size_t{Degree} + 1>& c, std::array<double, std::size_t{Degree} + 1>& magnitude,
           double h) {
  static_assert(Degree == 1 || Degree == 2);
  const double distance = std::abs(h);
  if constexpr (Degree == 2) {
    const double bend = c[2] * h;
    const double bends = magnitude[2] * distance;
    c[0] += (c[1] + bend) * h;
    magnitude[0] += (magnitude[1] + bends) * distance;
    c[1] += 2 * bend;
    magnitude[1] += 2 * bends;
  } else {
    c[0] += c[1] * h;
    magnitude[0] += magnitude[1] * distance;
  }
}

template <int Degree>
RelativeCoordinate<Degree> relative_coordinate(const PointMotion<Degree>& a, const PointMotion<Degree>& b, int d,
                                               double epoch) {
  RelativeCoordinate<Degree> r;
  bool present = false;
  if (a.start == b.start) {
    for (std::size_t i = Degree + 1; i-- > 0;) {
      r.c[i] = b.coefficients[i][d] - a.coefficients[i][d];
      r.magnitude[i] = std::abs(r.c[i]);
      r.present[i] = present = present || r.c[i] != 0;
    }
    shift<Degree>(r.c, r.magnitude, epoch - a.start);
    return r;
  }
  std::array<double, std::size_t{Degree} + 1> of_a, size_a, size_b;
  for (std::size_t i = Degree + 1; i-- > 0;) {
    of_a[i] = a.coefficients[i][d];
    r.c[i] = b.coefficients[i][d];
    size_a[i] = std::abs(of_a[i]);
    size_b[i] = std::abs(r.c[i]);
    r.present[i] = i == Degree ? of_a[i] != r.c[i] : present || size_a[i] + size_b[i] != 0;
    present = present || size_a[i] + size_b[i] != 0;
  }
  shift<Degree>(of_a, size_a, epoch - a.start);
  shift<Degree>(r.c, size_b, epoch - b.start);
  for (std::size_t i = 0; i <= Degree; ++i) {
    r.c[i] -= of_a[i];
    r.magnitude[i] = i == Degree ? std::abs(r.c[i]) : size_a[i] + size_b[i];
  }
  return r;
}

}  // namespace detail

template <int Degree>
Polynomial<Degree, Ball<double>> along_axis(const PointMotion<Degree>& a, const PointMotion<Degree>& b,
                                            const Eigen::Vector3d& axis, double epoch) {
  Polynomial<Degree, Ball<double>> f;
  if constexpr (Degree >= 3) {
    for (int d = 0; d < 3; ++d) {
      if (axis[d] != 0) f = f + difference_about<Ball<double>>(b.axis(d), a.axis(d), epoch) * axis[d];
    }
  } else {
    for (int d = 0; d < 3; ++d) {
      if (axis[d] == 0) continue;
      const auto r = detail::relative_coordinate(a, b, d, epoch);
      const double length = std::abs(axis[d]);
      for (std::size_t i = 0; i <= Degree; ++i) {
        if (!r.present[i]) continue;
        f.c[i].middle += axis[d] * r.c[i];
        f.c[i].radius += detail::along_axis_unit * (length * r.magnitude[i]) + detail::along_axis_lost;
      }
    }
  }
  return f;
}

template <int Degree>
Ball<DoubleDouble> extended_along_axis(const PointMotion<Degree>& a, const PointMotion<Degree>& b,
                                       const Eigen::Vector3d& axis, double t) {
  Ball<DoubleDouble> f;
  for (int d = 0; d < 3; ++d) {
    if (axis[d] != 0) f = f + extended_difference(b.axis(d), a.axis(d), t) * axis[d];
  }
  return f;
}

}  // namespace kds::certificates
