// A moving point on one side of the border of a region that moves: of a ball, or of an edge of a box.
#pragma once

#include "certificates/plane_motion.hpp"
#include "certificates/point_motion.hpp"
#include "certificates/squared.hpp"
#include "kds/certificate.hpp"
#include "kds/motion.hpp"

#include <algorithm>
#include <concepts>
#include <cstddef>

namespace kds::certificates {

/// How many coordinates a path has.
template <class Path>
inline constexpr int dimensions = 0;
template <int Degree>
inline constexpr int dimensions<PlaneMotion<Degree>> = 2;
template <int Degree>
inline constexpr int dimensions<PointMotion<Degree>> = 3;

/// sign (b(t) - a(t)) >= 0, for two coordinates. It stores its motions, since they are computed where it is made; Order
/// only refers to motions, which have to outlive it.
template <int Degree>
struct OnSide {
  static constexpr int degree = Degree;
  Motion<Degree> a, b;
  double sign;  ///< 1 or -1

  bool is_negative_of(const OnSide& other) const { return sign == -other.sign && a == other.a && b == other.b; }

  template <class Number>
  auto polynomial(double epoch) const {
    return difference_about<Number>(b, a, epoch) * sign;
  }
};

/// sign (radius(t)^2 - |point(t) - centre(t)|^2) >= 0.
template <class Path>
struct InBall {
  static constexpr int degree = 2 * Path::degree;
  Path point, centre;
  Motion<Path::degree> radius;
  double sign;  ///< 1: inside; -1: outside

  bool is_negative_of(const InBall& other) const {
    return sign == -other.sign && point == other.point && centre == other.centre && radius == other.radius;
  }

  template <class Number>
  auto polynomial(double epoch) const {
    auto inside = detail::squared(about<Number>(radius, epoch));
    for (int axis = 0; axis < dimensions<Path>; ++axis) {
      inside = inside - detail::squared(difference_about<Number>(point.axis(axis), centre.axis(axis), epoch));
    }
    return inside * sign;
  }
};

}  // namespace kds::certificates
