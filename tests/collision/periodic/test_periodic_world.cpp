// What a periodic world keeps: momentum and energy, bits over broad phases, straight paths, the world's own impulses.
#include "collision/periodic/periodic_world.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/periodic/periodic_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace test_periodic_world {

using namespace periodic_scenes;
using Eigen::Vector3d;
using kds::certificates::PointMotion;

template <int Degree>
void add_all(PeriodicWorld<Degree>& world, const std::vector<BodyDescription<Degree>>& balls) {
  for (const auto& ball : balls) world.add_body(ball);
}

TEST_CASE("periodic world: momentum and energy are kept") {
  const auto seed = GENERATE(1u, 2u);
  CAPTURE(seed);
  PeriodicOptions options;
  options.max = {4, 4.5, 5};
  const auto balls = random_balls<1>(60, options, seed);
  PeriodicWorld<1> world(options);
  add_all(world, balls);
  const auto momentum = [&] {
    Vector3d sum = Vector3d::Zero();
    for (BodyId id = 0; id < balls.size(); ++id) sum += balls[id].mass * world.velocity(id);
    return sum;
  };
  const auto energy = [&] {
    double sum = 0;
    for (BodyId id = 0; id < balls.size(); ++id) sum += balls[id].mass * world.velocity(id).squaredNorm() / 2;
    return sum;
  };
  const Vector3d momentum_before = momentum();
  const double energy_before = energy();
  while (world.counters().contacts < 5000) world.advance_to(world.now() + 1);
  CHECK((momentum() - momentum_before).norm() < 1e-12 * 60);
  CHECK(std::abs(energy() - energy_before) < 1e-12 * energy_before);
  CHECK(world.counters().wraps > 500);
  CHECK(world.counters().images_made - world.counters().images_ended == world.world().size() - world.size());
}

TEST_CASE("periodic world: the same events, bit for bit, with each broad phase, and after a snapshot") {
  const auto seed = GENERATE(1u, 2u);
  const auto shear = GENERATE(0.0, 1.5);
  CAPTURE(seed, shear);
  PeriodicOptions options;
  options.max = {4.5, 4, 5};
  options.boundaries[2] = seed == 1 ? Boundary::periodic : Boundary::walls;
  options.wall_temperatures[4] = seed == 1 ? 0 : 1.5;  // the floor is a thermostat, the ceiling reflects
  options.shear_rate = shear;
  options.elastic_within = 1e-4;
  auto balls = random_balls<2>(70, options, seed, 0.85);
  if (seed == 2) {
    for (auto& ball : balls) ball.motion[0].coefficients[2] = {0, 0, -0.5};
  }
  Log<2> expected;
  kds::Snapshot middle;
  std::size_t numbers_then = 0;
  {
    PeriodicWorld<2> world(options, &expected);
    add_all(world, balls);
    world.advance_to(1.5);
    middle = kds::save(world);
    numbers_then = expected.numbers.size();
    world.advance_to(3);
    world.audit();
    CHECK(expected.contacts > 300);
    CHECK(expected.overlaps + expected.passed == 0);
    CHECK((expected.walls > 0) == (seed == 2));
  }
  for (const BroadPhaseKind kind :
       {BroadPhaseKind::kinetic_sap, BroadPhaseKind::grid, BroadPhaseKind::sap, BroadPhaseKind::all_pairs}) {
    PeriodicOptions other = options;
    other.world.broad_phase = kind;
    other.world.rate = kind == BroadPhaseKind::sap ? 50 : 0;
    Log<2> log;
    PeriodicWorld<2> world(other, &log);
    add_all(world, balls);
    world.advance_to(3);
    CAPTURE(world.world().broad_phase());
    CHECK((log.numbers == expected.numbers));
  }
  Log<2> rest;
  PeriodicWorld<2> world(options, &rest);
  kds::restore(middle, world);
  CHECK(world.now() == 1.5);
  CHECK(world.size() == 70);
  world.advance_to(3);
  world.audit();
  CHECK((rest.numbers ==
         std::vector<double>(expected.numbers.begin() + std::ptrdiff_t(numbers_then), expected.numbers.end())));
}

/// Until rounding errors, which differ between the two, have grown.
TEST_CASE("periodic world: the same contacts if all is moved by half a period") {
  const auto seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  PeriodicOptions options;
  options.max = {4, 4.5, 5};
  auto balls = random_balls<1>(40, options, seed);
  if (seed == 3) {  // boxes and capsules that fit into the balls
    for (std::size_t i = 0; i < balls.size(); i += 2) {
      const double radius = std::get<Sphere>(balls[i].shape).radius;
      balls[i].shape = Box{Vector3d(0.5, 0.6, 0.6) * radius};
      balls[i].orientation = Eigen::Quaterniond(1, 0.1 * double(i), 0.3, -0.2).normalized();
      balls[i + 1].shape = Capsule{0.4 * radius, 0.5 * radius};
    }
  }
  struct Contacts final : PeriodicListener<1> {
    std::vector<PeriodicEvent> events;
    void contact(PeriodicWorld<1>&, const PeriodicEvent& event) override { events.push_back(event); }
  } here, there;
  const auto run = [&](const Vector3d& by, Contacts& told) {
    PeriodicWorld<1> world(options, &told);
    for (auto ball : balls) {
      ball.motion[0].coefficients[0] += by;
      world.add_body(ball);
    }
    while (told.events.size() < 150) world.step(world.now() + 100);
  };
  run({0, 0, 0}, here);
  run({2, 2.25, -2.5}, there);
  std::size_t across = 0, only_there = 0;
  for (std::size_t i = 0; i < 150; ++i) {
    CAPTURE(i);
    REQUIRE((here.events[i].a == there.events[i].a && here.events[i].b == there.events[i].b));
    REQUIRE(std::abs(here.events[i].contact.time - there.events[i].contact.time) < 1e-7);
    across += here.events[i].offset != Offset{};
    only_there += here.events[i].offset == Offset{} && there.events[i].offset != Offset{};
  }
  CHECK((across > 10 && only_there > 10));
}

TEST_CASE("periodic world: between walls it is a World, bit for bit") {
  const auto seed = GENERATE(1u, 2u);
  CAPTURE(seed);
  PeriodicOptions options;
  options.max = {4, 4.5, 5};
  options.boundaries = {Boundary::walls, Boundary::walls, Boundary::walls};
  const auto balls = random_balls<1>(60, options, seed, 0.98);
  Log<1> log;
  PeriodicWorld<1> periodic(options, &log);
  add_all(periodic, balls);
  struct Contacts final : WorldListener<1> {
    std::vector<double> numbers;
    void contact(World<1>&, const PairEvent& event) override {
      numbers.insert(numbers.end(), {double(event.a), double(event.b), event.contact.time});
    }
  } expected;
  World<1> world({.response = Response::elastic, .walls = Walls{options.min, options.max}}, &expected);
  for (const auto& ball : balls) world.add_body(ball);
  periodic.advance_to(4);
  world.advance_to(4);
  std::vector<double> found;
  for (std::size_t i = 0; i < log.numbers.size(); i += log.numbers[i] == 4 ? 4 : 14) {
    if (log.numbers[i] == 1) found.insert(found.end(), {log.numbers[i + 1], log.numbers[i + 2], log.numbers[i + 3]});
  }
  CHECK(found.size() > 3 * 300);
  CHECK((found == expected.numbers));
  for (BodyId id = 0; id < 60; ++id) CHECK(periodic.motion(id) == world.motion(id));
}

TEST_CASE("periodic world: a body that nothing meets flies straight on through all copies of the box") {
  const auto shear = GENERATE(0.0, 0.5, -2.0);
  CAPTURE(shear);
  PeriodicOptions options;
  options.max = {3, 4, 5};
  options.shear_rate = shear;
  Log<1> log;
  PeriodicWorld<1> world(options, &log);
  const Vector3d start{0.5, 3.5, 1}, velocity{-1.75, 2.5, 0.625};
  const BodyId id = world.add_body({.shape = Sphere{0.5}, .motion = {{{start, velocity}, 0}}});
  for (double t = 0.25; t < 40; t += 0.25) {
    world.advance_to(t);
    world.audit();
    const Offset crossings = world.crossings(id);
    const Vector3d x = world.position(id);
    CAPTURE(t, x.transpose());
    CHECK((x + world.lattice().displacement(crossings, t) - (start + t * velocity)).norm() < 1e-12);
    CHECK((world.velocity(id) + world.lattice().velocity(crossings) - velocity).norm() < 1e-14);
    CHECK((x.array() >= options.min.array() - 0.126).all());
    CHECK((x.array() <= options.max.array() + 0.126).all());
  }
  CHECK(log.wraps > 30);
  CHECK(log.numbers.size() == 6 * log.wraps);
}

TEST_CASE("periodic world: a parabola through all copies of the box") {
  const auto shear = GENERATE(0.0, 0.5);
  CAPTURE(shear);
  PeriodicOptions options;
  options.max = {3, 4, 5};
  options.shear_rate = shear;
  PeriodicWorld<2> world(options);
  const PointMotion<2> motion{{{0.5, 3.5, 1}, {-1.75, 2.5, 0.625}, {0.25, -0.375, 0.125}}, 0};
  const BodyId id = world.add_body({.shape = Sphere{0.5}, .motion = {motion}});
  for (double t = 0.25; t < 20; t += 0.25) {
    world.advance_to(t);
    world.audit();
    CAPTURE(t);
    const Vector3d place = world.position(id) + world.lattice().displacement(world.crossings(id), t);
    CHECK((place - motion.position(t)).norm() < 1e-11);
  }
  CHECK(world.counters().wraps > 50);
}

TEST_CASE("periodic world: a contact across an end, at the very double") {
  PeriodicOptions options;
  options.max = {8, 8, 8};
  struct Contacts final : PeriodicListener<1> {
    std::vector<PeriodicEvent> events;
    void contact(PeriodicWorld<1>&, const PeriodicEvent& event) override { events.push_back(event); }
  } told;
  PeriodicWorld<1> world(options, &told);
  // 1 and 7 are 2 apart across the end; they touch when they have come 1 nearer, after 1/2 s.
  const BodyId a = world.add_body({.shape = Sphere{0.5}, .motion = {{{{1, 4, 4}, {-1, 0, 0}}, 0}}, .user_data = 7});
  const BodyId b = world.add_body({.shape = Sphere{0.5}, .motion = {{{{7, 4, 4}, {1, 0, 0}}, 0}}, .user_data = 9});
  world.advance_to(0.5);
  REQUIRE(told.events.size() == 1);
  const PeriodicEvent& event = told.events[0];
  CHECK((event.a == a && event.b == b && event.offset == Offset{-1, 0, 0}));
  CHECK(event.contact.time == 0.5);
  CHECK(event.contact.point == Vector3d(0, 4, 4));
  CHECK(event.contact.normal == Vector3d(-1, 0, 0));
  CHECK((event.user_data_a == 7 && event.user_data_b == 9));
  CHECK(event.impulse == 2);
  CHECK(world.velocity(a) == Vector3d(1, 0, 0));
  CHECK(world.velocity(b) == Vector3d(-1, 0, 0));
}

TEST_CASE("periodic world: bodies that lie on a floor, and are met across an end") {
  PeriodicOptions options;
  options.max = {6, 6, 10};
  options.boundaries[2] = Boundary::walls;
  options.wall_restitution = 0;
  Log<2> log;
  PeriodicWorld<2> world(options, &log);
  const auto ball = [](const Vector3d& x, const Vector3d& v) {
    return BodyDescription<2>{.shape = Sphere{0.5}, .motion = {{{x, v, {0, 0, -5}}, 0}}, .restitution = 0.5};
  };
  const BodyId a = world.add_body(ball({0.75, 3, 0.5}, {0, 0, 0}));
  const BodyId b = world.add_body(ball({4.5, 3, 0.5}, {1, 0, 0}));
  world.advance_to(1);  // b comes to rest on the floor, and slides on
  CHECK(log.contacts == 0);
  world.advance_to(3);
  world.audit();
  CHECK(log.contacts == 1);
  // The ends of the box are 6 apart: the gap is 6 - 3.75 - 1 = 1.25.
  CHECK(world.velocity(a)[0] == Approx(0.75));
  CHECK(world.velocity(b)[0] == Approx(0.25));
  CHECK(world.position(a)[2] == 0.5);
  world.advance_to(40);
  world.audit();
  CHECK(log.contacts > 2);
  CHECK(world.velocity(a)[0] + world.velocity(b)[0] == Approx(1));
  CHECK(world.position(b)[2] == 0.5);
}

TEST_CASE("periodic world: bodies that come, go and change in callbacks") {
  const auto seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  struct Editor final : PeriodicListener<1> {
    ThermalVelocities random{5};
    std::size_t contacts = 0;
    void contact(PeriodicWorld<1>& world, const PeriodicEvent& event) override {
      ++contacts;
      const Vector3d x = world.position(event.a);
      if (contacts % 3 == 0) {
        world.remove_body(event.a);
        // Larger than all before it, and elsewhere: what it overlaps it passes through.
        world.add_body({.shape = Sphere{0.3 + 0.002 * double(contacts % 100)},
                        .motion = {{{x + Vector3d(10, 1, 1), random.inside(1)}, world.now()}}});
      } else if (contacts % 3 == 1) {
        world.update_motion(event.b, {{x + Vector3d(0, 2, -20), random.inside(1)}, world.now()});
      }
    }
    void wrapped(PeriodicWorld<1>& world, BodyId id, const Offset&) override {
      if (contacts % 7 == 0) world.remove_body(id);
    }
  } editor;
  PeriodicOptions options;
  options.max = {4, 4.5, 5};
  options.shear_rate = seed == 3 ? 1 : 0;
  PeriodicWorld<1> world(options, &editor);
  add_all(world, random_balls<1>(60, options, seed));
  while (world.size() > 10 && editor.contacts < 400 && world.now() < 100) {
    world.step(world.now() + 1);
    if (editor.contacts % 5 == 0) world.audit();
  }
  world.audit();
  CHECK(editor.contacts > 50);
  std::size_t bodies = 0, images = 0;
  world.world().visit_overlapping(Vector3d::Constant(-100), Vector3d::Constant(100), [&](BodyId id) {
    const auto owner = world.owner(id);
    CHECK(world.contains(owner.body));
    ++(owner.offset == Offset{} ? bodies : images);
    const Vector3d way = world.world().motion(id).position(world.now()) - world.position(owner.body);
    CHECK((way - world.lattice().displacement(owner.offset, world.now())).norm() < 1e-12);
  });
  CHECK(bodies == world.size());
  CHECK(images == world.counters().images_made - world.counters().images_ended);
}

}  // namespace test_periodic_world
