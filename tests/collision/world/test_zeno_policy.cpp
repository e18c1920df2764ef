// When the policy for endless bounces acts, what it reports, and that runs end.
#include "tests/collision/counted_runs.hpp"

#include <catch2/catch.hpp>

namespace kds::collision::test_zeno_policy {
namespace {

using namespace tests;

TEST_CASE("A ball pressed on the floor by its weight rests there, which is reported, and the run ends",
          "[degenerate]") {
  for (const auto method : all_methods) {
    for (const Shape& shape : {Shape(Sphere{1}), Shape(Box{{1, 1, 1}})}) {
      EventLog<2> log;
      World<2> world(with(Response::elastic, method), &log);
      world.add_body(fixed_body<2>(Box{{10, 10, 1}}, motion<2>({0, 0, -1})));
      world.add_body(body<2>(shape, motion<2>({0, 0, 1})));
      world.advance_to(0);
      world.update_motion(1, motion<2>({0, 0, 1}, {1, 0, 0}, {0, 0, -5}));
      world.advance_to(5);
      world.audit();
      CHECK(log.count(Kind::rebound_suppressed) == 1);
      CHECK(world.counters().rebounds_suppressed == 1);
      CHECK(world.motion(1).position(5) == Vector3d(5, 0, 1));
    }
  }
}

TEST_CASE("Bounces that pile up end at the contact that the policy names", "[degenerate]") {
  for (const auto method : all_methods) {
    for (const Shape& shape : {Shape(Sphere{1}), Shape(Box{{1, 1, 1}})}) {
      EventLog<1> log;
      WorldOptions options = with(Response::elastic, method);
      options.zeno = {.contacts = 10, .interval = 100};
      World<1> world(options, &log);
      world.add_body(fixed_body<1>(Box{{1, 90, 90}}, motion<1>({-3, 0, 0})));
      world.add_body(fixed_body<1>(Box{{1, 90, 90}}, motion<1>({3, 0, 0})));
      world.add_body(body<1>(shape, motion<1>({0, 0, 0}, {2, 1, 0})));  // to and fro in a second
      world.advance_to(50);
      CHECK(log.count(Kind::contact) == 11);
      REQUIRE(log.count(Kind::rebound_suppressed) == 1);
      CHECK(log.of(Kind::rebound_suppressed)[0].time() == 10.5);
      CHECK(world.motion(2).velocity(50) == Vector3d(0, 1, 0));
    }
  }
}

TEST_CASE("A ball between two fixed bodies that close in: the run ends", "[degenerate]") {
  for (const auto method : all_methods) {
    for (const Shape& shape : {Shape(Sphere{1}), Shape(Box{{1, 1, 1}})}) {
      EventLog<1> log;
      WorldOptions options = with(Response::elastic, method);
      options.zeno.interval = 1e-6;  // collapses soon
      World<1> world(options, &log);
      world.add_body(fixed_body<1>(Box{{1, 5, 5}}, motion<1>({-4, 0, 0}, {1, 0, 0})));
      world.add_body(fixed_body<1>(Box{{1, 5, 5}}, motion<1>({4, 0, 0}, {-1, 0, 0})));
      world.add_body(body<1>(shape, motion<1>({0.25, 0, 0}, {1, 0, 0})));
      world.advance_to(10);
      world.audit();
      CHECK(log.count(Kind::rebound_suppressed) > 0);
      CHECK(log.count(Kind::contact) > 100);
      CHECK(log.count(Kind::contact) < 100000);
      CHECK(in_order_of_time(log.events));
    }
  }
}

TEST_CASE("A body crushed between a wall and a fixed body: the run ends", "[degenerate]") {
  for (const auto method : all_methods) {
    EventLog<1> log;
    WorldOptions options = with(Response::elastic, method);
    options.walls = Walls{{-5, -5, -5}, {5, 5, 5}};
    options.zeno.interval = 1e-6;
    World<1> world(options, &log);
    auto piston = fixed_body<1>(Box{{1, 1, 1}}, motion<1>({0, 0, 0}, {-1, 0, 0}));
    world.add_body(piston);
    world.add_body(ball<1>(0.5, {-3, 0, 0}, {-1, 0, 0}));
    world.advance_to(4.25);
    world.audit();
    CHECK(world.counters().rebounds_suppressed > 0);
    CHECK(log.count(Kind::contact) < 100000);
  }
}

}  // namespace
}  // namespace kds::collision::test_zeno_policy
