// Fixed bodies that meet walls: what nothing else moves, walls turn back, stop and hold.
#include "tests/collision/event_log.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <vector>

namespace kds::collision::test_fixed_at_walls {
namespace {

using namespace tests;

constexpr std::array responses{Response::none, Response::elastic, Response::callback};

WorldOptions between_walls(Response response, double restitution) {
  WorldOptions options;
  options.response = response;
  options.walls = Walls{Vector3d::Constant(-10), Vector3d::Constant(10), restitution};
  return options;
}

template <int Degree>
BodyDescription<Degree> fixed_ball(const Vector3d& c0, const Vector3d& c1, const Vector3d& c2 = zero) {
  return fixed_body<Degree>(Sphere{1}, motion<Degree>(c0, c1, c2));
}

/// Up to t, audited; false if that took more than so many steps.
template <int Degree>
bool advance(World<Degree>& world, double t, int most = 1000) {
  while (world.step(t)) {
    world.audit();
    if (--most == 0) return false;
  }
  world.audit();
  return true;
}

TEMPLATE_TEST_CASE_SIG("A fixed body stops at a wall without rebound, slides along it, and is let go", "[world][walls]",
                       ((int Degree), Degree), 1, 2) {
  for (const Response response : responses) {
    EventLog<Degree> log;
    World<Degree> world(between_walls(response, 0), &log);
    world.add_body(fixed_ball<Degree>({5, 0, 0}, {2, 1, 0}));
    REQUIRE(advance(world, 4));
    REQUIRE(log.count(Kind::wall) == 1);
    CHECK(log.of(Kind::wall)[0].time() == 2);
    CHECK(world.counters().rebounds_suppressed == 1);
    CHECK(world.resting_at_wall(0, 1));
    CHECK_FALSE(world.resting_at_wall(0, 0));
    CHECK(world.motion(0).position(4) == Vector3d(9, 4, 0));
    CHECK(world.motion(0).velocity(4) == Vector3d(0, 1, 0));
    // A motion along the wall leaves it there; one inward lets it go; one outward meets the wall anew.
    world.update_motion(0, motion<Degree>({9, 4, 0}, {0, -1, 0}, zero, 4));
    REQUIRE(advance(world, 5));
    CHECK(world.resting_at_wall(0, 1));
    world.update_motion(0, motion<Degree>({9, 3, 0}, {-1, 0, 0}, zero, 5));
    REQUIRE(advance(world, 6));
    CHECK_FALSE(world.resting_at_wall(0, 1));
    CHECK(world.motion(0).position(6) == Vector3d(8, 3, 0));
    world.update_motion(0, motion<Degree>({8, 3, 0}, {1, 6, 0}, zero, 6));
    REQUIRE(advance(world, 8));  // into the corner
    CHECK(world.resting_at_wall(0, 1));
    CHECK(world.resting_at_wall(0, 3));
    CHECK(world.motion(0).position(8) == Vector3d(9, 9, 0));
    CHECK(log.count(Kind::wall) == 3);
    world.update_motion(0, motion<Degree>({0, 0, 0}, {0, 0, 1}, zero, 8));  // jumps
    CHECK_FALSE(world.resting_at_wall(0, 1));
    REQUIRE(advance(world, 9));
    CHECK(world.motion(0).position(9) == Vector3d(0, 0, 1));
  }
}

TEST_CASE("A fixed body pressed against a wall comes to rest there, and keeps its acceleration", "[world][walls]") {
  for (const Response response : responses) {
    for (const double restitution : {0.0, 0.5}) {
      EventLog<2> log;
      World<2> world(between_walls(response, restitution), &log);
      const Vector3d pull(0, 0.125, -1);
      world.add_body(fixed_ball<2>({0, 0, -5}, zero, pull));
      REQUIRE(advance(world, 2.0 * (1 + restitution) / (1 - restitution) + 1e-6));
      CHECK(world.counters().rebounds_suppressed == 1);
      CHECK(world.resting_at_wall(0, 4));
      const double t = world.now();
      CHECK(world.motion(0).position(t)[2] == Approx(-9).epsilon(1e-12));
      CHECK(world.motion(0).velocity(t)[2] == 0);
      CHECK(world.motion(0).coefficients[2] == Vector3d(0, 0.125, 0));
      CHECK(world.motion(0).velocity(t)[1] == Approx(0.25 * t));
      CHECK(world.free_motion(0).coefficients[2] == pull);
      // Turned round, what was pressed flies off.
      const Vector3d place = world.motion(0).position(t);
      world.update_motion(0, motion<2>(place, zero, {0, 0, 1}, t));
      REQUIRE(advance(world, t + 1));
      CHECK_FALSE(world.resting_at_wall(0, 4));
      CHECK(world.motion(0).position(t + 1)[2] == Approx(place[2] + 1));
    }
  }
}

TEST_CASE("A fixed body without rebound that is pulled away from the wall stops, and goes back", "[world][walls]") {
  EventLog<2> log;
  World<2> world(between_walls(Response::none, 0), &log);
  world.add_body(fixed_ball<2>({5, 0, 0}, {6, 1, 0}, {-1, 0, 0}));
  REQUIRE(advance(world, 3));
  REQUIRE(log.count(Kind::wall) == 1);
  const double since = 3 - log.of(Kind::wall)[0].time();
  CHECK(since == Approx(std::sqrt(5)));
  CHECK(world.motion(0).position(3)[0] == Approx(9 - since * since));
  CHECK_FALSE(world.resting_at_wall(0, 1));
}

TEST_CASE("Pieces of a script go on after a fixed body has come to rest at a wall", "[world][walls]") {
  EventLog<1> log;
  World<1> world(between_walls(Response::none, 0), &log);
  auto scripted = fixed_ball<1>({5, 0, 0}, {2, 0, 0});
  scripted.motion.push_back(motion<1>({9, 0, 0}, {-1, 0, 0}, zero, 4));
  scripted.motion.push_back(motion<1>({8, 0, 0}, {1, 0, 0}, zero, 5));
  world.add_body(scripted);
  REQUIRE(advance(world, 3));
  CHECK(world.resting_at_wall(0, 1));
  REQUIRE(advance(world, 4.5));
  CHECK_FALSE(world.resting_at_wall(0, 1));
  CHECK(world.motion(0).position(4.5) == Vector3d(8.5, 0, 0));
  REQUIRE(advance(world, 10));
  CHECK(log.count(Kind::wall) == 2);
  CHECK(world.resting_at_wall(0, 1));
  CHECK(world.motion(0).position(10) == Vector3d(9, 0, 0));
}

TEST_CASE("A fixed body that carries another stops at a wall, and what it carries stops on it", "[world][walls]") {
  const Vector3d weight(0, 0, -5);
  EventLog<2> log;
  World<2> world(between_walls(Response::elastic, 0), &log);
  world.add_body(fixed_ball<2>({0, 0, 0}, {0, 0, -3}));
  auto rider = ball<2>(1, {0, 0, 2}, {0, 0, -3}, weight);
  rider.restitution = 0;
  world.add_body(rider);
  REQUIRE(advance(world, 2));
  CHECK(world.resting(0, 1));
  REQUIRE(advance(world, 5));
  CHECK(world.resting_at_wall(0, 4));
  CHECK(world.resting(0, 1));
  CHECK(world.motion(1).position(5)[2] == Approx(-7));
  CHECK(log.count(Kind::wall) == 1);
}

TEST_CASE("A fixed body that presses another against a wall passes through it, and stops there", "[world][walls]") {
  EventLog<2> log;
  World<2> world(between_walls(Response::elastic, 0), &log);
  world.add_body(fixed_ball<2>({0, 0, -7}, {0, 0, 2}));
  world.add_body(ball<2>(1, {0, 0, -5}, {0, 0, 2}, {0, 0, -5}));
  REQUIRE(advance(world, 20, 20000));
  CHECK(world.resting_at_wall(0, 5));
  CHECK(world.motion(0).position(20)[2] == Approx(9));
}

}  // namespace
}  // namespace kds::collision::test_fixed_at_walls
