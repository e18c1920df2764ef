// Two oriented boxes around parts of bodies that turn: for how long they are apart, in doubles.
#pragma once

#include "collision/narrow_phase/turning/jets.hpp"
#include "collision/narrow_phase/turning/three_vectors.hpp"
#include "collision/narrow_phase/turning/turning_view.hpp"
#include "collision/shapes/obb_tree.hpp"
#include "collision/shapes/shape.hpp"
#include "kds/simd/four_doubles.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace kds::collision {

/// A box, or a ball, about a place in a body.
struct BodyNode {
  Eigen::Vector3d centre;
  ThreeVectors axes;  ///< the directions of the three edges; their lengths are off 1 by 2^-22 at most
  FourDoubles half;   ///< along the axes; the fourth lane is 0, here and there
  double round;       ///< by which the box is grown on all sides
  double radius;      ///< of the ball about the centre around it all
};

/// A node of the tree of a mesh, in units of length. It holds the triangles below it, with their corners scaled and
/// rounded.
///
/// Margin. What is certain of a node is that the products of its axes with a corner, taken from its centre, are within
/// the half extents, by 2^-20 of the tree's unit (ObbTree): roundings of doubles are nothing to that. Its axes are
/// floats, off by 2^-25 each coordinate: their matrix A is off a rotation by 3 2^-25, and so is the inverse of its
/// transpose from A by 6.2 2^-25. So the corner is within the box of these axes to 6.2 2^-25 of its distance: 2^-21 of
/// the radius is charged.
inline BodyNode body_node(const ObbNode& node, double unit) {
  const auto wide = [](const Lanes& x) { return FourDoubles(x[0], x[1], x[2], 0); };
  BodyNode result;
  result.centre = {unit * static_cast<double>(node.centre[0]), unit * static_cast<double>(node.centre[1]),
                   unit * static_cast<double>(node.centre[2])};
  for (std::size_t d = 0; d < 3; ++d) result.axes[d] = wide(node.axes[d]);
  result.half = FourDoubles(unit) * wide(node.half_extents);
  result.round = 0x1p-21 * unit * static_cast<double>(node.radius);
  result.radius = unit * static_cast<double>(node.radius) + result.round;
  return result;
}

inline BodyNode box_node(const Eigen::Vector3d& half) {
  BodyNode result;
  result.centre.setZero();
  result.axes = {FourDoubles(1, 0, 0, 0), FourDoubles(0, 1, 0, 0), FourDoubles(0, 0, 1, 0)};
  result.half = FourDoubles(half[0], half[1], half[2], 0);
  result.round = 0;
  result.radius = norm(half) * (1 + 0x1p-50);
  return result;
}

inline BodyNode ball_node(double radius) {
  BodyNode result = box_node(Eigen::Vector3d::Zero());
  result.round = result.radius = radius;
  return result;
}

inline BodyNode capsule_node(const Capsule& capsule) {
  BodyNode result = box_node(Eigen::Vector3d(0, 0, capsule.half_length));
  result.round = capsule.radius;
  result.radius += capsule.radius;
  return result;
}

/// Two bodies seen at one time, and bounds that hold for all of their nodes.
template <int Degree>
struct NodesView : TurningView<Degree> {
  using RigidMotion = certificates::RigidMotion<Degree>;

  /// `reach`: how far nodes reach from the origin of their body.
  NodesView(const RigidMotion& a, const RigidMotion& b, double reach_a, double reach_b, double t, double horizon)
      : TurningView<Degree>(a, b, t) {
    limit = (horizon - t) * (1 + 0x1p-40);
    const double far = 2 * (norm(this->way.value) + reach_a + reach_b);
    longest = std::max(0.0, std::min(limit, std::numeric_limits<double>::max()));
    if (const double v = norm(this->way.rate); v > 0) longest = std::min(longest, far / v);
    if (const double c = norm(this->way.bend); c > 0) longest = std::min(longest, std::sqrt(2 * far / c));
    const double rates = this->rate_a + this->rate_b;
    longest_turning = rates > 0 ? std::min(longest, 1 / rates) : longest;
    const auto third_of = [&](double rate) {
      return TurningBounds(*this, rate, reach_a, reach_b, longest_turning).third * (1 + 0x1p-20);
    };
    third = {third_of(0), third_of(this->rate_a), third_of(this->rate_b)};
    rounding = TurningBounds(*this, 0, reach_a, reach_b, longest).rounding * (1 + 0x1p-20);
  }

  double limit;                 ///< as far as is asked for, s
  double longest;               ///< how far to look ahead along directions at rest, s
  double longest_turning;       ///< the same along those that turn: up to a radian
  std::array<double, 3> third;  ///< bounds on |f'''| of gaps: along a direction at rest, that turns with a, with b
  double rounding;              ///< that gaps may be off by
};

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
NodeWait nodes_apart(const NodesView<Degree>& view, const BodyNode& a, const BodyNode& b);

/// Whether they are surely farther apart than a margin at the time of the view.
template <int Degree>
bool nodes_apart_by(double margin, const NodesView<Degree>& view, const BodyNode& a, const BodyNode& b);

// ---------------------------------------------------------------------------------------------------------------------

namespace detail {

/// The gap of two nodes along a direction, as it goes on.
template <int Degree>
class NodeGap {
 public:
  NodeGap(const NodesView<Degree>& view, const BodyNode& a, const BodyNode& b)
      : view_(view), a_(a), b_(b), in_a_(view.in_world_a(a.centre)), in_b_(view.in_world_b(b.centre)) {
    p_ = view.way.value + in_b_ - in_a_;
    distance_ = norm(p_);
  }

  NodeWait wait() {
    constexpr double worth = 0x1p-4;  // of their sizes
    const double balls = distance_ - (a_.radius + b_.radius) - view_.rounding;
    const Eigen::Vector3d by_a = cross(view_.spin_a, in_a_), by_b = cross(view_.spin_b, in_b_);
    rate_ = view_.way.rate + by_b - by_a;
    const double speed = norm(rate_) + view_.rate_a * a_.radius + view_.rate_b * b_.radius;
    least_ = std::min(view_.limit, worth * (a_.radius + b_.radius) / speed);
    bend_ = view_.way.bend + cross(view_.spin_b, by_b) - cross(view_.spin_a, by_a);
    if (balls > 0) {
      const Eigen::Vector3d n = p_ / distance_;
      const double wait = wait_of({balls, dot(n, rate_), dot(n, bend_)}, view_.third[0], view_.longest);
      if (wait >= least_) return {wait, true};
    }
    const Widest best = widest();
    if (!(best.gap > view_.rounding)) return {0, false};
    const double wait = wait_along(best.direction, best.turns_with);
    return {wait, wait >= least_ && wait > 0};
  }

  /// Whether they are surely farther apart than a margin.
  bool exceeds(double margin) {
    margin += view_.rounding;
    return distance_ - a_.radius - b_.radius > margin || widest().gap > margin;
  }

 private:
  struct Widest {
    double gap = 0;
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
    int turns_with = 0;
  };
  /// Along axes and the line of centres.
  Widest widest() {
    u_ = turned(view_.matrix_a, a_.axes);
    v_ = turned(view_.matrix_b, b_.axes);
    const double round = a_.round + b_.round;
    const FourDoubles along_a = dots(p_, u_), along_b = dots(p_, v_);
    FourDoubles widths_b(round);
    FourDoubles gap_a = magnitude(along_a) - a_.half;
    std::array<double, 3> gaps_a{};
    for (std::size_t i = 0; i < 3; ++i) {
      const FourDoubles x = magnitude(dots(vector(u_, i), v_));
      widths_b = widths_b + FourDoubles(a_.half[i]) * x;
      gaps_a[i] = gap_a[i] - round - sum_of(b_.half * x);
    }
    const FourDoubles gap_b = magnitude(along_b) - b_.half - widths_b;
    Widest best;
    std::size_t axis = 6;
    if (distance_ > 0) {
      const double widths = sum_of(a_.half * magnitude(along_a) + b_.half * magnitude(along_b));
      if (const double gap = distance_ - round - widths / distance_; gap > 0) best.gap = gap, axis = 7;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      if (gaps_a[i] > best.gap) best.gap = gaps_a[i], axis = i;
      if (gap_b[i] > best.gap) best.gap = gap_b[i], axis = 3 + i;
    }
    if (axis == 7) {
      best.direction = p_ / distance_;
    } else if (axis < 6) {
      const bool of_a = axis < 3;
      const std::size_t i = of_a ? axis : axis - 3;
      best.direction = vector(of_a ? u_ : v_, i);
      if ((of_a ? along_a : along_b)[i] < 0) best.direction = -best.direction;
      best.turns_with = of_a ? 1 : 2;
    }
    return best;
  }

  /// `with`: 0, a direction at rest; 1, one that turns with a; 2, with b.
  double wait_along(const Eigen::Vector3d& n, int with) const {
    Eigen::Vector3d rate = rate_, bend = bend_, spin_a = view_.spin_a, spin_b = view_.spin_b;  // as seen from n
    double rate_a = view_.rate_a, rate_b = view_.rate_b;
    if (with != 0) {
      const Eigen::Vector3d& spin = with == 1 ? view_.spin_a : view_.spin_b;
      const Eigen::Vector3d turn = cross(spin, p_);
      rate = rate_ - turn;
      bend = bend_ + cross(spin, turn - 2 * rate_);
      spin_a -= spin, spin_b -= spin;
      rate_a = rate_b = view_.rate_a + view_.rate_b;
    }
    const double stretch = view_.longest_turning;
    Jet f{dot(n, p_) - view_.rounding - a_.round - b_.round, dot(n, rate), dot(n, bend)};
    const auto take = [&](const FourDoubles& half, const ThreeVectors& axes, const Eigen::Vector3d& spin,
                          double rates) {
      const FourDoubles x = dots(n, axes);
      const FourDoubles end = x + FourDoubles(stretch) * dots(cross(n, spin), axes);
      const double now = sum_of(half * magnitude(x));
      f.value -= now;
      if (stretch > 0) f.rate -= (sum_of(half * magnitude(end)) - now) / stretch;
      f.bend -= sum_of(half) * rates * rates * (1 + 0x1p-20);
    };
    if (with == 1) f.value -= sum_of(a_.half * magnitude(dots(n, u_)));
    if (with == 2) f.value -= sum_of(b_.half * magnitude(dots(n, v_)));
    if (with != 1) take(a_.half, u_, spin_a, rate_a);
    if (with != 2) take(b_.half, v_, spin_b, rate_b);
    return wait_of(f, view_.third[static_cast<std::size_t>(with)], stretch);
  }

  /// Nothing, where it is surely less than what is worth it.
  double wait_of(const Jet& f, double third, double longest) const {
    const double s = std::min(least_, longest);
    const double bend = std::min(f.bend, 0.0);
    if (!(f.value + s * (f.rate + s * (0.5 * bend - s * third / 6)) > 0)) return 0;
    return positive_for(f, third, longest);
  }

  const NodesView<Degree>& view_;
  const BodyNode& a_;
  const BodyNode& b_;
  Eigen::Vector3d in_a_, in_b_;
  Eigen::Vector3d p_, rate_, bend_;  ///< from the centre of a to that of b
  double distance_;
  double least_ = 0;
  ThreeVectors u_, v_;
};

}  // namespace detail

template <int Degree>
NodeWait nodes_apart(const NodesView<Degree>& view, const BodyNode& a, const BodyNode& b) {
  return view.certain ? detail::NodeGap<Degree>(view, a, b).wait() : NodeWait{0, false};
}

template <int Degree>
bool nodes_apart_by(double margin, const NodesView<Degree>& view, const BodyNode& a, const BodyNode& b) {
  return view.certain && detail::NodeGap<Degree>(view, a, b).exceeds(margin);
}

}  // namespace kds::collision
