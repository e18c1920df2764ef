// A world in domains has the events of one world, bit for bit, whatever the domains and the windows.
#include "collision/parallel/parallel_world.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/event_log.hpp"
#include "tests/collision/parallel/parallel_log.hpp"
#include "tests/collision/random_scenes.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::collision::test_parallel_world {
namespace {

using tests::Event;
using tests::EventLog;
using tests::Kind;
using tests::ParallelLog;
using tests::Random;
using tests::Scene;

/// A scene, and how it is run.
template <int Degree>
struct Trial {
  Scene<Degree> scene;
  WorldOptions options;
  std::string what;
};

/// Bodies in a box, of some kinds and sizes, many of which meet at the same times where numbers are coarse.
template <int Degree>
Trial<Degree> trial(std::uint64_t seed) {
  Random random(seed);
  tests::SceneOptions of;
  const std::vector<tests::Shapes> shapes{tests::Shapes::spheres, tests::Shapes::spheres, tests::Shapes::boxes,
                                          tests::Shapes::mixture};
  of.shapes = shapes[random.below(shapes.size())];
  of.numbers = random.one_in(3) ? tests::Numbers::coarse : tests::Numbers::fine;
  of.bodies = of.shapes == tests::Shapes::mixture ? 10 + random.below(15) : 20 + random.below(180);
  of.side = std::cbrt(static_cast<double>(of.bodies)) * random.between(1.5, 4);
  if (of.numbers == tests::Numbers::coarse) of.side = std::ceil(of.side);
  of.heterogeneous = random.one_in(2);
  // Where bodies are accelerated towards walls, they gather there, and the scene is one world from then on.
  of.end_time = of.shapes == tests::Shapes::mixture ? 0.5 : random.between(0.5, Degree == 1 ? 8 : 1.5);
  Trial<Degree> result;
  result.scene = tests::SceneMaker(random, of).template scene<Degree>();
  if (random.one_in(3)) {
    for (auto& body : result.scene.bodies) body.sensor = random.one_in(8);
  }
  if (random.one_in(3)) {
    for (auto& body : result.scene.bodies) body.category = 1u << random.below(2), body.collides_with = 1u + random.below(3);
  }
  if (random.one_in(Degree == 1 ? 4 : 10)) {
    for (auto& body : result.scene.bodies) body.restitution = random.between(0.3, 1);
  }
  result.options.response = random.one_in(3) ? Response::none : Response::elastic;
  if (random.one_in(2)) {
    result.options.walls = Walls{Eigen::Vector3d::Constant(-1), Eigen::Vector3d::Constant(of.side + 1)};
  }
  const std::vector<BroadPhaseKind> kinds{BroadPhaseKind::automatic, BroadPhaseKind::grid, BroadPhaseKind::kinetic_sap};
  result.options.broad_phase = kinds[random.below(kinds.size())];
  result.what = "seed " + std::to_string(seed) + ", " + std::to_string(of.bodies) + " " + tests::name(of.shapes);
  return result;
}

/// What the runs of a test did in all, so that it is seen that there was something to go wrong.
struct Seen {
  std::uint64_t events = 0, windows = 0, failed = 0, whole = 0, corrected = 0;
};

template <int Degree>
void compare(const Trial<Degree>& trial, const ParallelOptions& parallel, std::size_t polls, Seen& seen) {
  INFO(trial.what << ", " << parallel.domains << " domains, halo " << parallel.halo << ", longest window "
                  << parallel.longest_window << ", polls " << polls);
  EventLog<Degree> right;
  World<Degree> world(trial.options, &right);
  for (const auto& body : trial.scene.bodies) world.add_body(body);
  world.advance_to(trial.scene.end_time);

  ParallelLog log;
  ParallelWorld<Degree> divided(trial.options, parallel, &log);
  for (const auto& body : trial.scene.bodies) divided.add_body(body);
  for (std::size_t poll = 1; poll < polls; ++poll) {
    divided.advance_to(trial.scene.end_time * static_cast<double>(poll) / static_cast<double>(polls));
  }
  divided.advance_to(trial.scene.end_time);
  std::erase_if(right.events, [](const Event& e) { return e.kind == Kind::rests || e.kind == Kind::wakes; });
  const std::size_t first = tests::first_difference(right.events, log.events);
  const bool same = first == right.events.size() && first == log.events.size();
  if (!same) {
    UNSCOPED_INFO("events " << right.events.size() << " and " << log.events.size() << ", the first that differs is "
                            << first);
    if (first < right.events.size()) UNSCOPED_INFO("right: " << right.events[first]);
    if (first < log.events.size()) UNSCOPED_INFO("wrong: " << log.events[first]);
  }
  REQUIRE(same);
  const WorldCounters counters = world.counters();
  const ParallelCounters told = divided.counters();
  REQUIRE(told.contacts == counters.contacts);
  REQUIRE(told.separations == counters.separations);
  REQUIRE(told.overlaps == counters.overlaps);
  REQUIRE(told.wall_contacts == counters.wall_contacts);
  for (BodyId id = 0; id < trial.scene.bodies.size(); ++id) REQUIRE(divided.motion(id) == world.motion(id));
  seen.events += log.events.size(), seen.windows += told.windows, seen.failed += told.windows_failed;
  seen.whole += told.stretches_whole, seen.corrected += told.copies_corrected;
}

template <int Degree>
void compare_seeds(std::uint64_t first, std::uint64_t count, Seen& seen) {
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const auto one = trial<Degree>(seed);
    Random random(seed + 0x9e3779b97f4a7c15);
    ParallelOptions parallel;
    parallel.threads = 1 + random.below(3);
    parallel.domains = 2 + random.below(7);
    parallel.halo = random.between(0.3, 4);
    if (random.one_in(3)) parallel.longest_window = random.between(0.01, 0.3);
    compare(one, parallel, 1 + random.below(4), seen);
  }
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("A world in domains has the events of one world", "[parallel]", ((int Degree), Degree), 1, 2) {
  Seen seen;
  const char* const seeds = std::getenv("KDS_PARALLEL_SEEDS");
  const char* const from = std::getenv("KDS_PARALLEL_FROM");
  compare_seeds<Degree>(from ? std::stoull(from) : 1, seeds ? std::stoull(seeds) : 60, seen);
  UNSCOPED_INFO("events " << seen.events << ", windows " << seen.windows << ", failed " << seen.failed
                          << ", stretches whole " << seen.whole << ", copies corrected " << seen.corrected);
  CHECK(seen.windows > 100);
  CHECK(seen.failed > 0);
  CHECK(seen.corrected > 0);
  CHECK(seen.events > 4000);
  if (seeds) std::cout << seen.events << " events, " << seen.windows << " windows, " << seen.failed << " failed, " << seen.whole << " whole, " << seen.corrected << " corrected\n";
}

}  // namespace kds::collision::test_parallel_world
