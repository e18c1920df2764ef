// Worlds whose bodies are bounded by k-DOPs: the same contacts from fewer pairs, whatever else the scene does.
#include "tests/collision/event_log.hpp"
#include "tests/collision/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace kds::collision::test_kdops {
namespace {

using namespace tests;

WorldOptions with(int k, Response response = Response::none) {
  WorldOptions options;
  options.broad_phase = BroadPhaseKind::kinetic_sap;
  options.kdop = k;
  options.response = response;
  return options;
}

struct Ran {
  std::vector<Event> contacts;
  WorldCounters counters;
};

/// Runs bodies, with an audit every now and then.
template <int Degree>
Ran run(const std::vector<BodyDescription<Degree>>& bodies, const WorldOptions& options, double end) {
  EventLog<Degree> log;
  World<Degree> world(options, &log);
  for (const auto& body : bodies) world.add_body(body);
  for (int i = 1; i <= 8; ++i) {
    world.advance_to(end * i / 8);
    world.audit();
  }
  Ran ran;
  for (const Event& e : log.events) {
    if (!is_pair_event(e)) ran.contacts.push_back(e);
  }
  ran.counters = world.counters();
  return ran;
}

/// Long thin boxes in any orientation.
std::vector<BodyDescription<1>> rods(std::uint64_t seed, std::size_t n) {
  Random random(seed);
  SceneMaker maker(random, {.shapes = Shapes::turned_boxes, .side = 12});
  std::vector<BodyDescription<1>> bodies;
  for (std::size_t i = 0; i < n; ++i) {
    bodies.push_back(body<1>(Box{{1.5, 0.05, 0.05}}, maker.path<1>(0)));
    bodies.back().orientation = maker.orientation();
  }
  return bodies;
}

}  // namespace

TEST_CASE("Rods have fewer pairs the more directions, and the same contacts", "[kdop][world]") {
  for (const Response response : {Response::none, Response::elastic}) {
    const std::uint64_t seed = 1300;
    CAPTURE(seed, static_cast<int>(response));
    const auto bodies = rods(seed, 120);
    const Ran boxes = run(bodies, with(6, response), 2);
    CHECK(boxes.contacts.size() > 20);
    for (const int k : {14, 18, 26}) {
      CAPTURE(k);
      const Ran dops = run(bodies, with(k, response), 2);
      CHECK(dops.contacts == boxes.contacts);
      CHECK(dops.counters.pairs_begun < boxes.counters.pairs_begun * 0.8);
      CHECK(dops.counters.pair_tests < boxes.counters.pair_tests * 0.8);
    }
  }
}

TEMPLATE_TEST_CASE_SIG("k-DOPs of bodies that bring boxes of their own, or spheres, or come later", "[kdop][world]",
                       ((int Degree), Degree), 1, 2) {
  for (std::uint64_t seed = 1310; seed < 1314; ++seed) {
    Random random(seed);
    SceneMaker maker(random, {.shapes = Shapes::mixture, .side = 5});
    std::vector<BodyDescription<Degree>> bodies;
    for (int i = 0; i < 24; ++i) {
      auto description = body<Degree>(maker.shape(), maker.path<Degree>(0.25 * random.integer(-2, 2)));
      description.orientation = maker.orientation();
      if (i % 3 == 0) description.volume = BoundingVolume::sphere;
      if (i % 3 == 1) {
        const double radius = place(description.shape, description.orientation).bounding_radius;
        description.box = [radius](double t, const certificates::PointMotion<Degree>& motion) {
          auto box = box_around(motion, Vector3d::Constant(-radius), Vector3d::Constant(radius));
          box.valid_until = t + 0.3;
          return box;
        };
      }
      bodies.push_back(std::move(description));
    }
    const Ran boxes = run(bodies, with(6), 2);
    CHECK(boxes.contacts.size() > 20);
    for (const int k : {14, 18, 26}) {
      CAPTURE(Degree, seed, k);
      CHECK(run(bodies, with(k), 2).contacts == boxes.contacts);
    }
  }
}

TEST_CASE("k-DOPs of bodies that are removed, moved and added in the midst of a run", "[kdop][world]") {
  const std::uint64_t seed = 1320;
  const auto drive = [&](int k) {
    Random random(seed);
    SceneMaker maker(random, {.shapes = Shapes::rings, .side = 5});
    EventLog<1> log;
    World<1> world(with(k), &log);
    std::vector<BodyId> ids;
    const auto add = [&](double start) {
      auto description = body<1>(maker.shape(), maker.path<1>(start));
      description.orientation = maker.orientation();
      ids.push_back(world.add_body(description));
    };
    for (int i = 0; i < 20; ++i) add(0);
    for (int i = 0; i < 60; ++i) {
      world.advance_to(i * 0.03125);
      world.audit();
      const std::size_t which = random.below(ids.size());
      const BodyId id = ids[which];
      if (i % 4 == 0) {
        world.remove_body(id);
        ids.erase(ids.begin() + static_cast<std::ptrdiff_t>(which));
        add(world.now());
      } else {
        world.update_motion(id, maker.path<1>(world.now() - (i % 4 == 1 ? 0 : 0.25)));
      }
      world.audit();
    }
    return log.events;
  };
  const auto expected = drive(6);
  CHECK(expected.size() > 60);
  for (const int k : {14, 18, 26}) {
    CAPTURE(seed, k);
    CHECK(drive(k) == expected);
  }
}

TEST_CASE("k-DOPs are of four kinds, and for kinetic sweep and prune", "[kdop][world]") {
  CHECK_THROWS_WITH(World<1>(with(8)), Catch::Matchers::Contains("kdop"));
  CHECK_THROWS_WITH(World<1>(with(0)), Catch::Matchers::Contains("kdop"));
  WorldOptions grid = with(14);
  grid.broad_phase = BroadPhaseKind::grid;
  CHECK_THROWS_WITH(World<1>(grid), Catch::Matchers::Contains("kdop"));
}

}  // namespace kds::collision::test_kdops
