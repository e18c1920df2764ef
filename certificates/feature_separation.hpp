// A ball away from a vertex or from the line of an edge of a box.
#pragma once

#include "certificates/point_motion.hpp"
#include "kds/certificate.hpp"

#include <array>

namespace kds::certificates {

/// sum over the used axes i of (axes[i] . (b(t) - a(t)) - offset[i])^2 >= radius^2.
///
/// With three orthonormal axes: the ball centred at b stays away from the point a + sum offset[i] axes[i]; with two,
/// from the line through it along the third. Degree 2 for linear, 4 for quadratic paths.
template <int PathDegree>
struct FeatureSeparation {
  static constexpr int degree = 2 * PathDegree;
  const PointMotion<PathDegree>& a;
  const PointMotion<PathDegree>& b;
  std::array<Eigen::Vector3d, 3> axes;
  std::array<double, 3> offset;
  std::array<bool, 3> used;
  double radius;

  template <class Number>
  Polynomial<degree, Number> polynomial(double epoch) const {
    const auto r = relative_motion<Number>(a, b, epoch);
    Polynomial<degree, Number> f;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!used[i]) continue;
      auto x = r[0] * axes[i][0] + r[1] * axes[i][1] + r[2] * axes[i][2];
      x.c[0] = x.c[0] - offset[i];
      f = f + x * x;
    }
    f.c[0] = f.c[0] - Number(radius) * Number(radius);
    return f;
  }
};

}  // namespace kds::certificates
