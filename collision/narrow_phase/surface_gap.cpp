#include "collision/narrow_phase/surface_gap.hpp"

#include "collision/narrow_phase/capsule_contact.hpp"
#include "collision/narrow_phase/lowest_place.hpp"
#include "collision/shapes/half_space.hpp"
#include "collision/shapes/polytope.hpp"
#include "collision/shapes/rotation.hpp"
#include "collision/shapes/rounded_core.hpp"
#include "collision/shapes/shape_forms.hpp"
#include "collision/vectors.hpp"

#include <algorithm>
#include <cmath>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

/// How far a shape extends from its centre along a unit vector.
double extent_along(const PlacedShape& shape, const Vector3d& along) {
  const double radius = ball_radius(shape.shape);
  if (radius > 0) return radius;
  if (unbounded(shape.shape)) {  // Along its normal; in other directions it has no end.
    const HalfSpace placed = placed_half_space(shape);
    return dot(placed.normal, along) > 1 - 0x1p-40 ? placed.offset : never;
  }
  if (shape.parts) {
    double most = -never;
    for (const PlacedShape& part : *shape.parts) most = std::max(most, extent_along(part, along));
    return most;
  }
  if (has_mesh(shape.shape)) return -LowestOfShape(shape, -along).height();
  if (const Polytope* const hull = polytope_of(shape.shape)) {
    double most = -never;
    for (const std::uint32_t i : hull->structure().corners) {
      most = std::max(most, dot(along, rotated(shape.rotation, hull->points()[i])));
    }
    return most;
  }
  const RoundedCore core = rounded_core(shape);
  double sum = core.radius;
  for (const auto& each : core.generators) sum += each.length * std::abs(dot(along, each.direction));
  return sum;
}

}  // namespace

template <int Degree>
double gap_along(const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b, const Vector3d& normal,
                 double t) {
  const Vector3d apart = b.motion.position(t) - a.motion.position(t);
  return dot(normal, apart) - extent_along(a.shape, normal) - extent_along(b.shape, -normal);
}

template <int Degree>
SurfaceGap surface_gap(const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b, double t) {
  const double radius_a = ball_radius(a.shape.shape);
  const double radius_b = ball_radius(b.shape.shape);
  if (radius_a > 0 && radius_b > 0) {
    const Vector3d apart = b.motion.position(t) - a.motion.position(t);
    const double distance = norm(apart);
    if (distance > 0) return {distance - radius_a - radius_b, apart / distance};
  }
  const bool hull = polytope_of(a.shape.shape) || polytope_of(b.shape.shape);
  const Vector3d normal = hull ? contact_at(a, b, t).normal : rounded_contact(a, b, t).normal;
  return {gap_along(a, b, normal, t), normal};
}

#define KDS_INSTANTIATE(degree)                                                                              \
  template SurfaceGap surface_gap(const TranslatingShape<degree>&, const TranslatingShape<degree>&, double); \
  template double gap_along(const TranslatingShape<degree>&, const TranslatingShape<degree>&, const Vector3d&, double);
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
