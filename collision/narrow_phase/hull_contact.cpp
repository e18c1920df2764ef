#include "collision/narrow_phase/hull_contact.hpp"

#include "collision/degrees.hpp"
#include "collision/narrow_phase/contact_patch.hpp"
#include "collision/narrow_phase/convex_core.hpp"
#include "collision/narrow_phase/hull_distance.hpp"
#include "collision/narrow_phase/quick_motion.hpp"
#include "collision/shapes/rotation.hpp"
#include "collision/shapes/support.hpp"
#include "collision/vectors.hpp"

#include <algorithm>
#include <vector>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

/// The places of the corners of a core about the centre of its body, rounded.
class CornerPlaces {
 public:
  explicit CornerPlaces(const PlacedShape& shape) : radius_(0) {
    const ConvexCore core(shape.shape);
    radius_ = core.radius();
    for (const std::uint32_t i : core.structure().corners) places_.push_back(rotated(shape.rotation, core.points()[i]));
  }

  const Vector3d& farthest(const Vector3d& along) const {
    return *std::max_element(places_.begin(), places_.end(),
                             [&](const Vector3d& x, const Vector3d& y) { return dot(along, x) < dot(along, y); });
  }
  double radius() const { return radius_; }

 private:
  std::vector<Vector3d> places_;
  double radius_;
};

/// From the place of b to the nearest point of the difference of the cores; zero if they overlap.
Vector3d nearest_of_difference(const CornerPlaces& a, const CornerPlaces& b, const Vector3d& place) {
  const auto farthest = [&](const Vector3d& along) {
    return Vector3d(a.farthest(along) - b.farthest(Vector3d(-along)) - place);
  };
  return nearest_to_origin(farthest, Vector3d(-place)).point;
}

}  // namespace

template <int Degree>
Contact hull_contact(const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b, double t) {
  const Vector3d centre_a = a.motion.position(t);
  const Vector3d apart = b.motion.position(t) - centre_a;
  Contact contact;
  contact.time = t;
  const CornerPlaces of_a(a.shape), of_b(b.shape);
  const double radius = of_a.radius() + of_b.radius();
  const Vector3d way = radius > 0 ? nearest_of_difference(of_a, of_b, apart) : Vector3d(Vector3d::Zero());
  if (squared_norm(way) > 0) {
    contact.normal = normalized(Vector3d(-way));
  } else {
    contact.normal = RoundedPolytope<Degree>(a, b, t, t, true).outmost();
  }
  const SupportingFeature feature_a = supporting_feature(a.shape, contact.normal);
  const SupportingFeature feature_b = supporting_feature(b.shape, -contact.normal);
  contact.feature_a = feature_a.feature;
  contact.feature_b = feature_b.feature;
  contact.point = centre_a + patch_centre(feature_a.vertices, feature_b.vertices, apart, contact.normal);
  return contact;
}

template <int Degree>
double hulls_apart_until(const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b, double now,
                         double horizon) {
  constexpr int most_planes = 8;
  constexpr double worth = 0x1p-10;  // a plane that lasts a thousandth of the time so far is the last to be tried
  const CornerPlaces of_a(a.shape), of_b(b.shape);
  double t = now;
  for (int k = 0; k < most_planes; ++k) {
    const Vector3d place = b.motion.position(t) - a.motion.position(t);
    const Vector3d way = nearest_of_difference(of_a, of_b, place);
    if (!(squared_norm(way) > 0)) return t;
    const Vector3d normal = normalized(Vector3d(-way));
    const QuickMotion<Degree> motion(a.motion, b.motion, t, horizon, a.shape.bounding_radius + b.shape.bounding_radius);
    const double height =
        dot(normal, of_a.farthest(normal)) - dot(normal, of_b.farthest(-normal)) + (of_a.radius() + of_b.radius());
    TimeWindow window{0, motion.end()};
    const bool meets = motion.clip(motion.along(normal), 1, height, window);
    if (!meets && motion.whole()) return never;
    const double next = motion.time_before(meets ? window.begin : motion.end());
    const double gained = next - t;
    t = std::max(t, next);
    if (!(gained > worth * (t - now))) return t;
  }
  return t;
}

#define KDS_INSTANTIATE(degree)                                                                            \
  template Contact hull_contact(const TranslatingShape<degree>&, const TranslatingShape<degree>&, double); \
  template double hulls_apart_until(const TranslatingShape<degree>&, const TranslatingShape<degree>&, double, double);
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
