// Two balls apart.
#pragma once

#include "certificates/point_motion.hpp"
#include "kds/certificate.hpp"

namespace kds::certificates {

/// |b(t) - a(t)|^2 >= (radius_a + radius_b)^2: two balls do not penetrate. Degree 2 for linear, 4 for quadratic paths.
template <int PathDegree>
struct BallSeparation {
  static constexpr int degree = 2 * PathDegree;
  const PointMotion<PathDegree>& a;
  const PointMotion<PathDegree>& b;
  double radius_a;
  double radius_b;

  template <class Number>
  Polynomial<degree, Number> polynomial(double epoch) const {
    const auto r = relative_motion<Number>(a, b, epoch);
    const Number reach = Number(radius_a) + radius_b;
    auto f = square(r[0]) + square(r[1]) + square(r[2]);
    f.c[0] = f.c[0] - reach * reach;
    return f;
  }

  Ball<DoubleDouble> extended_value(double t) const {
    const Ball<DoubleDouble> reach = Ball<DoubleDouble>(radius_a) + radius_b;
    Ball<DoubleDouble> f = -(reach * reach);
    for (int d = 0; d < 3; ++d) {
      const Ball<DoubleDouble> r = extended_difference(b.axis(d), a.axis(d), t);
      f = f + r * r;
    }
    return f;
  }
};

}  // namespace kds::certificates
