// Two convex bodies apart along a direction.
#pragma once

#include "certificates/along_axis.hpp"
#include "certificates/point_motion.hpp"
#include "kds/certificate.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>

namespace kds::certificates {

/// a . b for vectors of doubles.
template <class Number>
Number dot(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return Number(a[0]) * b[0] + Number(a[1]) * b[1] + Number(a[2]) * b[2];
}

/// side * axis . (b(t) - a(t)) >= half_width, where half_width = sum |axis . extents[i]| + sum margins[i]: the convex
/// bodies centred at a and b, sums of the segments +-extents[i] and of balls, lie apart on one side of a plane across
/// `axis`.
///
/// Any double vector is a valid axis: what is certified is the separation along exactly that direction.
/// Degree: that of the paths.
template <int PathDegree>
struct PlaneSeparation {
  static constexpr int degree = PathDegree;
  static constexpr std::size_t most_half_axes = 6;

  const PointMotion<PathDegree>& a;
  const PointMotion<PathDegree>& b;
  Eigen::Vector3d axis;
  double side;                                                   ///< +1 or -1
  std::array<const Eigen::Vector3d*, most_half_axes> extents{};  ///< half axes of either body, null when unused
  std::array<double, 2> margins{};                               ///< added to the half width as they are

  template <class Number>
  Polynomial<PathDegree, Number> polynomial(double epoch) const {
    if constexpr (std::is_same_v<Number, Ball<double>>) {
      auto f = along_axis(a, b, axis, epoch) * side;
      f.c[0] = f.c[0] - bounded_half_width();
      return f;
    } else {
      const auto r = relative_motion<Number>(a, b, epoch);
      Polynomial<PathDegree, Number> f = (r[0] * axis[0] + r[1] * axis[1] + r[2] * axis[2]) * side;
      f.c[0] = f.c[0] - half_width<Number>();
      return f;
    }
  }

  Ball<DoubleDouble> extended_value(double t) const {
    return extended_along_axis(a, b, axis, t) * side - half_width<Ball<DoubleDouble>>();
  }

 private:
  template <class Number>
  Number half_width() const {
    if constexpr (std::is_same_v<Number, Ball<DoubleDouble>>) {
      return extended_half_width();
    } else {
      Number half_width = Number(margins[0]) + margins[1];
      for (const Eigen::Vector3d* half_axis : extents) {
        if (half_axis) half_width = half_width + absolute(dot<Number>(axis, *half_axis));
      }
      return half_width;
    }
  }

  /// The same in double-doubles, of products that are exact. Error bound: each of the at most eight sums that a product
  /// takes part in adds 2^-102 of it; underflow less than 2^-1000.
  Ball<DoubleDouble> extended_half_width() const {
    DoubleDouble sum = two_sum(margins[0], margins[1]);
    double magnitudes = std::abs(margins[0]) + std::abs(margins[1]);
    for (const Eigen::Vector3d* half_axis : extents) {
      if (!half_axis) continue;
      const Eigen::Vector3d& h = *half_axis;
      const DoubleDouble x = two_product(axis[0], h[0]);
      const DoubleDouble y = two_product(axis[1], h[1]);
      const DoubleDouble z = two_product(axis[2], h[2]);
      const DoubleDouble along = (x + y) + z;
      sum = sum + (along.high < 0 ? -along : along);
      magnitudes += std::abs(x.high) + std::abs(y.high) + std::abs(z.high);
    }
    return {sum, 0x1p-98 * magnitudes + 0x1p-1000};
  }

  /// The same in doubles. Error bound, with u = 2^-53: 3 u of the sum of magnitudes in each product with the axis, 8 u
  /// in the sum; underflow less than 2^-1000.
  Ball<double> bounded_half_width() const {
    double sum = margins[0] + margins[1];
    double magnitudes = std::abs(margins[0]) + std::abs(margins[1]);
    for (const Eigen::Vector3d* half_axis : extents) {
      if (!half_axis) continue;
      const Eigen::Vector3d& h = *half_axis;
      const double x = axis[0] * h[0];
      const double y = axis[1] * h[1];
      const double z = axis[2] * h[2];
      sum += std::abs((x + y) + z);
      magnitudes += std::abs(x) + std::abs(y) + std::abs(z);
    }
    return {sum, 16 * 0x1p-53 * magnitudes + 0x1p-1000};
  }
};

}  // namespace kds::certificates
