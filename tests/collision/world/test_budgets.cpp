// advance_for(): work that is divided, and the log that does not depend on it.
#include "kds/framework/snapshot.hpp"
#include "tests/collision/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <cstddef>
#include <memory>
#include <vector>

namespace kds::collision::test_budgets {
namespace {

using namespace tests;

struct Way {
  BroadPhaseKind method = BroadPhaseKind::automatic;
  bool budgets = false;
  bool snapshots = false;
  std::size_t room = 0;  ///< for so many bodies from the beginning
};
struct Result {
  std::vector<Event> events;
  std::size_t calls = 0;
};

constexpr std::size_t bodies = 360;
constexpr double end = 0.25;  // s

/// Many bodies enter at once, some of them in contact; as many again enter while it runs, and some are moved. As many
/// begin their motions at one time to come, at which some others jump.
Result run(Response response, const Way& way) {
  WorldOptions options = with_response(response);
  options.walls = Walls{{-9, -9, -9}, {9, 9, 9}, 1};
  options.broad_phase = way.method;
  options.rate = 30;
  options.report_pairs = false;
  Result result;
  EventLog<2> log;
  auto world = std::make_unique<World<2>>(options, &log);
  world->reserve(way.room);
  Random random(7);
  const auto vector = [&](double most) {
    return Vector3d(random.between(-most, most), random.between(-most, most), random.between(-most, most));
  };
  constexpr double late_start = 0.15;  // s
  const auto add = [&](double start) {
    for (std::size_t i = 0; i < bodies; ++i) {
      auto described = body<2>(i % 8 == 0 ? Shape(Box{{0.3, 0.4, 0.5}}) : Shape(Sphere{0.4}),
                               motion<2>(vector(8), vector(4), vector(1), start));
      described.sensor = i % 50 == 0;
      world->add_body(described);
    }
  };
  const auto advance = [&](double t) {
    if (!way.budgets) return world->advance_to(t);
    while (!world->advance_for(0, t)) {
      ++result.calls;
      if (way.snapshots && result.calls % 16 == 0) {
        const Snapshot saved = save(*world);
        world = std::make_unique<World<2>>(options, &log);
        restore(saved, *world);
      }
    }
  };
  add(0);
  add(late_start);
  advance(0.1);
  add(world->now());
  for (BodyId id = 40; id < 3 * bodies; id += 30) {
    if (id >= bodies && id < 2 * bodies) continue;
    const World<2>::Motion jump[] = {motion<2>(vector(8), vector(4), zero, late_start)};
    world->append_motion(id, jump);
  }
  for (BodyId id = 0; id < 40; ++id) world->update_motion(id, motion<2>(vector(8), vector(4), zero, world->now()));
  advance(end);
  world->audit();
  result.events = log.events;
  return result;
}

TEST_CASE("What is done for budgets gives the log that is made in one go") {
  const auto response = GENERATE(Response::none, Response::elastic);
  const Result whole = run(response, {});
  CHECK(whole.events.size() > 60);
  for (const auto method : {BroadPhaseKind::automatic, BroadPhaseKind::grid, BroadPhaseKind::sap}) {
    for (const bool snapshots : {false, true}) {
      CAPTURE(static_cast<int>(method), snapshots);
      const Result parts = run(response, {method, true, snapshots});
      CHECK(parts.calls > whole.events.size() + 2 * bodies / 64);  // Bodies enter in parts.
      CHECK(parts.events == whole.events);
    }
  }
}

TEST_CASE("Room that is made beforehand changes no event, whenever it is made and for however many") {
  const Result whole = run(Response::elastic, {});
  for (const auto method : {BroadPhaseKind::automatic, BroadPhaseKind::grid, BroadPhaseKind::kinetic_sap}) {
    for (const std::size_t room : {std::size_t{40}, 5 * bodies}) {
      CAPTURE(static_cast<int>(method), room);
      CHECK(run(Response::elastic, {method, false, false, room}).events == whole.events);
      CHECK(run(Response::elastic, {method, true, true, room}).events == whole.events);
    }
  }
  // In the middle, and where bodies become so few that another broad phase takes over, and many again.
  EventLog<1> log, log_of_other;
  World<1> world(with_response(Response::none), &log), other(with_response(Response::none), &log_of_other);
  Random random(8);
  for (int round = 0; round < 4; ++round) {
    for (int i = 0; i < 200; ++i) {
      const auto place = [&] { return random.between(-10, 10); };
      const auto added = ball<1>(1, {place(), place(), place()}, {place(), place(), place()});
      world.add_body(added), other.add_body(added);
    }
    world.reserve(static_cast<std::size_t>(300 * round));
    for (World<1>* of : {&world, &other}) {
      of->advance_to(of->now() + 0.1);
      of->audit();
      std::size_t left = of->size();
      of->visit_bodies([&](BodyId id) {
        if (left-- > 10) of->remove_body(id);
      });
      of->advance_to(of->now() + 0.1);
    }
  }
  CHECK(log.events.size() > 400);
  CHECK(log.events == log_of_other.events);
}

TEST_CASE("Some bodies that begin their motions at one time have, and the world can be edited, asked and saved") {
  EventLog<1> log, log_of_copy, log_of_whole;
  World<1> world(with_response(Response::none), &log), copy(with_response(Response::none), &log_of_copy),
      whole(with_response(Response::none), &log_of_whole);
  constexpr BodyId count = 1000;
  const auto line = [](double x, double start) { return World<1>::Motion::line({x, 0, 0}, zero, start); };
  for (World<1>* of : {&world, &whole}) {
    for (BodyId i = 0; i < count; ++i) {
      auto described = ball<1>(1, zero);
      described.motion = {line(1.5 * static_cast<double>(i), 1), line(1.5 * static_cast<double>(i), 2)};
      of->add_body(described);
    }
  }
  while (world.now() < 1) CHECK_FALSE(world.advance_for(0, 3));
  CHECK(log.events.empty());
  std::size_t found = 0;
  const auto far = Vector3d::Constant(1e6);
  world.visit_overlapping(-far, far, [&](BodyId) { ++found; });
  CHECK(found == 64);  // one part
  CHECK(world.next_time() == 1);
  restore(save(world), copy);
  for (World<1>* of : {&world, &copy}) {
    of->advance_to(1.5);
    of->audit();
    of->advance_to(3);
  }
  whole.advance_to(3);
  CHECK(log.count(Kind::overlap) == count - 1);
  CHECK(log.events == log_of_whole.events);
  CHECK(log_of_copy.events == log_of_whole.events);
}

TEST_CASE("Bodies that begin at one time may be removed when some of them have begun, all that wait included") {
  EventLog<1> log;
  World<1> world(with_response(Response::none), &log);
  constexpr BodyId count = 300;
  for (BodyId i = 0; i < count; ++i) {
    auto described = ball<1>(1, zero);
    described.motion = {World<1>::Motion::line({1.5 * static_cast<double>(i), 0, 0}, zero, 1)};
    world.add_body(described);
  }
  while (world.now() < 1) CHECK_FALSE(world.advance_for(0, 3));
  for (BodyId id = 0; id < 64; ++id) world.remove_body(id);
  CHECK(world.next_time() == 1);
  world.update_motion(count - 1, World<1>::Motion::line({-50, 0, 0}, zero, 1));
  CHECK(world.next_time() == 1);
  while (!world.advance_for(0, 3)) world.next_time();
  CHECK(log.count(Kind::overlap) == count - 64 - 2);
  world.audit();
}

TEST_CASE("Half of the bodies have entered when a budget is used up, and the world can be edited and asked") {
  EventLog<1> log;
  World<1> world(with_response(Response::none), &log);
  constexpr BodyId count = 1000;
  for (BodyId i = 0; i < count; ++i) world.add_body(ball<1>(1, {1.5 * static_cast<double>(i), 0, 0}));
  CHECK_FALSE(world.advance_for(0, 1));
  CHECK(world.now() == 0);
  CHECK(log.events.empty());
  std::size_t found = 0;
  const auto far = Vector3d::Constant(1e6);
  world.visit_overlapping(-far, far, [&](BodyId) { ++found; });
  CHECK(found == count);
  world.remove_body(0);
  world.remove_body(count - 1);
  world.update_motion(1, World<1>::Motion::line({-10, 0, 0}, zero, 0));
  world.advance_to(1);
  CHECK(log.count(Kind::overlap) == count - 4);  // of the neighbours that are left
  world.audit();
}

}  // namespace
}  // namespace kds::collision::test_budgets
