// Pairs of solids that turn, and whether they meet when their distance by brute force says so.
#pragma once

#include "collision/motions.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "tests/collision_turning/narrow_phase/turning_oracle.hpp"
#include "tests/collision_turning/narrow_phase/turning_solids.hpp"
#include "tests/support/convex_gap.hpp"
#include "tests/support/first_time_check.hpp"
#include "tests/support/random_hulls.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <vector>

namespace kds::tests {

template <int Degree>
double first_meeting(const TurningSolid<Degree>& a, const TurningSolid<Degree>& b, double t0, double horizon,
                     collision::ContactMode mode = collision::ContactMode::transparent) {
  return first_contact(a.body(), b.body(), t0, horizon, mode);
}

/// The distance of two solids, by brute force.
template <int Degree>
class TurningGap {
 public:
  TurningGap(const TurningSolid<Degree>& a, const TurningSolid<Degree>& b)
      : a_(a), b_(b), gap_a_(a.shape), gap_b_(b.shape) {}
  double operator()(double t) const {
    return static_cast<double>(ConvexGap::between(gap_a_, pose(a_, t), gap_b_, pose(b_, t)));
  }

 private:
  static ConvexGap::Pose pose(const TurningSolid<Degree>& s, double t) {
    const auto pose = TurningOracle::pose(s.motion, t);
    return {pose.centre, pose.axes};
  }
  const TurningSolid<Degree>& a_;
  const TurningSolid<Degree>& b_;
  ConvexGap gap_a_, gap_b_;
};

inline collision::Shape random_hull(Random& random) {
  return hull_of_random([&random] {
    std::vector<Eigen::Vector3d> points;
    const auto kind = random.below(4);
    const int count = 4 + static_cast<int>(random.below(4));
    for (int i = 0; i < count; ++i) {
      Eigen::Vector3d p = random_vector(random, 1);
      if (kind == 0) p = on_lattice(p);
      if (kind == 1) p[2] *= 0x1p-20;             // flat
      if (kind == 2) p[1] *= 0.02, p[2] *= 0.02;  // a needle
      points.push_back(p);
    }
    return points;
  });
}

/// Two that come near each other at a time of about 1; in some, what they have of spins, axes or orientations is alike.
template <int Degree>
std::array<TurningSolid<Degree>, 2> random_solids(Random& random, double rate, const collision::Shape& shape_a,
                                                  const collision::Shape& shape_b) {
  using Eigen::Quaterniond, Eigen::Vector3d;
  const auto motion = [&](const Vector3d& meets) {
    const Vector3d velocity = random.one_in(5) ? Vector3d(Vector3d::Zero()) : random_vector(random, 2);
    Vector3d spin = random.one_in(4) ? Vector3d(Vector3d::Zero()) : random_vector(random, rate);
    if (random.one_in(4)) spin = Vector3d::Unit(static_cast<int>(random.below(3))) * rate;
    auto m = motion_of<Degree>(meets - velocity, velocity, spin, random.one_in(2) ? 0 : -random.between(0, 3));
    if constexpr (Degree == 2) m.path.coefficients[2] = random_vector(random, 1);
    if (!random.one_in(3)) {
      m.orientation = random.one_in(3) ? Quaterniond(1, 1, 0, 0)
                                       : Quaterniond(random.between(-1, 1), random.between(-1, 1),
                                                     random.between(-1, 1), random.between(-1, 1));
    }
    return m;
  };
  TurningSolid<Degree> a{shape_a, motion(Vector3d::Zero())};
  TurningSolid<Degree> b{shape_b, motion(random_vector(random, 0.8))};
  if (random.one_in(6)) b.motion.angular_velocity = a.motion.angular_velocity;
  if (random.one_in(6)) b.motion.orientation = a.motion.orientation;
  if (random.one_in(8))
    b.motion.path.start = a.motion.path.start, b.motion.angular_velocity = a.motion.angular_velocity;
  return {a, b};
}

template <int Degree>
void check_meeting(const TurningSolid<Degree>& a, const TurningSolid<Degree>& b, double t0, double horizon, int samples,
                   int& meetings) {
  using namespace collision;
  const double found = first_meeting(a, b, t0, horizon);
  CHECK(first_meeting(b, a, t0, horizon) == found);
  const double scale = a.placed.bounding_radius + b.placed.bounding_radius;
  const double speed = a.motion.path.velocity(t0).norm() + b.motion.path.velocity(t0).norm() +
                       scale * (a.motion.angular_velocity.norm() + b.motion.angular_velocity.norm());
  const double tolerance = 1e-13 * (scale + a.motion.path.position(t0).norm() + b.motion.path.position(t0).norm()) +
                           2e-15 * speed * (std::abs(t0) + std::abs(horizon));
  const TurningGap<Degree> gap(a, b);
  const auto verdict = check_first_time(gap, t0, horizon, found, tolerance, samples);
  CHECK_FALSE(verdict.missed);
  CHECK_FALSE(verdict.wrong);
  PairMemory memory;
  CHECK(estimated_first_contact(a.body(), b.body(), t0, horizon, ContactMode::transparent, memory).time <= found);
  if (found == never) {
    CHECK_FALSE(in_contact(a.body(), b.body(), horizon));
    return;
  }
  ++meetings;
  CHECK(in_contact(a.body(), b.body(), found));
  if (found > t0) CHECK_FALSE(in_contact(a.body(), b.body(), next_down(found)));
  const double parted = first_separation(a.body(), b.body(), found, horizon);
  if (parted != never) {
    CHECK_FALSE(in_contact(a.body(), b.body(), parted));
    CHECK(std::abs(gap(parted)) <= tolerance);
    CHECK(gap(0.5 * (found + parted)) <= tolerance);
  }
}

}  // namespace kds::tests
