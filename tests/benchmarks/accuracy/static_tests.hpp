// Whether two shapes overlap where they stand, as a sampling engine asks, and how deep. Doubles, no margins.
#pragma once

#include "collision/narrow_phase/mesh_contact.hpp"
#include "collision/shapes/shape.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

namespace accuracy {

using Eigen::Vector3d;
using kds::collision::PlacedShape;

/// Calls visit(axis, overlap along it times its length) for the axes that can separate two boxes, faces first, until it
/// returns false.
template <class Visit>
void box_axes(const PlacedShape& a, const PlacedShape& b, const Vector3d& r, const Visit& visit) {
  const auto overlap = [&](const Vector3d& axis) {
    double half_widths = 0;
    for (const auto& u : a.half_axes) half_widths += std::abs(axis.dot(u));
    for (const auto& u : b.half_axes) half_widths += std::abs(axis.dot(u));
    return half_widths - std::abs(axis.dot(r));
  };
  for (const PlacedShape* box : {&a, &b}) {
    for (int d = 0; d < 3; ++d) {
      const Vector3d axis = box->rotation.col(d);
      if (!visit(axis, overlap(axis))) return;
    }
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const Vector3d axis = a.rotation.col(i).cross(b.rotation.col(j));
      if (axis.squaredNorm() > 1e-20 && !visit(axis, overlap(axis))) return;
    }
  }
}

/// b's centre is at r from a's. The scenes hold one kind of shape each.
inline bool overlap(const PlacedShape& a, const PlacedShape& b, const Vector3d& r) {
  using namespace kds::collision;
  if (const auto* ball = std::get_if<Sphere>(&a.shape)) {
    const double sum_of_radii = ball->radius + std::get<Sphere>(b.shape).radius;
    return r.squaredNorm() < sum_of_radii * sum_of_radii;
  }
  if (std::holds_alternative<Box>(a.shape)) {
    bool apart = false;
    box_axes(a, b, r, [&](const Vector3d&, double overlap) { return !(apart = overlap <= 0); });
    return !apart;
  }
  RelativeMotion<1> still;
  still.coefficients = {r, Vector3d::Zero()};
  return MeshPair<1>(a, b, still).touching(0);
}

/// How deep balls or boxes are in each other: the shortest way out along one axis; < 0 apart.
inline double depth(const PlacedShape& a, const PlacedShape& b, const Vector3d& r) {
  using namespace kds::collision;
  if (const auto* ball = std::get_if<Sphere>(&a.shape)) {
    return ball->radius + std::get<Sphere>(b.shape).radius - r.norm();
  }
  double least = std::numeric_limits<double>::infinity();
  box_axes(a, b, r, [&](const Vector3d& axis, double overlap) {
    least = std::min(least, overlap / axis.norm());
    return true;
  });
  return least;
}

}  // namespace accuracy
