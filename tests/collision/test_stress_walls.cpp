// Fixed bodies and others, many, thrown at walls that take part of their speed or all: with every broad phase, audited
// after every step.
#include "tests/collision/counted_runs.hpp"

#include <catch2/catch.hpp>

#include <cstdint>

namespace kds::collision::test_stress_walls {
namespace {

using namespace tests;

TEMPLATE_TEST_CASE_SIG("stress: fixed bodies that move, between walls with and without rebound", "[world][stress]",
                       ((int Degree), Degree), 1, 2) {
  std::size_t walls = 0;
  std::size_t contacts = 0;
  std::uint64_t suppressed = 0;
  for (const auto response : {Response::none, Response::elastic, Response::callback}) {
    for (const double restitution : {0.0, 0.5}) {
      for (std::uint64_t seed = 640; seed < 643; ++seed) {
        INFO("response " << static_cast<int>(response) << ", restitution " << restitution << ", seed " << seed);
        Random random(seed);
        SceneMaker maker(random, {.shapes = seed % 2 == 0 ? Shapes::mixture : Shapes::spheres,
                                  .numbers = seed % 3 == 0 ? Numbers::coarse : Numbers::fine,
                                  .bodies = 9,
                                  .side = 4,
                                  .scripts = response == Response::none,
                                  .end_time = 4});
        auto scene = maker.scene<Degree>();
        for (std::size_t i = 0; i < scene.bodies.size(); i += 2) scene.bodies[i].fixed = true;
        std::vector<Event> first;
        for (const auto method : all_methods) {
          WorldOptions options = with(response, method);
          options.walls = Walls{Vector3d::Constant(-2), Vector3d::Constant(6), restitution};
          options.report_pairs = false;
          options.zeno = {.contacts = 20, .interval = 1e-4};
          EventLog<Degree> log;
          World<Degree> world(options, &log);
          for (const auto& b : scene.bodies) world.add_body(b);
          int steps = 0;
          while (world.step(scene.end_time) && ++steps < 20000) world.audit();
          REQUIRE(steps < 20000);
          world.audit();
          if (method == all_methods.front()) {
            first = log.events;
            walls += count(first, Kind::wall);
            contacts += count(first, Kind::contact);
            suppressed += world.counters().rebounds_suppressed;
          }
          const bool same = log.events == first;
          INFO("method " << static_cast<int>(method));
          CHECK(same);
        }
      }
    }
  }
  CHECK(walls > 300);
  CHECK(contacts > 150);
  CHECK(suppressed > 50);
}

}  // namespace
}  // namespace kds::collision::test_stress_walls
