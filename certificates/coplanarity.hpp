// Four moving points in one plane: the fact behind vertex-face and edge-edge contact.
#pragma once

#include "certificates/point_motion.hpp"
#include "kds/certificate.hpp"

namespace kds::certificates {

/// side * det(b - a, c - a, d - a) >= 0: six times the signed volume of the tetrahedron a, b, c, d keeps its sign.
///
/// With side +1 it is positive while a, b, c turn counter-clockwise seen from d. It fails when d crosses the plane
/// through a, b, c, and equally when the line through a, b crosses that through c, d. Degree 3 for linear paths: the
/// cubic of the literature on continuous collision [Provot97]; degree 6 for quadratic ones. Its failure times are exact
/// where four points become coplanar; whether the features meet there or only their plane and line is another question,
/// which features/feature_contact.hpp answers.
template <int PathDegree>
struct Coplanarity {
  static constexpr int degree = 3 * PathDegree;
  const PointMotion<PathDegree>& a;
  const PointMotion<PathDegree>& b;
  const PointMotion<PathDegree>& c;
  const PointMotion<PathDegree>& d;
  double side = 1;  ///< +1 or -1

  template <class Number>
  Polynomial<degree, Number> polynomial(double epoch) const {
    const auto x = relative_motion<Number>(a, b, epoch);
    const auto y = relative_motion<Number>(a, c, epoch);
    const auto z = relative_motion<Number>(a, d, epoch);
    const auto volume =
        (x[1] * y[2] - x[2] * y[1]) * z[0] + (x[2] * y[0] - x[0] * y[2]) * z[1] + (x[0] * y[1] - x[1] * y[0]) * z[2];
    return volume * side;
  }
};

}  // namespace kds::certificates
