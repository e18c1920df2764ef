// A half-space and a body that turns: which corners are the lowest, and for how long all are above the plane.
#pragma once

#include "certificates/turning/distance_of_parts.hpp"
#include "certificates/turning/rigid_motion.hpp"
#include "collision/narrow_phase/turning/corners_of_shape.hpp"
#include "collision/narrow_phase/turning/pair_frame.hpp"
#include "collision/shapes/shape.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace kds::collision {

/// A half-space (a), which does not turn, and the corners of a body (b), each the middle of a ball of a radius, which
/// may be 0: a box, a hull, a capsule, or a mesh, which has a vertex in what it penetrates. They are apart while all
/// corners are above the plane. So there is one *way* of being apart (see WaysApart), with a condition for each corner:
/// n . (o_b + R(t) x - o_a) >= offset + radius, of which the normal is as its doubles say.
///
/// Cost: few of the conditions are looked at, those of corners that can be the first to reach the plane. Corners of
/// solids are sought one by one, those of meshes down the tree: a corner of a mesh of 10 000 triangles for as much as
/// some dozen.
template <int Degree, class Corners>
class TurningAboveHalfSpace {
 public:
  using RigidMotion = certificates::RigidMotion<Degree>;
  using Certificate = certificates::BetweenParts<Degree, certificates::AbovePlane>;
  static constexpr int ways = 1;
  static constexpr bool many_conditions = true;

  /// `plane`: in world orientation. Refers to the motion of b, and to what `corners` refer to.
  TurningAboveHalfSpace(const HalfSpace& plane, const certificates::PointMotion<Degree>& a, Corners corners,
                        const RigidMotion& b)
      : plane_(plane), a_{a}, corners_(std::move(corners)), b_(b) {}

  static bool known_to_separate_nothing(int) { return false; }
  template <class Vanishes>
  static bool separates_nothing(int, const Vanishes&) {
    return false;
  }

  /// The pair as it is at a time, in doubles: products of vectors of the body with the normal, as they are turned.
  struct Frame : PairFrame<Degree> {
    Frame(const TurningAboveHalfSpace& pair, double t) : PairFrame<Degree>(pair.a_, pair.b_, t) {
      const Eigen::Vector3d& n = pair.plane_.normal;
      const Eigen::Vector3d turning = certificates::cross(n, this->spin_b);  // n . (w x v) = (n x w) . v
      normal = of_body(n), rate = of_body(turning), bend = of_body(certificates::cross(turning, this->spin_b));
      const Eigen::Vector3d &way_now = this->way.value, &way_rate = this->way.rate, &way_bend = this->way.bend;
      origin = {dot(n, way_now) - pair.plane_.offset - pair.corners_.grown_by(), dot(n, way_rate), dot(n, way_bend)};
    }
    /// A vector of the world, in the axes of the body.
    Eigen::Vector3d of_body(const Eigen::Vector3d& v) const {
      return {dot(this->axis_b(0), v), dot(this->axis_b(1), v), dot(this->axis_b(2), v)};
    }
    double height(const Eigen::Vector3d& x) const { return origin.value + dot(normal, x); }
    Jet height_jet(const Eigen::Vector3d& x) const { return origin + Jet{dot(normal, x), dot(rate, x), dot(bend, x)}; }
    /// No corner in a box is lower.
    double lowest(const BoxOfCorners& box) const { return height(box.centre) - extent(box) - box.rounding; }
    /// How far a box reaches below its centre.
    double extent(const BoxOfCorners& box) const {
      return std::abs(dot(normal, box.half[0])) + std::abs(dot(normal, box.half[1])) +
             std::abs(dot(normal, box.half[2]));
    }

    Eigen::Vector3d normal, rate, bend;  ///< in the axes of the body
    Jet origin;                          ///< the height of the body's origin above the plane, less the radius
  };
  Frame frame(double t) const { return {*this, t}; }

  /// Those of the corners that are no higher than a value at the time of a frame; all of them if there is no frame.
  struct Conditions {
    const Frame* frame = nullptr;
    double highest = 0x1p1000;
  };
  static Conditions all(int) { return {}; }
  /// What cannot reach the plane in the time of the stretch need not be looked at.
  Conditions unsure(const Frame& frame, int, double stretch) const {
    if (!frame.certain) return {};
    return {&frame, error(frame) + (stretch > 0 ? fastest(frame, stretch) * stretch : 0)};
  }
  /// Nor need corners be looked at that cannot come to be the lowest: two corners turn about each other no faster than
  /// the body.
  Conditions unsure_while_open(const Frame& frame, int, double stretch) const {
    if (!frame.certain) return {};
    const double past_each_other = frame.rate_b > 0 ? 2 * corners_.radius() * frame.rate_b * stretch : 0;
    return {&frame, lowest(frame) + (2 * error(frame) + past_each_other) * (1 + 0x1p-30)};
  }

  /// Calls test(certificate) for conditions until it returns false.
  template <class Test>
  bool every_condition(int, const Conditions& which, const Test& test) const {
    std::vector<std::uint32_t> found;
    const Frame* const frame = which.frame;
    corners_.search([&](const BoxOfCorners& box) { return frame ? frame->lowest(box) : 0; },
                    [&] { return next_up(which.highest); },
                    [&](std::uint32_t i) {
                      if (!frame || frame->height(corners_[i]) <= which.highest) found.push_back(i);
                    });
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return std::all_of(found.begin(), found.end(), [&](std::uint32_t i) {
      return test(Certificate{
          a_, b_, Eigen::Vector3d::Zero(), corners_[i], {plane_.normal, plane_.offset, corners_.grown_by()}});
    });
  }

  /// The height of the lowest corner.
  double gaps(const Frame& frame, std::array<double, ways>& gap) const {
    gap[0] = lowest(frame);
    return error(frame);
  }
  /// A bound on how fast it changes.
  double fastest(const PairFrame<Degree>& frame, double stretch) const {
    return frame.fastest(0, corners_.radius(), stretch);
  }

  /// A time from t on until which they are apart; t where doubles do not tell, or where it would be hardly later.
  double apart_until(double t, double horizon) const { return apart_until(frame(t), horizon); }
  double apart_until(const Frame& frame, double horizon) const;

  /// How far to look ahead, s; and for how much of that all corners are above the plane for certain, if they are just
  /// after the time of the frame, however near to it.
  double stretch(const Frame& frame, double longest) const {
    if (!frame.certain) return longest;
    return frame.stretch(std::abs(plane_.offset) + corners_.grown_by() + corners_.radius(), longest);
  }
  double open_wait(const Frame& frame, int, double stretch) const {
    return frame.certain ? above_for(frame, stretch, true) : 0;
  }

  /// How deep the body is in the half-space at t, in doubles.
  double depth(double t) const { return std::max(0.0, -lowest(frame(t))); }

  /// The same pair with the plane lower.
  std::optional<TurningAboveHalfSpace> smaller(double margin) const {
    TurningAboveHalfSpace pair = *this;
    pair.plane_.offset -= margin;
    return pair;
  }

  /// The time in which other corners come to be low. So few of many corners can be the lowest until then.
  double time_of_turning() const {
    const double rate = norm(b_.angular_velocity);
    return rate > 0 ? (Corners::many ? 0x1p-6 : 0.5) / rate : never;
  }

 private:
  double error(const PairFrame<Degree>& frame) const {
    if (!frame.certain) return never;
    const double lengths = norm(frame.way.value) + corners_.radius() + std::abs(plane_.offset) + corners_.grown_by();
    return frame.way_error + PairFrame<Degree>::rounding * lengths;
  }

  /// For how much of the stretch all corners are above the plane for certain. `open`: they are known to be just after
  /// the time of the frame.
  double above_for(const Frame& frame, double stretch, bool open) const;
  double lowest(const Frame& frame) const {
    double least = never;
    corners_.search([&](const BoxOfCorners& box) { return frame.lowest(box); }, [&] { return least; },
                    [&](std::uint32_t i) { least = std::min(least, frame.height(corners_[i])); });
    return least;
  }

  HalfSpace plane_;
  RigidMotion a_;  ///< which does not turn: the plane is as it is in the world
  Corners corners_;
  const RigidMotion& b_;
};

// ---------------------------------------------------------------------------------------------------------------------

/// While the body is far from the plane, its body of revolution about the axis of turning decides, whose lowest height
/// is constant. Nearer to the plane each corner is followed along its Taylor series. For a box of corners the series is
/// that of its centre, less the extent of the box below the centre while it turns, or in any orientation.
template <int Degree, class Corners>
double TurningAboveHalfSpace<Degree, Corners>::apart_until(const Frame& frame, double horizon) const {
  const double t = frame.time;
  if (!frame.certain) return t;
  const double all = (horizon - t) * (1 + 0x1p-40);
  const double rate = norm(frame.spin_b);
  const double lengths = std::abs(plane_.offset) + corners_.grown_by();
  const double stretch = this->stretch(frame, all);
  const double extent = rate > 0 ? corners_.revolving_extent(-frame.normal, frame.of_body(frame.spin_b / rate))
                                 : frame.origin.value - lowest(frame);
  const double roundings = PairFrame<Degree>::rounding * (lengths + corners_.radius());
  const double wait =
      revolving_apart_for(frame, plane_.normal, plane_.offset + corners_.grown_by() + extent + roundings);
  if (wait >= all || !(rate > 0)) return after_wait(t, wait, stretch);
  return after_wait(t, std::max(wait, above_for(frame, stretch, false)), stretch);
}

template <int Degree, class Corners>
double TurningAboveHalfSpace<Degree, Corners>::above_for(const Frame& frame, double stretch, bool open) const {
  const double lengths = std::abs(plane_.offset) + corners_.grown_by();
  const TurningBounds bounds(frame, 0, lengths, corners_.radius(), stretch);
  double first = stretch;
  const auto positive = [&](Jet f) {
    f.value -= bounds.rounding;
    return positive_for(f, bounds.third, first);
  };
  const auto positive_of_box = [&](const BoxOfCorners& box) {
    const Jet centre = frame.height_jet(box.centre);
    const double radius = box.radius + box.rounding;
    const double however_turned = positive(centre - Jet{radius, 0, 0});
    if (!(however_turned < first)) return first;
    return std::max(however_turned, positive(centre - Jet{frame.extent(box) + box.rounding, frame.rate_b * radius, 0}));
  };
  const auto positive_of_corner = [&](Jet f) {
    if (!open) return positive(f);
    f.value -= bounds.rounding;
    return positive_after(f, bounds.rate_rounding, bounds.bend_rounding, bounds.third, first);
  };
  corners_.search(
      positive_of_box, [&] { return first; },
      [&](std::uint32_t i) { first = std::min(first, positive_of_corner(frame.height_jet(corners_[i]))); });
  return first;
}

}  // namespace kds::collision
