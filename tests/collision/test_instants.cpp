// Things that happen at one instant, found by fuzzing: broad phases must not tell them apart.
#include "tests/collision/event_log.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace kds::collision::test_instants {
namespace {

using namespace tests;

/// The events of a world that `act` uses and `react` changes in callbacks. They must be the same, in the same order,
/// with each broad phase; frames of the swept boxes end at eighths.
using Act = std::function<void(World<1>&)>;
using React = std::function<void(World<1>&, const Event&)>;
std::vector<Event> with_each_broad_phase(bool pairs, const Act& act, const React& react = {}) {
  std::vector<Event> first;
  for (const auto& [kind, name, what] : broad_phases) {
    WorldOptions options;
    options.broad_phase = kind;
    options.rate = 8;
    options.report_pairs = pairs;
    EventLog<1> log;
    log.then = react;
    World<1> world(options, &log);
    act(world);
    world.audit();
    if (kind == broad_phases.front().kind) first = log.events;
    INFO(name);
    CHECK(log.events == first);
  }
  return first;
}

/// Its slot, with a stroke for each body that was removed from there before it.
std::string shown(BodyId id) { return std::to_string(body_slot(id)) + std::string(body_generation(id), '\''); }

/// Kind and bodies of each, for short.
std::vector<std::string> told(const std::vector<Event>& events) {
  std::vector<std::string> result;
  for (const Event& e : events) result.push_back(std::string(name(e.kind)) + ' ' + shown(e.a) + ' ' + shown(e.b));
  return result;
}
using Told = std::vector<std::string>;

TEST_CASE("Balls that part again at the only double at which they penetrate are in contact there", "[instants]") {
  constexpr double start = 1, spacing = 0x1p-52;  // of doubles from there on; the balls are nearest after 1.7 spacings
  const auto log = with_each_broad_phase(false, [](World<1>& world) {
    for (const auto& [x, speed] : {std::pair(0.0, 0.0), std::pair(-3.0, 1.75 / spacing)}) {
      auto body = ball<1>(0.5, {x, 0, 0}, {speed, 0, 0});
      body.motion[0].start = start;
      world.add_body(body);
    }
    world.advance_to(2);
  });
  CHECK(told(log) == Told{"contact 0 1", "separation 0 1"});
  REQUIRE(log.size() == 2);
  CHECK(log[0].time() == start + 2 * spacing);
  CHECK(log[1].time() == start + 3 * spacing);
}

TEST_CASE("A body that enters at the end of a frame takes nothing from the others", "[instants]") {
  // The swept boxes of the first two reach to 0.5, where the third enters; they meet at 0.5625.
  const auto log = with_each_broad_phase(false, [](World<1>& world) {
    world.add_body(ball<1>(0.5, {0, 0, 0}, {8, 0, 0}));
    world.add_body(ball<1>(0.5, {10, 0, 0}, {-8, 0, 0}));
    auto late = ball<1>(0.5, {0, 0, 10});
    late.motion[0].start = 0.5;
    world.add_body(late);
    world.advance_to(1);
  });
  REQUIRE(log.size() == 2);
  CHECK(log[0].time() == 0.5625);
}

TEST_CASE("Bodies that are moved in turn separate where the last move leaves them", "[instants]") {
  const auto log = with_each_broad_phase(false, [](World<1>& world) {
    world.add_body(ball<1>(1, {0, 0, 0}));
    world.add_body(ball<1>(1, {1.5, 0, 0}));
    world.advance_to(0.3);
    world.update_motion(0, motion<1>({9, 0, 0}, zero, zero, 0.3));  // their boxes part
    world.update_motion(1, motion<1>({9, 5, 0}, zero, zero, 0.3));
    world.advance_to(1);
  });
  REQUIRE(log.size() == 2);
  CHECK(log[1].kind == Kind::separation);
  CHECK(log[1].contact.normal == Vector3d(0, 1, 0));
}

TEST_CASE("A body that is removed separates where it was", "[instants]") {
  const auto log = with_each_broad_phase(false, [](World<1>& world) {
    world.add_body(ball<1>(1, {0, 0, 0}));
    world.add_body(ball<1>(1, {1.5, 0, 0}));
    world.advance_to(0.25);
    world.remove_body(0);
    world.add_body(ball<1>(1, {50, 0, 0}));  // takes over the slot
    world.advance_to(1);
  });
  REQUIRE(log.size() == 2);
  CHECK(log[1].kind == Kind::separation);
  CHECK(log[1].time() == 0.25);
  CHECK(log[1].contact.normal == Vector3d(1, 0, 0));
}

TEST_CASE("A body does not enter for one of its slot that was removed before it did", "[instants]") {
  const auto log = with_each_broad_phase(false, [](World<1>& world) {
    world.add_body(ball<1>(1, {5, 0, 0}));
    world.add_body(ball<1>(1, {0, 0, 0}));
    world.remove_body(0);
    auto later = ball<1>(1, {1, 0, 0});
    later.motion[0].start = 0.25;
    REQUIRE(world.add_body(later) == body_id(1, 0));  // the slot is given again at once
    world.advance_to(1);
  });
  REQUIRE(log.size() == 1);
  CHECK(log[0].kind == Kind::overlap);
  CHECK(log[0].time() == 0.25);
}

TEST_CASE("Pairs that begin at one time are told by their bodies, then their contacts", "[instants]") {
  // All reach the resting cube at 1, and so do their boxes.
  const auto log = with_each_broad_phase(true, [](World<1>& world) {
    const auto small = [](const Vector3d& c0, const Vector3d& c1) { return box<1>({0.5, 0.5, 0.5}, c0, c1); };
    world.add_body(small({0, 0, 4.5}, {0, 0, -3}));
    world.add_body(small({0, -3.5, 0}, {0, 2, 0}));
    world.add_body(box<1>({1, 1, 1}, zero));
    world.add_body(small({2.5, 0, 0}, {-1, 0, 0}));
    world.advance_to(1);
  });
  CHECK(told(log) ==
        Told{"pair_began 0 2", "pair_began 1 2", "pair_began 2 3", "contact 0 2", "contact 1 2", "contact 2 3"});
}

TEST_CASE("A jump ends what touched in the order of the bodies, contacts among it", "[instants]") {
  // At 1 body 1 jumps from 0 and 3 to 2 and 4: its pairs part and meet by the jump, contacts are found at that time.
  const auto log = with_each_broad_phase(true, [](World<1>& world) {
    world.add_body(ball<1>(1, {0, 0, 0}));
    auto jumping = ball<1>(1, {1, 0, 0});
    jumping.motion.push_back(motion<1>({51, 0, 0}, zero, zero, 1));
    world.add_body(jumping);
    world.add_body(ball<1>(1, {50, 0, 0}));
    world.add_body(ball<1>(1, {2, 0.5, 0}));
    world.add_body(ball<1>(1, {52, 0.5, 0}));
    world.advance_to(2);
  });
  const auto first = std::find_if(log.begin(), log.end(), [](const Event& e) { return e.time() == 1; });
  CHECK(told({first, log.end()}) == Told{"pair_ended 0 1", "pair_began 1 2", "pair_ended 1 3", "pair_began 1 4",
                                         "separation 0 1", "contact 1 2", "separation 1 3", "contact 1 4"});
}

TEST_CASE("A callback takes a body away before all of its overlaps are told, and puts another in its place",
          "[instants]") {
  // Three balls overlap. When that of 0 and 1 is told, 1 goes and a smaller ball comes in its place.
  const auto log = with_each_broad_phase(
      true,
      [](World<1>& world) {
        world.add_body(ball<1>(1, {0, 0, 0}));
        world.add_body(ball<1>(1, {1, 0, 0}));
        world.add_body(ball<1>(1, {0, 1, 0}));
        world.advance_to(1);
      },
      [](World<1>& world, const Event& e) {
        if (e.kind != Kind::overlap || e.b != 1) return;
        world.remove_body(1);
        CHECK(world.add_body(ball<1>(0.5, {1, 0, 0})) == body_id(1, 1));
      });
  CHECK(told(log) == Told{"pair_began 0 1", "pair_began 0 2", "pair_began 1 2", "overlap 0 1",  // then it goes
                          "pair_ended 0 1", "pair_began 0 1'", "pair_ended 1 2", "pair_began 2 1'", "separation 0 1",
                          "overlap 0 2", "overlap 0 1'", "overlap 2 1'"});
}

TEST_CASE("Bodies are said to touch until their separation is told", "[instants]") {
  // 1 jumps away from 0 and 2; the box of 1 parts from theirs at once.
  std::vector<bool> touching;
  const auto log = with_each_broad_phase(
      false,
      [](World<1>& world) {
        world.add_body(ball<1>(1, {0, 0, 0}));
        auto jumping = ball<1>(1, {1, 0, 0});
        jumping.motion.push_back(motion<1>({51, 0, 0}, zero, zero, 0.3));
        world.add_body(jumping);
        world.add_body(ball<1>(1, {0, 1.5, 0}));
        world.advance_to(1);
      },
      [&](World<1>& world, const Event& e) {
        if (e.kind == Kind::separation)
          touching.push_back(world.touching(1, 0)), touching.push_back(world.touching(1, 2));
      });
  CHECK(log.back().kind == Kind::separation);
  REQUIRE(touching.size() == 4 * broad_phases.size());
  for (std::size_t i = 0; i < touching.size(); ++i) CHECK(touching[i] == (i % 4 == 1));
}

TEST_CASE("A jump in a callback takes back the overlaps that it ends before they are told", "[instants]") {
  // 1 overlaps 0 and 2. When the first of these overlaps is told, 2 jumps: away, or to where it overlaps 1 less.
  const double to = GENERATE(50.0, 3.25);
  const Told expected = to == 50 ? Told{"overlap 0 1"} : Told{"overlap 0 1", "overlap 1 2"};
  for (const auto& [kind, name, what] : broad_phases) {
    WorldOptions options;
    options.response = Response::elastic;
    options.broad_phase = kind;
    options.rate = 8;
    EventLog<1> log;
    log.then = [&](World<1>& world, const Event& e) {
      if (e.b == 1) world.update_motion(2, motion<1>({to, 0, 0}, zero));
    };
    World<1> world(options, &log);
    for (const double x : {0.0, 1.5, 3.0}) world.add_body(ball<1>(1, {x, 0, 0}));
    world.advance_to(1);
    INFO(name);
    CHECK(told(log.events) == expected);
  }
}

TEST_CASE("A script's jump and an end that passes another at one instant make one overlap", "[instants]") {
  // Ball 1 jumps up beside ball 2 as that comes to touch it from the side, up to roundings: in the sorted lists that is
  // due at the double of the jump, and comes after it.
  int overlaps = 0;
  for (int i = 0; i < 100; ++i) {
    CAPTURE(i);
    const double start = 200 + 0.37 * i, speed = 50 + (i * 37) % 900, jump = start + 1 / speed;
    std::vector<Event> first;
    for (const auto& [kind, name, what] : broad_phases) {
      WorldOptions options;
      options.start_time = start;
      options.response = Response::elastic;
      options.broad_phase = kind;
      options.rate = 100;
      EventLog<1> log;
      World<1> world(options, &log);
      const auto add = [&](const Vector3d& at, const Vector3d& velocity) {
        auto body = ball<1>(0.5, at, velocity);
        body.motion[0].start = start;
        return body;
      };
      world.add_body(add({0, 1, 2}, {speed, speed, 0}));
      auto jumping = add({0, 1, 0}, {0, -speed, 0});
      jumping.motion.push_back(motion<1>({0, 1, 0}, {0, speed, 0}, zero, jump));
      world.add_body(jumping);
      world.add_body(add({2, 1, 0}, {-speed, 0, 0}));
      world.advance_to(start + 0.1);
      if (kind == broad_phases.front().kind) first = log.events;
      INFO(name);
      CHECK(log.events == first);
    }
    for (const Event& event : first) overlaps += event.kind == Kind::overlap;
  }
  CHECK(overlaps > 20);
}

}  // namespace
}  // namespace kds::collision::test_instants
