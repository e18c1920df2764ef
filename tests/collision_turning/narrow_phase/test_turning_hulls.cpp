// Convex hulls that turn: when they meet balls, boxes and each other, against distances by brute force in long doubles.
#include "collision/narrow_phase/convex_core.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/narrow_phase/turning/turning_boxes.hpp"
#include "collision/narrow_phase/turning/turning_polytopes.hpp"
#include "collision/narrow_phase/turning/ways_apart.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "tests/collision_turning/narrow_phase/check_meetings.hpp"
#include "tests/collision_turning/narrow_phase/turning_solids.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace test_turning_hulls {
namespace {

using namespace kds;
using namespace kds::collision;
using Eigen::Vector3d;
template <int Degree>
using Motion = certificates::RigidMotion<Degree>;
using kds::tests::check_meeting;
using kds::tests::first_meeting;
using kds::tests::motion_of;
using kds::tests::Random;
using kds::tests::random_hull;
using kds::tests::random_vector;

template <int Degree>
using Solid = kds::tests::TurningSolid<Degree>;

Shape random_other(Random& random) {
  if (random.one_in(3)) return Sphere{random.between(0.2, 1)};
  if (random.one_in(3)) return Box{Vector3d(0.5, random.between(0.1, 1), random.one_in(2) ? 0.5 : 0.02)};
  return random_hull(random);
}

template <int Degree>
std::array<Solid<Degree>, 2> random_pair(Random& random, double rate) {
  const Shape a = random_hull(random), b = random_other(random);
  return kds::tests::random_solids<Degree>(random, rate, a, b);
}

template <int Degree>
void check_pairs(std::uint32_t seed, int pairs) {
  Random random(seed);
  int meetings = 0;
  for (int i = 0; i < pairs; ++i) {
    const auto [a, b] = random_pair<Degree>(random, std::pow(10.0, random.between(-2, 1.2)));
    INFO("seed " << seed << ", pair " << i << ", with a " << kind_name(b.shape));
    check_meeting(a, b, 0, 2, 100, meetings);
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
      check_meeting(a, b, 0, horizon, 100, meetings);
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
    const double found = first_meeting(box, b, 0, 2);
    CHECK(first_meeting(hull, b, 0, 2) == found);
    if (found > 0 && found != never) {
      CHECK(first_meeting(hull, b, 0, 2, ContactMode::resolved) == first_meeting(box, b, 0, 2, ContactMode::resolved));
    }
    meetings += found != never;
    if (found != never) {
      CHECK(first_separation(hull.body(), b.body(), found, 2) == first_separation(box.body(), b.body(), found, 2));
    }
  }
  CHECK(meetings > 30);
}

TEST_CASE("hulls that are boxes, wherever in their bodies, meet as hulls do, to the bit",
          "[narrow-phase][turning][hull]") {
  Random random(11);
  int meetings = 0;
  const auto somewhere = [&random] {
    const double far = random.one_in(4) ? 3 : 0.5;
    const Vector3d centre = random_vector(random, far);
    const Vector3d half(random.between(0.1, 1), random.between(0.1, 1), random.one_in(3) ? 0.02 : 0.5);
    std::vector<Vector3d> points{centre};  // the first is inside
    for (int k = 0; k < 8; ++k) {
      const Vector3d signs(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
      points.emplace_back(centre + half.cwiseProduct(signs));
    }
    return convex_hull(std::move(points));
  };
  for (int i = 0; i < 150; ++i) {
    const double rate = std::pow(10.0, random.between(-3, 1.5));
    const ConvexHull of_a = somewhere(), of_b = somewhere();
    const auto [a, b] = kds::tests::random_solids<2>(random, rate, Shape(of_a), Shape(of_b));
    INFO("pair " << i << ", rate " << rate);
    REQUIRE((of_a.polytope->box() && of_b.polytope->box()));
    const TurningBoxes<2> boxes(a.motion, *of_a.polytope->box(), b.motion, *of_b.polytope->box());
    const TurningPolytopes<2> hulls(a.motion, ConvexCore(a.shape), b.motion, ConvexCore(b.shape));
    const WaysApart<TurningBoxes<2>> as_boxes(boxes);
    const WaysApart<TurningPolytopes<2>> as_hulls(hulls);
    const double found = as_boxes.first_penetration(0, 2);
    CHECK(found == as_hulls.first_penetration(0, 2));
    CHECK(boxes.apart_until(0, 2) <= found);
    CHECK(first_meeting(a, b, 0, 2) == found);
    if (found == never) continue;
    ++meetings;
    CHECK(as_boxes.first_parting(found, 2) == as_hulls.first_parting(found, 2));
    CHECK(as_boxes.penetrate(found + 0.01) == as_hulls.penetrate(found + 0.01));
  }
  CHECK(meetings > 30);
}

namespace {

/// What it keeps for those that are derived from it.
struct Ways : TurningPolytopes<2> {
  using Base = TurningPolytopes<2>;
  using Base::Base;
  bool open(Way way, double t) const {
    return every_condition(way, all(way), [t](const auto& condition) { return sign_after(condition, t) >= 0; });
  }
  double depth_along_all(double t) const { return depth_among(frame(t), near_pair(std::nullopt, 0)); }
};

/// Round, or flat by any factor, or with edges and faces that are parallel.
Shape hull_of_many(Random& random, int count) {
  const auto kind = random.below(4);
  const double flat = kind == 1 ? std::pow(10.0, random.between(-9, 0)) : 1;
  return kds::tests::hull_of_random([&] {
    std::vector<Vector3d> points;
    for (int i = 0; i < count; ++i) {
      Vector3d p = random_vector(random, 1).normalized();
      if (kind == 2) p = kds::tests::on_lattice(p);
      p[2] *= flat;
      points.push_back(p);
    }
    return points;
  });
}

}  // namespace

TEST_CASE("ways of hulls that are left out for a stretch are closed during it", "[narrow-phase][turning][hull]") {
  Random random(5);
  int looks = 0, wrong = 0, wrong_depths = 0;
  std::int64_t near = 0, there = 0;
  for (int i = 0; i < 60; ++i) {
    const int count = i % 4 == 0 ? 16 : 7;
    const double rate = std::pow(10.0, random.between(-1, 1));
    const auto [a, b] =
        kds::tests::random_solids<2>(random, rate, hull_of_many(random, count), hull_of_many(random, count));
    const Ways ways(a.motion, ConvexCore(a.shape), b.motion, ConvexCore(b.shape));
    const WaysApart<TurningPolytopes<2>> apart(ways);
    const double met = apart.first_penetration(0, 2);
    // Apart, at the contact and in each other, for stretches of any length.
    for (const double t : {met == never ? 1 : met, (met == never ? 1 : met) + random.between(-0.1, 0.1)}) {
      const double stretch = random.one_in(3) ? 0 : 0.1 * ways.time_of_turning() * random.between(0, 1);
      const auto found = ways.near_ways(ways.frame(t), stretch);
      const auto is_found = [&](std::int64_t way) {
        return std::any_of(found.begin(), found.end(), [way](const auto& each) { return each.way == way; });
      };
      near += static_cast<std::int64_t>(found.size()), there += ways.ways;
      wrong_depths += ways.depth(t) == ways.depth_along_all(t) ? 0 : 1;
      for (const double s : {t, t + random.between(0, 1) * stretch, t + stretch}) {
        for (std::int64_t way = 0; way < ways.ways; ++way) {
          if (is_found(way) || !ways.open(way, s)) continue;
          wrong += ways.separates_nothing(way, [](const auto& c) { return vanishes(c); }) ? 0 : 1;
        }
        ++looks;
      }
    }
  }
  CHECK(wrong == 0);
  CHECK(wrong_depths == 0);
  CHECK(near < there / 2);
  CHECK(looks == 360);
}

TEST_CASE("edges that keep parallel to a common axis of turning are told without exact tests",
          "[narrow-phase][turning][hull]") {
  const double pi = std::acos(-1.0);
  const auto prism = [&](int sides, double first, double radius, double half) {
    std::vector<Vector3d> points;
    for (int i = 0; i < sides; ++i) {
      const double angle = first + 2 * pi * i / sides;
      for (const double z : {-half, half}) points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
    return convex_hull(points);
  };
  std::uint64_t meetings = 0;
  turning_sign_counters = {};
  for (int i = 0; i < 24; ++i) {
    CAPTURE(i);
    const Shape a = prism(4, 0.1 + i, 1.5, 1), b = prism(3 + i % 5, 0.2, 0.25, i % 2 == 0 ? 1 : 0.3);
    Motion<2> of_a{}, of_b{};
    of_a.angular_velocity = {0, 0, i % 3 == 0 ? 0 : 0.3};
    of_b.path.coefficients = {Vector3d(0.1, 2.5, 0), Vector3d(0, -1, 0), Vector3d(0, -1, 0)};
    of_b.angular_velocity = {0, 0, 0.1 * i - 1};
    of_b.orientation = {1, 0, 0, 0.1 * i};
    const PlacedShape placed_a = place(a, Eigen::Quaterniond::Identity());
    const PlacedShape placed_b = place(b, Eigen::Quaterniond::Identity());
    const MovingShape<Motion<2>> moving_a{placed_a, of_a}, moving_b{placed_b, of_b};
    const double t = first_contact(moving_a, moving_b, 0, 2, ContactMode::resolved);
    meetings += t < 2;
    CHECK(in_contact(moving_a, moving_b, t));
  }
  CHECK(meetings == 24);
  CHECK(turning_sign_counters.exact <= 4 * meetings);
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
      CHECK(first_meeting(a, Solid<1>{wall, moved}, 0, 20) == never);
      moved.path.coefficients[0][0] = 1 - std::max(gap, 0x1p-53);
      CHECK(first_meeting(a, Solid<1>{wall, moved}, 0.5, 20) != never);
    }
  }
  // About its own face's normal, in the plane of the wall: nothing is ever penetrated.
  const Shape top = convex_hull({{0, 1, 0.25}, {0, -1, 0.5}, {0, 0, -1}, {-1, 0, 0}});
  const Solid<1> spinning{top, motion_of<1>({0, 0, 0}, {0, 0, 0}, {3, 0, 0})};
  CHECK(first_meeting(spinning, Solid<1>{wall, motion_of<1>({0, 0, 0}, {0, 0, 0}, {0, 0, 0})}, 0, 10) == never);
  CHECK(first_meeting(spinning, Solid<1>{wall, motion_of<1>({0, 0, 0}, {0, 0, 0}, {-2, 0, 0})}, 0, 10) == never);
  const Solid<1> nearer{wall, motion_of<1>({-0x1p-50, 0, 0}, {0, 0, 0}, {-2, 0, 0})};
  CHECK(first_meeting(spinning, nearer, 0, 10) == 0);
}

}  // namespace test_turning_hulls
