// Two bodies that turn, seen at one time in doubles.
#pragma once

#include "certificates/ball_separation.hpp"
#include "certificates/positive_parabola.hpp"
#include "certificates/turning/rigid_motion.hpp"
#include "collision/motion_range.hpp"
#include "collision/narrow_phase/turning/jets.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "kds/roots/failure_time.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace kds::collision {

/// The rates of two spins, of which frames at many times can be made.
struct PairRates {
  PairRates() = default;
  template <int Degree>
  PairRates(const certificates::RigidMotion<Degree>& of_a, const certificates::RigidMotion<Degree>& of_b)
      : a(of_a.spin().rate()), b(of_b.spin().rate()) {}

  Ball<DoubleDouble> a, b;
};

/// The axes of two bodies and the way from one to the other at one time, with bounds on what they do in the time to
/// come.
///
/// Error bound. Axes are off by 2^-46 of their length at most (Rotation), the way by `way_error`. A product of an axis,
/// or of the cross product of two, with the way or with half an edge is then off by less than 2^-43 of the lengths that
/// are multiplied; its derivatives, times a power of the time that is at most one over the sum of the rates, by no
/// more than that for each of the up to five products that they add up to. `rounding` = 2^-40 of the lengths is
/// charged for all of it.
template <int Degree>
class PairFrame {
 public:
  using RigidMotion = certificates::RigidMotion<Degree>;
  static constexpr double rounding = 0x1p-40;

  PairFrame(const RigidMotion& a, const RigidMotion& b, double t) : PairFrame(a, b, PairRates(a, b), t) {}
  PairFrame(const RigidMotion& a, const RigidMotion& b, const PairRates& rates, double t)
      : time(t),
        turn_a(a.rotation(rates.a, t)),
        turn_b(b.rotation(rates.b, t)),
        matrix_a(turn_a.matrix()),
        matrix_b(turn_b.matrix()),
        spin_a(that_counts(a.angular_velocity)),
        spin_b(that_counts(b.angular_velocity)),
        rate_a(norm(spin_a) * (1 + 0x1p-40)),
        rate_b(norm(spin_b) * (1 + 0x1p-40)) {
    const auto origin_a = a.origin(t);
    const auto origin_b = b.origin(t);
    way.value = origin_b.vector - origin_a.vector;
    way.rate = b.path.velocity(t) - a.path.velocity(t);
    way.bend = b.path.acceleration(t) - a.path.acceleration(t);
    way_error = origin_a.error + origin_b.error + rounding * certificates::magnitude_sum(way.value);
    rate_error = 0x1p-48 * (speeds(a, t) + speeds(b, t));
    certain = turn_a.error() + turn_b.error() <= 0x1p-44 && rate_a + rate_b <= 0x1p200 && way_error < 0x1p200;
  }

  Eigen::Vector3d axis_a(int i) const { return matrix_a.col(i); }
  Eigen::Vector3d axis_b(int i) const { return matrix_b.col(i); }

  /// How far to look ahead, s: no more than a radian of both turns together, nor than the time in which the way between
  /// the bodies changes by twice its length plus their sizes.
  double stretch(double sizes, double limit) const {
    const double rates = rate_a + rate_b;
    const double far = 2 * (norm(way.value) + sizes);
    double longest = std::min(limit, std::numeric_limits<double>::max());
    if (rates > 0) longest = std::min(longest, 1 / rates);
    if (const double speed = norm(way.rate); speed > 0) longest = std::min(longest, far / speed);
    if (const double bend = norm(way.bend); bend > 0) longest = std::min(longest, std::sqrt(2 * far / bend));
    return longest;
  }

  /// A bound on how fast n . p changes during the stretch that follows, length/s: n of length 1 at most turns with the
  /// bodies, and p is the way and vectors of the two of these lengths.
  double fastest(double of_a, double of_b, double stretch) const {
    const double speed = norm(way.rate) + rate_error + norm(way.bend) * stretch;
    const double distance = norm(way.value) + way_error + speed * stretch + of_a + of_b;
    return (speed + (rate_a + rate_b) * distance + rate_a * of_a + rate_b * of_b) * (1 + 0x1p-30);
  }

  double time;
  certificates::Rotation turn_a, turn_b;
  Eigen::Matrix3d matrix_a, matrix_b;  ///< the same: columns are the axes
  Eigen::Vector3d spin_a, spin_b;      ///< zero where they are as good as still
  double rate_a, rate_b;               ///< rad/s, rounded up
  VectorJet way;                       ///< from the centre of a to that of b
  double way_error;
  double rate_error;  ///< of the rate of the way
  bool certain;       ///< whether numbers are in the range in which the bounds hold

 private:
  /// A spin, or zero for one whose square may lose digits: what it turns by is less than what is charged for roundings.
  static Eigen::Vector3d that_counts(const Eigen::Vector3d& spin) {
    return spin.cwiseAbs().maxCoeff() < slowest_rate ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : spin;
  }
  static double speeds(const RigidMotion& motion, double t) {
    const double elapsed = std::abs(t - motion.path.start);
    double sum = certificates::magnitude_sum(motion.path.coefficients[1]);
    if constexpr (Degree == 2) sum += 2 * elapsed * certificates::magnitude_sum(motion.path.coefficients[2]);
    return sum;
  }
};

/// Bounds on f = n . p for all the time of a stretch: n turns at a rate, and p is the way and vectors that turn.
struct TurningBounds {
  double third;              ///< of |f'''|
  double rounding;           ///< of what is lost in computing f, f' and f'', and following them
  double lengths;            ///< of what p is the sum of, at any time of the stretch
  double rate_rounding = 0;  ///< of what is lost in computing f' alone
  double bend_rounding = 0;  ///< and f''

  TurningBounds(double of_third, double of_rounding, double of_lengths)
      : third(of_third), rounding(of_rounding), lengths(of_lengths) {}
  /// |n| is at most 1. `of_a`, `of_b`: sums of the lengths of the vectors that turn with each body.
  template <int Degree>
  TurningBounds(const PairFrame<Degree>& frame, double rate_n, double of_a, double of_b, double stretch) {
    const double bend = norm(frame.way.bend) * (1 + 0x1p-40);
    const double speed = norm(frame.way.rate) * (1 + 0x1p-40) + frame.rate_error + bend * stretch;
    const double distance = norm(frame.way.value) * (1 + 0x1p-40) + frame.way_error + speed * stretch;
    third = third_of(rate_n, frame.rate_a, frame.rate_b, {distance, speed, bend}, of_a, of_b) * (1 + 0x1p-40);
    lengths = norm(frame.way.value) + of_a + of_b + speed * stretch;
    rounding = PairFrame<Degree>::rounding * lengths + frame.way_error + frame.rate_error * stretch;
    const double p = distance + of_a + of_b;
    const double p1 = speed + frame.rate_a * of_a + frame.rate_b * of_b;
    const double p2 = bend + frame.rate_a * frame.rate_a * of_a + frame.rate_b * frame.rate_b * of_b;
    rate_rounding = PairFrame<Degree>::rounding * (rate_n * p + p1) + rate_n * frame.way_error + frame.rate_error;
    bend_rounding = PairFrame<Degree>::rounding * (rate_n * (rate_n * p + 2 * p1) + p2) +
                    rate_n * (rate_n * frame.way_error + 2 * frame.rate_error);
  }

  /// `third` without roundings. `way`: bounds on its length, and those of its derivatives.
  static double third_of(double rate_n, double rate_a, double rate_b, const Jet& way, double of_a, double of_b) {
    const double p = way.value + of_a + of_b;
    const double p1 = way.rate + rate_a * of_a + rate_b * of_b;
    const double p2 = way.bend + rate_a * rate_a * of_a + rate_b * rate_b * of_b;
    const double p3 = rate_a * rate_a * rate_a * of_a + rate_b * rate_b * rate_b * of_b;
    return rate_n > 0 || p3 > 0 ? rate_n * (rate_n * (rate_n * p + 3 * p1) + 3 * p2) + p3 : 0;
  }
};

/// The time t + wait, rounded down; t itself if the wait is less than the part `worth` of the stretch: then exact signs
/// are faster.
inline double after_wait(double t, double wait, double stretch, double worth = 0x1p-16) {
  return wait > worth * stretch ? std::max(t, next_down(t + wait)) : t;
}

/// How long the bodies of revolution around two bodies are apart along a constant direction: each is about its body's
/// axis of turning, so its extent along the direction never changes. The cost does not depend on how fast the bodies
/// turn. `covered`: by both together. n is at most a rounding longer than 1.
template <int Degree>
double revolving_apart_for(const PairFrame<Degree>& frame, const Eigen::Vector3d& n, double covered) {
  constexpr double rounding = PairFrame<Degree>::rounding;
  const double gap = dot(n, frame.way.value) - covered - frame.way_error - rounding * (norm(frame.way.value) + covered);
  const double rate = dot(n, frame.way.rate) - frame.rate_error - rounding * norm(frame.way.rate);
  const double bend = dot(n, frame.way.bend) - rounding * norm(frame.way.bend);
  return frame.certain ? certificates::positive_for(gap, rate, 0.5 * bend) : 0;
}

/// How far points of a body come at most along a unit vector while it turns about an axis: they keep their heights and
/// distances about it. each_point(take) calls take(x) for each, as they are at one time, about the origin of the body.
/// The sine of the angle to the axis is that of the product: the root of 1 - cosine^2 would lose angles below 1e-8.
template <class EachPoint>
double revolving_extent(const Eigen::Vector3d& n, const Eigen::Vector3d& spin, const EachPoint& each_point) {
  const double rate = norm(spin);
  const bool turns = rate > 0;
  const Eigen::Vector3d axis = turns ? Eigen::Vector3d(spin / rate) : n;
  const double cosine = dot(n, axis);
  const double sine = norm(cross(n, axis));
  double extent = -never;
  each_point([&](const Eigen::Vector3d& x) {
    extent = std::max(extent, turns ? dot(axis, x) * cosine + norm(cross(axis, x)) * sine : dot(n, x));
  });
  return extent;
}

/// When the balls around two bodies meet, `never` if they do not until the horizon; t if they overlap.
template <int Degree>
double balls_apart_until(const certificates::RigidMotion<Degree>& a, const certificates::RigidMotion<Degree>& b,
                         double radius_a, double radius_b, double t, double horizon) {
  return failure_time(certificates::BallSeparation<Degree>{a.path, b.path, radius_a, radius_b}, t, horizon);
}

}  // namespace kds::collision
