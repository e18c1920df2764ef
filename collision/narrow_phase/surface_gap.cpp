#include "collision/narrow_phase/surface_gap.hpp"

#include "collision/narrow_phase/capsule_contact.hpp"
#include "collision/shapes/rounded_core.hpp"
#include "collision/vectors.hpp"

#include <cmath>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

/// The half width of a shape along a unit vector, from its centre.
double half_width(const PlacedShape& shape, const Vector3d& along) {
  const double radius = ball_radius(shape.shape);
  if (radius > 0) return radius;
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
  return dot(normal, apart) - half_width(a.shape, normal) - half_width(b.shape, normal);
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
  const Vector3d normal = rounded_contact(a, b, t).normal;
  return {gap_along(a, b, normal, t), normal};
}

#define KDS_INSTANTIATE(degree)                                                                              \
  template SurfaceGap surface_gap(const TranslatingShape<degree>&, const TranslatingShape<degree>&, double); \
  template double gap_along(const TranslatingShape<degree>&, const TranslatingShape<degree>&, const Vector3d&, double);
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
