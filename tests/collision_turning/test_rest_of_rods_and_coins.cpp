// Rest of bodies of which the plain bounds say that they rock, slide or are out of balance for ever: thin rods, coins
// of many corners, and what lies in a corner without friction.
#include "collision/shapes/convex_hull.hpp"
#include "tests/collision_turning/rest_scenes.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <vector>

namespace test_rest_of_rods_and_coins {
namespace {

using namespace kds;
using namespace kds::collision;
using namespace kds::tests::rest;

/// A prism whose base has that many corners.
ConvexHull coin(int corners) {
  std::vector<Vector3d> points;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    for (const double z : {-0.03, 0.03}) points.emplace_back(0.5 * std::cos(angle), 0.5 * std::sin(angle), z);
  }
  return convex_hull(points);
}

Body floor_of(const Vector3d& normal, double offset = 0) {
  Body result = fixed(Sphere{1}, Vector3d::Zero());
  result.shape = HalfSpace{normal, offset};
  result.restitution = 1;
  return result;
}

/// How many contacts it has until it rests, on a floor; no more than a limit.
int contacts_until_rest(const Body& falling, double until, int limit) {
  Log log;
  Turning world(options(), &log);
  world.add_body(floor_of(Vector3d::UnitZ()));
  const BodyId id = world.add_body(falling);
  while (log.contacts < limit && !still(world, id) && world.step(until)) {
  }
  world.audit();
  CHECK(still(world, id));
  return log.contacts;
}

}  // namespace

TEST_CASE("thin rods come to rest on a floor", "[rest]") {
  for (const double thickness : {0.08, 0.06, 0.02}) {
    for (const double restitution : {0.0, 0.3}) {
      CAPTURE(thickness, restitution);
      Body rod = body(Box{Vector3d(0.6, thickness, thickness)}, {0, 0, 0.5}, tilted(0.3, {1, 2, 3}), {0.3, 0.2, 0.5});
      rod.restitution = restitution;
      CHECK(contacts_until_rest(rod, 6, 5000) < 5000);
    }
  }
}

TEST_CASE("a coin wobbles to rest, however many corners it has", "[rest]") {
  for (const int corners : {12, 32, 64}) {
    for (const double restitution : {0.0, 0.3}) {
      CAPTURE(corners, restitution);
      Body falls = body(coin(corners), {0, 0, 0.45}, tilted(1, {1, 0, 0}), {0, 0, 3});
      falls.restitution = restitution, falls.friction = 0.4;
      CHECK(contacts_until_rest(falls, 30, 12000) < 12000);
    }
  }
}

TEST_CASE("a wheel that rolls on its rim is not stopped as a coin that lies is", "[rest]") {
  Turning world(options());
  world.add_body(floor_of(Vector3d::UnitZ()));
  const double half_edge = std::numbers::pi / 32;
  Body wheel = body(coin(32), {0, 0, 0.5 * std::cos(half_edge) + 1e-6},
                    tilted(std::numbers::pi / 2, {1, 0, 0}) * tilted(half_edge, {0, 0, 1}));
  wheel.friction = 0.5;
  wheel.motion[0].path.coefficients[1] = {0.03, 0, 0};
  wheel.motion[0].angular_velocity = {0, 0.06, 0};
  const BodyId id = world.add_body(wheel);
  world.advance_to(0.5);
  CHECK_FALSE(still(world, id));
  world.advance_to(3);
  CHECK(still(world, id));
}

TEST_CASE("without friction rests what something stops, and what slides along it does not", "[rest]") {
  const Quaterniond slope = tilted(0.6, {0, 1, 0});
  for (const double along : {0.0, 0.01}) {
    CAPTURE(along);
    Log log;
    Turning world(options(), &log);
    world.add_body(floor_of(slope * Vector3d::UnitZ()));
    world.add_body(floor_of(slope * -Vector3d::UnitX(), -3));
    std::vector<BodyId> crates;
    for (const double x : {2.5, 1.9}) {
      Body crate = body(Box{Vector3d::Constant(0.25)}, slope * Vector3d(x, 0, 0.25 + 0x1p-10), slope);
      crate.motion[0].path.coefficients[1] = {0, along, 0};
      crate.friction = 0;
      crates.push_back(world.add_body(crate));
    }
    while (log.contacts < 4000 && world.step(2)) {
    }
    world.audit();
    CHECK(log.passed == 0);
    for (const BodyId crate : crates) {
      CHECK(still(world, crate) == (along == 0));
      CHECK(std::abs(world.motion(crate).path.velocity(world.now())[1] - along) < 1e-6);
    }
  }
}

}  // namespace test_rest_of_rods_and_coins
