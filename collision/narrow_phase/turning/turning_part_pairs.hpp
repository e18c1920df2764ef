// Which parts of two bodies that turn may meet, and when.
#pragma once

#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/narrow_phase/part_pairs.hpp"
#include "collision/narrow_phase/turning/pair_frame.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <vector>

namespace kds::collision {

/// A ball that holds a part, in the coordinates of its body.
struct BallOfPart {
  /// That about the box around the part, or that about the origin of the body if it is smaller. The box is turned as
  /// the part was placed, by a matrix that is a rotation up to roundings, for which 2^-40 of the lengths is charged.
  explicit BallOfPart(const PlacedShape& part) {
    const Eigen::Vector3d diagonal = part.high - part.low;
    radius = 0.5 * norm(diagonal) + 0x1p-40 * part.bounding_radius;
    if (radius < part.bounding_radius) {
      centre = part.rotation.transpose() * (0.5 * (part.low + part.high));
    } else {
      radius = part.bounding_radius;
    }
  }

  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius;
};

/// The pairs of parts of two bodies that turn which may penetrate each other at some time from now to the horizon, in
/// the order of the parts of a, then of b. (See parts_of() of part_pairs.hpp.) With half-spaces and meshes that bend
/// these are all.
///
/// Before the balls around the bodies meet no parts do. From then on the balls around two parts are followed along the
/// direction between their centres, which stays as it is: the way between the bodies is a polynomial, a centre is
/// accelerated by no more than its distance from the origin times the square of the rate; and, where a body turns fast,
/// a centre does not leave its circle.
///
/// Cost: a root, and for each pair of parts some fifty operations.
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
    std::vector<SeenBall> seen_b;
    for (const PlacedShape& part_b : parts_of(b.shape)) seen_b.emplace_back(BallOfPart(part_b), frame.matrix_b);
    for (const PlacedShape& part_a : parts_of(a.shape)) {
      const SeenBall seen_a(BallOfPart(part_a), frame.matrix_a);
      auto ball_b = seen_b.begin();
      for (const PlacedShape& part_b : parts_of(b.shape)) {
        const double wait = apart_for(frame, seen_a, *ball_b++);
        const double from = wait > 0 ? std::max(meet, next_down(meet + wait)) : meet;
        if (from <= horizon) pairs_.push_back({&part_a, &part_b, from, never});
      }
    }
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
};

}  // namespace kds::collision
