// Pairs that are let pass until they have separated: a state of the two bodies, whatever the broad phase.
#include "collision/narrow_phase/narrow_phase.hpp"
#include "tests/collision/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <functional>
#include <vector>

namespace kds::collision::test_let_pass {
namespace {

using namespace tests;

template <int Degree>
using Scene = std::function<void(World<Degree>&, EventLog<Degree>&)>;

/// The log of a scene, which has to be the same with every broad phase.
template <int Degree>
std::vector<Event> one_log(const WorldOptions& common, const Scene<Degree>& scene) {
  std::vector<Event> first;
  for (const BroadPhaseKind method : all_methods) {
    WorldOptions options = common;
    options.broad_phase = method;
    options.rate = method == BroadPhaseKind::sap ? 8 : 0;
    EventLog<Degree> log;
    World<Degree> world(options, &log);
    scene(world, log);
    INFO("broad phase " << world.broad_phase());
    world.audit();
    if (method == all_methods.front()) first = log.events;
    CHECK(log.events == first);
  }
  return first;
}

std::vector<Kind> kinds(const std::vector<Event>& events) {
  std::vector<Kind> result;
  for (const Event& e : events) result.push_back(e.kind);
  return result;
}

TEST_CASE("A body that began in overlap and has left is met like any other", "[world][let-pass]") {
  // It leaves the floor at 0.25 and comes back to floor and wall at one instant, the wall being first in the order.
  const auto events = one_log<2>(with_response(Response::elastic), [](World<2>& world, EventLog<2>&) {
    world.add_body(fixed_body<2>(Box{{1, 20, 10}}, motion<2>({6.25, 0, 10})));
    world.add_body(fixed_body<2>(Box{{20, 20, 1}}, motion<2>({0, 0, -1})));
    world.add_body(body<2>(Box{{1, 1, 1}}, motion<2>({0, 0, -0.0625}, {1, 0, 4.5}, {0, 0, -1})));
    world.advance_to(8);
    CHECK(world.motion(2).position(8)[2] > 1);
  });
  // The wall and the floor themselves overlap.
  REQUIRE(kinds(events) == std::vector{Kind::overlap, Kind::contact, Kind::contact});
  CHECK((events[0].a == 1 && events[0].b == 2));
  CHECK((events[1].a == 0 && events[1].b == 2 && events[1].time() == 4.25));
  CHECK((events[2].a == 1 && events[2].b == 2 && events[2].time() == 4.25));
}

TEST_CASE("The next body of an id is not let pass for what the one before did", "[world][let-pass]") {
  for (const Response response : {Response::elastic, Response::callback}) {
    one_log<1>(with_response(response), [](World<1>& world, EventLog<1>& log) {
      world.add_body(fixed_body<1>(Box{{5, 5, 1}}, motion<1>({0, 0, -1})));
      world.add_body(body<1>(Box{{1, 1, 1}}, motion<1>({0, 0, 0.5})));
      world.advance_to(0.5);
      CHECK(log.count(Kind::overlap) == 1);
      world.remove_body(1);
      world.advance_to(1);
      // Put down touching, moving up; then turned.
      const BodyId id = world.add_body(body<1>(Box{{1, 1, 1}}, motion<1>({0, 0, 1}, {0, 0, 1}, zero, 1)));
      CHECK(id == body_id(1, 1));
      world.advance_to(1);
      world.update_motion(id, motion<1>({0, 0, 1}, {0, 0, -1}, zero, 1));
      world.advance_to(3);
      CHECK(log.count(Kind::contact) == 1);
    });
  }
}

TEST_CASE("What touches and moves apart is in contact once it is turned, in the instant too", "[world][let-pass]") {
  for (const Response response : {Response::none, Response::elastic, Response::callback}) {
    const auto events = one_log<2>(with_response(response), [](World<2>& world, EventLog<2>&) {
      world.add_body(fixed_body<2>(Box{{1.25, 1.25, 1.25}}, motion<2>({0, -1.5, 1.5}, {-1.5, 0, 0})));
      world.add_body(body<2>(Box{{0.5, 0.25, 1}}, motion<2>({-0.5, 0, -0.5}, {2, 1.5, 1.5}, {0, 0.5, -1}), 2));
      world.advance_to(0);
      auto turned = world.motion(1);
      turned.coefficients[1] = -turned.coefficients[1];
      world.update_motion(1, turned);
      world.advance_to(3);
    });
    REQUIRE_FALSE(events.empty());
    CHECK((events[0].kind == Kind::contact && events[0].time() == 0));
  }
}

TEST_CASE("A jump by a piece of a script is a jump like any other", "[world][let-pass]") {
  const auto overlaps = [](bool by_script, double speed) {
    const auto there = motion<1>({1.5, 0, 0}, {speed, 0, 0}, zero, 100);
    return one_log<1>(with_response(Response::elastic), [=](World<1>& world, EventLog<1>&) {
      world.add_body(ball<1>(1, zero));
      auto jumping = ball<1>(1, {9, 0, 0}, {4, 0, 0});
      if (by_script) jumping.motion.push_back(there);
      world.add_body(jumping);
      world.advance_to(100);
      if (!by_script) world.update_motion(1, there);
      world.advance_to(200);
      CHECK(world.motion(1).velocity(200)[0] == speed);
    });
  };
  for (const double speed : {-1.0, 0.0, 1.0}) {
    const auto events = overlaps(true, speed);
    CHECK(kinds(events) == std::vector{Kind::overlap});
    CHECK(events == overlaps(false, speed));
  }
}

TEST_CASE("A body that jumps into overlap, leaves and jumps back overlaps twice", "[world][let-pass]") {
  const auto events = one_log<1>(with_response(Response::elastic), [](World<1>& world, EventLog<1>&) {
    world.add_body(ball<1>(1, zero));
    auto jumping = ball<1>(1, {1.5, 0, 0}, {4, 0, 0});
    jumping.motion.push_back(motion<1>({1.5, 0, 0}, {-1, 0, 0}, zero, 100));
    world.add_body(jumping);
    world.advance_to(99);
    world.advance_to(200);
    CHECK(world.motion(1).position(200)[0] == -98.5);
  });
  CHECK(kinds(events) == std::vector{Kind::overlap, Kind::overlap});
}

TEST_CASE("A callback may move a body away and back", "[world][let-pass]") {
  for (const double speed : {1.0, 3.0, 1.1}) {
    for (const bool turned : {false, true}) {
      for (const bool before_too : {false, true}) {
        const auto events = one_log<1>(with_response(Response::elastic), [=](World<1>& world, EventLog<1>& log) {
          const auto away_and_back = [](World<1>& w) {
            const auto path = w.motion(0);
            w.update_motion(0, motion<1>({50, 50, 50}, zero, zero, w.now()));
            w.update_motion(0, path);
          };
          log.then = [=](World<1>& w, const Event& e) {
            if (e.kind != Kind::contact) return;
            if (before_too) away_and_back(w);
            auto path = w.motion(0).restarted(w.now());
            path.coefficients[1] = -path.coefficients[1];
            w.update_motion(0, path);
            away_and_back(w);
          };
          auto b = body<1>(Box{{1, 1, 1}}, motion<1>({5, 0.3, 0.2}, {-0.5, 0, 0}), 2);
          if (turned) b.orientation = Eigen::Quaterniond(-0.496, 0.556, 0.646, 0.169).normalized();
          world.add_body(body<1>(Box{{1, 1, 1}}, motion<1>(zero, {speed, 0.1, 0})));
          world.add_body(b);
          world.advance_to(3);
        });
        // It is left approaching, and so passes through.
        CHECK(kinds(events) == std::vector{Kind::contact});
      }
    }
  }
}

TEST_CASE("What is told of an instant names each body by an id of its own", "[world][let-pass]") {
  const auto events = one_log<1>({}, [](World<1>& world, EventLog<1>& log) {
    log.then = [](World<1>& w, const Event& e) {
      if (e.kind == Kind::contact) {
        w.remove_body(e.b);
        CHECK(w.add_body(body<1>(Sphere{0.1}, motion<1>({500, 0, 0}, zero, zero, w.now()))) == body_id(1, 1));
      } else {
        CHECK_FALSE(w.contains(e.b));
      }
    };
    world.add_body(ball<1>(1, zero));
    world.add_body(ball<1>(0.1, {10, 0, 0}, {-5, 0, 0}));
    world.advance_to(10);
    CHECK(world.add_body(body<1>(Sphere{0.1}, motion<1>({700, 0, 0}, zero, zero, 10))) == body_id(1, 2));
  });
  REQUIRE(kinds(events) == std::vector{Kind::contact, Kind::separation});
  CHECK(events[1].b == 1);
}

TEST_CASE("A body that is removed as its contact ends separates once", "[world][let-pass]") {
  const auto events = one_log<1>({}, [](World<1>& world, EventLog<1>& log) {
    log.then = [](World<1>& w, const Event& e) {
      if (e.kind == Kind::separation && w.contains(1)) w.remove_body(1);
    };
    world.add_body(ball<1>(1, zero));
    auto jumping = ball<1>(1, {1.5, 0, 0});
    jumping.motion.push_back(motion<1>({50, 0, 0}, zero, zero, 1));
    world.add_body(jumping);
    world.advance_to(2);
  });
  CHECK(kinds(events) == std::vector{Kind::overlap, Kind::separation});
}

TEST_CASE("A search for the next event without a limit leaves the clock at the last one", "[world][let-pass]") {
  for (const BroadPhaseKind method : all_methods) {
    if (method == BroadPhaseKind::sap) continue;  // needs a limit
    for (const double window : {never, 0.5}) {
      WorldOptions options;
      options.broad_phase = method;
      options.window = window;
      EventLog<1> log;
      World<1> world(options, &log);
      world.add_body(ball<1>(1, zero));
      world.add_body(ball<1>(1, {5, 0, 0}, {-1, 0, 0}));
      while (world.step()) {
      }
      CHECK(world.now() == 7);
      CHECK_FALSE(world.step());
      CHECK(world.now() == 7);
      world.audit();
      world.advance_to(10);
      world.update_motion(1, motion<1>({-5, 0, 0}, {1, 0, 0}, zero, 10));
      while (world.step()) {
      }
      CHECK(world.now() == 17);
      CHECK(log.count(Kind::contact) == 2);
    }
  }
}

TEST_CASE("Resting meshes meet what they meet, however far events are predicted", "[world][let-pass]") {
  for (const double start : {0.0, 1000.0}) {
    std::vector<Event> first;
    for (const double window : {never, 1e-3, 0.05, 1.0}) {
      WorldOptions options = with_response(Response::elastic);
      options.start_time = start;
      options.window = window;
      const auto events = one_log<1>(options, [=](World<1>& world, EventLog<1>&) {
        auto a = body<1>(MeshShape{tetrahedron(), 0.5}, motion<1>({-1.5, 0.5, 1}, zero, zero, start));
        auto b = body<1>(MeshShape{tetrahedron(), 1}, motion<1>({-0.5, 0.5, 2.5}, {2, -2.5, -3}, zero, start), 0.5);
        a.restitution = b.restitution = 0;
        world.add_body(a), world.add_body(b);
        world.advance_to(start + 1);
      });
      if (window == never) first = events;
      CHECK(events == first);
    }
  }
}

}  // namespace
}  // namespace kds::collision::test_let_pass
