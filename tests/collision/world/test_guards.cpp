// Worlds that are called at the wrong moment, or interrupted: by callbacks and by box functions.
#include "kds/framework/snapshot.hpp"
#include "tests/collision/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <typeinfo>
#include <utility>
#include <vector>

namespace kds::collision::test_guards {
namespace {

using namespace tests;

struct Call {
  std::string name;
  std::function<void(World<1>&)> make;
};

std::vector<Call> calls_that_run() {
  return {{"World::step", [](World<1>& w) { w.step(w.now() + 1); }},
          {"World::advance_to", [](World<1>& w) { w.advance_to(w.now() + 1); }},
          {"World::advance_for", [](World<1>& w) { w.advance_for(0, w.now() + 1); }},
          {"World::next_time", [](World<1>& w) { w.next_time(); }},
          {"World::process", [](World<1>& w) { w.process(); }},
          {"World::extend_horizon", [](World<1>& w) { w.extend_horizon(w.now(), w.now() + 1); }},
          {"World::archive", [](World<1>& w) { save(w); }}};
}

std::vector<Call> calls_that_edit() {
  return {{"World::add_body",
           [](World<1>& w) {
             w.add_body(ball<1>(1, {0, 50, 0}));
           }},
          {"World::remove_body", [](World<1>& w) { w.remove_body(1); }},
          {"World::update_motion",
           [](World<1>& w) {
             w.update_motion(1, motion<1>({9, 9, 9}));
           }},
          {"World::reserve", [](World<1>& w) { w.reserve(1000); }}};
}

std::vector<Call> all_calls() {
  std::vector<Call> calls = calls_that_run();
  for (Call& call : calls_that_edit()) calls.push_back(std::move(call));
  return calls;
}

/// What the call throws, which must be a std::logic_error and nothing derived from it.
std::string refusal(const Call& call, World<1>& world) {
  try {
    call.make(world);
  } catch (const std::logic_error& error) {
    return typeid(error) == typeid(std::logic_error) ? error.what() : "of another type";
  } catch (...) {
    return "of another type";
  }
  return "nothing was thrown";
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

WorldOptions options_of(BroadPhaseKind method, Response response = Response::none) {
  WorldOptions options;
  options.broad_phase = method;
  options.response = response;
  options.rate = 16;
  options.report_pairs = true;
  options.walls = Walls{Vector3d::Constant(-20), Vector3d::Constant(20)};
  return options;
}

/// Contacts, overlaps, separations, walls and pairs.
std::vector<BodyDescription<1>> lively() {
  std::vector<BodyDescription<1>> bodies = two_balls();
  bodies.push_back(ball<1>(1, {-6, 0, 0}, {1, 0, 0}));
  bodies.push_back(box<1>({1, 1, 1}, {4.5, 0.5, 0}, {1, 0, 0}));
  return bodies;
}

TEST_CASE("guards: no callback runs, saves or loads its world, which goes on", "[world][guards]") {
  for (const auto method : all_methods) {
    for (const auto response : {Response::none, Response::elastic, Response::callback}) {
      const WorldOptions options = options_of(method, response);
      const std::vector<Event> expected = run<1>({lively(), 30}, options);
      REQUIRE(expected.size() > 10);
      EventLog<1> log;
      std::size_t refused = 0;
      log.then = [&](World<1>& world, const Event& event) {
        const double now = world.now();
        for (const Call& call : calls_that_run()) {
          refused += refusal(call, world) == call.name + ": must not be called from within a callback";
        }
        CHECK(world.now() == now);
        CHECK(event.time() <= now);
      };
      World<1> world(options, &log);
      for (const auto& b : lively()) world.add_body(b);
      world.advance_to(30);
      world.audit();
      CHECK(world.now() == 30);
      CHECK(log.events == expected);
      CHECK(refused == calls_that_run().size() * expected.size());
    }
  }
}

TEST_CASE("guards: what a callback throws comes out of the step, and the run goes on as if it had not",
          "[world][guards]") {
  for (const auto method : all_methods) {
    for (const auto response : {Response::none, Response::elastic, Response::callback}) {
      const WorldOptions options = options_of(method, response);
      const std::vector<Event> expected = run<1>({lively(), 30}, options);
      EventLog<1> log;
      log.then = [](World<1>&, const Event& event) { throw event; };
      World<1> world(options, &log);
      for (const auto& b : lively()) world.add_body(b);
      std::size_t thrown = 0;
      for (bool done = false; !done && thrown < 10 * expected.size();) {
        try {
          world.advance_to(30);
          done = true;
        } catch (const Event& event) {
          ++thrown;
          CHECK(event.time() == world.now());
          world.audit();
        }
      }
      CHECK(world.now() == 30);
      CHECK(thrown == expected.size());
      CHECK(log.events == expected);
      CHECK_NOTHROW(save(world));
    }
  }
}

/// A box for a ball of radius 1 that lasts for a second.
KineticBox<1> box_for_a_second(double t, const certificates::PointMotion<1>& m) {
  auto result = box_around(m, Vector3d::Constant(-1), Vector3d::Constant(1));
  result.valid_until = t + 1;
  return result;
}

TEST_CASE("guards: a box function may look at the world but not change it", "[world][guards]") {
  for (const auto method : all_methods) {
    for (const Call& call : all_calls()) {
      EventLog<1> log;
      World<1> world(options_of(method), &log);
      std::size_t asked = 0, refused = 0;
      auto looking = ball<1>(1, {0, 0, 0});
      looking.box = [&](double t, const auto& m) {
        ++asked;
        CHECK(world.contains(0));
        CHECK(world.size() >= 2);
        CHECK(world.motion(0) == m);
        refused += refusal(call, world) == call.name + ": a box function must not change the world";
        return box_for_a_second(t, m);
      };
      world.add_body(looking);
      world.add_body(ball<1>(1, {4, 0, 0}, {-2, 0, 0}));
      world.advance_to(5.5);
      world.update_motion(0, motion<1>({0, 0, 0}, {1, 0, 0}));
      world.advance_to(6.5);
      world.audit();
      CHECK(asked >= 7);
      CHECK(refused == asked);
      CHECK(log.count(Kind::contact) >= 1);
    }
  }
}

/// How a box function goes wrong, and what is said of it.
struct Mishap {
  std::string name;
  std::function<KineticBox<1>(World<1>&, KineticBox<1>)> then;
};

std::vector<Mishap> mishaps() {
  return {{"out of boxes", [](World<1>&, KineticBox<1>) -> KineticBox<1> { throw std::runtime_error("out of boxes"); }},
          {"no std::exception", [](World<1>&, KineticBox<1>) -> KineticBox<1> { throw 7; }},
          {"must not change the world",
           [](World<1>& world, KineticBox<1> box) {
             world.add_body(ball<1>(1, {0, 0, 0}));
             return box;
           }},
          {"not finite",
           [](World<1>&, KineticBox<1> box) {
             box.min.coefficients[1][1] = never;
             return box;
           }},
          {"validity has ended", [](World<1>& world, KineticBox<1> box) {
             box.valid_until = world.now();
             return box;
           }}};
}

TEST_CASE("guards: after a box function has failed nothing but looking and destroying is left", "[world][guards]") {
  for (const auto method : all_methods) {
    for (const Mishap& mishap : mishaps()) {
      for (const int when : {0, 1, 2, 3}) {  // as it enters, when its box ends, in an edit, in a callback that hides it
        INFO(mishap.name << ", case " << when);
        EventLog<1> log;
        auto world = std::make_unique<World<1>>(options_of(method), &log);
        bool failing = when == 0;
        auto failed = ball<1>(1, {0, 0, 0});
        failed.box = [&](double t, const auto& m) {
          const auto box = box_for_a_second(t, m);
          return failing ? mishap.then(*world, box) : box;
        };
        if (when == 3) {
          log.then = [&](World<1>& w, const Event& event) {
            if (event.kind != Kind::contact) return;
            failing = true;
            CHECK_THROWS(w.update_motion(0, motion<1>({0, 0, 0}, {0, 1, 0})));
            failing = false;
          };
        }
        world->add_body(failed);
        world->add_body(ball<1>(1, {4, 0, 0}, {-2, 0, 0}));
        if (when == 1 || when == 2) world->advance_to(0.5);
        failing = when < 3;
        if (when == 2) {
          CHECK_THROWS(world->update_motion(0, motion<1>({0, 1, 0})));
        } else {
          CHECK_THROWS(world->advance_to(3));
        }
        failing = false;
        const double now = world->now();
        for (const Call& call : all_calls()) {
          const std::string said = refusal(call, *world);
          INFO(said);
          CHECK(contains(said, call.name + ": the world can no longer be used"));
          CHECK(contains(said, mishap.name));
        }
        CHECK_THROWS_AS(world->audit(), std::logic_error);
        CHECK(world->now() == now);
        CHECK(world->size() == 2);
        CHECK(world->contains(1));
        CHECK(world->motion(1).coefficients[1] == Vector3d(-2, 0, 0));
        CHECK(world->free_motion(1) == world->motion(1));
        CHECK(world->mass(0) == 1);
        CHECK(world->shape(0).bounding_radius == 1);
        CHECK_FALSE(world->fixed(0));
        CHECK_FALSE(world->resting(0, 1));
        world->touching(0, 1);
        world->counters();
        CHECK_FALSE(world->broad_phase().empty());
        world.reset();
      }
    }
  }
}

TEST_CASE("guards: what is refused before anything is changed leaves the world whole", "[world][guards]") {
  EventLog<1> log;
  WorldOptions options = options_of(BroadPhaseKind::automatic);
  options.most_edits = 3;
  log.then = [](World<1>& world, const Event& event) {
    if (event.kind != Kind::contact) return;
    for (int i = 0; i < 1000; ++i) world.update_motion(2, motion<1>({0, 9, 0}));
  };
  World<1> world(options, &log);
  for (const auto& b : lively()) world.add_body(b);
  CHECK_THROWS_WITH(world.advance_to(30), Catch::Contains("most_edits"));
  log.then = nullptr;
  CHECK_THROWS_AS(world.add_body(ball<1>(-1, zero)), std::invalid_argument);
  CHECK_THROWS_AS(world.update_motion(0, motion<1>({never, 0, 0})), std::invalid_argument);
  CHECK_THROWS_AS(world.remove_body(77), std::out_of_range);
  world.advance_to(30);
  world.audit();
  CHECK(world.now() == 30);
}

}  // namespace
}  // namespace kds::collision::test_guards
