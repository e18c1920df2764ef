#include "collision/narrow_phase/convex_contact.hpp"

#include "certificates/ball_separation.hpp"
#include "collision/degrees.hpp"
#include "collision/narrow_phase/box_and_ball.hpp"
#include "collision/narrow_phase/box_and_box.hpp"
#include "collision/narrow_phase/contact_patch.hpp"
#include "collision/shapes/rotation.hpp"
#include "collision/vectors.hpp"

#include <algorithm>
#include <cmath>

namespace kds::collision {
namespace {

using certificates::BallSeparation;
using certificates::PlaneSeparation;
using Eigen::Vector3d;

template <int Degree>
bool is_ball(const MovingShape<Degree>& body) {
  return std::holds_alternative<Sphere>(body.shape.shape);
}
template <int Degree>
double radius(const MovingShape<Degree>& body) {
  return std::get<Sphere>(body.shape.shape).radius;
}
template <int Degree>
const Vector3d& half_extents(const MovingShape<Degree>& body) {
  return std::get<Box>(body.shape.shape).half_extents;
}

// ---- Where: normals and points, in doubles ------------------------------------------------------------------------

/// Contact of a box (a) with a ball (b): the point of the box nearest the ball's centre.
template <int Degree>
Contact box_ball_contact(const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t) {
  const Vector3d& h = half_extents(a);
  const Vector3d centre_a = a.motion.position(t);
  const Vector3d x = rotated_back(a.shape.rotation, b.motion.position(t) - centre_a);
  const Vector3d nearest = x.cwiseMax(-h).cwiseMin(h);
  Vector3d normal = x - nearest;
  BoxSide touched = BoxSide::Zero();
  if (squared_norm(normal) > 0) {
    for (int d = 0; d < 3; ++d) touched[d] = normal[d] > 0 ? 1 : (normal[d] < 0 ? -1 : 0);
    normal = normalized(normal);
  } else {  // The centre is inside: out through the nearest face.
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

/// Contact of two boxes: along the axis on which they penetrate least.
template <int Degree>
Contact box_box_contact(const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t) {
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
  const BoxSupport of_a = box_support(a.shape, contact.normal);
  const BoxSupport of_b = box_support(b.shape, -contact.normal);
  contact.feature_a = of_a.feature;
  contact.feature_b = of_b.feature;
  contact.point = a.motion.position(t) + patch_centre(of_a.vertices, of_b.vertices, apart, contact.normal);
  return contact;
}

// ---- When --------------------------------------------------------------------------------------------------------

/// Of degree 3 and above whether bodies part along a normal, and when they cease to, is told exactly: by the derivative
/// of their place along it. (In doubles a path that comes to rest would be lost in the roundings of its terms.)
template <int Degree>
DerivativeCertificate<PlaneSeparation<Degree>> parting(const Contact& contact, const MovingShape<Degree>& a,
                                                       const MovingShape<Degree>& b) {
  return {{a.motion, b.motion, contact.normal, 1.0, {}, {}}};
}

/// Whether b moves towards a along the normal just after t.
template <int Degree>
bool approaching(const Contact& contact, const MovingShape<Degree>& a, const MovingShape<Degree>& b) {
  if constexpr (Degree >= 3) return sign_after(parting(contact, a, b), contact.time) < 0;
  const double rate = dot(contact.normal, b.motion.velocity(contact.time) - a.motion.velocity(contact.time));
  if (rate != 0) return rate < 0;
  return dot(contact.normal, b.motion.acceleration(contact.time) - a.motion.acceleration(contact.time)) < 0;
}

/// When bodies that move apart along the contact's normal will turn towards each other.
template <int Degree>
double turning_time(const Contact& contact, const MovingShape<Degree>& a, const MovingShape<Degree>& b) {
  const double t = contact.time;
  if constexpr (Degree >= 3) return std::max(next_up(t), failure_time(parting(contact, a, b), t));
  const double rate = dot(contact.normal, b.motion.velocity(t) - a.motion.velocity(t));
  const double bend = dot(contact.normal, b.motion.acceleration(t) - a.motion.acceleration(t));
  return bend < 0 ? std::max(next_up(t), t + rate / -bend) : never;
}

/// Where to begin to look for a contact that counts, from t0 on: later where the bodies have just been in contact, do
/// not approach, and part before they turn. Exact signs would say whether they overlap by a rounding, and until when.
template <class P, int Degree, class Where>
double after_contact(const P& piece, const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t0,
                     const Where& where) {
  const double opened = opened_after_touch(piece, t0);
  if (opened == t0) return t0;
  const Contact contact = where(t0);
  return !approaching(contact, a, b) && turning_time(contact, a, b) > opened ? opened : t0;
}

/// First contact of one piece. `resolved` counts only the times at which the bodies approach.
template <class P, int Degree, class Where>
double first_piece_contact(const P& piece, const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t0,
                           double horizon, ContactMode mode, Where&& where) {
  for (double t = mode == ContactMode::resolved ? after_contact(piece, a, b, t0, where) : t0;;) {
    t = piece.first_inside(t, horizon);
    if (t == never || mode == ContactMode::transparent) return t;
    const Contact contact = where(t);
    if (approaching(contact, a, b)) return t;
    // Overlapping by rounding and moving apart: next when they have parted, or turn before they have.
    t = std::min(piece.first_outside(t, horizon), turning_time(contact, a, b));
    if (t == never || t > horizon) return never;
  }
}

template <int Degree>
BallSeparation<Degree> balls_apart(const MovingShape<Degree>& a, const MovingShape<Degree>& b) {
  return {a.motion, b.motion, radius(a), radius(b)};
}

}  // namespace

template <int Degree>
double ConvexContact<Degree>::first_contact(const Body& a, const Body& b, double t0, double horizon, ContactMode mode) {
  if (is_ball(a) && is_ball(b)) {
    const auto apart = balls_apart(a, b);
    return mode == ContactMode::transparent ? failure_time(apart, t0, horizon) : apart.first_approach(t0, horizon);
  }
  if (is_ball(a)) return first_contact(b, a, t0, horizon, mode);
  if (!(t0 <= horizon)) return never;
  const auto where = [&](double t) { return contact_at(a, b, t); };
  if (!is_ball(b)) return first_piece_contact(BoxAndBox<Degree>(a, b, t0, horizon), a, b, t0, horizon, mode, where);
  double first = never;
  BoxAndBall<Degree>(a, b, t0, horizon).earliest_pieces(horizon, [&](const auto& piece) {
    first = std::min(first, first_piece_contact(piece, a, b, t0, std::min(horizon, first), mode, where));
    return first;
  });
  return first;
}

template <int Degree>
double ConvexContact<Degree>::apart_until(const Body& a, const Body& b, double t0, double horizon, PairMemory& memory) {
  if (is_ball(a) && is_ball(b)) return t0;
  if (is_ball(a)) return apart_until(b, a, t0, horizon, memory);
  if (!(t0 <= horizon)) return never;
  if (!is_ball(b)) return BoxAndBox<Degree>::apart_until(a, b, t0, horizon, memory);
  double first = never;
  BoxAndBall<Degree>(a, b, t0, horizon).earliest_pieces(horizon, [&](const auto& piece) {
    return first = std::min(first, piece.earliest());
  });
  return first;
}

template <int Degree>
bool ConvexContact<Degree>::in_contact(const Body& a, const Body& b, double t) {
  if (is_ball(a) && is_ball(b)) return sign_after(balls_apart(a, b), t) < 0;
  if (is_ball(a)) return in_contact(b, a, t);
  if (!is_ball(b)) return BoxAndBox<Degree>(a, b, t, t).inside(t);
  bool inside = false;
  BoxAndBall<Degree>(a, b, t, t).every_piece([&](const auto& piece) { return !(inside = piece.inside(t)); });
  return inside;
}

template <int Degree>
double ConvexContact<Degree>::first_separation(const Body& a, const Body& b, double t0, double horizon) {
  if (is_ball(a) && is_ball(b)) {
    const auto apart = balls_apart(a, b);
    return sign_after(apart, t0) < 0 ? recovery_time(apart, t0, horizon) : t0;
  }
  if (is_ball(a)) return first_separation(b, a, t0, horizon);
  if (!is_ball(b)) {
    const BoxAndBox<Degree> boxes(a, b, t0, horizon);
    return boxes.inside(t0) ? boxes.first_outside(t0, horizon) : t0;
  }
  // Out of one piece may be into another: until no piece holds them.
  const BoxAndBall<Degree> pair(a, b, t0, horizon);
  double t = t0;
  for (bool moved = true; moved && t != never;) {
    moved = false;
    pair.every_piece([&](const auto& piece) {
      if (!piece.inside(t)) return true;
      t = piece.first_outside(t, horizon);
      moved = true;
      return t != never;
    });
  }
  return t;
}

template <int Degree>
Contact ConvexContact<Degree>::contact_at(const Body& a, const Body& b, double t) {
  if (is_ball(a) && is_ball(b)) return ball_contact_at(a.motion, b.motion, radius(a), t);
  if (is_ball(b)) return box_ball_contact(a, b, t);
  if (is_ball(a)) {
    Contact contact = box_ball_contact(b, a, t);
    contact.normal = -contact.normal;
    std::swap(contact.feature_a, contact.feature_b);
    return contact;
  }
  return box_box_contact(a, b, t);
}

#define KDS_INSTANTIATE(degree) template struct ConvexContact<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
