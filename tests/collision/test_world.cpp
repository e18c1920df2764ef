// The interface of the world: time, bodies that come and go, filters, runs that repeat.
#include "tests/collision/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::collision::test_world {
namespace {

using namespace tests;

WorldOptions reporting_pairs(BroadPhaseKind kind) {
  WorldOptions options;
  options.broad_phase = kind;
  options.rate = 10;
  options.report_pairs = true;
  return options;
}

TEST_CASE("An empty world and a world of one body run", "[world]") {
  for (const auto response : {Response::none, Response::elastic}) {
    World<1> world(with_response(response));
    world.advance_to(1);
    CHECK(world.now() == 1);
    CHECK_FALSE(world.step());
    CHECK(world.size() == 0);
    const BodyId id = world.add_body(ball<1>(1, {0, 0, 0}, {1, 0, 0}));
    CHECK(world.size() == 1);
    CHECK(world.contains(id));
    world.advance_to(5);
    CHECK_FALSE(world.step());
    CHECK(world.motion(id).position(5) == Vector3d(5, 0, 0));
    world.audit();
    world.remove_body(id);
    CHECK(world.size() == 0);
    CHECK_FALSE(world.contains(id));
    world.advance_to(6);
  }
}

TEST_CASE("Time passes up to a time, event by event, or for a budget", "[world]") {
  EventLog<1> log;
  World<1> world({}, &log);
  for (const auto& b : two_balls()) world.add_body(b);

  SECTION("up to a time, inclusive") {
    world.advance_to(std::nextafter(1.0, 0.0));
    CHECK(log.events.empty());
    world.advance_to(1);
    REQUIRE(log.count(Kind::contact) == 1);
    CHECK(log.events[0].time() == 1);
    CHECK(log.events[0].contact.point == Vector3d(1, 0, 0));
    CHECK(log.events[0].contact.normal == Vector3d(1, 0, 0));
    CHECK(world.touching(0, 1));
    world.advance_to(1);
    CHECK(log.events.size() == 1);
    world.advance_to(10);
    REQUIRE(log.count(Kind::separation) == 1);
    CHECK(log.events[1].time() == 3);
    CHECK_FALSE(world.touching(1, 0));
    CHECK(world.now() == 10);
  }
  SECTION("event by event, without a limit") {
    int steps = 0;
    while (world.step()) {
      ++steps;
      REQUIRE(steps < 100);
    }
    CHECK(log.count(Kind::contact) == 1);
    CHECK(log.count(Kind::separation) == 1);
  }
  SECTION("event by event, with a limit") {
    while (world.step(2)) CHECK(world.now() <= 2);
    CHECK(world.now() == 2);
    CHECK(log.events.size() == 1);
  }
  SECTION("for a budget") {
    int calls = 1;
    while (!world.advance_for(0, 10)) REQUIRE(++calls < 100);  // at least one event each time
    CHECK(calls > 1);
    CHECK(world.now() == 10);
    CHECK(log.events.size() == 2);
    CHECK(world.advance_for(60, 20));
    CHECK(world.now() == 20);
  }
}

TEST_CASE("A motion that changes outside callbacks changes what comes", "[world]") {
  EventLog<1> log;
  World<1> world({}, &log);
  for (const auto& b : two_balls()) world.add_body(b);
  world.advance_to(0.5);
  world.update_motion(1, motion<1>({3, 0, 0}, {-4, 0, 0}, zero, 0.5));
  world.advance_to(2);
  REQUIRE(log.count(Kind::contact) == 1);
  CHECK(log.events[0].time() == 0.75);
  world.audit();
}

TEST_CASE("A motion may change inside a callback", "[world]") {
  EventLog<1> log;
  log.then = [](World<1>& world, const Event& e) {
    if (e.kind != Kind::contact) return;
    const Vector3d here = world.motion(e.b).position(e.time());
    world.update_motion(e.b, motion<1>(here, {1, 0, 0}, zero, e.time()));
  };
  World<1> world({}, &log);
  for (const auto& b : two_balls()) world.add_body(b);
  world.advance_to(10);
  REQUIRE(log.events.size() == 2);
  CHECK(log.events[0].time() == 1);
  CHECK(log.events[1].kind == Kind::separation);  // just touching is no contact
  CHECK(log.events[1].time() == 1);
}

TEST_CASE("A teleport ends contacts where it leaves and begins them where it arrives", "[world]") {
  for (const auto& [kind, name, what] : broad_phases) {
    EventLog<1> log;
    World<1> world(reporting_pairs(kind), &log);
    for (const auto& b : two_balls()) world.add_body(b);
    world.add_body(ball<1>(1, {100, 0, 0}));
    world.advance_to(2);
    REQUIRE(world.touching(0, 1));
    world.update_motion(1, motion<1>({99.5, 0, 0}, {0, 0, 0}, zero, 2));
    world.advance_to(2);
    CHECK_FALSE(world.touching(0, 1));
    CHECK(world.touching(1, 2));
    REQUIRE(log.count(Kind::separation) == 1);
    REQUIRE(log.count(Kind::contact) == 2);
    REQUIRE(log.count(Kind::pair_ended) == 1);
    REQUIRE(log.count(Kind::pair_began) == 2);
    CHECK(log.of(Kind::separation).back().time() == 2);
    CHECK(log.of(Kind::contact).back().time() == 2);
    CHECK(log.of(Kind::pair_ended).back().a == 0);
    CHECK(log.of(Kind::pair_began).back().b == 2);
    world.advance_to(4);
    world.audit();
    CHECK(in_order_of_time(log.events));
  }
}

TEST_CASE("Two bodies that teleport together at one instant stay in contact", "[world]") {
  for (const auto& [kind, name, what] : broad_phases) {
    INFO(name);
    EventLog<1> log;
    World<1> world(reporting_pairs(kind), &log);
    for (auto b : two_balls()) {
      auto next = b.motion[0];
      next.coefficients[0] = b.motion[0].position(2) + Vector3d(50, 0, 0);
      next.start = 2;
      b.motion.push_back(next);
      world.add_body(b);
    }
    world.advance_to(10);
    CHECK(log.count(Kind::contact) == 1);
    REQUIRE(log.count(Kind::separation) == 1);
    CHECK(log.of(Kind::separation)[0].time() == 3);
    CHECK(log.count(Kind::pair_began) == 1);
    CHECK(log.count(Kind::pair_ended) == 1);
  }
}

TEST_CASE("A body that appears inside another overlaps, and does not stop the run", "[world]") {
  for (const auto response : {Response::none, Response::elastic}) {
    EventLog<1> log;
    World<1> world(with_response(response), &log);
    world.add_body(ball<1>(1, {0, 0, 0}));
    world.advance_to(1);
    auto late = ball<1>(1, {0.5, 0, 0}, {1, 0, 0});
    late.motion[0].start = 2;
    const BodyId id = world.add_body(late);
    CHECK(world.contains(id));
    world.advance_to(10);
    REQUIRE(log.count(Kind::overlap) == 1);
    CHECK(log.events[0].kind == Kind::overlap);
    CHECK(log.events[0].time() == 2);
    CHECK(log.count(Kind::contact) == 0);
    CHECK(log.count(Kind::separation) == (response == Response::none ? 1u : 0u));
  }
}

TEST_CASE("Removing a body ends its pairs and contacts, with reports", "[world]") {
  for (const auto& [kind, name, what] : broad_phases) {
    EventLog<1> log;
    World<1> world(reporting_pairs(kind), &log);
    for (const auto& b : two_balls()) world.add_body(b);
    world.advance_to(2);
    REQUIRE(log.count(Kind::pair_began) == 1);
    world.remove_body(0);
    world.advance_to(5);
    REQUIRE(log.count(Kind::separation) == 1);
    CHECK(log.of(Kind::separation)[0].time() == 2);
    CHECK(log.of(Kind::separation)[0].contact.point == Vector3d(1, 0, 0));
    REQUIRE(log.count(Kind::pair_ended) == 1);
    CHECK(log.of(Kind::pair_ended)[0].time() == 2);
    // The slot is given again, the id is not.
    CHECK(world.add_body(ball<1>(1, {50, 0, 0})) == body_id(1, 0));
    world.advance_to(6);
    world.audit();
  }
}

TEST_CASE("Bodies may be removed and added inside their own contact", "[world]") {
  for (const auto response : {Response::none, Response::elastic, Response::callback}) {
    for (int which = 0; which < 5; ++which) {
      INFO("response " << static_cast<int>(response) << ", case " << which);
      EventLog<1> log;
      bool done = false;
      BodyId third = 0;
      log.then = [&](World<1>& world, const Event& e) {
        if (e.kind != Kind::contact || done) return;
        done = true;
        if (which == 0 || which == 2) world.remove_body(e.a);
        if (which == 1 || which == 2) world.remove_body(e.b);
        if (which == 3) world.remove_body(third);
        if (which == 4) {  // another one comes in its place, in contact at once
          world.remove_body(e.a);
          const BodyId added = world.add_body(ball<1>(1, {1.5, 0, 0}));
          CHECK(added == body_id(1, body_slot(e.a)));
          CHECK_FALSE(world.contains(e.a));
        }
      };
      World<1> world(with_response(response), &log);
      for (const auto& b : two_balls()) world.add_body(b);
      third = world.add_body(ball<1>(1, {-6, 0, 0}, {0.5, 0, 0}));
      world.advance_to(20);
      world.audit();
      CHECK(done);
      CHECK(world.size() == (which == 2 ? 1u : which == 4 ? 3u : 2u));
      CHECK(log.count(Kind::overlap) == (which == 4 ? 1u : 0u));
      CHECK(in_order_of_time(log.events));
    }
  }
}

TEST_CASE("Filters: a pair is tested if each one's category is in the other's mask", "[world]") {
  for (const auto& [kind, name, what] : broad_phases) {
    for (int masks = 0; masks < 4; ++masks) {
      WorldOptions options;
      options.broad_phase = kind;
      options.rate = 10;
      options.report_pairs = true;
      EventLog<1> log;
      World<1> world(options, &log);
      auto balls = two_balls();
      balls[0].category = 2;
      balls[1].category = 4;
      balls[0].collides_with = (masks & 1) != 0 ? 4 : 2;
      balls[1].collides_with = (masks & 2) != 0 ? 2 : 4;
      for (const auto& b : balls) world.add_body(b);
      world.advance_to(10);
      world.audit();
      CHECK(log.events.empty() == (masks != 3));
      if (masks != 3) CHECK(world.counters().pair_tests == 0);
    }
  }
}

TEST_CASE("Fixed bodies at rest are never compared, even where they overlap", "[world]") {
  EventLog<1> log;
  World<1> world(with_response(Response::elastic), &log);
  for (int i = 0; i < 5; ++i) world.add_body(fixed_body<1>(Box{{1, 1, 1}}, motion<1>({0.5 * i, 0, 0})));
  world.advance_to(100);
  CHECK(log.count(Kind::contact) == 0);
  CHECK(log.count(Kind::overlap) == 9);  // all but the pairs 0-4 that touch; reported once
  CHECK(world.counters().broad_phase.swaps == 0);
}

TEST_CASE("The same run gives the same events", "[world]") {
  Random random(5);
  SceneMaker maker(random, {.shapes = Shapes::mixture, .bodies = 30, .side = 8, .heterogeneous = true, .end_time = 4});
  const auto scene = maker.scene<2>();
  WorldOptions options = with_response(Response::elastic);
  options.report_pairs = true;
  const auto first = run(scene, options);
  CHECK(first.size() > 50);
  CHECK(run(scene, options) == first);
  CHECK(in_order_of_time(first));
}

TEST_CASE("A body has the shape it was given, and room may be made beforehand", "[world]") {
  World<1> world(with_response(Response::none));
  world.reserve(100);
  CHECK(world.size() == 0);
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()));
  BodyDescription<1> ball;
  ball.shape = Sphere{0.75};
  ball.motion = {motion<1>({0, 0, 0})};
  BodyDescription<1> turned_ball = ball;
  turned_ball.orientation = turned;
  BodyDescription<1> box = turned_ball;
  box.shape = Box{{1, 2, 3}};
  for (const auto& description : {ball, turned_ball, box}) {
    const PlacedShape shape = world.shape(world.add_body(description));
    const PlacedShape expected = place(description.shape, description.orientation);
    CHECK(shape.shape.index() == expected.shape.index());
    CHECK(shape.rotation == expected.rotation);
    if (std::holds_alternative<Box>(shape.shape)) CHECK(shape.half_axes == expected.half_axes);
    CHECK(shape.low == expected.low);
    CHECK(shape.high == expected.high);
    CHECK(shape.bounding_radius == expected.bounding_radius);
  }
  CHECK(std::get<Sphere>(world.shape(1).shape).radius == 0.75);
  CHECK(world.size() == 3);
}

}  // namespace
}  // namespace kds::collision::test_world
