// Bodies that only report.
#include "tests/collision/random_scenes.hpp"

#include "kds/framework/snapshot.hpp"

#include <catch2/catch.hpp>

#include <memory>
#include <vector>

namespace kds::collision::test_sensors {
namespace {

using namespace tests;

template <int Degree>
std::vector<Event> of_body(const std::vector<Event>& events, BodyId id) {
  std::vector<Event> result;
  for (const Event& e : events) {
    if (e.a == id || (e.kind != Kind::wall && e.b == id)) result.push_back(e);
  }
  return result;
}

/// Balls and boxes that bounce between walls, and perhaps a sensor, which is the last; it flies through them all and is
/// put back to where it began at two times.
std::vector<Event> run(BroadPhaseKind kind, std::uint64_t seed, bool with_sensor, bool with_snapshots) {
  WorldOptions options;
  options.response = Response::elastic;
  options.walls = Walls{{-10, -10, -10}, {10, 10, 10}, 1};
  options.broad_phase = kind;
  options.rate = 7;
  EventLog<2> log;
  auto world = std::make_unique<World<2>>(options, &log);
  Random random(seed);
  const auto place = [&](double most) {
    return Vector3d(random.between(-most, most), random.between(-most, most), random.between(-most, most));
  };
  for (int i = 0; i < 12; ++i) {
    const Shape shape = i % 2 == 0 ? Shape(Sphere{1}) : Shape(Box{{0.8, 0.9, 1}});
    world->add_body(body<2>(shape, motion<2>(place(8), place(3), place(0.2))));
  }
  auto sensor = ball<2>(5, {-14, 0.1, 0.2}, {7, 0, 0});
  sensor.sensor = true;
  if (with_sensor) world->add_body(sensor);
  for (const double t : {1.3, 3.0, 4.5}) {
    world->advance_to(t);
    world->audit();
    if (with_sensor) world->update_motion(12, motion<2>({-14, 0.1, 0.2}, {9, 0, 0}, zero, t));
    if (!with_snapshots) continue;
    const Snapshot saved = save(*world);
    world = std::make_unique<World<2>>(options, &log);
    restore(saved, *world);
  }
  return log.events;
}

TEST_CASE("A sensor changes nothing that happens to others, whatever the broad phase") {
  const auto seed = GENERATE(range(1u, 5u));
  CAPTURE(seed);
  const auto without = run(BroadPhaseKind::all_pairs, seed, false, false);
  const auto expected = run(BroadPhaseKind::all_pairs, seed, true, false);
  const auto sensed = of_body<2>(expected, 12);
  REQUIRE(sensed.size() > 4);
  std::vector<Event> others;
  for (const Event& e : expected) {
    if (std::find(sensed.begin(), sensed.end(), e) == sensed.end()) others.push_back(e);
  }
  CHECK(others == without);
  // It begins and ceases to touch each other body in turn.
  for (BodyId other = 0; other < 12; ++other) {
    bool touches = false;
    for (const Event& e : sensed) {
      if (e.a != other) continue;
      CHECK((e.kind == Kind::separation) == touches);
      touches = !touches;
    }
  }
  for (const auto& [kind, name, what] : broad_phases) {
    INFO(name);
    CHECK(run(kind, seed, true, false) == expected);
    CHECK(run(kind, seed, true, true) == expected);
  }
}

TEST_CASE("A sensor reports as in mode `none`, and passes through walls") {
  for (const Response response : {Response::none, Response::elastic, Response::callback}) {
    WorldOptions options;
    options.response = response;
    options.walls = Walls{{-5, -5, -5}, {5, 5, 5}, 1};
    EventLog<1> log;
    World<1> world(options, &log);
    world.add_body(fixed_body<1>(Sphere{1}, motion<1>({0, 0, 0})));
    auto alarm = ball<1>(2, {-4, 0, 0}, {1, 0, 0});
    alarm.sensor = true;
    const BodyId sensor = world.add_body(alarm);
    CHECK(world.sensor(sensor));
    world.advance_to(3);
    CHECK(world.touching(0, sensor));
    world.advance_to(100);
    CHECK_FALSE(world.touching(0, sensor));
    REQUIRE(log.events.size() == 2);
    CHECK(log.events[0].kind == Kind::contact);
    CHECK(log.events[0].time() == 1);
    CHECK(log.events[1].kind == Kind::separation);
    CHECK(log.events[1].time() == 7);
    CHECK(world.motion(sensor).coefficients[1] == Vector3d(1, 0, 0));
  }
}

TEST_CASE("A sensor that enters in overlap, jumps, or is removed: what begins ends, and ends once") {
  WorldOptions options;
  options.response = Response::elastic;
  EventLog<1> log;
  World<1> world(options, &log);
  world.add_body(ball<1>(1, {0, 0, 0}));
  auto alarm = ball<1>(1, {1, 0, 0});
  alarm.sensor = true;
  const BodyId sensor = world.add_body(alarm);
  world.advance_to(1);
  world.update_motion(sensor, motion<1>({9, 0, 0}, zero, zero, 1));
  world.advance_to(2);
  world.update_motion(sensor, motion<1>({0.5, 0, 0}, zero, zero, 2));
  world.advance_to(3);
  world.remove_body(sensor);
  world.advance_to(4);
  std::vector<Kind> kinds;
  for (const Event& e : log.events) kinds.push_back(e.kind);
  CHECK(kinds == std::vector{Kind::overlap, Kind::separation, Kind::contact, Kind::separation});
}

}  // namespace
}  // namespace kds::collision::test_sensors
