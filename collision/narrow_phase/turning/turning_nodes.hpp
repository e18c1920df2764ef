// Two oriented boxes around parts of bodies that turn: for how long they are apart, in doubles.
#pragma once

#include "collision/narrow_phase/turning/jets.hpp"
#include "collision/narrow_phase/turning/turning_view.hpp"
#include "collision/shapes/obb_tree.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace kds::collision {

/// A box, or a ball, about a place in a body.
struct BodyNode {
  Eigen::Vector3d centre;
  std::array<Eigen::Vector3d, 3> axes;  ///< unit
  Eigen::Vector3d half;                 ///< along the axes
  double round;                         ///< by which the box is grown on all sides
  double radius;                        ///< of the ball about the centre around it all
};

/// A node of the tree of a mesh, in units of length. It holds the triangles below it, with their corners scaled and
/// rounded.
///
/// Margin. What is certain of a node is that the products of its axes with a corner, taken from its centre, are within
/// the half extents, by 2^-20 of the tree's unit (ObbTree): roundings of doubles are nothing to that. Its axes are
/// floats, off by 2^-25 each coordinate: their matrix is off a rotation by 3 2^-25, its inverse by 3.1 2^-25, and with
/// the axes made unit vectors it is by 6 2^-25. So the corner is within the box of the axes here to 9.1 2^-25 of its
/// distance: 2^-21 of the radius is charged.
inline BodyNode body_node(const ObbNode& node, double unit) {
  const auto vector = [](const Lanes& x) { return Eigen::Vector3d(x[0], x[1], x[2]); };
  BodyNode result;
  result.centre = unit * vector(node.centre);
  for (std::size_t k = 0; k < 3; ++k) {
    const int i = static_cast<int>(k);
    result.axes[k] = normalized(Eigen::Vector3d(node.axes[0][i], node.axes[1][i], node.axes[2][i]));
  }
  result.half = unit * vector(node.half_extents);
  result.round = 0x1p-21 * unit * static_cast<double>(node.radius);
  result.radius = unit * static_cast<double>(node.radius) + result.round;
  return result;
}

inline BodyNode box_node(const Eigen::Vector3d& half) {
  BodyNode result;
  result.centre.setZero();
  for (int k = 0; k < 3; ++k) result.axes[static_cast<std::size_t>(k)] = Eigen::Vector3d::Unit(k);
  result.half = half;
  result.round = 0;
  result.radius = norm(half) * (1 + 0x1p-50);
  return result;
}

inline BodyNode ball_node(double radius) {
  BodyNode result = box_node(Eigen::Vector3d::Zero());
  result.round = result.radius = radius;
  return result;
}

/// How long two nodes are surely apart from the time of a view on.
struct NodeWait {
  double wait;    ///< s
  bool worth_it;  ///< they get near each other by then, for their size
};

/// The balls around them, along the line between their centres; or where that does not last, the boxes, along that line
/// or along an axis of one of them that turns with it.
///
/// Method: along a unit vector n, from a to b, their gap is n . p - sum_k h_k |n . u_k|, with the half edges of both.
/// An n . u_k = x with its rate x' is at most |x| + s (|e| - |x|) / S + s^2 / 2 max |x''| until S, e = x + S x': a
/// convex function is below its chord. So the gap stays above a cubic.
template <int Degree>
NodeWait nodes_apart(const TurningView<Degree>& view, const BodyNode& a, const BodyNode& b, double limit);

/// Whether they are surely farther apart than a margin at the time of the view.
template <int Degree>
bool nodes_apart_by(double margin, const TurningView<Degree>& view, const BodyNode& a, const BodyNode& b);

// ---------------------------------------------------------------------------------------------------------------------

namespace detail {

/// The gap of two nodes along a direction, as it goes on.
template <int Degree>
class NodeGap {
 public:
  NodeGap(const TurningView<Degree>& view, const BodyNode& a, const BodyNode& b)
      : view_(view), a_(a), b_(b), in_a_(view.in_world_a(a.centre)), in_b_(view.in_world_b(b.centre)) {
    p_.value = view.way.value + in_b_ - in_a_;
    distance_ = norm(p_.value);
    p_.rate = view.way.rate + cross(view.spin_b, in_b_) - cross(view.spin_a, in_a_);
  }

  double distance() const { return distance_; }
  double speed() const { return norm(p_.rate) + view_.rate_a * a_.radius + view_.rate_b * b_.radius; }

  /// Of the balls around them.
  double balls_wait(double limit) {
    if (!(distance_ > a_.radius + b_.radius)) return 0;
    set_bend();
    const double of_a = norm(in_a_), of_b = norm(in_b_);
    const double far = 2 * (norm(view_.way.value) + of_a + of_b);
    double longest = limit;
    if (const double v = norm(view_.way.rate); v > 0) longest = std::min(longest, far / v);
    if (const double c = norm(view_.way.bend); c > 0) longest = std::min(longest, std::sqrt(2 * far / c));
    const TurningBounds bounds(view_, 0, of_a, of_b, longest);
    const Eigen::Vector3d n = p_.value / distance_;
    const Jet f{distance_ - (a_.radius + b_.radius) - bounds.rounding, dot(n, p_.rate), dot(n, p_.bend)};
    return positive_for(f, bounds.third, longest);
  }

  double boxes_wait(double limit) {
    const Widest best = widest();
    if (!(best.gap > 0)) return 0;
    set_bend();
    return wait_along(best.direction, best.turns_with, limit);
  }

  /// Whether they are surely farther apart than a margin.
  bool exceeds(double margin) {
    const double size = norm(in_a_) + a_.radius + norm(in_b_) + b_.radius + norm(view_.way.value);
    margin += view_.way_error + PairFrame<Degree>::rounding * size;
    return distance_ - a_.radius - b_.radius > margin || widest().gap > margin;
  }

 private:
  void set_bend() {
    p_.bend = view_.way.bend + cross(view_.spin_b, cross(view_.spin_b, in_b_)) -
              cross(view_.spin_a, cross(view_.spin_a, in_a_));
  }

  struct Widest {
    double gap = 0;
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
    int turns_with = 0;
  };
  Widest widest() {
    for (std::size_t k = 0; k < 3; ++k) {
      u_[k] = view_.in_world_a(a_.axes[k]);
      v_[k] = view_.in_world_b(b_.axes[k]);
    }
    Widest best;
    const auto consider = [&](Eigen::Vector3d n, int with) {
      double along = dot(n, p_.value);
      if (along < 0) along = -along, n = -n;
      const double gap = along - half_width(n);
      if (gap > best.gap) best = {gap, n, with};
    };
    if (distance_ > 0) consider(p_.value / distance_, 0);
    for (std::size_t k = 0; k < 3; ++k) {
      if (a_.half[0] > 0) consider(u_[k], 1);
      if (b_.half[0] > 0) consider(v_[k], 2);
    }
    return best;
  }

  double half_width(const Eigen::Vector3d& n) const {
    double sum = a_.round + b_.round;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      sum += a_.half[i] * std::abs(dot(n, u_[k])) + b_.half[i] * std::abs(dot(n, v_[k]));
    }
    return sum;
  }

  /// `with`: 0, a direction at rest; 1, one that turns with a; 2, with b.
  double wait_along(const Eigen::Vector3d& direction, int with, double limit) const {
    const Eigen::Vector3d spin =
        with == 0 ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : (with == 1 ? view_.spin_a : view_.spin_b);
    const double rate = with == 0 ? 0 : (with == 1 ? view_.rate_a : view_.rate_b);
    const double of_a = norm(in_a_) + a_.radius, of_b = norm(in_b_) + b_.radius;
    const double stretch = view_.stretch(of_a + of_b, limit);
    const VectorJet n = turning(direction, spin);
    const TurningBounds bounds(view_, rate, of_a, of_b, stretch);
    Jet f = dot(n, p_);
    f.value -= bounds.rounding + a_.round + b_.round;
    const auto take = [&](double half, const Eigen::Vector3d& axis, const Eigen::Vector3d& axis_spin, double rates) {
      const double x = dot(direction, axis);
      const double slope = dot(direction, cross(axis_spin - spin, axis));
      const double end = std::abs(x + stretch * slope);
      f.value -= half * std::abs(x);
      if (stretch > 0) f.rate -= half * (end - std::abs(x)) / stretch;
      f.bend -= half * rates * rates;
    };
    for (std::size_t k = 0; k < 3; ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      if (with != 1) take(a_.half[i], u_[k], view_.spin_a, view_.rate_a + rate);
      if (with == 1) f.value -= a_.half[i] * std::abs(dot(direction, u_[k]));
      if (with != 2) take(b_.half[i], v_[k], view_.spin_b, view_.rate_b + rate);
      if (with == 2) f.value -= b_.half[i] * std::abs(dot(direction, v_[k]));
    }
    return positive_for(f, bounds.third, stretch);
  }

  const TurningView<Degree>& view_;
  const BodyNode& a_;
  const BodyNode& b_;
  Eigen::Vector3d in_a_, in_b_;
  VectorJet p_;  ///< from the centre of a to that of b
  double distance_;
  std::array<Eigen::Vector3d, 3> u_, v_;
};

}  // namespace detail

template <int Degree>
NodeWait nodes_apart(const TurningView<Degree>& view, const BodyNode& a, const BodyNode& b, double limit) {
  constexpr double worth = 0.25;  // of their sizes
  if (!view.certain) return {0, false};
  detail::NodeGap<Degree> gap(view, a, b);
  const double least = std::min(limit, worth * (a.radius + b.radius) / gap.speed());
  double wait = gap.balls_wait(limit);
  if (!(wait >= least)) wait = std::max(wait, gap.boxes_wait(limit));
  return {wait, wait >= least && wait > 0};
}

template <int Degree>
bool nodes_apart_by(double margin, const TurningView<Degree>& view, const BodyNode& a, const BodyNode& b) {
  return view.certain && detail::NodeGap<Degree>(view, a, b).exceeds(margin);
}

}  // namespace kds::collision
