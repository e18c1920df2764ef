// Convex hulls that turn: when they meet balls, boxes and each other, against distances by brute force in long doubles.
#include "collision/motions.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "tests/collision_turning/narrow_phase/turning_oracle.hpp"
#include "tests/collision_turning/narrow_phase/turning_solids.hpp"
#include "tests/support/convex_gap.hpp"
#include "tests/support/first_time_check.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace test_turning_hulls {
namespace {

using namespace kds;
using namespace kds::collision;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using kds::tests::ConvexGap;
using kds::tests::motion_of;
using kds::tests::Random;
using kds::tests::random_vector;
using kds::tests::TurningOracle;

template <int Degree>
using Solid = kds::tests::TurningSolid<Degree>;

template <int Degree>
double first(const Solid<Degree>& a, const Solid<Degree>& b, double t0, double horizon,
             ContactMode mode = ContactMode::transparent) {
  return first_contact(a.body(), b.body(), t0, horizon, mode);
}

/// The distance of two solids, by brute force.
template <int Degree>
class Gap {
 public:
  Gap(const Solid<Degree>& a, const Solid<Degree>& b) : a_(a), b_(b), gap_a_(a.shape), gap_b_(b.shape) {}
  double operator()(double t) const {
    return static_cast<double>(ConvexGap::between(gap_a_, pose(a_, t), gap_b_, pose(b_, t)));
  }

 private:
  static ConvexGap::Pose pose(const Solid<Degree>& s, double t) {
    const auto pose = TurningOracle::pose(s.motion, t);
    return {pose.centre, pose.axes};
  }
  const Solid<Degree>& a_;
  const Solid<Degree>& b_;
  ConvexGap gap_a_, gap_b_;
};

Shape random_hull(Random& random) {
  for (;;) {
    std::vector<Vector3d> points;
    const auto kind = random.below(4);
    const int count = 4 + static_cast<int>(random.below(4));
    for (int i = 0; i < count; ++i) {
      Vector3d p = random_vector(random, 1);
      if (kind == 0) p = Vector3d((2 * p).array().round() / 2);  // faces and edges that are parallel
      if (kind == 1) p[2] *= 0x1p-20;                            // flat
      if (kind == 2) p[1] *= 0.02, p[2] *= 0.02;                 // a needle
      points.push_back(p);
    }
    try {
      return convex_hull(points);
    } catch (const InvalidHull&) {
    }
  }
}

Shape random_other(Random& random) {
  if (random.one_in(3)) return Sphere{random.between(0.2, 1)};
  if (random.one_in(3)) return Box{Vector3d(0.5, random.between(0.1, 1), random.one_in(2) ? 0.5 : 0.02)};
  return random_hull(random);
}

/// Two that come near each other at a time of about 1; in some, what they have of spins, axes or orientations is alike.
template <int Degree>
std::array<Solid<Degree>, 2> random_pair(Random& random, double rate) {
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
  Solid<Degree> a{random_hull(random), motion(Vector3d::Zero())};
  Solid<Degree> b{random_other(random), motion(random_vector(random, 0.8))};
  if (random.one_in(6)) b.motion.angular_velocity = a.motion.angular_velocity;
  if (random.one_in(6)) b.motion.orientation = a.motion.orientation;
  if (random.one_in(8))
    b.motion.path.start = a.motion.path.start, b.motion.angular_velocity = a.motion.angular_velocity;
  return {a, b};
}

template <int Degree>
void check_pair(const Solid<Degree>& a, const Solid<Degree>& b, double t0, double horizon, int samples, int& meetings) {
  const double found = first(a, b, t0, horizon);
  CHECK(first(b, a, t0, horizon) == found);
  const double scale = a.placed.bounding_radius + b.placed.bounding_radius;
  const double speed = a.motion.path.velocity(t0).norm() + b.motion.path.velocity(t0).norm() +
                       scale * (a.motion.angular_velocity.norm() + b.motion.angular_velocity.norm());
  const double tolerance = 1e-13 * (scale + a.motion.path.position(t0).norm() + b.motion.path.position(t0).norm()) +
                           2e-15 * speed * (std::abs(t0) + std::abs(horizon));
  const Gap<Degree> gap(a, b);
  const auto verdict = kds::tests::check_first_time(gap, t0, horizon, found, tolerance, samples);
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

template <int Degree>
void check_pairs(std::uint32_t seed, int pairs) {
  Random random(seed);
  int meetings = 0;
  for (int i = 0; i < pairs; ++i) {
    const auto [a, b] = random_pair<Degree>(random, std::pow(10.0, random.between(-2, 1.2)));
    INFO("seed " << seed << ", pair " << i << ", with a " << kind_name(b.shape));
    check_pair(a, b, 0, 2, 100, meetings);
  }
  CHECK(meetings > pairs / 8);
}

}  // namespace

TEST_CASE("turning hulls meet balls, boxes and hulls when their distance says so", "[narrow-phase][turning][hull]") {
  check_pairs<1>(1, 60);
  check_pairs<2>(2, 60);
}

TEST_CASE("turning hulls: slowly and fast, begun long ago", "[narrow-phase][turning][hull]") {
  Random random(7);
  int meetings = 0;
  for (const double rate : {1e-9, 1e-4, 100.0, 1e4}) {
    for (int i = 0; i < 8; ++i) {
      auto [a, b] = random_pair<1>(random, rate);
      a.motion = a.motion.restarted(-1000);
      INFO("rate " << rate << ", pair " << i << ", with a " << kind_name(b.shape));
      const double horizon = rate > 10 ? 20 / rate : 2;
      check_pair(a, b, 0, horizon, 100, meetings);
    }
  }
  CHECK(meetings > 5);
}

TEST_CASE("a turning hull of the corners of a box meets as the box does, to the bit", "[narrow-phase][turning][hull]") {
  Random random(3);
  int meetings = 0;
  for (int i = 0; i < 100; ++i) {
    auto [a, b] = random_pair<1>(random, 3);
    const Vector3d half(1, 0.5, random.one_in(2) ? 0.5 : 0.25);
    std::vector<Vector3d> corners;
    for (int k = 0; k < 8; ++k) {
      corners.emplace_back(k & 1 ? half[0] : -half[0], k & 2 ? half[1] : -half[1], k & 4 ? half[2] : -half[2]);
    }
    const Solid<1> box{Box{half}, a.motion}, hull{convex_hull(corners), a.motion};
    if (std::holds_alternative<ConvexHull>(b.shape)) b = Solid<1>{Box{Vector3d(0.5, 0.5, 0.5)}, b.motion};
    INFO("pair " << i << ", with a " << kind_name(b.shape));
    const double found = first(box, b, 0, 2);
    CHECK(first(hull, b, 0, 2) == found);
    if (found > 0 && found != never) {
      CHECK(first(hull, b, 0, 2, ContactMode::resolved) == first(box, b, 0, 2, ContactMode::resolved));
    }
    meetings += found != never;
    if (found != never) {
      CHECK(first_separation(hull.body(), b.body(), found, 2) == first_separation(box.body(), b.body(), found, 2));
    }
  }
  CHECK(meetings > 30);
}

TEST_CASE("turning hulls: grazing, by gaps of any size", "[narrow-phase][turning][hull]") {
  // A tetrahedron whose tip, at the distance 1, turns about the z axis; a wall whose face is at 1 + gap.
  const Shape tip = convex_hull({{1, 0, 0}, {0, 0.5, -0.5}, {0, -0.5, -0.5}, {0, 0, 0.5}});
  const Shape wall = convex_hull({{0, -1, -1}, {0, 1, -1}, {0, -1, 1}, {0, 1, 1}, {1, 0, 0}});
  for (const double rate : {0.5, 30.0}) {
    for (const double gap : {0.1, 1e-4, 1e-8, 1e-12, 0x1p-52, 0.0}) {
      const Solid<1> a{tip, motion_of<1>({0, 0, 0}, {0, 0, 0}, {0, 0, rate})};
      auto moved = motion_of<1>({1 + gap, 0, 0}, {0, 0, 0}, {0, 0, 0});
      INFO("rate " << rate << ", gap " << gap);
      CHECK(first(a, Solid<1>{wall, moved}, 0, 20) == never);
      moved.path.coefficients[0][0] = 1 - std::max(gap, 0x1p-53);
      CHECK(first(a, Solid<1>{wall, moved}, 0.5, 20) != never);
    }
  }
  // About its own face's normal, in the plane of the wall: nothing is ever penetrated.
  const Shape top = convex_hull({{0, 1, 0.25}, {0, -1, 0.5}, {0, 0, -1}, {-1, 0, 0}});
  const Solid<1> spinning{top, motion_of<1>({0, 0, 0}, {0, 0, 0}, {3, 0, 0})};
  CHECK(first(spinning, Solid<1>{wall, motion_of<1>({0, 0, 0}, {0, 0, 0}, {0, 0, 0})}, 0, 10) == never);
  CHECK(first(spinning, Solid<1>{wall, motion_of<1>({0, 0, 0}, {0, 0, 0}, {-2, 0, 0})}, 0, 10) == never);
  const Solid<1> nearer{wall, motion_of<1>({-0x1p-50, 0, 0}, {0, 0, 0}, {-2, 0, 0})};
  CHECK(first(spinning, nearer, 0, 10) == 0);
}

}  // namespace test_turning_hulls
