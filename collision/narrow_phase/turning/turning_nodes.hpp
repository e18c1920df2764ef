// Two oriented boxes around parts of bodies that turn: for how long they are apart, in floats.
#pragma once

#include "collision/lanes.hpp"
#include "collision/narrow_phase/turning/jets.hpp"
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
  using RigidMotion = certificates::RigidMotion<Degree>;
  static constexpr double rounding = 512 * 0x1p-24;

  NodesView(const RigidMotion& a, const RigidMotion& b, const NodeUnits& of_a, const NodeUnits& of_b, double t,
            double horizon)
      : TurningView<Degree>(a, b, t),
        size(norm(this->way.value) + of_a.reach + of_b.reach),
        ahead(std::max(0.0, this->stretch(of_a.reach + of_b.reach, (horizon - t) * (1 + 0x1p-40)))) {
    const auto in_a = [&](const Eigen::Vector3d& x) { return lanes(this->seen_from_a(x)); };
    const double s = ahead;
    for (int k = 0; k < 3; ++k) columns[static_cast<std::size_t>(k)] = in_a(this->matrix_b.col(k));
    way_now = in_a(this->way.value / size);
    way_rate = in_a(s * this->way.rate / size);
    way_bend = in_a(s * (s * this->way.bend) / size);
    turn_a = in_a(s * this->spin_a);
    turn_b = in_a(s * this->spin_b);
    unit_a = static_cast<float>(of_a.unit / size);
    unit_b = static_cast<float>(of_b.unit / size);
    round = static_cast<float>((of_a.round + of_b.round) / size);
    angle_a = static_cast<float>(s * this->rate_a);
    angle_b = static_cast<float>(s * this->rate_b);
    const double bend = norm(this->way.bend) * s * s / size;
    const double speed = (norm(this->way.rate) + this->rate_error) * s / size + bend;
    const double distance = (norm(this->way.value) + this->way_error) / size + speed;
    const auto third_of = [&](double angle_n) {
      return TurningBounds::third_of(angle_n, s * this->rate_a, s * this->rate_b, {distance, speed, bend},
                                     of_a.reach / size, of_b.reach / size) *
             (1 + 0x1p-20);
    };
    third = {third_of(0), third_of(s * this->rate_a), third_of(s * this->rate_b)};
    margin = rounding + (this->way_error + this->rate_error * s) / size;
  }

  double size;                   ///< length
  double ahead;                  ///< how far to look ahead, s
  std::array<Lanes, 3> columns;  ///< where the axes of b point
  Lanes way_now, way_rate, way_bend;
  Lanes turn_a, turn_b;  ///< in that time, as vectors
  float angle_a, angle_b;
  float unit_a, unit_b, round;  ///< of nodes
  std::array<double, 3> third;  ///< bounds on |f'''| of gaps: along a direction at rest, that turns with a, with b
  double margin;                ///< that gaps may be off by
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
NodeWait nodes_apart(const NodesView<Degree>& view, const ObbNode& a, const ObbNode& b);

/// Whether they are surely farther apart than a margin at the time of the view.
template <int Degree>
bool nodes_apart_by(double margin, const NodesView<Degree>& view, const ObbNode& a, const ObbNode& b);

// ---------------------------------------------------------------------------------------------------------------------

namespace detail {

/// The gap of two nodes along a direction, as it goes on.
template <int Degree>
class NodeGap {
 public:
  NodeGap(const NodesView<Degree>& view, const ObbNode& a, const ObbNode& b)
      : view_(view),
        axes_a_(a.axes),
        axes_b_(b.axes),
        in_a_(a.centre * splat(view.unit_a)),
        in_b_(dots(b.centre * splat(view.unit_b), view.columns)),
        half_a_(a.half_extents * splat(view.unit_a)),
        half_b_(b.half_extents * splat(view.unit_b)),
        radius_a_(a.radius * view.unit_a),
        radius_b_(b.radius * view.unit_b + view.round) {
    p_ = view.way_now + in_b_ - in_a_;
    distance_ = std::sqrt(dot(p_, p_));
  }

  NodeWait wait() {
    const double balls = distance_ - (radius_a_ + radius_b_) - view_.margin;
    if (balls > 0) {
      find_rates();
      const Lanes n = p_ / splat(distance_);
      const double wait = wait_of({balls, dot(n, rate_), dot(n, bend_)}, view_.third[0]);
      if (wait >= least_) return in_seconds(wait);
    }
    const Widest best = widest();
    if (!(best.gap > view_.margin)) return {0, false};
    if (!(balls > 0)) find_rates();
    return in_seconds(wait_along(best.direction, best.turns_with));
  }

  /// Whether they are surely farther apart than a margin.
  bool exceeds(double margin) {
    margin = margin / view_.size + view_.margin;
    return distance_ - radius_a_ - radius_b_ > margin || widest().gap > margin;
  }

 private:
  static float sum_of_three(Lanes x) { return x[0] + x[1] + x[2]; }
  static float dot(Lanes x, Lanes y) { return sum_of_three(x * y); }
  static Lanes cross(Lanes x, Lanes y) { return next_lanes(x) * last_lanes(y) - last_lanes(x) * next_lanes(y); }
  /// The products of a vector with three, whose coordinates are the rows.
  static Lanes dots(Lanes x, const std::array<Lanes, 3>& rows) {
    return splat(x[0]) * rows[0] + splat(x[1]) * rows[1] + splat(x[2]) * rows[2];
  }

  void find_rates() {
    constexpr float worth = 0x1p-4F;  // of their sizes
    const Lanes by_a = cross(view_.turn_a, in_a_), by_b = cross(view_.turn_b, in_b_);
    rate_ = view_.way_rate + by_b - by_a;
    bend_ = view_.way_bend + cross(view_.turn_b, by_b) - cross(view_.turn_a, by_a);
    const float radii = radius_a_ + radius_b_;
    const float speed = std::sqrt(dot(rate_, rate_)) + view_.angle_a * radius_a_ + view_.angle_b * radius_b_;
    least_ = worth * radii < speed ? worth * radii / speed : 1;
  }

  struct Widest {
    float gap = 0;
    Lanes direction{};
    int turns_with = 0;
  };
  /// Along axes and the line of centres.
  Widest widest() {
    for (std::size_t i = 0; i < 3; ++i) {
      v_[i] = splat(view_.columns[0][i]) * axes_b_[0] + splat(view_.columns[1][i]) * axes_b_[1] +
              splat(view_.columns[2][i]) * axes_b_[2];
    }
    const Lanes along_a = dots(p_, axes_a_), along_b = dots(p_, v_);
    const std::array<Lanes, 3> x{magnitude(dots(edge(axes_a_, 0), v_)), magnitude(dots(edge(axes_a_, 1), v_)),
                                 magnitude(dots(edge(axes_a_, 2), v_))};
    const Lanes round = splat(view_.round);
    const Lanes gap_a = magnitude(along_a) - half_a_ - sums(half_b_ * x[0], half_b_ * x[1], half_b_ * x[2]) - round;
    const Lanes gap_b = magnitude(along_b) - half_b_ - dots(half_a_, x) - round;
    const float widths = sum_of_three(half_a_ * magnitude(along_a) + half_b_ * magnitude(along_b));
    const float line = distance_ > 0 ? distance_ - view_.round - widths / distance_ : 0;
    const float best_a = highest(gap_a), best_b = highest(gap_b);
    if (line >= best_a && line >= best_b) return {line, p_ / splat(distance_), 0};
    const bool of_a = best_a >= best_b;
    const Lanes& gap = of_a ? gap_a : gap_b;
    const float best = of_a ? best_a : best_b;
    const std::size_t i = gap[0] == best ? 0 : (gap[1] == best ? 1 : 2);
    const Lanes direction = edge(of_a ? axes_a_ : v_, i);
    return {best, (of_a ? along_a : along_b)[i] < 0 ? -direction : direction, of_a ? 1 : 2};
  }

  static Lanes edge(const std::array<Lanes, 3>& rows, std::size_t i) {
    return Lanes{rows[0][i], rows[1][i], rows[2][i], 0};
  }

  /// `with`: 0, a direction at rest; 1, one that turns with a; 2, with b.
  double wait_along(Lanes n, int with) const {
    Lanes rate = rate_, bend = bend_, turn_a = view_.turn_a, turn_b = view_.turn_b;  // as seen from n
    float angle_a = view_.angle_a, angle_b = view_.angle_b;
    if (with != 0) {
      const Lanes turn = with == 1 ? view_.turn_a : view_.turn_b;
      const Lanes turned = cross(turn, p_);
      rate = rate_ - turned;
      bend = bend_ + cross(turn, turned - rate_ - rate_);
      turn_a -= turn, turn_b -= turn;
      angle_a = angle_b = view_.angle_a + view_.angle_b;
    }
    Jet f{dot(n, p_) - view_.margin - view_.round, dot(n, rate), dot(n, bend)};
    const auto take = [&](Lanes half, const std::array<Lanes, 3>& axes, Lanes turn, float angles, bool turns) {
      const Lanes x = dots(n, axes);
      const float now = sum_of_three(half * magnitude(x));
      f.value -= now;
      if (!turns) return;
      f.rate -= sum_of_three(half * magnitude(x + dots(cross(n, turn), axes))) - now;
      f.bend -= sum_of_three(half) * angles * angles;
    };
    take(half_a_, axes_a_, turn_a, angle_a, with != 1);
    take(half_b_, v_, turn_b, angle_b, with != 2);
    return wait_of(f, view_.third[static_cast<std::size_t>(with)]);
  }

  /// Part of the stretch. Nothing, where it is surely less than what is worth it.
  double wait_of(const Jet& f, double third) const {
    const double s = least_;
    const double bend = std::min(f.bend, 0.0);
    if (!(f.value + s * (f.rate + s * (0.5 * bend - s * third / 6)) > 0)) return 0;
    return positive_for(f, third, 1);
  }

  NodeWait in_seconds(double wait) const {
    return {wait >= 1 ? view_.ahead : wait * view_.ahead * (1 - 0x1p-30), wait >= least_ && view_.ahead > 0};
  }

  const NodesView<Degree>& view_;
  const std::array<Lanes, 3>& axes_a_;
  const std::array<Lanes, 3>& axes_b_;  ///< as b sees them
  Lanes in_a_, in_b_;                   ///< from the origins of the bodies to the centres
  Lanes half_a_, half_b_;
  float radius_a_, radius_b_;
  Lanes p_, rate_{}, bend_{};  ///< from the centre of a to that of b
  float distance_;
  float least_ = 0;
  std::array<Lanes, 3> v_{};  ///< the axes of b
};

}  // namespace detail

template <int Degree>
NodeWait nodes_apart(const NodesView<Degree>& view, const ObbNode& a, const ObbNode& b) {
  return view.certain ? detail::NodeGap<Degree>(view, a, b).wait() : NodeWait{0, false};
}

template <int Degree>
bool nodes_apart_by(double margin, const NodesView<Degree>& view, const ObbNode& a, const ObbNode& b) {
  return view.certain && detail::NodeGap<Degree>(view, a, b).exceeds(margin);
}

}  // namespace kds::collision
