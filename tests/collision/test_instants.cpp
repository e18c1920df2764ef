// Things that happen at one instant, found by fuzzing: broad phases must not tell them apart.
#include "tests/collision/event_log.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <functional>
#include <vector>

namespace kds::collision {
namespace {

using namespace tests;

/// The events of a world that `act` uses, with each broad phase; frames of the swept boxes end at eighths.
std::vector<std::vector<Event>> with_each_broad_phase(const std::function<void(World<1>&)>& act) {
  std::vector<std::vector<Event>> logs;
  for (const auto& [kind, name, what] : broad_phases) {
    WorldOptions options;
    options.broad_phase = kind;
    options.rate = 8;
    EventLog<1> log;
    World<1> world(options, &log);
    act(world);
    world.audit();
    logs.push_back(log.events);
  }
  return logs;
}

TEST_CASE("A body that enters at the end of a frame takes nothing from the others", "[instants]") {
  // The swept boxes of the first two reach to 0.5, where the third enters; they meet at 0.5625.
  const auto logs = with_each_broad_phase([](World<1>& world) {
    world.add_body(ball<1>(0.5, {0, 0, 0}, {8, 0, 0}));
    world.add_body(ball<1>(0.5, {10, 0, 0}, {-8, 0, 0}));
    auto late = ball<1>(0.5, {0, 0, 10});
    late.motion[0].start = 0.5;
    world.add_body(late);
    world.advance_to(1);
  });
  REQUIRE(logs[0].size() == 2);
  CHECK(logs[0][0].time() == 0.5625);
  CHECK(logs[1] == logs[0]);
  CHECK(logs[2] == logs[0]);
}

TEST_CASE("Bodies that are moved in turn separate where the last move leaves them", "[instants]") {
  const auto logs = with_each_broad_phase([](World<1>& world) {
    world.add_body(ball<1>(1, {0, 0, 0}));
    world.add_body(ball<1>(1, {1.5, 0, 0}));
    world.advance_to(0.3);
    world.update_motion(0, motion<1>({9, 0, 0}, zero, zero, 0.3));  // their boxes part
    world.update_motion(1, motion<1>({9, 5, 0}, zero, zero, 0.3));
    world.advance_to(1);
  });
  REQUIRE(logs[0].size() == 2);
  CHECK(logs[0][1].kind == Kind::separation);
  CHECK(logs[0][1].contact.normal == Vector3d(0, 1, 0));
  CHECK(logs[1] == logs[0]);
  CHECK(logs[2] == logs[0]);
}

TEST_CASE("A body that is removed separates where it was", "[instants]") {
  const auto logs = with_each_broad_phase([](World<1>& world) {
    world.add_body(ball<1>(1, {0, 0, 0}));
    world.add_body(ball<1>(1, {1.5, 0, 0}));
    world.advance_to(0.25);
    world.remove_body(0);
    world.add_body(ball<1>(1, {50, 0, 0}));  // takes over the id
    world.advance_to(1);
  });
  REQUIRE(logs[0].size() == 2);
  CHECK(logs[0][1].kind == Kind::separation);
  CHECK(logs[0][1].time() == 0.25);
  CHECK(logs[0][1].contact.normal == Vector3d(1, 0, 0));
  CHECK(logs[1] == logs[0]);
  CHECK(logs[2] == logs[0]);
}

TEST_CASE("A body does not enter for one of its id that was removed before it did", "[instants]") {
  const auto logs = with_each_broad_phase([](World<1>& world) {
    world.add_body(ball<1>(1, {5, 0, 0}));
    world.add_body(ball<1>(1, {0, 0, 0}));
    world.remove_body(0);
    auto later = ball<1>(1, {1, 0, 0});
    later.motion[0].start = 0.25;
    REQUIRE(world.add_body(later) == 0);
    world.advance_to(1);
  });
  REQUIRE(logs[0].size() == 1);
  CHECK(logs[0][0].kind == Kind::overlap);
  CHECK(logs[0][0].time() == 0.25);
  CHECK(logs[1] == logs[0]);
  CHECK(logs[2] == logs[0]);
}

}  // namespace
}  // namespace kds::collision
