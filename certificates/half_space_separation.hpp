// A convex body above a plane.
#pragma once

#include "certificates/along_axis.hpp"
#include "certificates/point_motion.hpp"
#include "certificates/polytope_separation.hpp"
#include "certificates/zonotope_separation.hpp"

#include <Eigen/Core>

#include <span>
#include <type_traits>

namespace kds::certificates {

/// What is lowest of a body along a normal, seen from its centre: a point of it, as it is turned and scaled, less the
/// half widths of segments about the point and a radius. Any of these may be nothing: no segment, a radius or a scale
/// of 0.
struct LowestPlace {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double scale = 0;
  std::span<const Generator> generators{};
  double radius = 0;

  /// Along a normal of any length; the radius counts as it is.
  template <class Number>
  Number height(const Eigen::Vector3d& normal) const {
    const auto n = detail::numbers<Number>(normal);
    Number low = Number(0.0) - Number(radius);
    for (const Generator& each : generators) {
      low = low - absolute(detail::inner_product(n, detail::numbers<Number>(each.direction)) * each.length);
    }
    if (scale == 0) return low;
    const TurnedPoints points{turn, {&point, 1}};
    return low + detail::inner_product(n, points.operator()<Number>(0)) * scale;
  }
};

/// normal . (b(t) - a(t)) + lowest.height(normal) >= offset: a body at b is above the plane normal . x = offset of a
/// half-space at a. Degree: that of the paths.
template <int PathDegree>
struct HalfSpaceSeparation {
  static constexpr int degree = PathDegree;

  const PointMotion<PathDegree>& a;
  const PointMotion<PathDegree>& b;
  Eigen::Vector3d normal;
  double offset;
  const LowestPlace& lowest;

  template <class Number>
  Polynomial<PathDegree, Number> polynomial(double epoch) const {
    Polynomial<PathDegree, Number> f;
    if constexpr (std::is_same_v<Number, Ball<double>>) {
      f = along_axis(a, b, normal, epoch);
    } else {
      const auto r = relative_motion<Number>(a, b, epoch);
      f = r[0] * normal[0] + r[1] * normal[1] + r[2] * normal[2];
    }
    f.c[0] = f.c[0] + (lowest.height<Number>(normal) - Number(offset));
    return f;
  }

  Ball<DoubleDouble> extended_value(double t) const {
    using Number = Ball<DoubleDouble>;
    return extended_along_axis(a, b, normal, t) + (lowest.height<Number>(normal) - Number(offset));
  }
};

}  // namespace kds::certificates
