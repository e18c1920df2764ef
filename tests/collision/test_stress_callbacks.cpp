// A run cannot loop: listeners that keep changing things where a contact has just been.
#include "tests/collision/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

namespace kds::collision::test_stress_callbacks {
namespace {

using namespace tests;

WorldOptions with(Response response, BroadPhaseKind method) {
  WorldOptions options;
  options.response = response;
  options.broad_phase = method;
  options.rate = 16;
  return options;
}

void set_speed(World<1>& world, BodyId id, double speed) {
  world.update_motion(id, motion<1>(world.motion(id).position(world.now()), {speed, 0, 0}, zero, world.now()));
}

TEST_CASE("callbacks: a body sent to and fro between two that it touches passes through in the end", "[world][loop]") {
  for (const auto method : all_methods) {
    EventLog<1> log;
    log.then = [](World<1>& world, const Event& e) {
      if (e.kind == Kind::contact) set_speed(world, 1, e.b == 1 ? 1 : -1);  // back from 0 to 2 and back
    };
    World<1> world(with(Response::callback, method), &log);
    world.add_body(fixed_body<1>(Box{{1, 1, 1}}, motion<1>({0, 0, 0})));
    world.add_body(body<1>(Box{{1, 1, 1}}, motion<1>({2, 0, 0}, {1, 0, 0})));
    world.add_body(fixed_body<1>(Box{{1, 1, 1}}, motion<1>({4, 0, 0})));
    world.advance_to(10);
    CHECK(world.now() == 10);
    // Ten times the policy's patience of 100 contacts at this one instant.
    CHECK(log.count(Kind::rebound_suppressed) >= 1);
    CHECK(log.count(Kind::contact) >= 1000);
    CHECK(log.count(Kind::contact) < 3000);
  }
}

TEST_CASE("callbacks: fixed bodies moved into each other again and again at one instant", "[world][loop]") {
  for (const auto method : all_methods) {
    EventLog<1> log;
    // At each contact: away and, at the same instant, towards each other once more.
    log.then = [](World<1>& world, const Event& e) {
      if (e.kind != Kind::contact) return;
      set_speed(world, 0, -1);
      set_speed(world, 0, 1);
    };
    World<1> world(with(Response::callback, method), &log);
    world.add_body(fixed_body<1>(Sphere{1}, motion<1>({0, 0, 0}, {1, 0, 0})));
    world.add_body(fixed_body<1>(Sphere{1}, motion<1>({4, 0, 0})));
    world.advance_to(10);
    CHECK(log.count(Kind::contact) == 1);  // left approaching: passes through
  }
}

TEST_CASE("callbacks: a listener that undoes each elastic response lets the pair pass", "[world][loop]") {
  for (const auto method : all_methods) {
    EventLog<1> log;
    log.then = [](World<1>& world, const Event& e) {
      if (e.kind != Kind::contact) return;
      set_speed(world, 0, 1);
      set_speed(world, 1, -1);
    };
    World<1> world(with(Response::elastic, method), &log);
    world.add_body(ball<1>(1, {0, 0, 0}, {1, 0, 0}));
    world.add_body(ball<1>(1, {8, 0, 0}, {-1, 0, 0}));
    world.advance_to(10);
    CHECK(log.count(Kind::contact) == 1);
    CHECK(world.motion(0).position(10) == Vector3d(10, 0, 0));
  }
}

TEST_CASE("callbacks: a listener that turns other bodies round at each contact", "[world][loop]") {
  // Three in touch: at each contact of two the third is sent against them, for ever if it were let.
  for (const auto method : all_methods) {
    for (const auto response : {Response::elastic, Response::callback}) {
      EventLog<1> log;
      log.then = [](World<1>& world, const Event& e) {
        if (e.kind != Kind::contact) return;
        const BodyId third = 3 - e.a - e.b;
        set_speed(world, 1, third == 0 ? 1 : -1);
        set_speed(world, 0, 2);
        set_speed(world, 2, -2);
      };
      World<1> world(with(response, method), &log);
      world.add_body(ball<1>(1, {0, 0, 0}, {2, 0, 0}));
      world.add_body(ball<1>(1, {2, 0, 0}));
      world.add_body(ball<1>(1, {4, 0, 0}, {-2, 0, 0}));
      world.advance_to(10);
      CHECK(log.count(Kind::contact) < 10000);
      world.audit();
    }
  }
}

/// Runs and expects the guard to stop it.
template <int Degree>
std::string stopped(World<Degree>& world, double end) {
  try {
    world.advance_to(end);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return {};
}

TEST_CASE("callbacks: teleports to and fro without end are stopped, with a reason", "[world][loop]") {
  for (const auto method : all_methods) {
    WorldOptions options = with(Response::none, method);
    options.most_edits = 2000;
    EventLog<1> log;
    log.then = [](World<1>& world, const Event& e) {
      const bool together = e.kind == Kind::contact;
      world.update_motion(1, motion<1>({together ? 50.0 : 1.0, 0, 0}, zero, zero, world.now()));
    };
    World<1> world(options, &log);
    world.add_body(ball<1>(1, {0, 0, 0}));
    world.add_body(ball<1>(1, {8, 0, 0}, {-1, 0, 0}));
    CHECK(stopped(world, 10).find("most_edits") != std::string::npos);
    CHECK(world.now() == Approx(6));
    // The world can still be used.
    log.then = nullptr;
    world.advance_to(20);
    CHECK(world.now() == 20);
    world.audit();
  }
}

TEST_CASE("callbacks: turning round at each contact and separation, tick by tick, is stopped", "[world][loop]") {
  for (const auto method : all_methods) {
    WorldOptions options = with(Response::none, method);
    options.most_edits = 2000;
    EventLog<1> log;
    log.then = [](World<1>& world, const Event& e) { set_speed(world, 1, e.kind == Kind::contact ? 1 : -1); };
    World<1> world(options, &log);
    world.add_body(ball<1>(1, {0, 0, 0}));
    world.add_body(ball<1>(1, {8, 0, 0}, {-1, 0, 0}));
    CHECK(stopped(world, 10).find("within") != std::string::npos);
    CHECK(world.now() < 6.0001);
  }
}

TEST_CASE("callbacks: bodies that beget bodies without end are stopped", "[world][loop]") {
  for (const auto method : all_methods) {
    WorldOptions options = with(Response::none, method);
    options.most_edits = 100;
    EventLog<1> log;
    log.then = [](World<1>& world, const Event& e) {
      if (e.kind != Kind::overlap) return;
      world.remove_body(e.b);
      world.add_body(ball<1>(1, {0.5, 0, 0}));
    };
    World<1> world(options, &log);
    world.add_body(ball<1>(1, {0, 0, 0}));
    world.add_body(ball<1>(1, {1, 0, 0}));
    CHECK(stopped(world, 10).find("most_edits") != std::string::npos);
  }
}

TEST_CASE("callbacks: bodies that beget bodies, of which none goes, are stopped", "[world][loop]") {
  for (const auto method : all_methods) {
    WorldOptions options = with(Response::none, method);
    options.most_edits = 200;
    EventLog<1> log;
    log.then = [](World<1>& world, const Event& e) {
      if (e.kind == Kind::overlap) world.add_body(ball<1>(0.75, world.motion(e.b).position(0) + Vector3d(1, 0, 0)));
    };
    World<1> world(options, &log);
    world.add_body(ball<1>(0.75, {0, 0, 0}));
    world.add_body(ball<1>(0.75, {1, 0, 0}));
    CHECK(stopped(world, 10).find("most_edits") != std::string::npos);
    CHECK(world.size() == 202);  // 200 is more than 64 for each of the two that there were
  }
}

TEST_CASE("callbacks: many changes spread over time, or made outside callbacks, are welcome", "[world][loop]") {
  for (const auto method : all_methods) {
    WorldOptions options = with(Response::callback, method);
    options.most_edits = 300;
    EventLog<1> log;
    log.then = [](World<1>& world, const Event& e) {
      if (e.kind == Kind::contact) set_speed(world, 1, e.a == 0 ? 4 : -4);
    };
    World<1> world(options, &log);
    world.add_body(fixed_body<1>(Sphere{1}, motion<1>({0, 0, 0})));
    world.add_body(ball<1>(1, {4, 0, 0}, {4, 0, 0}));
    world.add_body(fixed_body<1>(Sphere{1}, motion<1>({8, 0, 0})));
    for (int i = 0; i < 1000; ++i) world.update_motion(1, motion<1>({4, 0, 0}, {4, 0, 0}));
    world.advance_to(500);
    CHECK(log.count(Kind::contact) == 500);
    CHECK(log.count(Kind::rebound_suppressed) == 0);
  }
}

TEST_CASE("callbacks: a listener may lift what rests, and take away what it rests on", "[world][loop]") {
  for (const auto method : all_methods) {
    EventLog<2> log;
    int suppressed = 0;
    log.then = [&](World<2>& world, const Event& e) {
      if (e.kind != Kind::rebound_suppressed) return;
      ++suppressed;
      if (suppressed == 1) {  // up again
        auto up = world.free_motion(1).restarted(world.now());
        up.coefficients[1][2] += 10;
        world.update_motion(1, up);
      } else {
        world.remove_body(0);
      }
    };
    World<2> world(with(Response::elastic, method), &log);
    world.add_body(fixed_body<2>(Box{{10, 10, 1}}, motion<2>({0, 0, -1})));
    auto thrown = ball<2>(1, {0, 0, 2}, zero, {0, 0, -5});
    thrown.restitution = 0;
    world.add_body(thrown);
    world.advance_to(10);
    CHECK(suppressed == 2);
    // Falls 1, is thrown up for 2 s, lands, and falls for good.
    const double start = std::sqrt(0.2) + 2;
    CHECK(world.motion(1).position(10)[2] == Approx(1 - 5 * (10 - start) * (10 - start)));
  }
}

}  // namespace
}  // namespace kds::collision::test_stress_callbacks
