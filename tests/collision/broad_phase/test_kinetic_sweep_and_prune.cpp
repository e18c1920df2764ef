// Kinetic sweep and prune by itself, against brute force over exact numbers.
#include "collision/broad_phase/kinetic_sweep_and_prune.hpp"
#include "kds/audit.hpp"
#include "tests/collision/broad_phase/broad_phase_stress.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

namespace kds::collision::test_kinetic_sweep_and_prune {
namespace {

using namespace tests;

template <int Degree>
auto lists(ListedAxes listed) {
  return std::make_unique<KineticSweepAndPrune<Degree>>(0, SweepTuning{.listed = listed});
}

struct Report {
  double time;
  BodySlot a, b;
  bool began;
  auto operator<=>(const Report&) const = default;
};

/// Keeps what is reported.
struct Log final : PairListener {
  std::vector<Report> reports;
  void pair_began(BodySlot a, BodySlot b, double t) override { reports.push_back({t, a, b, true}); }
  void pair_ended(BodySlot a, BodySlot b, double t) override { reports.push_back({t, a, b, false}); }
};

TEMPLATE_TEST_CASE_SIG("Kinetic sweep and prune under stress", "[broad_phase]", ((int Degree), Degree), 1, 2) {
  const ListedAxes listed = GENERATE(ListedAxes::one, ListedAxes::all);
  std::size_t events = 0;
  std::size_t reports = 0;
  for (const bool coarse : {false, true}) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
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
  CHECK(events > 400);
  CHECK(reports > 400);
}

TEMPLATE_TEST_CASE_SIG("Pairs begin and end at the times of exact arithmetic, also of boxes that grow", "[broad_phase]",
                       ((int Degree), Degree), 1, 2) {
  const ListedAxes listed = GENERATE(ListedAxes::one, ListedAxes::all);
  constexpr double end = 2;
  std::size_t stretches = 0;
  for (std::uint64_t seed = 1; seed <= 15; ++seed) {
    INFO("degree " << Degree << ", seed " << seed << ", listed axes " << static_cast<int>(listed));
    Stress<Degree> stress(seed, false, lists<Degree>(listed));
    stress.side = 8;
    stress.insert(10);
    Log log;
    std::vector<Report> expected;
    for (const auto& [a, b] : stress.pairs.now) expected.push_back({0, a, b, true});
    for (const auto& report : expected) log.reports.push_back(report);
    expected.clear();
    while (stress.broad_phase.advance(end, log)) {
    }
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

/// All that is reported up to t = 2 by 30 boxes, asked for window by window.
template <int Degree>
std::vector<Report> reports_in_windows(std::uint64_t seed, ListedAxes listed, double window) {
  Random random(seed);
  std::vector<KineticBox<Degree>> boxes;
  for (int i = 0; i < 30; ++i) boxes.push_back(random_box<Degree>(random, false, 0, 9));
  std::vector<typename KineticSweepAndPrune<Degree>::Entry> entries;
  for (BodySlot id = 0; id < 30; ++id) entries.push_back({id, &boxes[id]});
  KineticSweepAndPrune<Degree> broad_phase(0, {.listed = listed});
  Log log;
  broad_phase.extend_horizon(0, std::min(window, 2.0));
  broad_phase.insert(entries, 0, log);
  for (double now = 0; now < 2; now = std::min(now + window, 2.0)) {
    broad_phase.extend_horizon(now, std::min(now + window, 2.0));
    while (broad_phase.advance(std::min(now + window, 2.0), log)) {
    }
    broad_phase.audit(std::min(now + window, 2.0));
  }
  return log.reports;
}

TEMPLATE_TEST_CASE_SIG("Neither which axes are listed nor how far is looked ahead changes a report", "[broad_phase]",
                       ((int Degree), Degree), 1, 2) {
  std::size_t reports = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto expected = reports_in_windows<Degree>(seed, ListedAxes::all, never);
    reports += expected.size();
    for (const auto listed : {ListedAxes::one, ListedAxes::all, ListedAxes::automatic}) {
      for (const double window : {0.03, 0.5, never}) {
        INFO("degree " << Degree << ", seed " << seed << ", listed axes " << static_cast<int>(listed) << ", window "
                       << window);
        CHECK(reports_in_windows<Degree>(seed, listed, window) == expected);
      }
    }
  }
  CHECK(reports > 200);
}

TEST_CASE("The axis with the fewest pairs is listed, and all three for a few bodies", "[broad_phase]") {
  for (const int thin : {0, 1, 2}) {
    Random random(7);
    std::vector<KineticBox<1>> boxes;
    for (int i = 0; i < 64; ++i) {
      KineticBox<1> box = random_box<1>(random, false, 0, 12);
      for (auto* end : {&box.min, &box.max}) end->coefficients[0][thin] = 20 * random.between(0, 12);
      box.max.coefficients[0][thin] = box.min.coefficients[0][thin] + 0.5;
      boxes.push_back(box);
    }
    std::vector<KineticSweepAndPrune<1>::Entry> entries;
    for (BodySlot id = 0; id < 64; ++id) entries.push_back({id, &boxes[id]});
    Log log;
    KineticSweepAndPrune<1> automatic(0);
    automatic.insert(entries, 0, log);
    CHECK(automatic.listed_axes() == 1u << thin);
    KineticSweepAndPrune<1> few(0);
    few.insert(std::span(entries).first(63), 0, log);
    CHECK(few.listed_axes() == 7);
  }
}

TEST_CASE("Lists that change in the midst of a run lose nothing and report nothing", "[broad_phase]") {
  Stress<1> stress(21, false, lists<1>(ListedAxes::automatic));
  const auto& lists_in_use = dynamic_cast<KineticSweepAndPrune<1>&>(stress.broad_phase);
  stress.side = 20;
  stress.insert(20);
  stress.advance(0.2);
  CHECK(lists_in_use.listed_axes() == 7);
  stress.insert(60);  // now they are four times as many
  const unsigned before = lists_in_use.listed_axes();
  CHECK((before == 1 || before == 2 || before == 4));
  stress.broad_phase.audit(stress.now);
  stress.compare_with_brute_force();
  for (int round = 0; round < 30; ++round) {
    stress.advance(stress.now + 0.02);
    stress.update();
  }
  // The boxes flee along the listed axis, come to rest on it and leave the others: another one is better now.
  const auto slow = before;
  for (auto& [id, box] : stress.boxes) {
    for (int d = 0; d < 3; ++d) {
      if ((slow >> d & 1) == 0) continue;
      box.min.coefficients[0][d] = 0.01 * id;
      box.max.coefficients[0][d] = 5 + 0.01 * id;
      box.min.coefficients[1][d] = box.max.coefficients[1][d] = 0;
    }
    stress.broad_phase.update(id, box, stress.now, stress.pairs);
  }
  stress.advance(stress.now);
  const std::size_t reports = stress.pairs.reports;
  stress.broad_phase.extend_horizon(stress.now, never);
  CHECK(stress.pairs.reports == reports);
  CHECK((lists_in_use.listed_axes() & slow) == 0);
  stress.broad_phase.audit(stress.now);
  stress.compare_with_brute_force();
  stress.advance(stress.now + 0.1);
  stress.compare_with_brute_force();
}

TEST_CASE("An audit sees a box that is not where it was said to be", "[broad_phase]") {
  KineticSweepAndPrune<1> broad_phase(0);
  ListedPairs pairs;
  Random random(3);
  std::vector<KineticBox<1>> boxes;
  for (int i = 0; i < 5; ++i) boxes.push_back(random_box<1>(random, false, 0, 5));
  std::vector<KineticSweepAndPrune<1>::Entry> entries;
  for (BodySlot id = 0; id < 5; ++id) entries.push_back({id, &boxes[id]});
  broad_phase.insert(entries, 0, pairs);
  broad_phase.audit(0);
  REQUIRE(broad_phase.next_time() < 100);
  CHECK_THROWS_AS(broad_phase.audit(-100), AuditFailure);  // the order is another one then
}

TEST_CASE("Removing and inserting again under the same id", "[broad_phase]") {
  Stress<1> stress(9, false, lists<1>(GENERATE(ListedAxes::one, ListedAxes::all)));
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
}  // namespace kds::collision::test_kinetic_sweep_and_prune
