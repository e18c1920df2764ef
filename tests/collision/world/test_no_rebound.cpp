// Contacts without rebound between bodies that are pulled apart: they stop each other, and part.
#include "tests/collision/event_log.hpp"

#include <catch2/catch.hpp>

namespace kds::collision::test_no_rebound {
namespace {

using namespace tests;

TEST_CASE("What meets a wall without rebound, and is pulled away from it, stops there and goes back", "[world][zeno]") {
  WorldOptions options;
  options.response = Response::elastic;
  options.walls = Walls{Vector3d::Constant(-10), Vector3d::Constant(10)};
  options.walls->restitution = 0;
  EventLog<2> log;
  World<2> world(options, &log);
  world.add_body(ball<2>(1, Vector3d(5, 0, 0), Vector3d(6, 1, 0), Vector3d(-1, 0, 0)));
  int steps = 0;
  while (world.step(3) && ++steps < 100) world.audit();
  REQUIRE(log.count(Kind::wall) == 1);
  CHECK(log.of(Kind::wall)[0].time() == Approx(3 - std::sqrt(5)));
  const double since = 3 - log.of(Kind::wall)[0].time();
  CHECK(world.motion(0).position(3)[0] == Approx(9 - since * since));
  CHECK(world.motion(0).position(3)[1] == Approx(3));
  CHECK_FALSE(world.resting_at_wall(0, 1));
}

TEST_CASE("Balls that meet without rebound, and are pulled apart, do not pass through each other", "[world][zeno]") {
  WorldOptions options;
  options.response = Response::elastic;
  EventLog<2> log;
  World<2> world(options, &log);
  for (const double side : {-1.0, 1.0}) {
    auto one = ball<2>(1, Vector3d(5 * side, 0, 0), Vector3d(-6 * side, 0, 0), Vector3d(side, 0, 0));
    one.restitution = 0;
    world.add_body(one);
  }
  int steps = 0;
  while (world.step(2) && ++steps < 100) world.audit();
  REQUIRE(log.count(Kind::contact) == 1);
  const double t = log.of(Kind::contact)[0].time();
  CHECK(t == Approx(3 - std::sqrt(5)));
  CHECK(world.motion(0).position(2)[0] == Approx(-1 - (2 - t) * (2 - t)));
  CHECK(world.motion(1).position(2)[0] == Approx(1 + (2 - t) * (2 - t)));
}

}  // namespace
}  // namespace kds::collision::test_no_rebound
