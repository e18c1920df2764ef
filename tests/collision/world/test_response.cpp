// Response of the world: nothing, elastic, walls.
#include "tests/collision/random_scenes.hpp"

#include <catch2/catch.hpp>

namespace kds::collision::test_response {
namespace {

using namespace tests;

TEST_CASE("A listener that does nothing about a contact lets the bodies pass", "[world]") {
  EventLog<1> log;
  World<1> world(with_response(Response::callback), &log);
  for (const auto& b : two_balls()) world.add_body(b);
  world.advance_to(10);
  CHECK(log.events.size() == 1);
  CHECK(log.count(Kind::contact) == 1);
  CHECK(world.motion(1).position(10) == Vector3d(-16, 0, 0));
}

TEST_CASE("Elastic contacts of two bodies exchange momentum by the book", "[world]") {
  const auto velocities = [](BodyDescription<1> a, BodyDescription<1> b) {
    World<1> world(with_response(Response::elastic));
    world.add_body(a);
    world.add_body(b);
    world.advance_to(1.5);
    CHECK(world.counters().contacts == 1);
    return std::pair(world.motion(0).velocity(1.5)[0], world.motion(1).velocity(1.5)[0]);
  };
  auto balls = two_balls();
  CHECK(velocities(balls[0], balls[1]) == std::pair(-2.0, 0.0));
  balls[0].mass = 3;
  CHECK(velocities(balls[0], balls[1]) == std::pair(-1.0, 1.0));
  balls[0].fixed = true;
  CHECK(velocities(balls[0], balls[1]) == std::pair(0.0, 2.0));
  balls[1].mass = 1000;
  CHECK(velocities(balls[0], balls[1]) == std::pair(0.0, 2.0));
}

TEMPLATE_TEST_CASE_SIG("Momentum and energy last through thousands of elastic contacts", "[world]",
                       ((int Degree), Degree), 1, 2) {
  Random random(11);
  EventLog<Degree> log;
  World<Degree> world(with_response(Response::elastic), &log);
  const Vector3d gravity = Degree == 2 ? Vector3d(0, 0, -0.5) : Vector3d(0, 0, 0);
  double mass = 0;
  const auto state = [&](double t) {
    Vector3d momentum = Vector3d::Zero();
    double energy = 0;
    for (BodyId id = 0; id < world.size(); ++id) {
      const Vector3d v = world.motion(id).velocity(t);
      momentum += world.mass(id) * v;
      energy += world.mass(id) * (v.squaredNorm() / 2 - 2 * gravity.dot(world.motion(id).position(t)));
    }
    return std::pair(momentum, energy);
  };
  // Far apart and thrown at the middle, all in free fall: so they meet often, and nothing but they changes momentum.
  for (int i = 0; i < 6 * 6 * 6; ++i) {
    const Vector3d place(i % 6 - 2.5, i / 6 % 6 - 2.5, i / 36 - 2.5);
    const Vector3d v(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
    auto description = ball<Degree>(0.45, 1.2 * place, 5 * v - 4 * place, gravity);
    description.mass = random.one_in(2) ? 1 : random.between(0.2, 5);
    mass += description.mass;
    world.add_body(description);
  }
  const auto [momentum, energy] = state(0);
  world.advance_to(3);
  const auto [momentum_after, energy_after] = state(3);
  CHECK(log.count(Kind::contact) > 1000);
  CHECK(log.count(Kind::rebound_suppressed) == 0);
  // Each contact rounds a few times; the bound leaves 10^3 roundings of the sum.
  CHECK((momentum_after - (momentum + 2 * 3 * mass * gravity)).norm() < 1e-12 * mass * 20);
  CHECK(energy_after == Approx(energy).epsilon(1e-11));
  CHECK(in_order_of_time(log.events));
  world.audit();
}

TEST_CASE("Walls turn bodies back at their bounding sphere", "[world]") {
  WorldOptions options;
  options.walls = Walls{{0, 0, 0}, {10, 10, 10}};
  for (const auto response : {Response::none, Response::elastic}) {
    options.response = response;
    EventLog<1> log;
    World<1> world(options, &log);
    world.add_body(ball<1>(1, {5, 5, 5}, {2, 1, 0}));
    world.advance_to(10);
    const auto hits = log.of(Kind::wall);
    REQUIRE(hits.size() == 4);
    CHECK(hits[0].time() == 2);
    CHECK(hits[0].b == 1);
    CHECK(hits[0].contact.normal == Vector3d(1, 0, 0));
    CHECK(hits[0].contact.point == Vector3d(10, 7, 5));
    CHECK(hits[1].time() == 4);
    CHECK(hits[1].b == 3);
    CHECK(hits[2].time() == 6);
    CHECK(hits[2].b == 0);
    CHECK(hits[2].contact.normal == Vector3d(-1, 0, 0));
    CHECK(hits[3].time() == 10);
    CHECK(world.counters().wall_contacts == 4);
  }
}

TEST_CASE("A ball thrown up falls back to the floor again and again", "[world]") {
  WorldOptions options;
  options.walls = Walls{{0, 0, 0}, {10, 10, 100}};
  EventLog<2> log;
  World<2> world(options, &log);
  world.add_body(ball<2>(1, {5, 5, 5}, {0, 0, 0}, {0, 0, -1}));  // 4 m above the floor: falls for 2 s
  world.advance_to(41);
  CHECK(log.count(Kind::wall) == 10);
  for (std::size_t i = 0; i < log.events.size(); ++i) CHECK(log.events[i].time() == 2.0 + 4.0 * static_cast<double>(i));
}

}  // namespace
}  // namespace kds::collision::test_response
