// Kinetic sweep and prune by itself, against brute force over exact numbers.
#include "collision/kinetic_sweep_and_prune.hpp"
#include "kds/audit.hpp"
#include "tests/collision/broad_phase_stress.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

namespace kds::collision {
namespace {

using namespace tests;

template <int Degree>
auto lists(ListedAxes listed) {
  return std::make_unique<KineticSweepAndPrune<Degree>>(0, listed);
}

TEMPLATE_TEST_CASE_SIG("Kinetic sweep and prune under stress", "[broad_phase]", ((int Degree), Degree), 1, 2) {
  const ListedAxes listed = GENERATE(ListedAxes::one, ListedAxes::two, ListedAxes::three);
  std::size_t events = 0;
  std::size_t reports = 0;
  for (const bool coarse : {false, true}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      INFO("degree " << Degree << (coarse ? ", coarse" : ", fine") << " numbers, seed " << seed << ", listed axes "
                     << static_cast<int>(listed));
      Stress<Degree> stress(seed, coarse, lists<Degree>(listed));
      stress.insert(20);
      stress.compare_with_brute_force();
      for (int round = 0; round < 60; ++round) {
        const double step = coarse ? 0.0625 * stress.random.integer(0, 2) : stress.random.between(0, 0.15);
        stress.advance(stress.now + step);
        if (round % 6 == 3) stress.compare_with_brute_force();
        const auto dice = stress.random.below(10);
        if (dice == 0) {
          stress.insert(1 + stress.random.below(3));
        } else if (dice == 1 && stress.boxes.size() > 10) {
          stress.remove();
        } else {
          stress.update();
        }
        // What is due at this very instant comes first, then the state is that of the motions.
        stress.advance(stress.now);
        stress.broad_phase.audit(stress.now);
        if (round % 6 == 0) stress.compare_with_brute_force();
      }
      events += stress.events;
      reports += stress.pairs.reports;
    }
  }
  CHECK(events > 2000);
  CHECK(reports > 1000);
}

TEMPLATE_TEST_CASE_SIG("Pairs begin and end at the times of exact arithmetic, also of boxes that grow",
                       "[broad_phase]", ((int Degree), Degree), 1, 2) {
  const ListedAxes listed = GENERATE(ListedAxes::one, ListedAxes::two, ListedAxes::three);
  constexpr double end = 2;
  std::size_t stretches = 0;
  for (std::uint64_t seed = 1; seed <= 15; ++seed) {
    INFO("degree " << Degree << ", seed " << seed << ", listed axes " << static_cast<int>(listed));
    Stress<Degree> stress(seed, false, lists<Degree>(listed));
    stress.side = 8;
    stress.insert(10);
    struct Report {
      double time;
      BodyId a, b;
      bool began;
      auto operator<=>(const Report&) const = default;
    };
    struct Log final : PairListener {
      std::vector<Report> reports;
      void pair_began(BodyId a, BodyId b, double t) override { reports.push_back({t, a, b, true}); }
      void pair_ended(BodyId a, BodyId b, double t) override { reports.push_back({t, a, b, false}); }
    } log;
    std::vector<Report> expected;
    for (const auto& [a, b] : stress.pairs.now) expected.push_back({0, a, b, true});
    for (const auto& report : expected) log.reports.push_back(report);
    expected.clear();
    while (stress.broad_phase.advance(end, log)) {}
    for (auto a = stress.boxes.begin(); a != stress.boxes.end(); ++a) {
      for (auto b = std::next(a); b != stress.boxes.end(); ++b) {
        for (const auto& s : oracle::overlaps(exact(a->second), exact(b->second), 0, end)) {
          expected.push_back({s.begin.ceiling(), a->first, b->first, true});
          if (s.end) expected.push_back({s.end->ceiling(), a->first, b->first, false});
        }
      }
    }
    std::sort(expected.begin(), expected.end());
    std::sort(log.reports.begin(), log.reports.end());
    REQUIRE(log.reports == expected);
    stretches += expected.size();
  }
  CHECK(stretches > 200);
}

TEST_CASE("An audit sees a box that is not where it was said to be", "[broad_phase]") {
  KineticSweepAndPrune<1> broad_phase(0);
  Pairs pairs;
  Random random(3);
  std::vector<KineticBox<1>> boxes;
  for (int i = 0; i < 5; ++i) boxes.push_back(random_box<1>(random, false, 0, 5));
  std::vector<KineticSweepAndPrune<1>::Entry> entries;
  for (BodyId id = 0; id < 5; ++id) entries.push_back({id, &boxes[id]});
  broad_phase.insert(entries, 0, pairs);
  broad_phase.audit(0);
  REQUIRE(broad_phase.next_time() < 100);
  CHECK_THROWS_AS(broad_phase.audit(-100), AuditFailure);  // the order is another one then
}

TEST_CASE("Removing and inserting again under the same id", "[broad_phase]") {
  Stress<1> stress(9, false, lists<1>(GENERATE(ListedAxes::one, ListedAxes::two, ListedAxes::three)));
  stress.insert(6);
  for (int round = 0; round < 30; ++round) {
    stress.remove();
    stress.insert(1);
    stress.advance(stress.now + 0.1);
    stress.compare_with_brute_force();
  }
  while (!stress.boxes.empty()) stress.remove();
  CHECK(stress.pairs.now.empty());
  CHECK(stress.broad_phase.next_time() == never);
  stress.insert(4);  // the first insertion into an empty structure is another path
  stress.compare_with_brute_force();
}

}  // namespace
}  // namespace kds::collision
