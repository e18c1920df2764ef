// Capsules that turn: when they meet balls, boxes, hulls and each other, against distances by brute force in long
// doubles, and in cases in which geometry tells the time exactly.
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/polytope.hpp"
#include "tests/collision_turning/narrow_phase/check_meetings.hpp"
#include "tests/collision_turning/narrow_phase/turning_solids.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

namespace test_turning_capsules {
namespace {

using namespace kds;
using namespace kds::collision;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using kds::tests::check_meeting;
using kds::tests::first_meeting;
using kds::tests::motion_of;
using kds::tests::Random;
using kds::tests::random_vector;

template <int Degree>
using Solid = kds::tests::TurningSolid<Degree>;

Shape random_capsule(Random& random) {
  const double radius = random.one_in(3) ? 0.25 : random.between(0.02, 0.6);
  return Capsule{radius, random.one_in(3) ? 0.5 : random.between(0.05, 1.2)};
}

enum Kind { ball, box, hull, capsule };

Shape random_other(Random& random, Kind kind) {
  switch (kind) {
    case ball:
      return Sphere{random.between(0.2, 1)};
    case box:
      return Box{Vector3d(0.5, random.between(0.1, 1), random.one_in(2) ? 0.5 : 0.02)};
    case hull:
      return kds::tests::random_hull(random);
    default:
      return random_capsule(random);
  }
}

template <int Degree>
void check_pairs(std::uint32_t seed, int pairs, const std::vector<double>& rates) {
  Random random(seed);
  for (const Kind kind : {ball, box, hull, capsule}) {
    int meetings = 0;
    for (int i = 0; i < pairs; ++i) {
      const double rate = rates.empty() ? std::pow(10.0, random.between(-2, 1.2)) : rates[random.below(rates.size())];
      const Shape shape_a = random_capsule(random), shape_b = random_other(random, kind);
      auto [a, b] = kds::tests::random_solids<Degree>(random, rate, shape_a, shape_b);
      if (!rates.empty()) a.motion = a.motion.restarted(-1000);
      INFO("seed " << seed << ", pair " << i << ", with a " << kind_name(b.shape) << ", " << rate << " rad/s");
      check_meeting(a, b, 0, rate > 10 && !rates.empty() ? 20 / rate : 2, kind == hull ? 40 : 100, meetings);
    }
    CHECK(meetings > pairs / 8);
  }
}

/// A capsule whose segment is along x, y or z.
Quaterniond along(int axis) { return axis == 0 ? Quaterniond(1, 0, 1, 0) : Quaterniond(1, axis == 1 ? 1 : 0, 0, 0); }

Solid<1> capsule_of(double radius, double half_length, int axis, const Vector3d& position, const Vector3d& velocity,
                    const Vector3d& spin) {
  auto motion = motion_of<1>(position, velocity, spin);
  motion.orientation = along(axis);
  return {Capsule{radius, half_length}, motion};
}

}  // namespace

TEST_CASE("turning capsules meet all solids when their distance says so", "[narrow-phase][turning][capsule]") {
  check_pairs<1>(11, 20, {});
  check_pairs<2>(12, 20, {});
}

TEST_CASE("turning capsules: slowly and fast, begun long ago", "[narrow-phase][turning][capsule]") {
  check_pairs<1>(13, 16, {1e-9, 1e-4, 100.0, 1e4});
}

TEST_CASE("capsules of no length are the balls that they are", "[narrow-phase][turning][capsule]") {
  Random random(14);
  int meetings = 0;
  for (int i = 0; i < 100; ++i) {
    const Shape other = random_other(random, static_cast<Kind>(i % 4));
    const auto [a, b] = kds::tests::random_solids<2>(random, 3, Capsule{0.375, 0}, other);
    const double found = first_meeting(a, b, 0, 2);
    CHECK(found == first_meeting(Solid<2>{Sphere{0.375}, a.motion}, b, 0, 2));
    meetings += found != never;
  }
  CHECK(meetings > 15);
}

TEST_CASE("capsules whose axes stay parallel", "[narrow-phase][turning][capsule]") {
  // Both along z, which they turn about or not; the gap is 1 - t, less the radii 0.5.
  for (const auto& [spin_a, spin_b] :
       {std::array{0.0, 0.0}, std::array{3.0, 0.0}, std::array{3.0, 3.0}, std::array{3.0, -1.0}}) {
    for (const double shifted : {0.0, 0.75, 1.5, -1.5, 1.75}) {
      CAPTURE(spin_a, spin_b, shifted);
      const Solid<1> a = capsule_of(0.25, 1, 2, {0, 0, 0}, {0, 0, 0}, {0, 0, spin_a});
      const Solid<1> b = capsule_of(0.25, 0.5, 2, {1, 0, shifted}, {-1, 0, 0}, {0, 0, spin_b});
      // Side by side, or end to end; with its end 1/4 beyond the other's the way is shorter by as much as a leg.
      const double expected = std::abs(shifted) <= 1.5 ? 0.5 : 1 - std::sqrt(0.1875);
      CHECK(std::abs(first_meeting(a, b, 0, 2) - expected) < 1e-15);
      if (std::abs(shifted) <= 1.5) CHECK(first_meeting(a, b, 0, 2) == 0.5);
    }
  }
  // Turning as one about an axis across them, side by side: at the distance of the radii they touch for good.
  for (const double distance : {0.5, next_down(0.5), next_up(0.5)}) {
    Solid<1> a = capsule_of(0.25, 1, 0, {0, 0, 0}, {0, 0, 0}, {0, 0, 2});
    Solid<1> b = capsule_of(0.25, 1, 0, {0, 0, distance}, {0, 0, 0}, {0, 0, 2});
    CHECK(first_meeting(a, b, 0, 20) == (distance < 0.5 ? 0 : never));
    b.motion.orientation = Quaterniond(0, 1, 0, 1);  // the same axis, the other way round
    CHECK(first_meeting(a, b, 0, 20) == (distance < 0.5 ? 0 : never));
    b.motion.path.coefficients[1] = {0, 0, 0.25};
    CHECK(first_separation(a.body(), b.body(), 0, 20) == (distance < 0.5 ? 0x1p-52 : 0));
  }
}

TEST_CASE("capsules end on end, on a common axis of spin", "[narrow-phase][turning][capsule]") {
  for (const double spin : {0.0, 1.0, 1e3}) {
    // Along z, end to end at 2 - t; and with one across, whose side is met by the end of the other.
    const Solid<1> a = capsule_of(0.25, 0.5, 2, {0, 0, 0}, {0, 0, 0}, {0, 0, spin});
    const Solid<1> b = capsule_of(0.25, 0.75, 2, {0, 0, 2}, {0, 0, -1}, {0, 0, -2 * spin});
    CHECK(first_meeting(a, b, 0, 2) == 0.25);
    const Solid<1> across = capsule_of(0.25, 1, 0, {0, 0, 2}, {0, 0, -1}, {0, 0, -2 * spin});
    CHECK(first_meeting(a, across, 0, 2) == 1);
  }
  // Both across their common axis: lines at a distance of 1 - t at all angles.
  const Solid<1> low = capsule_of(0.25, 1, 0, {0, 0, 0}, {0, 0, 0}, {0, 0, 1});
  const Solid<1> high = capsule_of(0.25, 1, 0, {0, 0, 1}, {0, 0, -1}, {0, 0, -3});
  CHECK(first_meeting(low, high, 0, 2) == 0.5);
  const Solid<1> touching = capsule_of(0.25, 1, 0, {0, 0, 0.5}, {0, 0, 0}, {0, 0, -3});
  CHECK(first_meeting(low, touching, 0, 100) == never);
  const Solid<1> deep = capsule_of(next_up(0.25), 1, 0, {0, 0, 0.5}, {0, 0, 0}, {0, 0, -3});
  CHECK(first_meeting(low, deep, 0.125, 100) == 0.125);
}

TEST_CASE("a capsule that turns on a face, along an edge and past a corner", "[narrow-phase][turning][capsule]") {
  const std::vector<Vector3d> corners{{1, 1, 1},  {1, 1, -1},  {1, -1, 1},  {1, -1, -1},
                                      {-1, 1, 1}, {-1, 1, -1}, {-1, -1, 1}, {-1, -1, -1}};
  for (const Shape& cube : {Shape(Box{Vector3d(1, 1, 1)}), Shape(convex_hull(corners))}) {
    CAPTURE(kind_name(cube));
    const Solid<1> still{cube, motion_of<1>({0, 0, 0}, {0, 0, 0}, {0, 0, 0})};
    const Solid<1> turning{cube, motion_of<1>({0, 0, 0}, {0, 0, 0}, {0, 0, 2})};
    for (const Solid<1>& solid : {still, turning}) {
      // On top, at the height of its radius: it touches for good; nudged down it is in contact at once.
      const double height = 1.25;
      CHECK(first_meeting(solid, capsule_of(0.25, 0.5, 0, {0, 0, height}, {0, 0, 0}, {0, 0, 3}), 0, 20) == never);
      CHECK(first_meeting(solid, capsule_of(0.25, 0.5, 0, {0, 0, next_down(height)}, {0, 0, 0}, {0, 0, 3}), 0, 20) ==
            0);
      CHECK(first_meeting(solid, capsule_of(0.25, 4, 0, {0, 0, 2}, {0, 0, -1}, {0, 0, 3}), 0, 20) == 0.75);
    }
    // Beside the edge along y at (1, 1) of x and z, turning about itself: the way to it is (0.3, 0.4) (2 - t).
    const Solid<1> beside = capsule_of(0.25, 0.5, 1, {1.75, 0, 2}, {-0.75, 0, -1}, {0, 5, 0});
    CHECK(first_meeting(still, beside, 0, 2) == 0.8);
    // An end, off the corner (1, 1, 1) by (2, 1, 2) (1 - t).
    const Solid<1> at_corner = capsule_of(0.75, 0.5, 2, {3, 2, 3.5}, {-2, -1, -2}, {0, 0, 5});
    CHECK(first_meeting(still, at_corner, 0, 2) == 0.75);
  }
}

TEST_CASE("turning capsules: grazing, by gaps of any size", "[narrow-phase][turning][capsule]") {
  // The end of a capsule goes round about z with the radius 1 + 0.25; what it passes begins at that and a gap.
  for (const double rate : {0.5, 30.0}) {
    for (const double gap : {0.1, 1e-4, 1e-8, 1e-12, 0x1p-50, 0.0}) {
      INFO("rate " << rate << ", gap " << gap);
      const Solid<1> a = capsule_of(0.25, 1, 0, {0, 0, 0}, {0, 0, 0}, {0, 0, rate});
      const auto others = [&](double x) {
        const Solid<1> pole = capsule_of(0.5, 2, 2, {x + 0.5, 0, 0}, {0, 0, 0}, {0, 0, 0});
        const Solid<1> wall{Box{Vector3d(0.5, 2, 2)}, motion_of<1>({x + 0.5, 0, 0}, {0, 0, 0}, {0, 0, 0})};
        const Solid<1> stone{Sphere{0.5}, motion_of<1>({x + 0.5, 0, 0}, {0, 0, 0}, {0, 0, 0})};
        return std::array{pole, wall, stone};
      };
      for (const Solid<1>& other : others(1.25 + gap)) CHECK(first_meeting(a, other, 0, 20) == never);
      for (const Solid<1>& other : others(1.25 - std::max(gap, 0x1p-50))) {
        CHECK(first_meeting(a, other, 0.5, 20) != never);
      }
    }
  }
}

TEST_CASE("a turning capsule meets the surface of a hull when it meets the hull, to the bit",
          "[narrow-phase][turning][capsule]") {
  Random random(15);
  int meetings = 0, resolved = 0;
  for (int i = 0; i < 60; ++i) {
    const Shape hull = kds::tests::random_hull(random), capsule = random_capsule(random);
    const auto [a, b] = kds::tests::random_solids<1>(random, std::pow(10.0, random.between(-2, 1.2)), hull, capsule);
    const Solid<1> surface{surface_of(hull), a.motion};
    INFO("pair " << i);
    const double found = first_meeting(a, b, 0, 2);
    if (found == 0) continue;  // it might be inside of the surface
    CHECK(first_meeting(surface, b, 0, 2) == found);
    CHECK(first_meeting(b, surface, 0, 2) == found);
    if (found == never) continue;
    ++meetings;
    CHECK(in_contact(surface.body(), b.body(), found));
    CHECK_FALSE(in_contact(surface.body(), b.body(), next_down(found)));
    if (first_meeting(a, b, 0, 2, ContactMode::resolved) != found) continue;
    CHECK(first_meeting(surface, b, 0, 2, ContactMode::resolved) == found);
    const Contact of_solid = contact_at(a.body(), b.body(), found),
                  of_surface = contact_at(surface.body(), b.body(), found);
    CHECK((of_solid.normal - of_surface.normal).norm() < 1e-6);
    CHECK((of_solid.point - of_surface.point).norm() < 1e-6);
    ++resolved;
  }
  CHECK(meetings > 15);
  CHECK(resolved > 10);
}

TEST_CASE("capsules side by side that turn alike meet beside each other", "[narrow-phase][turning][capsule]") {
  // Turned alike but for a rounding, they are sides of a parallelogram that is as thin as that, and in any plane: also
  // in one in which they are beside each other.
  Random random(1);
  int met = 0;
  for (int i = 0; i < 300; ++i) {
    const Vector3d spin = random_vector(random, 0.2);
    const double gap = std::ldexp(1.0, random.integer(-45, -23));
    const double unlike = std::ldexp(1.0, random.integer(-60, -40));
    CAPTURE(i, unlike, gap);
    const Solid<1> a = capsule_of(0.25, 0.5, 2, {0, 0, 0}, {0, 0, 0}, spin);
    const Solid<1> b = capsule_of(0.25, 0.5, 2, {0, 0.5 + gap, 0}, {0, 0, 0}, (1 + unlike) * spin);
    const double found = first_meeting(a, b, 0, 0.5);
    if (found == never) continue;
    CHECK((contact_at(a.body(), b.body(), found).normal - Vector3d::UnitY()).norm() < 0.1);
    // They approach, so it is one at which they bounce, too.
    CHECK(first_meeting(a, b, 0, 0.5, ContactMode::resolved) == found);
    ++met;
  }
  CHECK(met > 250);
}

TEST_CASE("a turning capsule and one triangle", "[narrow-phase][turning][capsule]") {
  const auto mesh = std::make_shared<const Mesh>(std::vector<Vector3d>{{-2, -2, 0}, {3, -2, 0}, {0, 3, 0}},
                                                 std::vector<Mesh::Triangle>{{0, 1, 2}});
  for (const double spin : {0.0, 2.0}) {
    const Solid<1> triangle{MeshShape{mesh}, motion_of<1>({0, 0, 0}, {0, 0, 0}, {0, 0, spin})};
    // It comes down lying, from either side, and on end; what lies on it at its radius touches for good.
    for (const double side : {1.0, -1.0}) {
      CHECK(first_meeting(triangle, capsule_of(0.25, 0.5, 0, {0, 0, 2 * side}, {0, 0, -side}, {0, 0, 3}), 0, 2) ==
            1.75);
      CHECK(first_meeting(triangle, capsule_of(0.25, 0.5, 2, {0, 0, 2 * side}, {0, 0, -side}, {0, 0, 3}), 0, 2) ==
            1.25);
      CHECK(first_meeting(triangle, capsule_of(0.25, 0.5, 0, {0, 0, 0.25 * side}, {0, 0, 0}, {0, 0, 3}), 0, 20) ==
            never);
      CHECK(first_meeting(triangle, capsule_of(next_up(0.25), 0.5, 0, {0, 0, 0.25 * side}, {0, 0, 0}, {0, 0, 3}), 0,
                          20) == 0);
    }
    // It goes through: apart again when all of it is beyond.
    const Solid<1> through = capsule_of(0.25, 0.5, 2, {0, 0, 2}, {0, 0, -1}, {0, 0, 1});
    CHECK(first_separation(triangle.body(), through.body(), 1.5, 9) == 2.75);
    const Contact contact = contact_at(triangle.body(), through.body(), 1.25);
    CHECK(contact.normal == Vector3d(0, 0, 1));
    CHECK(contact.point.norm() < 1e-15);
    CHECK(contact.feature_b == Feature::vertex(0));
  }
}

}  // namespace test_turning_capsules
