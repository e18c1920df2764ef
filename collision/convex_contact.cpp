#include "collision/convex_contact.hpp"

#include "certificates/ball_separation.hpp"
#include "certificates/conjunction.hpp"
#include "certificates/feature_separation.hpp"
#include "certificates/plane_separation.hpp"
#include "collision/contact_patch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace kds::collision {
namespace {

using certificates::BallSeparation;
using certificates::FeatureSeparation;
using certificates::PlaneSeparation;
using certificates::PointMotion;
using Eigen::Vector3d;

constexpr int most_planes = 30;  // two sides of the fifteen axes of two boxes

/// Cross products of edges shorter than this (relative, squared) come from parallel edges, whose common directions
/// the face normals cover: leaving one out lets a contact be reported early by at most 2^-40 of the boxes' size.
constexpr double parallel_edges = 0x1p-80;

/// A convex set of relative positions in which two shapes penetrate.
template <int Degree, class Curved>
struct Piece {
  std::vector<PlaneSeparation<Degree>> planes;
  std::vector<Curved> curved;

  double first_inside(double t0, double horizon) const {
    return certificates::first_all_broken<PlaneSeparation<Degree>, Curved>(t0, horizon, planes, curved);
  }
  bool inside(double t) const { return certificates::all_broken<PlaneSeparation<Degree>, Curved>(t, planes, curved); }
  double first_outside(double t0, double horizon) const {
    return certificates::first_any_holds<PlaneSeparation<Degree>, Curved>(t0, horizon, planes, curved);
  }
};

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

template <int Degree>
using BallPiece = Piece<Degree, FeatureSeparation<Degree>>;

/// Both sides of a slab |axis . r| < sum of the margins.
template <int Degree>
void add_slab(std::vector<PlaneSeparation<Degree>>& planes, const MovingShape<Degree>& a, const MovingShape<Degree>& b,
              const Vector3d& axis, double margin, double margin_too = 0) {
  for (const double side : {1.0, -1.0}) planes.push_back({a.motion, b.motion, axis, side, {}, {margin, margin_too}});
}

/// The pieces of a box (a) and a ball (b): a box grown by the radius is the union of three slabs, one grown along each
/// axis, twelve cylinders about the edges and eight balls about the vertices.
template <int Degree>
std::vector<BallPiece<Degree>> box_and_ball(const MovingShape<Degree>& a, const MovingShape<Degree>& b) {
  const Vector3d& h = half_extents(a);
  const double r = radius(b);
  const Eigen::Matrix3d& axes = a.shape.rotation;
  const std::array<Vector3d, 3> frame{axes.col(0), axes.col(1), axes.col(2)};
  std::vector<BallPiece<Degree>> pieces;
  pieces.reserve(23);
  for (int grown = 0; grown < 3; ++grown) {
    BallPiece<Degree> slab;
    for (int d = 0; d < 3; ++d) add_slab(slab.planes, a, b, axes.col(d), h[d], d == grown ? r : 0.0);
    pieces.push_back(std::move(slab));
  }
  for (int along = 0; along < 3; ++along) {
    std::array<bool, 3> used{true, true, true};
    used[static_cast<std::size_t>(along)] = false;
    for (int corner = 0; corner < 4; ++corner) {
      std::array<double, 3> offset{};
      offset[static_cast<std::size_t>((along + 1) % 3)] = (corner & 1 ? 1 : -1) * h[(along + 1) % 3];
      offset[static_cast<std::size_t>((along + 2) % 3)] = (corner & 2 ? 1 : -1) * h[(along + 2) % 3];
      BallPiece<Degree> edge;
      add_slab(edge.planes, a, b, axes.col(along), h[along]);
      edge.curved.push_back({a.motion, b.motion, frame, offset, used, r});
      pieces.push_back(std::move(edge));
    }
  }
  for (int corner = 0; corner < 8; ++corner) {
    const std::array<double, 3> offset{(corner & 1 ? 1 : -1) * h[0], (corner & 2 ? 1 : -1) * h[1],
                                       (corner & 4 ? 1 : -1) * h[2]};
    BallPiece<Degree> vertex;
    vertex.curved.push_back({a.motion, b.motion, frame, offset, {true, true, true}, r});
    pieces.push_back(std::move(vertex));
  }
  return pieces;
}

/// The slab around all pieces of a box and a ball: outside it there is nothing to look for.
template <int Degree>
BallPiece<Degree> hull_of_box_and_ball(const MovingShape<Degree>& a, const MovingShape<Degree>& b) {
  BallPiece<Degree> hull;
  for (int d = 0; d < 3; ++d) {
    add_slab(hull.planes, a, b, a.shape.rotation.col(d), half_extents(a)[d], radius(b));
  }
  return hull;
}

/// Directions that can separate two boxes: three face normals each, nine products of edges.
template <int Degree>
std::vector<Vector3d> separating_axes(const MovingShape<Degree>& a, const MovingShape<Degree>& b) {
  std::vector<Vector3d> axes;
  axes.reserve(15);
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
using BoxPiece = Piece<Degree, FeatureSeparation<Degree>>;

template <int Degree>
BoxPiece<Degree> box_and_box(const MovingShape<Degree>& a, const MovingShape<Degree>& b) {
  const auto& u = a.shape.half_axes;
  const auto& w = b.shape.half_axes;
  BoxPiece<Degree> piece;
  piece.planes.reserve(most_planes);
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
  const Vector3d x = a.shape.rotation.transpose() * (b.motion.position(t) - centre_a);
  const Vector3d nearest = x.cwiseMax(-h).cwiseMin(h);
  Vector3d normal = x - nearest;
  BoxSide touched;
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
  contact.normal = a.shape.rotation * normal;
  contact.point = centre_a + a.shape.rotation * nearest;
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
    if (t > horizon) return never;
  }
}

template <class P>
bool inside_any(const std::vector<P>& pieces, double t) {
  return std::any_of(pieces.begin(), pieces.end(), [t](const P& piece) { return piece.inside(t); });
}

template <class P>
double first_outside_all(const std::vector<P>& pieces, double t, double horizon) {
  bool moved = true;
  while (moved && t != never) {
    moved = false;
    for (const P& piece : pieces) {
      if (!piece.inside(t)) continue;
      t = piece.first_outside(t, horizon);
      if (t == never) break;
      moved = true;
    }
  }
  return t;
}

/// Calls f with the pieces of any two spheres and boxes (balls of one piece count as a list of one).
template <int Degree>
BallSeparation<Degree> balls_apart(const MovingShape<Degree>& a, const MovingShape<Degree>& b) {
  return {a.motion, b.motion, radius(a), radius(b)};
}

template <int Degree>
std::vector<BallPiece<Degree>> pieces_of(const MovingShape<Degree>& a, const MovingShape<Degree>& b) {
  if (is_ball(b)) return box_and_ball(a, b);
  if (is_ball(a)) return box_and_ball(b, a);
  std::vector<BallPiece<Degree>> one;
  one.push_back(box_and_box(a, b));
  return one;
}

}  // namespace

template <int Degree>
double ConvexContact<Degree>::first_contact(const Body& a, const Body& b, double t0, double horizon,
                                            ContactMode mode) {
  if (is_ball(a) && is_ball(b)) {
    using Apart = BallSeparation<Degree>;
    const Apart apart = balls_apart(a, b);
    if (mode == ContactMode::transparent) return failure_time(apart, t0, horizon);
    // Penetrating and still closing in.
    const DerivativeCertificate<Apart> parting{apart};
    return certificates::first_all_broken<Apart, DerivativeCertificate<Apart>>(t0, horizon, {&apart, 1},
                                                                               {&parting, 1});
  }
  if (is_ball(a)) return first_contact(b, a, t0, horizon, mode);
  const auto where = [&](double t) { return contact_at(a, b, t); };
  double first = never;
  if (is_ball(b)) {
    t0 = hull_of_box_and_ball(a, b).first_inside(t0, horizon);
    if (t0 == never) return never;
  }
  for (const auto& piece : pieces_of(a, b)) {
    first = std::min(first, first_piece_contact(piece, a, b, t0, std::min(horizon, first), mode, where));
  }
  return first;
}

template <int Degree>
bool ConvexContact<Degree>::in_contact(const Body& a, const Body& b, double t) {
  if (is_ball(a) && is_ball(b)) return sign_after(balls_apart(a, b), t) < 0;
  return inside_any(pieces_of(a, b), t);
}

template <int Degree>
double ConvexContact<Degree>::first_separation(const Body& a, const Body& b, double t0, double horizon) {
  if (is_ball(a) && is_ball(b)) {
    const auto apart = balls_apart(a, b);
    return sign_after(apart, t0) < 0 ? recovery_time(apart, t0, horizon) : t0;
  }
  return first_outside_all(pieces_of(a, b), t0, horizon);
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
