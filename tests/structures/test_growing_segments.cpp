// Segments that grow until they meet, against a simulation in rational numbers.
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"
#include "kds/testing/trial.hpp"
#include "structures/growing_segments.hpp"
#include "tests/structures/growing_definition.hpp"
#include "tests/structures/random_values.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace test_growing_segments {

using namespace kds;
using namespace kds::tests;
using namespace kds::tests::growing;

TEST_CASE("growing segments stop where the definition says, whatever comes, goes or coincides", "[growing_segments]") {
  std::size_t stopped = 0;
  for (const Scene scene : {Scene::generic, Scene::lattice, Scene::crossroads, Scene::coarse_clock}) {
    for (std::uint64_t seed = 1; seed <= 25; ++seed) {
      CAPTURE(static_cast<int>(scene), seed);
      Random random(seed);
      Structure structure(beginning(scene));
      Id count = 0;
      for (int i = 0; i < 10; ++i) {
        GrowingEnd end = random_end(random, scene, structure.simulator.now());
        structure.insert(count++, end);
        for (Polynomial<1>& x : end.path.coordinate) x.c[1] = -x.c[1];
        if (!end.whole) structure.insert(count++, end);
      }
      int wrong = 0;
      for (int step = 0; step < 6; ++step) {
        wrong += structure.run_to(structure.simulator.now() + span(scene) * static_cast<double>(random.below(3)));
        const Id id = static_cast<Id>(random.below(count));
        if (structure.ends.contains(id) && random.one_in(2)) structure.remove(id);
        structure.insert(count++, random_end(random, scene, structure.simulator.now()));
      }
      wrong += structure.run_to(structure.simulator.now() + 8 * span(scene));
      REQUIRE(wrong == 0);
      for (const Id id : structure.ends.ids()) stopped += structure.segments.rule().stopped_by(id) != nobody;
    }
  }
  CHECK(stopped > 1000);
}

TEST_CASE("growing segments that are many stop where the definition says, among others that come and go",
          "[growing_segments]") {
  for (const Scene scene : {Scene::generic, Scene::lattice, Scene::coarse_clock}) {
    for (std::uint64_t seed = 40; seed < 48; ++seed) {
      CAPTURE(static_cast<int>(scene), seed);
      Random random(seed);
      Structure structure(beginning(scene));
      Id count = 0;
      for (; count < 60; ++count) structure.insert(count, random_end(random, scene, structure.simulator.now()));
      int wrong = 0;
      for (int step = 0; step < 12; ++step) {
        wrong +=
            structure.run_to(structure.simulator.now() + 0.25 * span(scene) * static_cast<double>(random.below(3)));
        const Id id = static_cast<Id>(random.below(count));
        if (structure.ends.contains(id)) structure.remove(id);
        structure.insert(count++, random_end(random, scene, structure.simulator.now()));
      }
      CHECK(wrong == 0);
    }
  }
}

TEST_CASE("a trial of growing segments finds nothing wrong", "[growing_segments]") {
  const auto make = [](Random& random, Kind kind, double now) {
    GrowingEnd end{random_plane_motion<1>(random, kind, now)};
    end.whole = random.one_in(8);
    return end;
  };
  std::size_t events = 0;
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      CAPTURE(static_cast<int>(kind), seed);
      const auto findings = testing::try_rule({.seed = seed, .kind = kind}, GrowingSegmentsRule{}, make,
                                              [](const auto&, const auto&, double) { return std::uint64_t{0}; });
      CHECK(findings.first == "");
      events += findings.events.size();
    }
  }
  CHECK(events > 100);
}

TEST_CASE("growing segments: degeneracies", "[growing_segments][degeneracy]") {
  Structure structure(0);
  const auto stopped_by = [&](Id id) { return structure.segments.rule().stopped_by(id); };
  SECTION("two that come to one point at one time both stop, and so does a third that comes there later") {
    structure.insert(0, end_at(-1, 0, 1, 0));
    structure.insert(1, end_at(0, -1, 0, 1));
    structure.insert(2, end_at(2, 2, -1, -1));
    CHECK(structure.run_to(5) == 0);
    CHECK(std::array{stopped_by(0), stopped_by(1), stopped_by(2)} == std::array<Id, 3>{1, 0, 0});
  }
  SECTION("one that has stopped short of a crossing lets the other through") {
    structure.insert(0, end_at(0, 0, 1, 0));
    structure.insert(1, line_at(3, 0, 0, 1));
    structure.insert(2, end_at(4, -9, 0, 1));
    CHECK(structure.run_to(20) == 0);
    CHECK(std::array{stopped_by(0), stopped_by(2)} == std::array<Id, 2>{1, nobody});
  }
  SECTION("on one line ends stop where they face each other, and behind another's beginning") {
    structure.insert(0, end_at(0, 0, 1, 0));
    structure.insert(1, end_at(4, 0, -1, 0));
    structure.insert(2, end_at(-9, 0, 2, 0));
    structure.insert(3, end_at(20, 0, 1, 0));
    CHECK(structure.run_to(20) == 0);
    CHECK(std::array{stopped_by(0), stopped_by(1), stopped_by(2), stopped_by(3)} == std::array<Id, 4>{1, 0, 0, nobody});
    CHECK(structure.segments.rule().tip(structure.ends[2], 2, 20) == std::array{0.0, 0.0});
  }
  SECTION("one that begins on the track of another crosses it, and one at rest is an obstacle of no length") {
    structure.insert(0, end_at(0, 0, 1, 0));
    structure.insert(1, end_at(3, 4, 0, 0));
    CHECK(structure.run_to(2) == 0);
    structure.insert(2, end_at(1, 0, 0, 1, 2));
    structure.insert(3, end_at(3, 0, 0, 1, 2));
    CHECK(structure.run_to(20) == 0);
    CHECK(std::array{stopped_by(0), stopped_by(2), stopped_by(3)} == std::array<Id, 3>{3, nobody, 1});
  }
  SECTION("one that is still to begin meets nothing before, and is no obstacle") {
    structure.insert(0, end_at(0, 0, 1, 0, 5));
    structure.insert(1, line_at(-2, 0, 0, 1));
    structure.insert(2, end_at(3, -2, 0, 1));
    structure.insert(3, end_at(1, -9, 0, 1));
    structure.insert(4, end_at(2, 0, 1, 0, 9));
    structure.insert(5, end_at(-1, 0, 1, 0));
    CHECK(structure.run_to(20) == 0);
    CHECK(std::array{stopped_by(0), stopped_by(2), stopped_by(3), stopped_by(5)} == std::array<Id, 4>{2, nobody, 0, 2});
  }
  SECTION("what stopped an end may go: the end stays") {
    structure.insert(0, end_at(0, 0, 1, 0));
    structure.insert(1, line_at(3, 0, 0, 1));
    CHECK(structure.run_to(4) == 0);
    structure.remove(1);
    CHECK(structure.run_to(9) == 0);
    CHECK(structure.segments.rule().stop_time(0) == 3);
  }
}

TEST_CASE("of many ends, those that are inserted when they begin do as those that were there before",
          "[growing_segments]") {
  const std::uint64_t seed = 780;
  CAPTURE(seed);
  Random random(seed);
  constexpr Id n = 600;  // many more than an end keeps in order
  std::vector<GrowingEnd> ends;
  for (Id id = 0; id < n; ++id) {
    const double start = id % 2 == 0 ? 0 : random.between(0, 0.4);
    ends.push_back(end_at(random.unit(), random.unit(), random.between(-1, 1), random.between(-1, 1), start));
  }
  MovingSet<GrowingEnd> all, some;
  for (Id id = 0; id < n; ++id) {
    all.insert(id, ends[id], 0);
    if (ends[id].path.start == 0) some.insert(id, ends[id], 0);
  }
  Kinetic<GrowingSegmentsRule> known(all, 0), told(some, 0);
  Simulator known_before(0, known), told_later(0, told);
  std::vector<Id> later;
  for (Id id = 0; id < n; ++id) {
    if (!some.contains(id)) later.push_back(id);
  }
  std::sort(later.begin(), later.end(), [&](Id a, Id b) { return ends[a].path.start < ends[b].path.start; });
  for (const Id id : later) {
    told_later.advance_to(ends[id].path.start);
    some.insert(id, ends[id], ends[id].path.start);
  }
  int wrong = 0, stopped = 0;
  for (double t = 0.5; t < 4; t += 0.5) {
    known_before.advance_to(t), told_later.advance_to(t);
    known_before.audit(), told_later.audit();
    for (Id id = 0; id < n; ++id) {
      wrong += known.rule().stop_time(id) != told.rule().stop_time(id);
      wrong += known.rule().stopped_by(id) != told.rule().stopped_by(id);
      stopped += t == 3.5 && told.rule().stopped_by(id) != nobody;
    }
  }
  CHECK(wrong == 0);
  CHECK(stopped > 500);
}

}  // namespace test_growing_segments
