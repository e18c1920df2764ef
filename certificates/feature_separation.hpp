// A ball away from a vertex or from the line of an edge of a box.
#pragma once

#include "certificates/along_axis.hpp"
#include "certificates/point_motion.hpp"
#include "kds/certificate.hpp"

#include <array>
#include <cstddef>
#include <type_traits>

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
    Polynomial<degree, Number> f;
    const auto add = [&](std::size_t i, Polynomial<PathDegree, Number> x) {
      x.c[0] = x.c[0] - offset[i];
      f = f + square(x);
    };
    if constexpr (std::is_same_v<Number, Ball<double>>) {
      for (std::size_t i = 0; i < 3; ++i) {
        if (used[i]) add(i, along_axis(a, b, axes[i], epoch));
      }
    } else {
      const auto r = relative_motion<Number>(a, b, epoch);
      for (std::size_t i = 0; i < 3; ++i) {
        if (used[i]) add(i, r[0] * axes[i][0] + r[1] * axes[i][1] + r[2] * axes[i][2]);
      }
    }
    f.c[0] = f.c[0] - Number(radius) * Number(radius);
    return f;
  }

  Ball<DoubleDouble> extended_value(double t) const {
    Ball<DoubleDouble> f = -(Ball<DoubleDouble>(radius) * Ball<DoubleDouble>(radius));
    for (std::size_t i = 0; i < 3; ++i) {
      if (!used[i]) continue;
      const Ball<DoubleDouble> x = extended_along_axis(a, b, axes[i], t) - offset[i];
      f = f + x * x;
    }
    return f;
  }
};

}  // namespace kds::certificates
