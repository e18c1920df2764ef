// Bodies in resting contact: they lie on each other, slide, are lifted, knocked and let go.
#include "tests/collision/world/resting_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

namespace kds::collision::test_resting {
namespace {

using namespace tests;

TEST_CASE("Resting: a box slides off the edge and falls, from the instant at which it has left it", "[zeno]") {
  const auto scene = [&](World<2>& world) {
    world.add_body(floor_box(4));
    world.add_body(bouncy(box<2>({0.5, 0.5, 0.5}, {0, 0, 0.5}, {2, 0, 0}, weight), 0));
    world.advance_to(10);
  };
  with_all_methods(elastic(), scene, [&](World<2>& world, EventLog<2>& log) {
    CHECK(log.count(Kind::rebound_suppressed) == 1);
    CHECK_FALSE(world.resting(0, 1));
    CHECK(world.motion(1).start == Approx(2.25));
    const double fallen = 5 * 7.75 * 7.75;
    CHECK(world.motion(1).position(10)[2] == Approx(0.5 - fallen));
  });
}

TEST_CASE("Resting: the support goes away, comes back, lifts, the body falls, lands, is lifted", "[zeno]") {
  const auto scene = [&](World<2>& world) {
    world.add_body(floor_box());
    world.add_body(bouncy(ball<2>(1, {0, 0, 1}, zero, weight), 0.5));
    world.advance_to(1);
    CHECK(world.resting(0, 1));
    // Faster down than the ball follows, for 0.5 s.
    world.update_motion(0, motion<2>({0, 0, -1}, {0, 0, -8}, zero, 1));
    world.advance_to(1.5);
    CHECK_FALSE(world.resting(0, 1));
    CHECK(world.motion(1).position(1.5)[2] == Approx(1 - 1.25));
    world.update_motion(0, motion<2>({0, 0, -5}, zero, zero, 1.5));
    world.advance_to(10);
    CHECK(world.resting(0, 1));
    CHECK(world.motion(1).position(10)[2] == Approx(-3));
    // Up: it is thrown, comes back, and rides.
    world.update_motion(0, motion<2>({0, 0, -5}, {0, 0, 0.5}, zero, 10));
    world.advance_to(11);
    CHECK(world.resting(0, 1));
    CHECK(world.motion(1).velocity(11) == Vector3d(0, 0, 0.5));
    CHECK(world.motion(1).position(11)[2] == Approx(-2.5));
    // The floor is taken away.
    world.remove_body(0);
    world.advance_to(12);
    CHECK(world.motion(1).position(12)[2] == Approx(-2.5 + 0.5 - 5));
  };
  with_all_methods(elastic(), scene, [](World<2>&, EventLog<2>&) {});
}

TEST_CASE("Resting: a floor that sinks with less than gravity carries on, with more it lets go", "[zeno]") {
  for (const double half : {4.0, 6.0}) {
    const auto scene = [&](World<2>& world) {
      world.add_body(floor_box());
      world.add_body(bouncy(ball<2>(1, {0, 0, 1}, zero, weight), 0.5));
      world.advance_to(1);
      world.update_motion(0, motion<2>({0, 0, -1}, zero, {0, 0, -half}, 1));
      world.advance_to(2);
    };
    with_all_methods(elastic(), scene, [&](World<2>& world, EventLog<2>&) {
      CHECK(world.resting(0, 1) == (half < 5));
      CHECK(world.motion(1).position(2)[2] == Approx(1 - std::min(half, 5.0)));
    });
  }
}

TEST_CASE("Resting: what lies on the floor may be knocked up, along and down", "[zeno]") {
  const auto scene = [&](World<2>& world) {
    world.add_body(fixed_body<2>(Box{{0.5, 0.5, 1}}, motion<2>({0, 0, -1})));  // a pillar
    world.add_body(bouncy(ball<2>(1, {0, 0, 1}, zero, weight), 0.5));
    world.add_body(ball<2>(0.25, {-4, 0, -2}, {3.25, 0, 2.5}));  // from below, past the pillar
    world.advance_to(10);
  };
  with_all_methods(elastic(), scene, [](World<2>& world, EventLog<2>& log) {
    const auto contacts = log.of(Kind::contact);
    REQUIRE(contacts.size() >= 2);
    const auto hit = std::find_if(contacts.begin(), contacts.end(), [](const Event& e) { return e.a == 1; });
    REQUIRE(hit != contacts.end());
    CHECK(hit->contact.normal[2] < 0);  // from the large ball down to the small one
    CHECK(world.motion(1).coefficients[2] == weight);
    CHECK_FALSE(world.resting(0, 1));
  });
}

TEST_CASE("Resting: what falls on a body at rest does not press it through the floor", "[zeno]") {
  for (const double mass : {0.01, 1.0, 100.0}) {
    const auto scene = [&](World<2>& world) {
      world.add_body(floor_box());
      world.add_body(bouncy(box<2>({1, 1, 1}, {0, 0, 1}, zero, weight), 0.5));
      world.add_body(bouncy(box<2>({1, 1, 1}, {0.5, 0.5, 8}, zero, weight), 0.5, mass));
      double lowest = 1;
      while (world.step(30)) lowest = std::min(lowest, world.motion(1).position(world.now())[2]);
      CHECK(lowest > 1 - 1e-9);
    };
    with_all_methods(elastic(), scene, [&](World<2>& world, EventLog<2>& log) {
      INFO("mass " << mass);
      CHECK(log.count(Kind::rebound_suppressed) >= 3);
      CHECK(at_rest(world, 1));
      CHECK(at_rest(world, 2));
      CHECK(std::abs(world.motion(1).position(30)[2] - 1) < 1e-9);
      CHECK(std::abs(world.motion(2).position(30)[2] - 3) < 1e-9);
    });
  }
}

TEST_CASE("Resting: an elastic blow goes through a body at rest on the floor and comes back", "[zeno]") {
  const auto scene = [&](World<2>& world) {
    world.add_body(floor_box());
    world.add_body(ball<2>(1, {0, 0, 1}, zero, weight));
    world.advance_to(1);
    auto blow = ball<2>(1, {0, 0, 8}, {0, 0, -7});  // weightless
    blow.motion[0].start = 1;
    world.add_body(blow);
    world.advance_to(1.25);
    CHECK(world.resting(0, 1));
    world.advance_to(1.75);
  };
  with_all_methods(elastic(), scene, [](World<2>& world, EventLog<2>&) {
    // Down at 7, through the ball, back from the floor, and up again.
    CHECK(world.motion(2).velocity(1.75)[2] == Approx(7));
    CHECK(world.motion(2).position(1.75)[2] == Approx(3 + 7 * (0.75 - 5 / 7.0)));
  });
}

TEST_CASE("Resting: two balls, one upon the other, and a pile of three boxes", "[zeno]") {
  for (const double e : {0.0, 0.3, 0.8}) {
    for (const bool balls : {true, false}) {
      const auto scene = [&](World<2>& world) {
        world.add_body(floor_box());
        const std::vector<double> masses = balls ? std::vector<double>{1, 2} : std::vector<double>{1, 4, 0.3};
        for (std::size_t i = 0; i < masses.size(); ++i) {
          const Vector3d at(balls ? 0 : 0.25 * static_cast<double>(i), 0, 3 + 3 * static_cast<double>(i));
          world.add_body(balls ? bouncy(ball<2>(1, at, zero, weight), e, masses[i])
                               : bouncy(box<2>({1, 1, 1}, at, zero, weight), e, masses[i]));
        }
        world.advance_to(40);
        const auto events = world.counters().contacts;
        world.advance_to(1000);
        CHECK(world.counters().contacts == events);
      };
      with_all_methods(elastic(), scene, [&](World<2>& world, EventLog<2>& log) {
        INFO("restitution " << e << (balls ? ", balls" : ", boxes"));
        CHECK(log.count(Kind::rebound_suppressed) >= world.size() - 1);
        CHECK(log.count(Kind::contact) < 20000);
        for (BodyId id = 1; id < world.size(); ++id) {
          CHECK(world.resting(id - 1, id));
          CHECK(at_rest(world, id));
          CHECK(std::abs(world.motion(id).position(1000)[2] - (2.0 * id - 1)) < 1e-9);
        }
      });
    }
  }
}

TEST_CASE("Resting: the lowest of a pile is taken away and the rest lands on the floor", "[zeno]") {
  const auto scene = [&](World<2>& world) {
    world.add_body(floor_box());
    for (int i = 0; i < 4; ++i) world.add_body(bouncy(box<2>({1, 1, 1}, {0, 0, 1 + 2.0 * i}, zero, weight), 0.25));
    world.advance_to(1);
    for (BodyId id = 1; id <= 4; ++id) CHECK(world.resting(id - 1, id));
    world.remove_body(1);
    world.advance_to(1.5);
    CHECK(world.motion(4).position(1.5)[2] == Approx(7 - 5 * 0.25));  // all fall as one
    world.advance_to(30);
  };
  with_all_methods(elastic(), scene, [](World<2>& world, EventLog<2>&) {
    for (BodyId id = 2; id <= 4; ++id) {
      CHECK(at_rest(world, id));
      CHECK(std::abs(world.motion(id).position(30)[2] - (2.0 * id - 3)) < 1e-9);
    }
  });
}

TEST_CASE("Resting: a ball slides over a ball and off it", "[zeno]") {
  const auto scene = [&](World<2>& world) {
    world.add_body(fixed_body<2>(Sphere{2}, motion<2>(zero)));
    world.add_body(bouncy(ball<2>(1, {0.125, 0, 3.25}, zero, weight), 0.25));
    double least = 3;
    double leaves_at = 1;  // the height at which they last rest on each other, over the distance of their centres
    while (world.step(3)) {
      const Vector3d place = world.motion(1).position(world.now());
      least = std::min(least, place.norm());
      if (world.resting(0, 1)) leaves_at = place[2] / 3;
    }
    CHECK(least > 3 - 1e-9);
    // Without friction it leaves where cos(angle) = 2/3; energy tells its speed (the first bounces have cost some).
    CHECK(leaves_at == Approx(2.0 / 3).margin(0.02));
  };
  with_all_methods(elastic(), scene, [](World<2>& world, EventLog<2>& log) {
    CHECK(world.motion(1).coefficients[2] == weight);
    CHECK(log.count(Kind::contact) < 20000);
  });
}

TEST_CASE("Resting: meshes rest on meshes and slide into what stands in the way", "[zeno]") {
  // A step: two cubes side by side, the right one higher; as one mesh.
  const auto step = [] {
    std::vector<Vector3d> vertices;
    std::vector<Mesh::Triangle> triangles;
    const auto& one = *cube();
    for (const Vector3d& at : {Vector3d(-1, 0, -1), Vector3d(1, 0, 0)}) {
      const auto first = static_cast<std::uint32_t>(vertices.size());
      for (const auto& v : one.vertices()) vertices.push_back(v + at);
      for (const auto& t : one.triangles()) triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
    return std::make_shared<const Mesh>(vertices, triangles);
  }();
  for (const Shape& slider : {Shape(Sphere{0.25}), Shape(Box{{0.25, 0.25, 0.25}})}) {
    const auto scene = [&](World<2>& world) {
      world.add_body(fixed_body<2>(MeshShape{step, 1}, motion<2>(zero)));
      world.add_body(bouncy(body<2>(slider, motion<2>({-1, 0, 0.5}, {0.5, 0, 0}, weight)), 0.5));
      world.advance_to(3);
    };
    with_all_methods(elastic(), scene, [&](World<2>& world, EventLog<2>& log) {
      REQUIRE(log.count(Kind::rebound_suppressed) >= 1);
      // At x = 0 it meets the face of the higher cube and goes back at half the speed, still on the lower one.
      const auto contacts = log.of(Kind::contact);
      const auto hit = std::find_if(contacts.begin(), contacts.end(),
                                    [](const Event& e) { return std::abs(e.contact.normal[0]) > 0.99; });
      REQUIRE(hit != contacts.end());
      CHECK(hit->time() == Approx(1.5).margin(1e-6));
      CHECK(world.motion(1).velocity(3)[0] == Approx(-0.25));
      CHECK(world.motion(1).position(3)[2] == Approx(0.25).margin(1e-5));
    });
  }
}

TEST_CASE("What is left along a normal is a rounding of the speeds there were, not of those that are left",
          "[resting]") {
  // Ball 2 comes to rest against ball 0, which is left with next to no speed.
  EventLog<2> log;
  World<2> world(with_response(Response::elastic), &log);
  auto a = body<2>(Sphere{0.75}, motion<2>({0.5, 0.5, 1}, {-2.5, 0, 0}), 4);
  auto b = fixed_body<2>(Sphere{0.25}, motion<2>({-1, 0.5, 1}));
  auto c = body<2>(Sphere{1.25}, motion<2>({-1.5, 0.5, 1}, {3, 1, -0.5}, {0.5, 1, -1}));
  a.restitution = 0;
  b.restitution = c.restitution = 1e-9;
  for (const auto& each : {a, b, c}) world.add_body(each);
  int steps = 0;
  while (world.step(9)) {
    REQUIRE_NOTHROW(world.audit());
    ++steps;
  }
  CHECK(steps > 20);
  CHECK(world.counters().rebounds_suppressed > 0);
}

}  // namespace
}  // namespace kds::collision::test_resting
