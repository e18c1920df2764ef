// Sensors that move with another body.
#include "kds/framework/snapshot.hpp"
#include "tests/collision/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <vector>

namespace kds::collision::test_attached {
namespace {

using namespace tests;

constexpr BodyId balls = 10;
constexpr std::uint32_t plain = 1, alarm = 2;

enum class Alarms { none, attached, by_hand };

struct Way {
  BroadPhaseKind method = BroadPhaseKind::all_pairs;
  bool snapshots = false;
  bool looks_ahead = false;
};

/// Balls that bounce off each other and off walls, some of which enter later or have a script that makes them jump.
/// Each may have an alarm of twice its radius, which reports other balls.
std::vector<Event> run(std::uint64_t seed, Alarms alarms, const Way& way) {
  Random random(seed);
  const auto vector = [&](double most) {
    return Vector3d(random.between(-most, most), random.between(-most, most), random.between(-most, most));
  };
  WorldOptions options = with_response(Response::elastic);
  options.walls = Walls{{-7, -7, -7}, {7, 7, 7}, 1};
  options.broad_phase = way.method;
  options.rate = 5;
  const auto jump = motion<2>(vector(5), vector(3), zero, 1.5);
  EventLog<2> log;
  const auto follow = [&](World<2>& w, BodyId id) {
    if (alarms != Alarms::by_hand || id >= balls) return;
    w.update_motion(balls + id, World<2>::Motion(w.motion(id)));
    if (id == 2 && w.now() < jump.start) w.append_motion(balls + id, {&jump, 1});
  };
  log.then = [&](World<2>& w, const Event& e) {
    if (e.kind == Kind::wall || (e.kind == Kind::contact && e.b < balls)) follow(w, e.a);
    if (e.kind == Kind::contact && e.b < balls) follow(w, e.b);
  };
  auto world = std::make_unique<World<2>>(options, &log);
  std::vector<BodyDescription<2>> sensors;
  for (BodyId i = 0; i < balls; ++i) {
    const double radius = random.between(0.5, 1);
    auto described = body<2>(Sphere{radius}, motion<2>(vector(5), vector(3), vector(0.3)));
    if (i == 1) described.motion[0].start = 0.75;
    if (i == 2) described.motion.push_back(jump);
    world->add_body(described);
    described.shape = Sphere{2 * radius};
    described.sensor = true;
    described.category = alarm, described.collides_with = plain;
    if (alarms == Alarms::attached) described.attached_to = i, described.motion = {};
    sensors.push_back(described);
  }
  for (const auto& sensor : sensors) {
    if (alarms != Alarms::none) world->add_body(sensor);
  }
  if (alarms == Alarms::by_hand) {
    for (BodyId i = 0; i < balls; ++i) world->ignore_pair(i, balls + i);
  }
  for (const double t : {0.5, 1.0, 2.0, 3.0}) {
    world->advance_to(t);
    if (way.looks_ahead && way.method != BroadPhaseKind::sap) world->next_time();
    world->audit();
    const auto back = motion<2>({0.1 * t, 0, 0}, {0, 1, 0}, zero, t);
    world->update_motion(3, back);
    if (alarms == Alarms::by_hand) world->update_motion(balls + 3, back);
    if (!way.snapshots) continue;
    const Snapshot saved = save(*world);
    world = std::make_unique<World<2>>(options, &log);
    restore(saved, *world);
  }
  return log.events;
}

TEST_CASE("Attached sensors report what sensors do that a listener moves, and change nothing else") {
  std::size_t of_sensors = 0;
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    CAPTURE(seed);
    const auto events = run(seed, Alarms::attached, {});
    CHECK(events == run(seed, Alarms::by_hand, {}));
    std::vector<Event> of_balls;
    std::copy_if(events.begin(), events.end(), std::back_inserter(of_balls),
                 [](const Event& e) { return e.kind == Kind::wall || e.b < balls; });
    CHECK(of_balls == run(seed, Alarms::none, {}));
    of_sensors += events.size() - of_balls.size();
  }
  CHECK(of_sensors > 200);
}

TEST_CASE("Attached sensors report alike, whatever the broad phase, and with snapshots in between") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    CAPTURE(seed);
    const auto expected = run(seed, Alarms::attached, {});
    for (const auto& [method, name, what] : broad_phases) {
      INFO(name);
      CHECK(run(seed, Alarms::attached, {.method = method}) == expected);
      CHECK(run(seed, Alarms::attached, {.method = method, .snapshots = true}) == expected);
      CHECK(run(seed, Alarms::attached, {.method = method, .looks_ahead = true}) == expected);
    }
  }
}

TEST_CASE("An attached sensor is removed with its body, with reports, and goes by itself") {
  EventLog<1> log;
  World<1> world(with_response(Response::none), &log);
  const BodyId owner = world.add_body(ball<1>(1, zero, {1, 0, 0}));
  auto described = ball<1>(3, zero);
  described.sensor = true, described.motion = {}, described.attached_to = owner;
  const BodyId first = world.add_body(described);
  const BodyId second = world.add_body(described);
  CHECK(world.attached_to(first) == owner);
  CHECK_FALSE(world.attached_to(owner));
  const BodyId other = world.add_body(ball<1>(1, {8, 0, 0}));
  world.advance_to(5);
  CHECK(world.motion(first).position(5) == Vector3d(5, 0, 0));
  REQUIRE(world.touching(first, other));
  CHECK(log.events.size() == 2);  // Neither the body nor the other sensor is in contact with it.
  world.remove_body(second);
  world.advance_to(5.5);
  CHECK(log.events.size() == 3);
  CHECK(log.events.back().kind == Kind::separation);
  world.remove_body(owner);
  world.advance_to(6);
  CHECK_FALSE(world.contains(first));
  CHECK(log.events.size() == 4);
  CHECK(log.events.back().kind == Kind::separation);
  CHECK(world.size() == 1);
  world.audit();
}

TEST_CASE("A sensor may be attached in the callback in which its body jumps") {
  struct Attacher final : WorldListener<1> {
    BodyId sensor = 0;
    void timer(World<1>& world, TimerId) override {
      world.update_motion(0, World<1>::Motion::line({20, 0, 0}, zero, world.now()));
      auto described = ball<1>(3, zero);
      described.sensor = true, described.motion = {}, described.attached_to = 0;
      sensor = world.add_body(described);
      world.update_motion(0, World<1>::Motion::line({30, 0, 0}, {1, 0, 0}, world.now()));
    }
  } log;
  WorldOptions options = with_response(Response::none);
  options.broad_phase = GENERATE(BroadPhaseKind::all_pairs, BroadPhaseKind::grid, BroadPhaseKind::kinetic_sap);
  World<1> world(options, &log);
  world.add_body(ball<1>(1, zero));
  world.add_body(ball<1>(1, {33.5, 0, 0}));
  world.set_timer(1);
  world.advance_to(1.5);
  world.audit();
  CHECK(world.touching(1, log.sensor));
  CHECK_FALSE(world.touching(0, 1));
  CHECK(world.motion(log.sensor) == world.motion(0));
}

TEST_CASE("What cannot be attached is refused, and nothing is added") {
  World<1> world(with_response(Response::elastic));
  const BodyId owner = world.add_body(ball<1>(1, zero));
  auto described = ball<1>(2, zero);
  described.attached_to = owner;
  CHECK_THROWS_WITH(world.add_body(described), "attached_to: only a sensor can be attached to a body");
  described.sensor = true;
  CHECK_THROWS_WITH(world.add_body(described), "motion: a sensor that is attached to a body has the motion of that");
  described.motion = {};
  described.attached_to = 7;
  CHECK_THROWS_AS(world.add_body(described), std::out_of_range);
  described.attached_to = owner;
  described.shape = Sphere{-1};
  CHECK_THROWS_AS(world.add_body(described), std::invalid_argument);
  CHECK(world.size() == 1);
  described.shape = Sphere{2};
  const BodyId sensor = world.add_body(described);
  described.attached_to = sensor;
  CHECK_THROWS_WITH(world.add_body(described), "attached_to: body 1 is attached to another itself");
  const auto away = World<1>::Motion::line({1, 0, 0}, zero, 0);
  CHECK_THROWS_WITH(world.update_motion(sensor, away),
                    "World::update_motion: body 1 is attached to body 0, whose motion it has");
  CHECK_THROWS_WITH(world.append_motion(sensor, {}),
                    "World::append_motion: body 1 is attached to body 0, whose motion it has");
  CHECK_THROWS_WITH(world.ignore_pair(owner, owner), "World::ignore_pair: body 0 and itself are no pair");
  CHECK(world.size() == 2);
}

}  // namespace
}  // namespace kds::collision::test_attached
