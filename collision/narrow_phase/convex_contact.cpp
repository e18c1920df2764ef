#include "collision/narrow_phase/convex_contact.hpp"

#include "certificates/ball_separation.hpp"
#include "collision/degrees.hpp"
#include "collision/narrow_phase/box_and_box.hpp"
#include "collision/narrow_phase/contact_patch.hpp"
#include "collision/shapes/box.hpp"
#include "collision/shapes/rotation.hpp"
#include "collision/vectors.hpp"

#include <algorithm>
#include <cmath>

namespace kds::collision {
namespace {

using certificates::BallSeparation;
using Eigen::Vector3d;

template <int Degree>
double radius(const TranslatingShape<Degree>& body) {
  return std::get<Sphere>(body.shape.shape).radius;
}
template <int Degree>
const Vector3d& half_extents(const TranslatingShape<Degree>& body) {
  return std::get<Box>(body.shape.shape).half_extents;
}

// ---- Where: normals and points, in doubles ------------------------------------------------------------------------

/// Contact of two boxes: along the axis on which they penetrate least.
template <int Degree>
Contact box_box_contact(const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b, double t) {
  const Vector3d apart = b.motion.position(t) - a.motion.position(t);
  double deepest = -never;
  Contact contact;
  contact.time = t;
  every_box_axis(a.shape, b.shape, [&](const Vector3d& axis, int) {
    const Vector3d n = normalized(axis) * (dot(axis, apart) < 0 ? -1.0 : 1.0);
    double gap = dot(n, apart);
    for (const auto& u : a.shape.half_axes) gap -= std::abs(dot(n, u));
    for (const auto& u : b.shape.half_axes) gap -= std::abs(dot(n, u));
    if (gap > deepest) {
      deepest = gap;
      contact.normal = n;
    }
    return true;
  });
  const SupportingFeature of_a = supporting_feature(a.shape, contact.normal);
  const SupportingFeature of_b = supporting_feature(b.shape, -contact.normal);
  contact.feature_a = of_a.feature;
  contact.feature_b = of_b.feature;
  contact.point = a.motion.position(t) + patch_centre(of_a.vertices, of_b.vertices, apart, contact.normal);
  return contact;
}

template <int Degree>
BallSeparation<Degree> balls_apart(const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b) {
  return {a.motion, b.motion, radius(a), radius(b)};
}

}  // namespace

template <int Degree>
Contact box_ball_contact(const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b, double t) {
  const Vector3d& h = half_extents(a);
  const Vector3d centre_a = a.motion.position(t);
  const Vector3d x = rotated_back(a.shape.rotation, b.motion.position(t) - centre_a);
  const Vector3d nearest = x.cwiseMax(-h).cwiseMin(h);
  Vector3d normal = x - nearest;
  BoxSide touched = BoxSide::Zero();
  if (squared_norm(normal) > 0) {
    for (int d = 0; d < 3; ++d) touched[d] = normal[d] > 0 ? 1 : (normal[d] < 0 ? -1 : 0);
    normal = normalized(normal);
  } else {  // The centre is inside: the normal leads out through the nearest face.
    int axis = 0;
    (h - x.cwiseAbs()).minCoeff(&axis);
    touched[axis] = x[axis] < 0 ? -1 : 1;
    normal = Vector3d::Unit(axis) * touched[axis];
  }
  Contact contact;
  contact.time = t;
  contact.normal = rotated(a.shape.rotation, normal);
  contact.point = centre_a + rotated(a.shape.rotation, nearest);
  contact.feature_a = box_feature(touched);
  return contact;
}

// ---- Two balls -----------------------------------------------------------------------------------------------------

template <int Degree>
double BallsContact<Degree>::first_contact(const Body& a, const Body& b, double t0, double horizon, ContactMode mode,
                                           FoundTouch*) {
  const auto apart = balls_apart(a, b);
  return mode == ContactMode::transparent ? failure_time(apart, t0, horizon) : apart.first_approach(t0, horizon);
}

/// On lines and parabolas there is no cheaper bound: the exact time costs hardly more.
template <int Degree>
double BallsContact<Degree>::apart_until(const Body& a, const Body& b, double t0, double horizon, PairMemory&) {
  if constexpr (Degree >= 3) {
    if (horizon < never && balls_apart(a, b).plane_between(t0, horizon)) return never;
  }
  return t0;
}

template <int Degree>
bool BallsContact<Degree>::in_contact(const Body& a, const Body& b, double t) {
  return sign_after(balls_apart(a, b), t) < 0;
}

template <int Degree>
double BallsContact<Degree>::first_separation(const Body& a, const Body& b, double t0, double horizon) {
  const auto apart = balls_apart(a, b);
  return sign_after(apart, t0) < 0 ? recovery_time(apart, t0, horizon) : t0;
}

template <int Degree>
Contact BallsContact<Degree>::contact_at(const Body& a, const Body& b, double t, const FoundTouch&) {
  return ball_contact_at(a.motion, b.motion, radius(a), t);
}

// ---- Two boxes -----------------------------------------------------------------------------------------------------

template <int Degree>
double BoxesContact<Degree>::first_contact(const Body& a, const Body& b, double t0, double horizon, ContactMode mode,
                                           FoundTouch*) {
  if (!(t0 <= horizon)) return never;
  const auto where = [&](double t) { return box_box_contact(a, b, t); };
  return first_piece_contact(BoxAndBox<Degree>(a, b, t0, horizon), a, b, t0, horizon, mode, where);
}

template <int Degree>
double BoxesContact<Degree>::apart_until(const Body& a, const Body& b, double t0, double horizon, PairMemory& memory) {
  return t0 <= horizon ? BoxAndBox<Degree>::apart_until(a, b, t0, horizon, memory) : never;
}

template <int Degree>
bool BoxesContact<Degree>::in_contact(const Body& a, const Body& b, double t) {
  return BoxAndBox<Degree>(a, b, t, t).inside(t);
}

template <int Degree>
double BoxesContact<Degree>::first_separation(const Body& a, const Body& b, double t0, double horizon) {
  const BoxAndBox<Degree> boxes(a, b, t0, horizon);
  return boxes.inside(t0) ? boxes.first_outside(t0, horizon) : t0;
}

template <int Degree>
Contact BoxesContact<Degree>::contact_at(const Body& a, const Body& b, double t, const FoundTouch&) {
  return box_box_contact(a, b, t);
}

#define KDS_INSTANTIATE(degree)         \
  template struct BallsContact<degree>; \
  template struct BoxesContact<degree>; \
  template Contact box_ball_contact(const TranslatingShape<degree>&, const TranslatingShape<degree>&, double);
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
