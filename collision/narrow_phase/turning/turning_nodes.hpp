// Two oriented boxes around parts of bodies that turn: for how long they are apart, in floats.
#pragma once

#include "collision/lanes.hpp"
#include "collision/narrow_phase/turning/four_vectors.hpp"
#include "collision/narrow_phase/turning/turning_view.hpp"
#include "collision/shapes/obb_tree.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace kds::collision {

/// What all nodes of a body have in common.
struct NodeUnits {
  double unit;   ///< their length in the world
  double round;  ///< by which they are grown on all sides
  double reach;  ///< how far they reach from the origin of the body
};

/// The box of these half extents as a node. Its unit is half its diagonal.
inline ObbNode box_node(const Eigen::Vector3d& half) {
  ObbNode node{};
  for (std::size_t k = 0; k < 3; ++k) node.axes[k][k] = 1;
  if (const double length = norm(half); length > 0) node.half_extents = lanes(half / length), node.radius = 1;
  return node;
}
inline NodeUnits box_units(const Eigen::Vector3d& half) { return {norm(half), 0, norm(half) * (1 + 0x1p-50)}; }

/// Two bodies seen at one time, and what holds for all of their nodes.
///
/// All is in the axes of body a. Lengths are divided by `size`, how far the bodies' parts may be from each other now,
/// and times by `ahead`: up to a radian of both turns together, and no longer than the time in which the bodies come to
/// be elsewhere. So all numbers are of order 1, and floats suffice.
///
/// Margin. In roundings of a float, u = 2^-24: numbers that are converted are good to 1, so what is turned by the
/// matrix to 7, axes of nodes as they are to 4, and the corners of a node are in the box of these axes to 8 (ObbTree
/// grows nodes by 2^-20 of their unit for the products of exact axes). A gap is a product with the way (12), and with
/// three half edges of each of two boxes, which are together no longer than 3^(1/2) times the size (60); its rate, of
/// vectors that add up to 4 at most, 48, and twice the 60 for the chords; half of its bend, of vectors that add up to
/// 13 and are turned twice, 60. That is some 300; `rounding` has room for 512: 3e-5 of the size. A larger one leaves
/// more to the triangles. What is lost of the way in doubles is added.
template <int Degree>
struct NodesView : TurningView<Degree> {
  using TurningView<Degree>::seen_from_a;
  using RigidMotion = certificates::RigidMotion<Degree>;
  static constexpr double rounding = 512 * 0x1p-24;

  NodesView(const RigidMotion& a, const RigidMotion& b, const PairRates& rates, const NodeUnits& of_a,
            const NodeUnits& of_b, double t, double horizon)
      : TurningView<Degree>(a, b, rates, t),
        size(norm(this->way.value) + of_a.reach + of_b.reach),
        ahead(std::max(0.0, this->stretch(of_a.reach + of_b.reach, (horizon - t) * (1 + 0x1p-40)))) {
    const auto in_a = [&](const Eigen::Vector3d& x) { return four_times(lanes(this->seen_from_a(x))); };
    const double s = ahead;
    for (int k = 0; k < 3; ++k) columns[static_cast<std::size_t>(k)] = in_a(this->matrix_b.col(k));
    way_now = in_a(this->way.value / size);
    way_rate = in_a(s * this->way.rate / size);
    way_bend = in_a(s * (s * this->way.bend) / size);
    turn_a = in_a(s * this->spin_a);
    turn_b = in_a(s * this->spin_b);
    unit_a = in_floats(of_a.unit / size);
    unit_b = in_floats(of_b.unit / size);
    round = in_floats((of_a.round + of_b.round) / size);
    angle_a = in_floats(s * this->rate_a);
    angle_b = in_floats(s * this->rate_b);
    const double bend = norm(this->way.bend) * s * s / size;
    const double speed = (norm(this->way.rate) + this->rate_error) * s / size + bend;
    const double distance = (norm(this->way.value) + this->way_error) / size + speed;
    const auto third_of = [&](double angle_n) {
      return in_floats(TurningBounds::third_of(angle_n, s * this->rate_a, s * this->rate_b, {distance, speed, bend},
                                               of_a.reach / size, of_b.reach / size) *
                       (1 + 0x1p-20));
    };
    third = {third_of(0), third_of(s * this->rate_a), third_of(s * this->rate_b)};
    third_of_products = third_of(s * (this->rate_a + this->rate_b));
    margin = in_floats((rounding + (this->way_error + this->rate_error * s) / size) * (1 + 0x1p-20));
  }

  double size;                         ///< length
  double ahead;                        ///< how far to look ahead, s
  std::array<FourVectors, 3> columns;  ///< where the axes of b point; here and below the same four times
  FourVectors way_now, way_rate, way_bend;
  FourVectors turn_a, turn_b;  ///< in that time, as vectors
  FourFloats angle_a, angle_b;
  FourFloats unit_a, unit_b, round;  ///< of nodes
  std::array<FourFloats, 3> third;   ///< bounds on |f'''| of gaps: along a direction at rest, that turns with a, with b
  FourFloats third_of_products;      ///< the same along a product of vectors that turn with either
  FourFloats margin;                 ///< that gaps may be off by

  /// Vectors in the axes of b.
  FourVectors seen_from_a(const FourVectors& of_b) const {
    return of_b.x * columns[0] + of_b.y * columns[1] + of_b.z * columns[2];
  }

 private:
  static FourFloats in_floats(double x) { return splat(static_cast<float>(x)); }
};

/// Four pairs of nodes.
using FourNodes = std::array<const ObbNode*, 4>;

/// How long two nodes are surely apart from the time of a view on, for each of four pairs.
struct FourWaits {
  FourFloats part;    ///< of the time ahead
  unsigned worth_it;  ///< bit i: the pair gets near each other by then, for its size
};

/// Along the line between their centres, or along an axis of one of them that turns with it.
///
/// Method: along a unit vector n, from a to b, their gap is n . p - sum_k h_k |n . u_k|, with the half edges of both.
/// An n . u_k = x with its rate x' is at most |x| + s (|e| - |x|) / S + s^2 / 2 max |x''| until S, e = x + S x': a
/// convex function is below its chord. So the gap stays above a cubic.
template <int Degree>
FourWaits nodes_apart(const NodesView<Degree>& view, const FourNodes& a, const FourNodes& b);

/// Whether they are surely farther apart than a margin at the time of the view: bit i of pair i.
template <int Degree>
unsigned nodes_apart_by(double margin, const NodesView<Degree>& view, const FourNodes& a, const FourNodes& b);

// ---------------------------------------------------------------------------------------------------------------------

namespace detail {

/// Of the nodes of one side.
inline FourVectors side_by_side(const FourNodes& nodes, Lanes ObbNode::*member) {
  return collision::side_by_side(nodes[0]->*member, nodes[1]->*member, nodes[2]->*member, nodes[3]->*member);
}
inline FourFloats radii(const FourNodes& nodes) {
  return FourFloats{nodes[0]->radius, nodes[1]->radius, nodes[2]->radius, nodes[3]->radius};
}
/// The directions of their edges.
inline std::array<FourVectors, 3> edges(const FourNodes& nodes) {
  std::array<FourVectors, 3> rows;
  for (std::size_t k = 0; k < 3; ++k) {
    rows[k] = collision::side_by_side(nodes[0]->axes[k], nodes[1]->axes[k], nodes[2]->axes[k], nodes[3]->axes[k]);
  }
  return {{{rows[0].x, rows[1].x, rows[2].x}, {rows[0].y, rows[1].y, rows[2].y}, {rows[0].z, rows[1].z, rows[2].z}}};
}

/// The gaps of four pairs of nodes along a direction each, as they go on.
template <int Degree>
class NodeGaps {
 public:
  NodeGaps(const NodesView<Degree>& view, const FourNodes& a, const FourNodes& b)
      : view_(view),
        a_(a),
        b_(b),
        in_a_(view.unit_a * side_by_side(a, &ObbNode::centre)),
        in_b_(view.seen_from_a(view.unit_b * side_by_side(b, &ObbNode::centre))),
        p_(view.way_now + in_b_ - in_a_),
        by_a_(cross(view.turn_a, in_a_)),
        by_b_(cross(view.turn_b, in_b_)),
        rate_(view.way_rate + by_b_ - by_a_) {}

  FourWaits waits() {
    const Widest best = widest();
    const FourFloats part = where(best.gap > view_.margin, part_along(best));
    return {part, set_of_four(part >= least_part())};
  }

  /// Whether they are surely farther apart than a margin.
  unsigned exceed(double margin) {
    const FourFloats least = splat(static_cast<float>(margin / view_.size * (1 + 0x1p-20))) + view_.margin;
    return set_of_four(widest().gap > least);
  }

 private:
  /// The part of the time that is worth it: until they have moved by some part of their sizes.
  FourFloats least_part() const {
    const FourFloats worth = splat(1.0F / 24);
    const FourFloats radius_a = view_.unit_a * radii(a_), radius_b = view_.unit_b * radii(b_) + view_.round;
    const FourFloats speed = square_root(dot(rate_, rate_)) + view_.angle_a * radius_a + view_.angle_b * radius_b;
    return lesser(worth * (radius_a + radius_b) / speed, splat(1));
  }

  struct Widest {
    FourFloats gap;
    FourVectors direction;
    FourFloatsBits with_a, with_b;  ///< whether the direction turns with it
  };
  /// Along axes and the line of centres.
  Widest widest() {
    u_ = edges(a_);
    v_ = edges(b_);
    for (FourVectors& v : v_) v = view_.seen_from_a(v);
    half_a_ = view_.unit_a * side_by_side(a_, &ObbNode::half_extents);
    half_b_ = view_.unit_b * side_by_side(b_, &ObbNode::half_extents);
    std::array<FourVectors, 3> x;  // of edge i of a along those of b
    for (std::size_t i = 0; i < 3; ++i) x[i] = heights(u_[i], v_);
    const FourVectors along_a{dot(p_, u_[0]), dot(p_, u_[1]), dot(p_, u_[2])};
    const FourVectors along_b{dot(p_, v_[0]), dot(p_, v_[1]), dot(p_, v_[2])};
    const FourFloats distance = square_root(dot(p_, p_)),
                     over_distance = where(distance > splat(0), splat(1) / distance);
    const FourFloats widths = dot(half_a_, magnitudes(along_a)) + dot(half_b_, magnitudes(along_b));
    Widest best{distance - over_distance * widths, over_distance * p_, {}, {}};
    const auto note = [&](FourFloats along, FourFloats reach, const FourVectors& axis, FourFloatsBits& with,
                          FourFloatsBits& other) {
      const FourFloats gap = magnitude(along) - reach;
      const FourFloatsBits wider = gap > best.gap;
      best.gap = greater(gap, best.gap);
      best.direction = where(wider, signed_by(along, axis), best.direction);
      with |= wider, other &= ~wider;
    };
    const auto of_a = [&](FourFloats along, FourFloats half, const FourVectors& x_of, const FourVectors& axis) {
      note(along, half + dot(half_b_, x_of), axis, best.with_a, best.with_b);
    };
    const auto of_b = [&](FourFloats along, FourFloats half, const FourVectors& x_of, const FourVectors& axis) {
      note(along, half + dot(half_a_, x_of), axis, best.with_b, best.with_a);
    };
    of_a(along_a.x, half_a_.x, x[0], u_[0]);
    of_a(along_a.y, half_a_.y, x[1], u_[1]);
    of_a(along_a.z, half_a_.z, x[2], u_[2]);
    of_b(along_b.x, half_b_.x, {x[0].x, x[1].x, x[2].x}, v_[0]);
    of_b(along_b.y, half_b_.y, {x[0].y, x[1].y, x[2].y}, v_[1]);
    of_b(along_b.z, half_b_.z, {x[0].z, x[1].z, x[2].z}, v_[2]);
    best.gap -= view_.round;
    return best;
  }

  /// How far vectors reach along axes.
  static FourVectors heights(const FourVectors& n, const std::array<FourVectors, 3>& axes) {
    return magnitudes({dot(n, axes[0]), dot(n, axes[1]), dot(n, axes[2])});
  }

  FourFloats part_along(const Widest& widest) const {
    const FourVectors& n = widest.direction;
    const FourFloatsBits turns = widest.with_a | widest.with_b;
    const FourVectors turn = where(widest.with_a, view_.turn_a, where(widest.with_b, view_.turn_b));
    const FourVectors turned = cross(turn, p_);
    const FourVectors rate = rate_ - turned;  // as seen from n, as all that follows
    const FourVectors bend =
        view_.way_bend + cross(view_.turn_b, by_b_) - cross(view_.turn_a, by_a_) + cross(turn, turned - rate_ - rate_);
    FourFloats f0 = dot(n, p_) - view_.margin - view_.round, f1 = dot(n, rate), f2 = dot(n, bend);
    const auto take = [&](const FourVectors& half, const std::array<FourVectors, 3>& axes, const FourVectors& turn_of,
                          FourFloats angle) {
      const FourVectors across = cross(n, turn_of - turn);
      const FourVectors x{dot(n, axes[0]), dot(n, axes[1]), dot(n, axes[2])};
      const FourVectors end{dot(across, axes[0]), dot(across, axes[1]), dot(across, axes[2])};
      const FourFloats now = dot(half, magnitudes(x));
      f0 -= now;
      f1 -= dot(half, magnitudes(x + end)) - now;
      f2 -= (half.x + half.y + half.z) * angle * angle;
    };
    const FourFloats both = view_.angle_a + view_.angle_b;
    take(half_a_, u_, view_.turn_a, where(~widest.with_a, where(turns, both, view_.angle_a)));
    take(half_b_, v_, view_.turn_b, where(~widest.with_b, where(turns, both, view_.angle_b)));
    const FourFloats third = where(widest.with_a, view_.third[1], where(widest.with_b, view_.third[2], view_.third[0]));
    return positive_part(f0, f1, f2, third);
  }

  const NodesView<Degree>& view_;
  const FourNodes& a_;
  const FourNodes& b_;
  FourVectors in_a_, in_b_;           ///< from the origins of the bodies to the centres
  FourVectors p_;                     ///< from the centre of a to that of b
  FourVectors by_a_, by_b_, rate_;    ///< how fast the centres turn, and p changes
  std::array<FourVectors, 3> u_, v_;  ///< the axes of either
  FourVectors half_a_, half_b_;
};

}  // namespace detail

template <int Degree>
FourWaits nodes_apart(const NodesView<Degree>& view, const FourNodes& a, const FourNodes& b) {
  if (!view.certain) return {FourFloats{}, 0};
  FourWaits waits = detail::NodeGaps<Degree>(view, a, b).waits();
  if (!(view.ahead > 0)) waits.worth_it = 0;
  return waits;
}

template <int Degree>
unsigned nodes_apart_by(double margin, const NodesView<Degree>& view, const FourNodes& a, const FourNodes& b) {
  return view.certain ? detail::NodeGaps<Degree>(view, a, b).exceed(margin) : 0;
}

}  // namespace kds::collision
