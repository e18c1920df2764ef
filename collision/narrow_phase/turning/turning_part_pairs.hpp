// Which parts of two bodies that turn may meet, and when.
#pragma once

#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/narrow_phase/part_pairs.hpp"
#include "collision/narrow_phase/turning/pair_frame.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

namespace kds::collision {

/// The pairs of parts of two bodies that turn which may penetrate each other at some time from now to the horizon, in
/// the order of the parts of a, then of b. (See parts_of() of part_pairs.hpp.) With half-spaces and meshes that bend
/// these are all.
///
/// Before the balls around the bodies meet no parts do. From then on the balls around two parts are followed along the
/// direction between their centres, which stays as it is: the way between the bodies is a polynomial, a centre is
/// accelerated by no more than its distance from the origin times the square of the rate; and, where a body turns fast,
/// a centre does not leave its circle.
///
/// Where a body has a tree of parts, balls around groups are looked at first, by bounds on the numbers from which it is
/// told of two parts for how long they are apart: the pairs listed, and their times, are those that a look at each part
/// finds. There pairs are listed piece by piece, first those that meet while the bodies come nearer by the size of the
/// smaller one: list_on() goes on.
///
/// Cost: a root, and for each pair of parts some fifty operations; as many for each pair of groups.
template <int Degree>
class TurningPartPairs : public ListOfPartPairs {
 public:
  using Body = MovingShape<certificates::RigidMotion<Degree>>;

  TurningPartPairs(const Body& a, const Body& b, double now, double horizon) {
    const auto any_time = [](const PlacedShape& shape) { return unbounded(shape.shape) || bends(shape.shape); };
    if (any_time(a.shape) || any_time(b.shape)) {
      for (const PlacedShape& part_a : parts_of(a.shape)) {
        for (const PlacedShape& part_b : parts_of(b.shape)) pairs_.push_back({&part_a, &part_b, now, never});
      }
      return;
    }
    const double meet =
        balls_apart_until(a.motion, b.motion, a.shape.bounding_radius, b.shape.bounding_radius, now, horizon);
    if (meet == never) return;
    const PairFrame<Degree> frame(a.motion, b.motion, meet);
    const auto turned = [](const PlacedShape& shape) { return !shape.rotation.isIdentity(0); };
    if ((part_tree(a.shape) || part_tree(b.shape)) && !turned(a.shape) && !turned(b.shape)) {
      in_groups_.emplace(a.shape, b.shape, frame, meet, horizon);
      const double size = std::min(a.shape.bounding_radius, b.shape.bounding_radius);
      const double speed = most_speed(frame, a.shape.bounding_radius, b.shape.bounding_radius);
      const double bend = most_bend(frame, a.shape.bounding_radius, b.shape.bounding_radius);
      in_groups_->stretch = certificates::positive_for(size, -speed, -0.5 * bend);
      list_until(std::min(horizon, meet + in_groups_->stretch));
      return;
    }
    std::vector<SeenBall> seen_b;
    for (const PlacedShape& part_b : parts_of(b.shape)) seen_b.emplace_back(BallOfPart(part_b), frame.matrix_b);
    for (const PlacedShape& part_a : parts_of(a.shape)) {
      const SeenBall seen_a(BallOfPart(part_a), frame.matrix_a);
      auto ball_b = seen_b.begin();
      for (const PlacedShape& part_b : parts_of(b.shape)) {
        const double from = from_when(frame, seen_a, *ball_b++, meet);
        if (from <= horizon) pairs_.push_back({&part_a, &part_b, from, never});
      }
    }
  }

  /// Lists more pairs if some that meet by this time are not yet listed; else false.
  bool list_on(double until) {
    if (!in_groups_ || !(listed_until_ < std::min(until, in_groups_->horizon))) return false;
    listed_before_ = listed_until_;
    in_groups_->stretch *= 2;
    const double next = in_groups_->meet + in_groups_->stretch;
    list_until(next > listed_until_ ? std::min(next, in_groups_->horizon) : in_groups_->horizon);
    return true;
  }

 private:
  /// The same in the axes of the world, about the body's origin.
  struct SeenBall {
    SeenBall(const BallOfPart& ball, const Eigen::Matrix3d& axes)
        : centre(axes * ball.centre),
          distance(norm(ball.centre) * (1 + PairFrame<Degree>::rounding)),
          radius(ball.radius) {}

    Eigen::Vector3d centre;
    double distance;  ///< how far the centre is from the origin of the body
    double radius;
  };

  /// How far the centre comes along a unit vector while it turns.
  static double revolving_extent(const SeenBall& ball, const Eigen::Vector3d& n, const Eigen::Vector3d& spin) {
    const double rate = norm(spin);
    if (!(rate > 0)) return dot(n, ball.centre);
    const Eigen::Vector3d axis = spin / rate;
    const double cosine = dot(n, axis);
    const double sine = norm(cross(n, axis));  // 1 - cosine^2 loses small angles
    return dot(axis, ball.centre) * cosine + norm(cross(axis, ball.centre)) * sine;
  }

  /// A ball that holds the balls of the parts of a group, in the coordinates of the body.
  struct GroupBall {
    explicit GroupBall(const PartTree::Node& node) : centre(node.centre), radius(node.radius), reach(node.reach) {}
    /// Of all parts of a shape.
    explicit GroupBall(const PlacedShape& shape) {
      if (const PartTree* const tree = part_tree(shape)) {
        *this = GroupBall(tree->nodes()[0]);
        return;
      }
      for (const PlacedShape& part : parts_of(shape)) {
        const BallOfPart ball(part);
        radius = std::max(radius, norm(ball.centre) + ball.radius);
        reach = std::max(reach, norm(ball.centre));
      }
    }
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double radius = 0;
    double reach = 0;  ///< the greatest distance of the centre of a part's ball from the body's origin
  };

  /// What is needed to list more pairs.
  struct InGroups {
    InGroups(const PlacedShape& shape_a, const PlacedShape& shape_b, const PairFrame<Degree>& seen, double from,
             double until)
        : a(shape_a), b(shape_b), all_of_a(shape_a), all_of_b(shape_b), frame(seen), meet(from), horizon(until) {}
    /// `all`: that of the root.
    static GroupBall ball(const PartGroups& groups, std::uint32_t group, const GroupBall& all) {
      return group == 0 ? all : GroupBall(groups.node(group));
    }
    PartGroups a, b;
    GroupBall all_of_a, all_of_b;
    PairFrame<Degree> frame;
    double meet, horizon;
    double stretch = 0;
  };

  /// Bounds on how fast the way between points of the two bodies changes, and on its second derivative, at distances
  /// from the origins of at most these.
  static double most_speed(const PairFrame<Degree>& frame, double of_a, double of_b) {
    return (norm(frame.way.rate) + frame.rate_a * of_a + frame.rate_b * of_b) * (1 + 0x1p-20) + frame.rate_error;
  }
  static double most_bend(const PairFrame<Degree>& frame, double of_a, double of_b) {
    const double inward = frame.rate_a * frame.rate_a * of_a + frame.rate_b * frame.rate_b * of_b;
    return (norm(frame.way.bend) + inward) * (1 + 0x1p-20);
  }

  /// At most the time for which apart_for() says of any of the parts of two groups that they are apart: its gap, rate
  /// and bend are bounded by those of the groups, with 2^-20 of the lengths for all roundings.
  static double groups_apart_for(const PairFrame<Degree>& frame, const GroupBall& a, const GroupBall& b) {
    if (!frame.certain) return 0;
    const Eigen::Vector3d centre_a = frame.matrix_a * a.centre, centre_b = frame.matrix_b * b.centre;
    const double distance = norm(frame.way.value + centre_b - centre_a);
    const double lengths = norm(frame.way.value) + norm(centre_a) + norm(centre_b) + a.radius + b.radius;
    const double gap = distance - a.radius - b.radius - frame.way_error - 0x1p-20 * lengths;
    return certificates::positive_for(gap, -most_speed(frame, a.reach, b.reach),
                                      -0.5 * most_bend(frame, a.reach, b.reach)) *
           (1 - 0x1p-20);
  }

  /// Lists the pairs that may meet after `listed_before_` and by this time.
  void list_until(double until) {
    const PartGroups &a = in_groups_->a, &b = in_groups_->b;
    const PairFrame<Degree>& frame = in_groups_->frame;
    const double meet = in_groups_->meet;
    const auto may_meet = [&](std::uint32_t of_a, std::uint32_t of_b) {
      const GroupBall ball_a = InGroups::ball(a, of_a, in_groups_->all_of_a);
      const GroupBall ball_b = InGroups::ball(b, of_b, in_groups_->all_of_b);
      return !(meet + groups_apart_for(frame, ball_a, ball_b) > until);
    };
    const auto parts_a = parts_of(a.shape()), parts_b = parts_of(b.shape());
    for (const auto& [place_a, place_b] : pairs_in_groups(a, b, may_meet)) {
      const PlacedShape &part_a = parts_a[place_a], &part_b = parts_b[place_b];
      const double from = from_when(frame, SeenBall(BallOfPart(part_a), frame.matrix_a),
                                    SeenBall(BallOfPart(part_b), frame.matrix_b), meet);
      if (from <= until && from > listed_before_) pairs_.push_back({&part_a, &part_b, from, never});
    }
    if (listed_before_ != -never) {
      std::sort(pairs_.begin(), pairs_.end(),
                [](const Pair& x, const Pair& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; });
    }
    listed_until_ = until;
  }

  /// From when on two parts may meet, of bodies that do not before `meet`.
  static double from_when(const PairFrame<Degree>& frame, const SeenBall& a, const SeenBall& b, double meet) {
    const double wait = apart_for(frame, a, b);
    return wait > 0 ? std::max(meet, next_down(meet + wait)) : meet;
  }

  /// A time in which two balls do not meet; 0 where that is not known.
  static double apart_for(const PairFrame<Degree>& frame, const SeenBall& a, const SeenBall& b) {
    constexpr double rounding = PairFrame<Degree>::rounding;
    if (!frame.certain) return 0;
    const Eigen::Vector3d way = frame.way.value + b.centre - a.centre;
    const double distance = norm(way);
    const double radii = a.radius + b.radius;
    const double lengths = norm(frame.way.value) + a.distance + b.distance + radii;
    const double gap = distance - radii - frame.way_error - rounding * lengths;
    if (!(gap > 0)) return 0;
    const Eigen::Vector3d n = way / distance;
    const double turning = frame.rate_a * a.distance + frame.rate_b * b.distance;
    const Eigen::Vector3d velocity = frame.way.rate + cross(frame.spin_b, b.centre) - cross(frame.spin_a, a.centre);
    const double rate = dot(n, velocity) - frame.rate_error - rounding * (norm(frame.way.rate) + turning);
    const double inward = frame.rate_a * frame.rate_a * a.distance + frame.rate_b * frame.rate_b * b.distance;
    const double bend = dot(n, frame.way.bend) - rounding * norm(frame.way.bend) - (1 + rounding) * inward;
    const double covered =
        radii + revolving_extent(a, n, frame.spin_a) + revolving_extent(b, -n, frame.spin_b) + rounding * lengths;
    return std::max(certificates::positive_for(gap, rate, 0.5 * bend), revolving_apart_for(frame, n, covered));
  }

  std::optional<InGroups> in_groups_;
  double listed_until_ = never;
};

}  // namespace kds::collision
