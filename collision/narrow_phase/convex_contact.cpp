#include "collision/narrow_phase/convex_contact.hpp"

#include "certificates/ball_separation.hpp"
#include "certificates/conjunction.hpp"
#include "certificates/feature_separation.hpp"
#include "certificates/plane_separation.hpp"
#include "collision/narrow_phase/contact_patch.hpp"
#include "collision/shapes/rotation.hpp"

#include <boost/container/static_vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace kds::collision {
namespace {

using certificates::BallSeparation;
using certificates::FeatureSeparation;
using certificates::PlaneSeparation;
using certificates::PointMotion;
using Eigen::Vector3d;

/// Cross products of edges shorter than this (relative, squared) come from parallel edges, whose common directions
/// the face normals cover: leaving one out lets a contact be reported early by at most 2^-40 of the boxes' size.
constexpr double parallel_edges = 0x1p-80;

/// A convex set of relative positions in which two shapes penetrate: all its certificates are broken there.
template <int Degree, std::size_t MostPlanes, std::size_t MostCurved>
struct Piece {
  using Plane = PlaneSeparation<Degree>;
  using Curved = FeatureSeparation<Degree>;

  boost::container::static_vector<Plane, MostPlanes> planes;
  boost::container::static_vector<Curved, MostCurved> curved;

  std::span<const Plane> all_planes() const { return {planes.data(), planes.size()}; }
  std::span<const Curved> all_curved() const { return {curved.data(), curved.size()}; }

  double first_inside(double t0, double horizon) const {
    return certificates::first_all_broken(t0, horizon, all_planes(), all_curved());
  }
  bool inside(double t) const { return certificates::all_broken(t, all_planes(), all_curved()); }
  double first_outside(double t0, double horizon) const {
    return certificates::first_any_holds(t0, horizon, all_planes(), all_curved());
  }
};

/// One piece of a box and a ball.
template <int Degree>
using BallPiece = Piece<Degree, 6, 1>;

/// The piece of two boxes: both sides of up to fifteen axes.
template <int Degree>
using BoxPiece = Piece<Degree, 30, 0>;

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

// ---- What is in contact: pieces ----------------------------------------------------------------------------------

/// Both sides of a slab |axis . r| < sum of the margins.
template <int Degree>
void add_slab(BallPiece<Degree>& piece, const MovingShape<Degree>& a, const MovingShape<Degree>& b, const Vector3d& axis,
              double margin, double margin_too = 0) {
  for (const double side : {1.0, -1.0}) {
    piece.planes.push_back({a.motion, b.motion, axis, side, {}, {margin, margin_too}});
  }
}

/// Calls visit(piece) for the pieces of a box (a) and a ball (b), until it returns false. A box grown by the radius is
/// the union of three slabs, one grown along each axis, twelve cylinders about the edges and eight balls about the
/// vertices.
template <int Degree, class Visit>
void visit_box_and_ball(const MovingShape<Degree>& a, const MovingShape<Degree>& b, const Visit& visit) {
  const Vector3d& h = half_extents(a);
  const double r = radius(b);
  const Eigen::Matrix3d& axes = a.shape.rotation;
  const std::array<Vector3d, 3> frame{axes.col(0), axes.col(1), axes.col(2)};
  for (int grown = 0; grown < 3; ++grown) {
    BallPiece<Degree> slab;
    for (int d = 0; d < 3; ++d) add_slab(slab, a, b, axes.col(d), h[d], d == grown ? r : 0.0);
    if (!visit(slab)) return;
  }
  // Where the ball's centre is beyond the faces on two axes, and between them on the third.
  for (int along = 0; along < 3; ++along) {
    std::array<bool, 3> used{true, true, true};
    used[static_cast<std::size_t>(along)] = false;
    for (int corner = 0; corner < 4; ++corner) {
      std::array<double, 3> offset{};
      offset[static_cast<std::size_t>((along + 1) % 3)] = (corner & 1 ? 1 : -1) * h[(along + 1) % 3];
      offset[static_cast<std::size_t>((along + 2) % 3)] = (corner & 2 ? 1 : -1) * h[(along + 2) % 3];
      BallPiece<Degree> edge;
      add_slab(edge, a, b, axes.col(along), h[along]);
      edge.curved.push_back({a.motion, b.motion, frame, offset, used, r});
      if (!visit(edge)) return;
    }
  }
  for (int corner = 0; corner < 8; ++corner) {
    const std::array<double, 3> offset{(corner & 1 ? 1 : -1) * h[0], (corner & 2 ? 1 : -1) * h[1],
                                       (corner & 4 ? 1 : -1) * h[2]};
    BallPiece<Degree> vertex;
    vertex.curved.push_back({a.motion, b.motion, frame, offset, {true, true, true}, r});
    if (!visit(vertex)) return;
  }
}

/// The slab around all pieces of a box and a ball: outside it there is nothing to look for.
template <int Degree>
BallPiece<Degree> hull_of_box_and_ball(const MovingShape<Degree>& a, const MovingShape<Degree>& b) {
  BallPiece<Degree> hull;
  for (int d = 0; d < 3; ++d) {
    add_slab(hull, a, b, a.shape.rotation.col(d), half_extents(a)[d], radius(b));
  }
  return hull;
}

/// Directions that can separate two boxes: three face normals each, nine products of edges.
template <int Degree>
boost::container::static_vector<Vector3d, 15> separating_axes(const MovingShape<Degree>& a,
                                                              const MovingShape<Degree>& b) {
  boost::container::static_vector<Vector3d, 15> axes;
  for (int d = 0; d < 3; ++d) axes.push_back(a.shape.rotation.col(d));
  if (a.shape.rotation == b.shape.rotation) return axes;
  for (int d = 0; d < 3; ++d) axes.push_back(b.shape.rotation.col(d));
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const Vector3d axis = a.shape.rotation.col(i).cross(b.shape.rotation.col(j));
      if (axis.squaredNorm() > parallel_edges) axes.push_back(axis);
    }
  }
  return axes;
}

template <int Degree>
BoxPiece<Degree> box_and_box(const MovingShape<Degree>& a, const MovingShape<Degree>& b) {
  const auto& u = a.shape.half_axes;
  const auto& w = b.shape.half_axes;
  BoxPiece<Degree> piece;
  for (const Vector3d& axis : separating_axes(a, b)) {
    for (const double side : {1.0, -1.0}) {
      piece.planes.push_back({a.motion, b.motion, axis, side, {&u[0], &u[1], &u[2], &w[0], &w[1], &w[2]}, {}});
    }
  }
  return piece;
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
  if (normal.squaredNorm() > 0) {
    for (int d = 0; d < 3; ++d) touched[d] = normal[d] > 0 ? 1 : (normal[d] < 0 ? -1 : 0);
    normal.normalize();
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

template <int Degree>
Contact ball_ball_contact(const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t) {
  Contact contact;
  contact.time = t;
  const Vector3d centre_a = a.motion.position(t);
  const Vector3d apart = b.motion.position(t) - centre_a;
  if (apart.norm() > 0) contact.normal = apart.normalized();  // concentric balls: the default direction
  contact.point = centre_a + contact.normal * radius(a);
  return contact;
}

/// Contact of two boxes: along the axis on which they penetrate least.
template <int Degree>
Contact box_box_contact(const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t) {
  const Vector3d apart = b.motion.position(t) - a.motion.position(t);
  double deepest = -never;
  Contact contact;
  contact.time = t;
  for (const Vector3d& axis : separating_axes(a, b)) {
    const Vector3d n = axis.normalized() * (axis.dot(apart) < 0 ? -1.0 : 1.0);
    double gap = n.dot(apart);
    for (const auto& u : a.shape.half_axes) gap -= std::abs(n.dot(u));
    for (const auto& u : b.shape.half_axes) gap -= std::abs(n.dot(u));
    if (gap > deepest) {
      deepest = gap;
      contact.normal = n;
    }
  }
  const BoxSupport of_a = box_support(a.shape, contact.normal);
  const BoxSupport of_b = box_support(b.shape, -contact.normal);
  contact.feature_a = of_a.feature;
  contact.feature_b = of_b.feature;
  contact.point = a.motion.position(t) + patch_centre(of_a.vertices, of_b.vertices, apart, contact.normal);
  return contact;
}

// ---- When --------------------------------------------------------------------------------------------------------

/// Whether b moves towards a along the normal just after t.
template <int Degree>
bool approaching(const Contact& contact, const MovingShape<Degree>& a, const MovingShape<Degree>& b) {
  const double rate = contact.normal.dot(b.motion.velocity(contact.time) - a.motion.velocity(contact.time));
  if (rate != 0) return rate < 0;
  return contact.normal.dot(b.motion.acceleration(contact.time) - a.motion.acceleration(contact.time)) < 0;
}

/// When bodies that move apart along the contact's normal will turn towards each other.
template <int Degree>
double turning_time(const Contact& contact, const MovingShape<Degree>& a, const MovingShape<Degree>& b) {
  const double t = contact.time;
  const double rate = contact.normal.dot(b.motion.velocity(t) - a.motion.velocity(t));
  const double bend = contact.normal.dot(b.motion.acceleration(t) - a.motion.acceleration(t));
  return bend < 0 ? std::max(next_up(t), t + rate / -bend) : never;
}

/// First contact of one piece. `resolved` counts only the times at which the bodies approach.
template <class P, int Degree, class Where>
double first_piece_contact(const P& piece, const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t0,
                           double horizon, ContactMode mode, Where&& where) {
  for (double t = t0;;) {
    t = piece.first_inside(t, horizon);
    if (t == never || mode == ContactMode::transparent) return t;
    const Contact contact = where(t);
    if (approaching(contact, a, b)) return t;
    // Overlapping by rounding and moving apart: next when they have parted, or turn before they have.
    t = std::min(piece.first_outside(t, horizon), turning_time(contact, a, b));
    if (t == never || t > horizon) return never;
  }
}

/// Calls visit(piece) for the pieces of two shapes of which at least one is a box, until it returns false.
template <int Degree, class Visit>
void visit_pieces(const MovingShape<Degree>& a, const MovingShape<Degree>& b, const Visit& visit) {
  if (is_ball(b)) {
    visit_box_and_ball(a, b, visit);
  } else if (is_ball(a)) {
    visit_box_and_ball(b, a, visit);
  } else {
    visit(box_and_box(a, b));
  }
}

template <int Degree>
BallSeparation<Degree> balls_apart(const MovingShape<Degree>& a, const MovingShape<Degree>& b) {
  return {a.motion, b.motion, radius(a), radius(b)};
}

}  // namespace

template <int Degree>
double ConvexContact<Degree>::first_contact(const Body& a, const Body& b, double t0, double horizon,
                                            ContactMode mode) {
  if (is_ball(a) && is_ball(b)) {
    const auto apart = balls_apart(a, b);
    return mode == ContactMode::transparent ? failure_time(apart, t0, horizon) : apart.first_approach(t0, horizon);
  }
  if (is_ball(a)) return first_contact(b, a, t0, horizon, mode);
  const auto where = [&](double t) { return contact_at(a, b, t); };
  double first = never;
  if (is_ball(b)) {
    t0 = hull_of_box_and_ball(a, b).first_inside(t0, horizon);
    if (t0 == never) return never;
  }
  visit_pieces(a, b, [&](const auto& piece) {
    first = std::min(first, first_piece_contact(piece, a, b, t0, std::min(horizon, first), mode, where));
    return first > t0;
  });
  return first;
}

template <int Degree>
bool ConvexContact<Degree>::in_contact(const Body& a, const Body& b, double t) {
  if (is_ball(a) && is_ball(b)) return sign_after(balls_apart(a, b), t) < 0;
  bool inside = false;
  visit_pieces(a, b, [&](const auto& piece) { return !(inside = piece.inside(t)); });
  return inside;
}

template <int Degree>
double ConvexContact<Degree>::first_separation(const Body& a, const Body& b, double t0, double horizon) {
  if (is_ball(a) && is_ball(b)) {
    const auto apart = balls_apart(a, b);
    return sign_after(apart, t0) < 0 ? recovery_time(apart, t0, horizon) : t0;
  }
  // Out of one piece may be into another: until no piece holds them.
  double t = t0;
  bool moved = true;
  while (moved && t != never) {
    moved = false;
    visit_pieces(a, b, [&](const auto& piece) {
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
  if (is_ball(a) && is_ball(b)) return ball_ball_contact(a, b, t);
  if (is_ball(b)) return box_ball_contact(a, b, t);
  if (is_ball(a)) {
    Contact contact = box_ball_contact(b, a, t);
    contact.normal = -contact.normal;
    std::swap(contact.feature_a, contact.feature_b);
    return contact;
  }
  return box_box_contact(a, b, t);
}

template struct ConvexContact<1>;
template struct ConvexContact<2>;

}  // namespace kds::collision
