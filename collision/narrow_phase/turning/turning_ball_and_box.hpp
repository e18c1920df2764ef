// A ball and a box that turns: on which sides of the box the ball is, and for how long they are apart.
#pragma once

#include "certificates/turning/ball_box_separation.hpp"
#include "certificates/turning/rigid_motion.hpp"
#include "collision/narrow_phase/turning/pair_frame.hpp"

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace kds::collision {

/// A box (a) and a ball (b) are apart while the ball's centre is beyond some sides of the box that meet, and the sum of
/// the squares of how far it is beyond each is at least that of the radius: for a face, an edge or a corner. The 26
/// choices of sides are the *ways* of being apart (see TurningBoxes).
template <int Degree>
class TurningBallAndBox {
 public:
  using RigidMotion = certificates::RigidMotion<Degree>;
  static constexpr int ways = 26;

  TurningBallAndBox(const RigidMotion& box, const Eigen::Vector3d& half, const RigidMotion& ball, double radius)
      : box_(box), ball_(ball), half_(half), radius_(radius), radius_of_box_(norm(half) * (1 + 0x1p-50)) {}

  static bool known_to_separate_nothing(int) { return false; }

  using Conditions = std::uint32_t;
  static constexpr Conditions all(int) { return ~Conditions{0}; }

  template <class Test>
  bool every_condition(int way, Conditions, const Test& test) const {
    const certificates::detail::BallAndBox<Degree> pair{ball_.path, box_, half_};
    const certificates::BoxSides sides = sides_of(way);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (sides[axis] == 0) continue;
      if (!test(certificates::CentreBeyondSide<Degree>{pair, axis, sides[axis]})) return false;
    }
    return test(certificates::BallBeyondSides<Degree>{pair, radius_, sides});
  }

  PairFrame<Degree> frame(double t) const { return {box_, ball_, t}; }

  /// They are few.
  Conditions unsure(const PairFrame<Degree>&, int way, double) const { return all(way); }

  double gaps(const PairFrame<Degree>& frame, std::array<double, ways>& gap) const {
    Eigen::Vector3d x;
    for (int axis = 0; axis < 3; ++axis) {
      x[axis] = dot(frame.axis_a(axis), frame.way.value);
    }
    for (int way = 0; way < ways; ++way) {
      const certificates::BoxSides sides = sides_of(way);
      double square = 0, least = never;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (sides[axis] == 0) continue;
        const auto i = static_cast<Eigen::Index>(axis);
        const double beyond = sides[axis] * x[i] - half_[i];
        square += beyond * beyond;
        least = std::min(least, beyond);
      }
      gap[static_cast<std::size_t>(way)] = std::min(least, std::sqrt(square) - radius_);
    }
    return error(frame);
  }

  /// A bound on how fast the widths change.
  double fastest(const PairFrame<Degree>& frame, double stretch) const {
    return frame.fastest(certificates::magnitude_sum(half_), 0, stretch);
  }

  double apart_until(double t, double horizon) const {
    t = balls_apart_until(box_, ball_, radius_of_box_, radius_, t, horizon);
    if (t == never) return never;
    const PairFrame<Degree> frame = this->frame(t);
    // The direction from the nearest point of the box to the centre, in the box, with which it turns.
    Eigen::Vector3d nearest, beyond;
    for (int axis = 0; axis < 3; ++axis) {
      const double x = dot(frame.axis_a(axis), frame.way.value);
      nearest[axis] = std::min(std::max(x, -half_[axis]), half_[axis]);
      beyond[axis] = x - nearest[axis];
    }
    const double distance = norm(beyond);
    if (!(distance - radius_ > error(frame))) return t;
    const Eigen::Vector3d direction = beyond / distance;
    const double offset = radius_ + half_[0] * std::abs(direction[0]) + half_[1] * std::abs(direction[1]) +
                          half_[2] * std::abs(direction[2]);
    const VectorJet n = turning(frame.turn_a(direction), frame.spin_a);
    const double stretch = frame.stretch(radius_of_box_ + radius_, (horizon - t) * (1 + 0x1p-40));
    // The spin of the ball does not matter: a ball that turns covers the same place.
    const TurningBounds bounds(frame, frame.rate_a, 0, 0, stretch);
    Jet f = dot(n, frame.way);
    f.value -= offset * (1 + PairFrame<Degree>::rounding) + bounds.rounding;
    return after_wait(t, positive_for(f, bounds.third, stretch), stretch);
  }

  /// How deep the two are in each other at t, in doubles; `never` where the ball's centre is in the box: no smaller
  /// ball is out of it.
  double depth(double t) const {
    const PairFrame<Degree> frame(box_, ball_, t);
    double square = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double x = dot(frame.axis_a(axis), frame.way.value);
      const double beyond = std::max(0.0, std::abs(x) - half_[axis]);
      square += beyond * beyond;
    }
    return square > 0 ? std::max(0.0, radius_ - std::sqrt(square)) : never;
  }

  template <class Vanishes>
  static bool separates_nothing(int, const Vanishes&) {
    return false;
  }

  /// The same pair with a smaller ball; none where nothing of it is left.
  std::optional<TurningBallAndBox> smaller(double margin) const {
    if (!(radius_ > margin)) return std::nullopt;
    return TurningBallAndBox(box_, half_, ball_, radius_ - margin);
  }

  double time_of_turning() const {
    const double rate = norm(box_.angular_velocity);
    return rate > 0 ? 0.5 / rate : never;
  }

 private:
  /// Digits to the base of three, of all but "none of any axis".
  static certificates::BoxSides sides_of(int way) {
    const int number = way < 13 ? way : way + 1;
    return {number % 3 - 1, number / 3 % 3 - 1, number / 9 - 1};
  }
  double error(const PairFrame<Degree>& frame) const {
    if (!frame.certain) return never;
    return 4 * frame.way_error + PairFrame<Degree>::rounding * (certificates::magnitude_sum(half_) + radius_);
  }

  const RigidMotion& box_;
  const RigidMotion& ball_;
  Eigen::Vector3d half_;
  double radius_, radius_of_box_;
};

}  // namespace kds::collision
