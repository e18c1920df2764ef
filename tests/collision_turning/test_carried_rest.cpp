// Bodies that turn come to rest on what glides or accelerates: belts, lifts and carts.
#include "kds/framework/snapshot.hpp"

#include "tests/collision_turning/narrow_phase/turning_solids.hpp"
#include "tests/collision_turning/rest_scenes.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace test_carried_rest {
namespace {

using namespace kds;
using namespace kds::tests::rest;
using kds::tests::Random;
using kds::tests::random_vector;

/// A fixed body that moves.
Body moving(Body body, const Vector3d& velocity) {
  body.motion[0].path.coefficients[1] = velocity;
  return body;
}

Body accelerated(Body body, const Vector3d& acceleration) {
  body.motion[0].path.coefficients[2] = 0.5 * acceleration;
  return body;
}

/// Whether a body does not turn, and its path is that of another one, but for its place.
bool moves_as(const Turning& world, BodyId id, BodyId other) {
  const auto &motion = world.motion(id), &carrier = world.motion(other);
  const auto &path = motion.path.coefficients, &expected = carrier.path.coefficients;
  const bool accelerates = !expected[2].isZero(0);
  return path[1] == expected[1] && path[2] == expected[2] &&
         (!accelerates || motion.path.start == carrier.path.start) && motion.angular_velocity.isZero(0);
}

bool moves_at(const Turning& world, BodyId id, const Vector3d& velocity) {
  const auto& motion = world.motion(id);
  return motion.path.coefficients[1] == velocity && motion.path.coefficients[2].isZero(0) &&
         motion.angular_velocity.isZero(0);
}

Vector3d place(const Turning& world, BodyId id) { return world.motion(id).path.position(world.now()); }

/// A stack of three boxes above a body whose upper side is at the height 0 at first.
void add_stack(Turning& world, const Vector3d& velocity = Vector3d::Zero()) {
  for (int i = 0; i < 3; ++i) {
    world.add_body(moving(body(Box{Vector3d(0.5, 0.5, 0.25)}, {0.02 * (i % 2), 0, 0.55 * i + 0.35}), velocity));
  }
}

/// 32 steps; if it `saves`, each ends with an audit and goes on in another world, from a snapshot.
void take_steps(std::unique_ptr<Turning>& world, Log& log, BroadPhaseKind kind, double step, bool saves) {
  for (int k = 1; k <= 32; ++k) {
    world->advance_to(k * step);
    if (!saves) continue;
    world->audit();
    const auto image = save(*world);
    world = std::make_unique<Turning>(options(kind), &log);
    restore(image, *world);
  }
}

}  // namespace

TEST_CASE("a stack comes to rest on a belt and is carried, the same with all broad phases and snapshots", "[rest]") {
  const Vector3d belt(0.7, -0.2, 0);
  std::vector<std::string> expected;
  for (const auto kind : {BroadPhaseKind::automatic, BroadPhaseKind::all_pairs, BroadPhaseKind::kinetic_sap,
                          BroadPhaseKind::grid, BroadPhaseKind::sap}) {
    for (const bool saves : {false, true}) {
      if (saves && kind != BroadPhaseKind::automatic) continue;
      CAPTURE(static_cast<int>(kind), saves);
      Log log;
      auto world = std::make_unique<Turning>(options(kind), &log);
      world->add_body(moving(ground(), belt));
      add_stack(*world);
      take_steps(world, log, kind, 0.125, saves);
      for (BodyId i = 0; i < 3; ++i) CHECK(world->resting(i, i + 1));
      for (BodyId i = 1; i <= 3; ++i) CHECK(moves_at(*world, i, belt));
      CHECK(log.passed == 0);
      CHECK(log.rested - log.woken == 3);
      CHECK(std::abs(place(*world, 3)[2] - 1.25) < 6 * holding_distance);
      world->audit();
      // From then on nothing happens, however long it takes.
      const int contacts = log.contacts;
      const Vector3d from_belt = place(*world, 1) - place(*world, 0);
      if (kind == BroadPhaseKind::automatic) {
        world->advance_to(1000);
        CHECK((place(*world, 1) - place(*world, 0) - from_belt).norm() < 1e-12);
      }
      CHECK(log.contacts == contacts);
      if (expected.empty()) expected = log.lines;
      CHECK(log.lines == expected);
    }
  }
}

TEST_CASE("a lift carries what rests on it, and wakes it where it stops", "[rest]") {
  for (const double speed : {1.5, -0.75, 0.005}) {
    CAPTURE(speed);
    Log log;
    Turning world(options(), &log);
    Body lift = moving(ground(), {0, 0, speed});
    RigidMotion<2> stops = lift.motion[0];
    stops.path.start = 4;
    stops.path.coefficients = {Vector3d(0, 0, -1 + 4 * speed), Vector3d::Zero(), Vector3d::Zero()};
    lift.motion.push_back(stops);
    world.add_body(lift);
    add_stack(world);
    world.advance_to(3.5);
    for (BodyId i = 0; i < 3; ++i) CHECK(world.resting(i, i + 1));
    for (BodyId i = 1; i <= 3; ++i) CHECK(moves_at(world, i, {0, 0, speed}));
    CHECK(world.free_motion(1).path.coefficients[1] == Vector3d(0, 0, speed));
    CHECK(world.free_motion(1).path.coefficients[2] == Vector3d(0, 0, -gravity / 2));
    world.audit();
    world.advance_to(4);
    for (BodyId i = 0; i < 3; ++i) CHECK_FALSE(world.resting(i, i + 1));
    world.advance_to(10);
    for (BodyId i = 1; i <= 3; ++i) CHECK(still(world, i));
    CHECK(std::abs(place(world, 1)[2] - (4 * speed + 0.25)) < 2 * holding_distance);
    CHECK(std::abs(place(world, 3)[2] - (4 * speed + 1.25)) < 6 * holding_distance);
    CHECK(log.passed == 0);
    world.audit();
  }
}

TEST_CASE("a turntable lets nothing rest, and carries all the same", "[rest]") {
  Log log;
  Turning world(options(), &log);
  Body table = ground();
  table.motion[0].angular_velocity = {0, 0, 0.125};
  world.add_body(table);
  add_stack(world);
  world.advance_to(0.625);
  CHECK(log.rested == 0);
  CHECK(log.passed == 0);
  CHECK(place(world, 3)[2] > 1.2);  // in shortest flights
}

TEST_CASE("a lift that speeds up and a cart that brakes carry what rests on them", "[rest]") {
  struct Case {
    Vector3d velocity, acceleration;
  };
  for (const Case& c : {Case{{0, 0, 0}, {0, 0, 4}}, Case{{0, 0, 1}, {0, 0, -6}}, Case{{6, -1, 0}, {-2, 0.5, 0}},
                        Case{{0.3, 0, 0.2}, {1, 1, 2}}}) {
    CAPTURE(c.velocity.transpose(), c.acceleration.transpose());
    std::vector<std::string> expected;
    for (const auto kind : {BroadPhaseKind::automatic, BroadPhaseKind::all_pairs, BroadPhaseKind::kinetic_sap}) {
      for (const bool saves : {false, true}) {
        if (saves && kind != BroadPhaseKind::automatic) continue;
        Log log;
        auto world = std::make_unique<Turning>(options(kind), &log);
        world->add_body(accelerated(moving(ground(), c.velocity), c.acceleration));
        add_stack(*world, c.velocity);
        take_steps(world, log, kind, 0.0625, saves);
        for (BodyId i = 0; i < 3; ++i) CHECK(world->resting(i, i + 1));
        for (BodyId i = 1; i <= 3; ++i) CHECK(moves_as(*world, i, 0));
        CHECK(log.passed == 0);
        CHECK(log.contacts < 20000);
        world->audit();
        // No energy is left, seen from what carries them, and nothing has sunk in: the heights are those of the boxes.
        for (BodyId i = 1; i <= 3; ++i) {
          const Vector3d above = place(*world, i) - place(*world, 0);
          CHECK(above[2] > 1 + 0.25 + 0.5 * static_cast<double>(i - 1) - 1e-12);
          CHECK(above[2] <
                1 + 0.25 + 0.5 * static_cast<double>(i - 1) + 12 * static_cast<double>(i) * holding_distance);
        }
        // From then on nothing happens, and the place on the carrier is exactly the same.
        const int contacts = log.contacts;
        const Vector3d from_carrier = world->motion(3).path.coefficients[0] - world->motion(0).path.coefficients[0];
        if (kind == BroadPhaseKind::automatic) {
          world->advance_to(60);
          CHECK(moves_as(*world, 3, 0));
          CHECK(world->motion(3).path.coefficients[0] - world->motion(0).path.coefficients[0] == from_carrier);
        }
        CHECK(log.contacts == contacts);
        if (expected.empty()) expected = log.lines;
        CHECK(log.lines == expected);
      }
    }
  }
}

TEST_CASE("what is carried wakes where its carrier ceases to accelerate, or does so otherwise", "[rest]") {
  // Up with 4 m/s^2 for 2 s, then with the speed reached for 1 s, then it brakes with 4 m/s^2 until it stands.
  Log log;
  Turning world(options(), &log);
  Body lift = accelerated(ground(), {0, 0, 4});
  const auto piece = [&](double start, double height, double speed, double acceleration) {
    RigidMotion<2> motion = lift.motion[0];
    motion.path.start = start;
    motion.path.coefficients = {Vector3d(0, 0, height - 1), Vector3d(0, 0, speed), Vector3d(0, 0, acceleration / 2)};
    lift.motion.push_back(motion);
  };
  piece(2, 8, 8, 0), piece(3, 16, 8, -4), piece(5, 24, 0, 0);
  world.add_body(lift);
  add_stack(world);
  int most = 0;
  for (const double until : {2.0, 3.0, 5.0, 8.0}) {
    world.advance_to(until - 0.0625);
    CAPTURE(until);
    for (BodyId i = 0; i < 3; ++i) CHECK(world.resting(i, i + 1));
    for (BodyId i = 1; i <= 3; ++i) CHECK(moves_as(world, i, 0));
    CHECK(world.free_motion(1).path.coefficients[2] == Vector3d(0, 0, -gravity / 2));
    CHECK((world.free_motion(1).path.coefficients[1] - world.motion(0).path.velocity(world.now())).norm() < 1e-12);
    world.audit();
    world.advance_to(until);
    CHECK(world.resting(0, 1) == (until == 8));
    most = std::max(most, log.contacts);
  }
  CHECK(most < 60000);
  CHECK(log.passed == 0);
  for (BodyId i = 1; i <= 3; ++i) CHECK(still(world, i));
  CHECK(std::abs(place(world, 1)[2] - 24.25) < 3 * holding_distance);
}

TEST_CASE("what friction cannot hold slides off a cart, and what falls slower than a lift does not rest on it",
          "[rest]") {
  // Friction holds up to 0.5 x 10 m/s^2.
  for (const double acceleration : {4.0, 6.0}) {
    Log log;
    Turning world(options(), &log);
    world.add_body(accelerated(ground(), {acceleration, 0, 0}));
    const BodyId box = world.add_body(body(Box{Vector3d(0.5, 0.5, 0.125)}, {0, 0, 0.135}));
    world.advance_to(1);
    CAPTURE(acceleration);
    CHECK(world.resting(0, box) == (acceleration < 5));
    if (acceleration > 5) {
      CHECK(log.rested == 0);
      // It is drawn along with 5 m/s^2, but for what it slides while it falls at first.
      CHECK(std::abs(place(world, box)[0] - 2.5) < 0.25);
    }
    CHECK(log.passed == 0);
  }
  for (const double acceleration : {-9.0, -10.0, -11.0}) {
    Log log;
    Turning world(options(), &log);
    world.add_body(accelerated(ground(), {0, 0, acceleration}));
    const BodyId box = world.add_body(body(Box{Vector3d(0.5, 0.5, 0.125)}, {0, 0, 0.125}));
    world.advance_to(1);
    CAPTURE(acceleration);
    CHECK(world.resting(0, box) == (acceleration > -10));
    CHECK(log.passed == 0);
  }
}

TEST_CASE("on two belts of different speeds nothing rests, on two of the same it does", "[rest]") {
  const double other = GENERATE(0.25, 0.5);
  CAPTURE(other);
  Log log;
  Turning world(options(), &log);
  world.add_body(moving(fixed(Box{Vector3d(20, 1, 1)}, {0, -1, -1}), {0.5, 0, 0}));
  world.add_body(moving(fixed(Box{Vector3d(20, 1, 1)}, {0, 1, -1}), {other, 0, 0}));
  const BodyId box = world.add_body(body(Box{Vector3d(0.5, 0.5, 0.25)}, {0, 0, 0.3}));
  world.advance_to(2);
  CHECK(world.resting(0, box) == (other == 0.5));
  CHECK(world.resting(1, box) == (other == 0.5));
  CHECK(log.passed == 0);
  CHECK(place(world, box)[2] > 0.24);
}

TEST_CASE("what a belt carries wakes at a wall, and where another comes to lie", "[rest]") {
  Log log;
  Turning world(options(), &log);
  world.add_body(moving(ground(), {1, 0, 0}));
  const BodyId wall = world.add_body(fixed(Box{Vector3d(0.25, 5, 5)}, {4, 0, 5.125}));
  const BodyId first = world.add_body(body(Box{Vector3d::Constant(0.25)}, {0, 0, 0.3}));
  world.advance_to(2);
  CHECK(moves_at(world, first, {1, 0, 0}));
  const BodyId second = world.add_body([&] {
    Body late = body(Box{Vector3d::Constant(0.2)}, place(world, first) + Vector3d(0, 0, 0.5));
    late.motion[0].path.start = 2;
    late.motion[0].path.coefficients[1] = {1, 0, 0};
    return late;
  }());
  world.advance_to(3);
  CHECK(world.resting(first, second));
  CHECK(moves_at(world, second, {1, 0, 0}));
  world.audit();
  world.advance_to(4);  // It is at the wall since 3.5 s.
  CHECK_FALSE(world.resting(0, first));
  CHECK(place(world, first)[0] < 3.5 + 1e-12);
  CHECK(place(world, first)[2] > 0.2);
  CHECK_FALSE(world.resting(wall, first));
  CHECK(log.passed == 0);
}

TEST_CASE("crates that a belt presses against a stop rest there, and the belt slides on below them", "[rest]") {
  const Body belt = moving(fixed(HalfSpace{Vector3d::UnitZ(), 0}, Vector3d::Zero()), {0.5, 0, 0});
  std::vector<std::string> expected;
  for (const auto& [kind, saves] : {std::pair(BroadPhaseKind::automatic, false),
                                    {BroadPhaseKind::automatic, true},
                                    {BroadPhaseKind::all_pairs, false}}) {
    CAPTURE(static_cast<int>(kind), saves);
    Log log;
    auto world = std::make_unique<Turning>(options(kind), &log);
    world->add_body(belt);
    const BodyId stop = world->add_body(fixed(Box{Vector3d(0.25, 2, 2)}, {2, 0, 1}));
    for (const double x : {1.25, 0.5}) {
      world->add_body(moving(body(Box{Vector3d(0.25, 0.2, 0.15)}, {x, 0.02 * x, 0.16}), {0.5, 0, 0}));
    }
    take_steps(world, log, kind, 0.125, saves);
    for (BodyId i = 2; i <= 3; ++i) CHECK((world->resting(0, i) && still(*world, i)));
    CHECK(world->resting(stop, 2));
    CHECK(world->resting(2, 3));
    CHECK(std::abs(place(*world, 3)[0] - 1) < 6 * holding_distance);
    CHECK(log.passed == 0);
    const int contacts = log.contacts;
    world->advance_to(1000);
    world->audit();
    CHECK(log.contacts == contacts);
    if (expected.empty()) expected = log.lines;
    CHECK(log.lines == expected);
    // The other way it draws them along.
    RigidMotion<2> back = world->motion(0).restarted(1000);
    back.path.coefficients[1] = {-0.5, 0, 0};
    world->update_motion(0, back);
    world->advance_to(1001);
    CHECK(place(*world, 2)[0] < 1.25);
  }
}

TEST_CASE("at a stop nothing rests on a half-space that rises, however slowly, or has no friction", "[rest]") {
  for (const auto& [rising, friction] : {std::pair(0.0, 0.5), {1e-9, 0.5}, {0.0, 0.0}}) {
    CAPTURE(rising, friction);
    Log log;
    Turning world(options(), &log);
    world.add_body(moving(fixed(HalfSpace{Vector3d::UnitZ(), 0}, Vector3d::Zero()), {0.5, 0, rising}));
    world.add_body(fixed(Box{Vector3d(0.25, 2, 2)}, {0.75, 0, 1}));
    Body crate = moving(body(Box{Vector3d(0.25, 0.2, 0.15)}, {0.2, 0, 0.16}), {0.5, 0, 0});
    crate.friction = friction;
    const BodyId id = world.add_body(crate);
    world.advance_to(0.375);
    const bool rests = rising == 0 && friction > 0;
    CHECK(world.resting(1, id) == rests);
    CHECK(still(world, id) == rests);
  }
}

TEST_CASE("boxes thrown on a gliding floor come to rest on it, at any velocity", "[rest]") {
  int at_rest = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const Vector3d velocity = random_vector(random, 3);
    Log log;
    Turning world(options(), &log);
    world.add_body(moving(ground(), velocity));
    Body die = body(Box{Vector3d(0.3, 0.4, 0.5)}, {0, 0, 2}, tilted(random.between(-2, 2), {1, 0.5, 0.25}),
                    random_vector(random, 3));
    die.motion[0].path.coefficients[1] = velocity + random_vector(random, 1);
    const BodyId id = world.add_body(die);
    for (int k = 1; k <= 80 && !moves_at(world, id, velocity); ++k) world.advance_to(k / 4.0);
    at_rest += moves_at(world, id, velocity);
    CHECK(place(world, id)[2] - place(world, 0)[2] > 1.29);
    CHECK(log.passed == 0);
    world.audit();
  }
  CHECK(at_rest == 12);
}

}  // namespace test_carried_rest
