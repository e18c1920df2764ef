// Bodies that rest on what moves with a changing acceleration: they follow it while it presses them, and part from it
// at the moment at which it no longer does.
#include "kds/framework/snapshot.hpp"
#include "tests/collision/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <cmath>

namespace kds::collision::test_resting {
namespace {

using namespace tests;

constexpr double g = 8;  // length/s^2, a power of two: halves and sums of it are exact

/// A platform whose top is at height 0 at the start, its motion given piece by piece, and a crate on it.
template <int Degree>
struct Lift {
  explicit Lift(const std::vector<certificates::PointMotion<Degree>>& pieces, double restitution = 0)
      : world(with_response(Response::elastic), &log) {
    auto platform = fixed_body<Degree>(Box{{4, 4, 1}}, pieces.front());
    platform.motion = pieces;
    world.add_body(platform);
    auto crate = box<Degree>({1, 1, 1}, {0, 0, 2}, pieces.front().velocity(0), {0, 0, -g / 2});
    crate.restitution = restitution;
    world.add_body(crate);
  }
  double height() const { return world.motion(1).position(world.now())[2] - world.motion(0).position(world.now())[2]; }
  void audit_until(double t) {
    while (world.step(t)) world.audit();
    world.audit();
  }

  EventLog<Degree> log;
  World<Degree> world;
};

template <int Degree>
using Path = certificates::PointMotion<Degree>;

TEST_CASE("Curves: a crate follows a lift that starts and stops gently", "[splines][resting]") {
  const Vector3d low(0, 0, 0), high(0, 0, 3);
  Lift<5> lift({Path<5>::quintic(low, zero, zero, high, zero, zero, 0, 4), Path<5>{{high}, 4}});
  for (int i = 1; i <= 50; ++i) {
    lift.audit_until(0.1 * i);
    INFO("at " << lift.world.now());
    REQUIRE(lift.world.resting(0, 1));
    // Some roundings of the coordinates: nothing sinks in, nothing is left behind.
    REQUIRE(std::abs(lift.height() - 2) < 1e-14);
  }
  CHECK(lift.world.motion(1).velocity(5).norm() < 1e-14);
  CHECK(lift.log.count(Kind::contact) == 1);
}

TEST_CASE("Curves: a lift that goes down ever faster leaves its crate when it falls faster", "[splines][resting]") {
  // z = -t^3: its acceleration -6 t is that of the crate at t = g / 6.
  Lift<3> lift({Path<3>{{zero, zero, zero, {0, 0, -1}}, 0}});
  lift.audit_until(g / 6 - 0.01);
  CHECK(lift.world.resting(0, 1));
  CHECK(std::abs(lift.height() - 2) < 1e-14);
  lift.audit_until(g / 6 + 0.5);
  CHECK_FALSE(lift.world.resting(0, 1));
  // From there on the crate falls freely: |z - z0 - v t - ...| is all in the cubic term, t'^3.
  CHECK(lift.height() == Approx(2 + 0.125));
  const Vector3d acceleration = lift.world.motion(1).acceleration(lift.world.now());
  CHECK(acceleration == Vector3d(0, 0, -g));
  CHECK(lift.log.count(Kind::contact) == 1);
}

TEST_CASE("Curves: a body whose own thrust grows lifts off when it outweighs it", "[splines][resting]") {
  EventLog<4> log;
  World<4> world(with_response(Response::elastic), &log);
  world.add_body(fixed_body<4>(Box{{4, 4, 1}}, motion<4>({0, 0, -1})));
  auto rocket = body<4>(Box{{1, 1, 1}}, Path<4>{{{0, 0, 1}, zero, {0, 0, -g / 2}, {0, 0, 1}}, 0});
  rocket.restitution = 0;
  world.add_body(rocket);
  while (world.step(g / 6 - 1e-6)) world.audit();
  CHECK(world.resting(0, 1));
  CHECK(world.motion(1).position(world.now())[2] == 1);
  // The acceleration is 6 t - g: what the floor took of it before it does not come back.
  while (world.step(g / 6 + 1)) world.audit();
  CHECK_FALSE(world.resting(0, 1));
  CHECK(world.motion(1).position(world.now())[2] == Approx(1 + 1.0));
  CHECK(world.free_motion(1).acceleration(world.now())[2] == Approx(6));
}

TEST_CASE("Curves: a stack on a lift parts where it is no longer pressed", "[splines][resting]") {
  Lift<3> lift({Path<3>{{zero, zero, zero, {0, 0, -1}}, 0}});
  auto second = box<3>({1, 1, 1}, {0, 0, 4}, zero, {0, 0, -g / 2});
  second.restitution = 0;
  lift.world.add_body(second);
  lift.audit_until(1);
  CHECK(lift.world.resting(0, 1));
  CHECK(lift.world.resting(1, 2));
  lift.audit_until(g / 6 + 0.25);
  CHECK_FALSE(lift.world.resting(0, 1));
  const double gap =
      lift.world.motion(2).position(lift.world.now())[2] - lift.world.motion(1).position(lift.world.now())[2];
  CHECK(std::abs(gap - 2) < 1e-12);
}

TEST_CASE("Curves: a ball pressed against a wall by a force that turns leaves it then", "[splines][resting]") {
  WorldOptions options = with_response(Response::elastic);
  options.walls = Walls{Vector3d::Constant(-4), Vector3d::Constant(4), 0};
  for (const bool fixed : {false, true}) {
    INFO((fixed ? "fixed" : "free"));
    World<3> world(options);
    // Pressed outward with 12 - 12 t until t = 1.
    auto ball = body<3>(Sphere{1}, Path<3>{{{3, 0, 0}, zero, {6, 0, 0}, {-2, 0, 0}}, 0});
    ball.restitution = 0;
    ball.fixed = fixed;
    world.add_body(ball);
    while (world.step(0.5)) world.audit();
    CHECK(world.resting_at_wall(0, 1));
    CHECK(world.motion(0).position(0.5)[0] == 3);
    while (world.step(2)) world.audit();
    CHECK_FALSE(world.resting_at_wall(0, 1));
    CHECK(world.motion(0).position(2)[0] == Approx(3 - 2));
  }
}

TEST_CASE("Curves: bodies that bounce on a lift come to rest on it", "[splines][resting]") {
  Lift<3> lift({Path<3>{{zero, zero, {0, 0, 0.25}, {0, 0, 0.125}}, 0}}, 0.5);
  lift.world.update_motion(1, Path<3>{{{0, 0, 3}, zero, {0, 0, -g / 2}}, 0});
  lift.audit_until(4);
  CHECK(lift.world.resting(0, 1));
  CHECK(std::abs(lift.height() - 2) < 1e-12);
  CHECK(lift.log.count(Kind::contact) > 10);
}

TEST_CASE("Curves: a world that is loaded goes on as the one that was saved", "[splines][resting]") {
  Lift<3> saved({Path<3>{{zero, zero, zero, {0, 0, -1}}, 0}}, 0.5);
  saved.world.advance_to(1);
  const Snapshot snapshot = save(saved.world);
  EventLog<3> log;
  World<3> loaded(with_response(Response::elastic), &log);
  restore(snapshot, loaded);
  CHECK(loaded.resting(0, 1));
  saved.log.events.clear();
  saved.world.advance_to(3);
  loaded.advance_to(3);
  loaded.audit();
  CHECK(log.events == saved.log.events);
  for (const BodyId id : {0, 1}) CHECK(loaded.motion(id) == saved.world.motion(id));
}

}  // namespace
}  // namespace kds::collision::test_resting
