// Heaps of bodies that turn come to rest, in parts where others still move; rolling friction.
#include "collision/world.hpp"
#include "kds/framework/snapshot.hpp"

#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace test_heaps {
namespace {

using namespace kds;
using namespace kds::collision;
using certificates::RigidMotion;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using kds::tests::Random;
using Turning = TurningWorld<2>;
using Body = Turning::Description;

constexpr double gravity = 10;

struct Log : Turning::Listener {
  std::vector<std::string> lines;
  int rested = 0, woken = 0, passed = 0;

  void note(const char* what, const PairEvent& event) {
    char text[160];
    std::snprintf(text, sizeof text, "%a %s %llu %llu %a", event.contact.time, what,
                  static_cast<unsigned long long>(event.a), static_cast<unsigned long long>(event.b),
                  event.contact.point[0]);
    lines.emplace_back(text);
  }
  void contact(Turning&, const PairEvent& event) override { note("contact", event); }
  void rests(Turning&, const PairEvent& event) override { ++rested, note("rests", event); }
  void wakes(Turning&, const PairEvent& event) override { ++woken, note("wakes", event); }
  void passes(Turning&, const PairEvent&) override { ++passed; }
};

Body falling(const Shape& shape, const Vector3d& at, double start = 0) {
  RigidMotion<2> motion{{{at, Vector3d::Zero(), Vector3d(0, 0, -gravity / 2)}}};
  motion.path.start = start;
  return {.shape = shape, .motion = {motion}, .restitution = 0.3, .friction = 0.5};
}

Body fixed(const Shape& shape, const Vector3d& at) {
  Body body = falling(shape, at);
  body.motion[0].path.coefficients[2] = Vector3d::Zero();
  body.fixed = true;
  return body;
}

/// Boxes of a world, and what they are.
struct Boxes {
  std::vector<BodyId> ids;
  std::vector<Vector3d> halves;
  std::size_t fixed = 0;  ///< the first of them

  void add(Turning& world, Body body, const Vector3d& half) {
    body.shape = Box{half};
    fixed += body.fixed;
    ids.push_back(world.add_body(body));
    halves.push_back(half);
  }
  void add_ground(Turning& world) { add(world, test_heaps::fixed(Sphere{1}, {0, 0, -1}), {20, 20, 1}); }
};

bool still(const Turning& world, BodyId id) {
  const auto& motion = world.motion(id);
  return motion.path.coefficients[1].isZero(0) && motion.path.coefficients[2].isZero(0) &&
         motion.angular_velocity.isZero(0);
}

bool all_still(const Turning& world, const Boxes& boxes) {
  return std::all_of(boxes.ids.begin(), boxes.ids.end(), [&](BodyId id) { return still(world, id); });
}

/// How deep two boxes are in each other at most, by their fifteen axes: found without the library.
double deepest_overlap(const Turning& world, const Boxes& boxes) {
  const std::size_t n = boxes.ids.size();
  std::vector<Vector3d> centres;
  std::vector<Matrix3d> axes;
  for (const BodyId id : boxes.ids) {
    const auto& motion = world.motion(id);
    centres.push_back(motion.path.position(world.now()));
    Matrix3d own;
    for (int d = 0; d < 3; ++d) own.col(d) = motion.direction(Vector3d::Unit(d), world.now()).vector;
    axes.push_back(own);
  }
  double deepest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      double apart = -never;
      const auto along = [&](const Vector3d& axis) {
        if (axis.norm() < 1e-6) return;
        const Vector3d u = axis.normalized();
        const double half_widths = (axes[i].transpose() * u).cwiseAbs().dot(boxes.halves[i]) +
                                   (axes[j].transpose() * u).cwiseAbs().dot(boxes.halves[j]);
        apart = std::max(apart, std::abs(u.dot(centres[i] - centres[j])) - half_widths);
      };
      for (int d = 0; d < 3; ++d) {
        along(axes[i].col(d)), along(axes[j].col(d));
        for (int e = 0; e < 3; ++e) along(axes[i].col(d).cross(axes[j].col(e)));
      }
      deepest = std::max(deepest, -apart);
    }
  }
  return deepest;
}

/// Crates, boards and rods above a floor between four fixed walls.
Boxes fill_box(Turning& world, int bodies, std::uint64_t seed) {
  Boxes boxes;
  constexpr double half_width = 1.25, thickness = 0.25, height = 2;
  constexpr double middle = half_width + thickness;
  boxes.add(world, fixed(Sphere{1}, {0, 0, -thickness}), {middle + thickness, middle + thickness, thickness});
  for (const double side : {-1.0, 1.0}) {
    boxes.add(world, fixed(Sphere{1}, {side * middle, 0, height}), {thickness, half_width, height});
    boxes.add(world, fixed(Sphere{1}, {0, side * middle, height}), {half_width, thickness, height});
  }
  const std::vector<Vector3d> halves{{0.3, 0.3, 0.3}, {0.1, 0.125, 0.5}, {0.4, 0.3, 0.15}};
  Random random(seed);
  for (int i = 0; i < bodies; ++i) {
    Body body = falling(Sphere{1}, {1.2 * (i % 2) - 0.6, 1.2 * (i / 2 % 2) - 0.6, 0.75 + 1.2 * (i / 4)});
    const double w = random.between(-1, 1), x = random.between(-1, 1), y = random.between(-1, 1);
    body.motion[0].orientation = Quaterniond(w, x, y, random.between(-1, 1));
    boxes.add(world, body, halves[static_cast<std::size_t>(i) % halves.size()]);
  }
  return boxes;
}

WorldOptions options(BroadPhaseKind kind = BroadPhaseKind::automatic) {
  WorldOptions result{.response = Response::elastic, .broad_phase = kind, .shortest_flight = 4e-3};
  if (kind == BroadPhaseKind::sap) result.rate = 60;
  return result;
}

}  // namespace

TEST_CASE("a heap of crates, boards and rods comes to rest, and then costs nothing", "[heaps]") {
  Log log;
  Turning world(options(), &log);
  const Boxes boxes = fill_box(world, 7, 1);
  while (!all_still(world, boxes) && world.now() < 8) {
    world.advance_to(world.now() + 0.25);
    CHECK(deepest_overlap(world, boxes) < 1e-12);
    world.audit();
  }
  CHECK(all_still(world, boxes));
  CHECK(log.passed == 0);
  const auto lines = log.lines.size();
  const auto tests = world.counters().pair_tests;
  world.advance_to(world.now() + 1000);
  CHECK(log.lines.size() == lines);
  CHECK(world.counters().pair_tests <= tests + boxes.ids.size());
}

TEST_CASE("heaps rest and wake in parts, the same with all broad phases, windows and snapshots", "[heaps]") {
  std::vector<std::string> expected;
  for (const auto kind :
       {BroadPhaseKind::automatic, BroadPhaseKind::all_pairs, BroadPhaseKind::grid, BroadPhaseKind::sap}) {
    for (const bool saves : {false, true}) {
      if (saves && kind != BroadPhaseKind::automatic) continue;
      CAPTURE(static_cast<int>(kind), saves);
      Log log;
      auto world = std::make_unique<Turning>(options(kind), &log);
      const Boxes boxes = fill_box(*world, 5, 5);
      for (int k = 1; k <= 15; ++k) {
        world->advance_to(k / 10.0);
        if (!saves) continue;
        world->audit();
        const auto image = save(*world);
        world = std::make_unique<Turning>(options(kind), &log);
        restore(image, *world);
      }
      CHECK(log.rested > 0);
      if (expected.empty()) expected = log.lines;
      CHECK(log.lines == expected);
    }
  }
}

TEST_CASE("a wall of bricks that is struck falls over, and comes to rest", "[heaps]") {
  Log log;
  Turning world(options(), &log);
  Boxes boxes;
  boxes.add_ground(world);
  const Vector3d half(0.25, 0.125, 0.125);
  for (int i = 0; i < 8; ++i) {
    boxes.add(world, falling(Sphere{1}, {0.52 * (i % 2) + 0.1 * (i / 2 % 2), 0, 0.126 + 0.251 * (i / 2)}), half);
  }
  world.advance_to(0.5);
  REQUIRE(all_still(world, boxes));
  Body thrown = falling(Sphere{1}, {0.25, -2, 0.7}, 0.5);
  thrown.motion[0].path.coefficients[1] = Vector3d(0, 5, 1.5);
  thrown.mass = 4;
  boxes.add(world, thrown, Vector3d::Constant(0.2));
  const int woken = log.woken;
  world.advance_to(1.25);
  CHECK(log.woken > woken);
  double lowest = never;
  for (const BodyId id : boxes.ids) {
    if (id > 6) lowest = std::min(lowest, world.motion(id).path.position(world.now())[2]);
  }
  CHECK(lowest < 0.6);  // they have stood at 0.88
  while (!all_still(world, boxes) && world.now() < 6) world.advance_to(world.now() + 0.25);
  CHECK(all_still(world, boxes));
  CHECK(deepest_overlap(world, boxes) < 1e-12);
  CHECK(log.passed == 0);
}

TEST_CASE("a body that takes an impact without moving stays at rest", "[heaps]") {
  // Another falls on a heavy plate: in its midst, where the floor takes it, or beyond the edge of what it lies on.
  for (const double at : {0.0, 0.875}) {
    CAPTURE(at);
    Log log;
    Turning world({.response = Response::elastic}, &log);
    world.add_body(fixed(Box{Vector3d(0.5, 0.5, 0.5)}, {0, 0, -0.5}));
    Body plate = falling(Box{Vector3d(1, 0.5, 0.125)}, {0, 0, 0.126});
    plate.mass = 4;
    const BodyId below = world.add_body(plate);
    world.advance_to(0.5);
    REQUIRE(still(world, below));
    const BodyId ball = world.add_body(falling(Sphere{0.125}, {at, 0, 1}, 0.5));
    world.advance_to(0.95);
    CHECK(world.motion(ball).path.velocity(0.95)[2] > -2.5);  // it has bounced
    CHECK(log.woken == (at > 0));
    CHECK(still(world, below) == (at == 0));
    world.audit();
  }
}

TEST_CASE("what rests next to what is pushed away rests on", "[heaps]") {
  Log log;
  Turning world({.response = Response::elastic}, &log);
  Boxes boxes;
  boxes.add_ground(world);
  const Vector3d half(0.25, 0.25, 0.25);
  for (int i = 0; i < 2; ++i) boxes.add(world, falling(Sphere{1}, {0.75 * i, 0, 0.251}), {0.25, 0.5, 0.25});
  boxes.add(world, falling(Sphere{1}, {0.375, 0, 0.752}), {0.75, 0.25, 0.25});
  Body top = falling(Sphere{1}, {0.375, 0, 1.253});
  top.friction = 0.03125;  // which drags little along as it goes
  boxes.add(world, top, half);
  world.advance_to(0.5);
  REQUIRE(all_still(world, boxes));
  Body thrown = falling(Sphere{0.125}, {0.375, -2, 1.2225}, 0.5);
  thrown.motion[0].path.coefficients[1] = Vector3d(0, 10, 1);
  world.add_body(thrown);
  world.advance_to(0.72);
  CHECK_FALSE(still(world, boxes.ids[4]));
  for (int i = 1; i <= 3; ++i) CHECK(still(world, boxes.ids[static_cast<std::size_t>(i)]));
  CHECK(world.resting(boxes.ids[1], boxes.ids[3]));
  world.audit();
}

TEST_CASE("a body does not come to rest in the way of another", "[heaps]") {
  // At one contact of these two the lower one is ready to rest, and the upper one is not.
  Log log;
  Turning world(options(), &log);
  Boxes boxes;
  boxes.add_ground(world);
  const auto put = [&](const Vector3d& half, const Vector3d& at, double angle, double mass, double restitution) {
    Body body = falling(Sphere{1}, at);
    body.motion[0].orientation = Quaterniond(std::cos(angle / 2), 0, 0, std::sin(angle / 2));
    body.mass = mass, body.restitution = restitution;
    boxes.add(world, body, half);
  };
  put({0.10463616661178173, 0.1808203694683011, 0.20257130965610143},
      {-0.041374301914720239, -0.025696565970027604, 0.21257130965610144}, 1.724541264472526, 2.9450083426841798,
      0.059063853346355881);
  put({0.25755281074138392, 0.25981811508447572, 0.18112637483898769},
      {-0.099518207178217508, 0.046165839887187726, 0.61626899415119052}, 2.5189478098181799, 2.7118217122328896,
      0.21322586573625335);
  world.advance_to(1);
  CHECK(log.passed == 0);
  CHECK(all_still(world, boxes));
  CHECK(deepest_overlap(world, boxes) < 1e-12);
  CHECK(world.motion(boxes.ids[2]).path.position(1)[2] > 0.58);
}

TEST_CASE("small impacts on what rests add up", "[heaps]") {
  // A box slides onto a plate that rests on ice. Each of its contacts would move the plate too little to wake it.
  for (const double mass : {2.0, 20.0}) {
    CAPTURE(mass);
    Turning world({.response = Response::elastic});
    Body ice = fixed(Box{Vector3d(20, 20, 1)}, {0, 0, -1});
    ice.friction = 0;
    world.add_body(ice);
    Body plate = falling(Box{Vector3d(3, 3, 0.125)}, {0, 0, 0.125 + 1e-6});
    plate.mass = mass;
    const BodyId below = world.add_body(plate);
    world.advance_to(0.25);
    REQUIRE(still(world, below));
    Body box = falling(Box{Vector3d(0.125, 0.125, 0.0625)}, {-0.5, 0, 0.3125 + 1e-5}, 0.25);
    box.motion[0].path.coefficients[1] = Vector3d(2, 0, 0);
    const BodyId above = world.add_body(box);
    world.advance_to(0.875);
    const auto speed = [&](BodyId id) { return world.motion(id).path.velocity(0.875)[0]; };
    // The plate has been taken for fixed while it would have moved at less than 2 cm/s.
    const double momentum = mass * speed(below) + speed(above);
    CHECK(momentum < 2.01);
    CHECK(momentum > 2 - 0.02 * mass);
    CHECK(speed(below) > 0);
  }
  // A ball rolls along a plank, beyond the edge of what that lies on.
  Turning world({.response = Response::elastic});
  world.add_body(fixed(Box{Vector3d(0.5, 0.5, 1)}, {0, 0, -1}));
  const BodyId plank = world.add_body(falling(Box{Vector3d(3, 0.25, 0.125)}, {0, 0, 0.125 + 1e-6}));
  world.advance_to(0.25);
  REQUIRE(still(world, plank));
  Body ball = falling(Sphere{0.125}, {0.25, 0, 0.375 + 1e-5}, 0.25);
  ball.mass = 0.5;
  ball.motion[0].path.coefficients[1] = Vector3d(1, 0, 0);
  ball.motion[0].angular_velocity = Vector3d(0, 8, 0);
  const BodyId rolls = world.add_body(ball);
  const auto sinks = [&](double until) {  // the end of the plank to which the ball rolls
    world.advance_to(until);
    CHECK(std::abs(world.motion(rolls).path.position(until)[0] - until) < 0.1);
    return -world.motion(plank).direction(Vector3d::UnitX(), until).vector[2];
  };
  CHECK(std::abs(sinks(1.25)) < 1e-3);
  CHECK(sinks(2.25) > 0.01);  // it tips with the ball at 1.5
}

TEST_CASE("rolling friction stops what rolls, and holds it on slopes that are flat enough", "[heaps]") {
  constexpr double radius = 0.5, rolling = 0.01;
  const auto run = [&](double friction, double slope, const Shape& shape, double speed, double until) {
    Log log;
    Turning world({.response = Response::elastic}, &log);
    Body ground = fixed(Box{Vector3d(30, 30, 1)}, Vector3d::Zero());
    const Quaterniond q(std::cos(slope / 2), 0, std::sin(slope / 2), 0);
    ground.motion[0].orientation = q;
    ground.rolling_friction = 1;
    world.add_body(ground);
    const double c = std::cos(slope), s = std::sin(slope);
    Body body = falling(shape, Vector3d(s, 0, c) * (1 + radius + 1e-4));
    body.motion[0].path.coefficients[1] = speed * Vector3d(c, 0, -s);
    body.motion[0].angular_velocity = Vector3d(0, speed / radius, 0);
    if (std::holds_alternative<Capsule>(shape)) {  // which lies across the way
      body.motion[0].orientation = Quaterniond(std::sqrt(0.5), std::sqrt(0.5), 0, 0);
    }
    body.rolling_friction = friction;
    const BodyId id = world.add_body(body);
    world.advance_to(until);
    world.audit();
    struct Result {
      bool still;
      double speed;
    };
    return Result{still(world, id), world.motion(id).path.velocity(until).norm()};
  };
  // A ball is slowed down by 5/7 g rolling / radius: 0.143 m/s^2.
  const auto ball = run(rolling, 0, Sphere{radius}, 0.25, 1);
  CHECK_FALSE(ball.still);
  CHECK(std::abs(ball.speed - (0.25 - gravity * 5 / 7 * rolling / radius)) < 0.02);
  CHECK(run(rolling, 0, Sphere{radius}, 0.25, 2).still);
  CHECK(run(rolling, 0, Capsule{radius, 0.5}, 0.125, 1.5).still);
  CHECK(run(rolling, 0.015, Sphere{radius}, 0, 0.5).still);
  CHECK_FALSE(run(rolling, 0.025, Sphere{radius}, 0, 0.5).still);
  const auto free = run(0, 0, Sphere{radius}, 0.25, 2);
  CHECK_FALSE(free.still);
  CHECK(std::abs(free.speed - 0.25) < 0.01);
}

TEST_CASE("rolling friction that is no length is refused", "[heaps]") {
  Turning world({.response = Response::elastic});
  for (const double bad : {-1.0, std::numeric_limits<double>::quiet_NaN(), never}) {
    Body body = falling(Sphere{1}, Vector3d::Zero());
    body.rolling_friction = bad;
    CHECK_THROWS_WITH(world.add_body(body), Catch::StartsWith("rolling_friction: must be in [0, 2^205"));
  }
  World<1> others({.response = Response::elastic});
  BodyDescription<1> body{.shape = Sphere{1}, .motion = {{{{Vector3d(0, 0, 0)}}}}, .rolling_friction = 0.5};
  CHECK_THROWS_WITH(others.add_body(body), "rolling_friction: bodies of this world do not turn");
}

}  // namespace test_heaps
