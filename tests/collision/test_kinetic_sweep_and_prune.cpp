// Kinetic sweep and prune by itself, against brute force over exact numbers.
#include "collision/kinetic_sweep_and_prune.hpp"
#include "kds/audit.hpp"
#include "tests/support/exact_models.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace kds::collision {
namespace {

using kds::tests::Random;
using Eigen::Vector3d;

template <int Degree>
certificates::PointMotion<Degree> path(Random& random, bool coarse, double now, double side) {
  const auto number = [&](double low, double high) {
    return coarse ? random.integer(static_cast<int>(2 * low), static_cast<int>(2 * high)) * 0.5
                  : random.between(low, high);
  };
  certificates::PointMotion<Degree> result;
  result.coefficients[0] = {number(0, side), number(0, side), number(0, side)};
  result.coefficients[1] = {number(-2, 2), number(-2, 2), number(-2, 2)};
  if constexpr (Degree >= 2) {
    result.coefficients[2].setZero();
    if (random.one_in(2)) result.coefficients[2] = {number(-1, 1), number(-1, 1), number(-1, 1)};
  }
  result.start = now;
  return result;
}

/// A box that grows, at rates of its own for each side; one in four keeps its size.
template <int Degree>
KineticBox<Degree> random_box(Random& random, bool coarse, double now, double side) {
  const auto centre = path<Degree>(random, coarse, now, side);
  KineticBox<Degree> box{centre, centre};
  const bool grows = !random.one_in(4);
  for (int d = 0; d < 3; ++d) {
    const auto size = [&] { return coarse ? 0.5 * random.integer(1, 3) : random.between(0.2, 1.5); };
    box.min.coefficients[0][d] -= size();
    box.max.coefficients[0][d] += size();
    if (!grows) continue;
    const auto rate = [&] { return coarse ? 0.5 * random.integer(0, 2) : random.between(0, 1); };
    box.min.coefficients[1][d] -= rate();
    box.max.coefficients[1][d] += rate();
  }
  return box;
}

template <int Degree>
oracle::MovingBox exact(const KineticBox<Degree>& box) {
  oracle::MovingBox result;
  for (std::size_t d = 0; d < 3; ++d) {
    const auto low = box.min.axis(static_cast<int>(d));
    const auto high = box.max.axis(static_cast<int>(d));
    result.low[d] = {{low.position.c.begin(), low.position.c.end()}, low.start};
    result.high[d] = {{high.position.c.begin(), high.position.c.end()}, high.start};
  }
  return result;
}

/// Keeps what is reported and holds it against the contract.
struct Pairs final : PairListener {
  std::set<std::pair<BodyId, BodyId>> now;
  std::map<std::pair<BodyId, BodyId>, double> since;
  double clock = 0;
  std::size_t reports = 0;

  void pair_began(BodyId a, BodyId b, double t) override {
    note(a, b, t);
    REQUIRE(now.insert({a, b}).second);
    since[{a, b}] = t;
  }
  void pair_ended(BodyId a, BodyId b, double t) override {
    note(a, b, t);
    REQUIRE(now.erase({a, b}) == 1);
  }
  void note(BodyId a, BodyId b, double t) {
    REQUIRE(a < b);
    REQUIRE(t >= clock);
    clock = t;
    ++reports;
  }
};

template <int Degree>
struct Stress {
  Stress(std::uint64_t seed, bool is_coarse, ListedAxes listed = ListedAxes::three)
      : random(seed), coarse(is_coarse), broad_phase(0, listed) {
    broad_phase.extend_horizon(0, never);
  }

  void insert(std::size_t count) {
    std::vector<BodyId> ids;
    for (BodyId id = 0; ids.size() < count; ++id) {
      if (!boxes.contains(id)) ids.push_back(id);
    }
    std::vector<typename KineticSweepAndPrune<Degree>::Entry> entries;
    for (const BodyId id : ids) {
      boxes[id] = random_box<Degree>(random, coarse, now, side);
      entries.push_back({id, &boxes[id]});
    }
    broad_phase.insert(entries, now, pairs);
  }

  BodyId any() { return std::next(boxes.begin(), static_cast<std::ptrdiff_t>(random.below(boxes.size())))->first; }

  void remove() {
    const BodyId id = any();
    broad_phase.remove(id, now, pairs);
    boxes.erase(id);
    for (const auto& [a, b] : pairs.now) REQUIRE((a != id && b != id));
  }

  void update() {
    const BodyId id = any();
    KineticBox<Degree> box = random_box<Degree>(random, coarse, now, side);
    if (!random.one_in(3)) {  // goes on from where it is
      for (auto [end, old] : {std::pair(&box.min, &boxes[id].min), std::pair(&box.max, &boxes[id].max)}) {
        end->coefficients[0] = old->position(now);
      }
      for (int d = 0; d < 3; ++d) {  // growing again, should it have shrunk to nothing
        if (!(box.min.coefficients[0][d] < box.max.coefficients[0][d])) {
          box.max.coefficients[0][d] = box.min.coefficients[0][d] + 0.5;
        }
        box.max.coefficients[1][d] = std::max(box.max.coefficients[1][d], box.min.coefficients[1][d]);
        if constexpr (Degree >= 2) box.max.coefficients[2][d] = box.min.coefficients[2][d];
      }
    }
    boxes[id] = box;
    broad_phase.update(id, box, now, pairs);
  }

  /// Everything up to t, with an audit after each event.
  void advance(double t) {
    while (broad_phase.next_time() <= t) {
      now = std::max(now, broad_phase.next_time());
      broad_phase.advance(broad_phase.next_time(), pairs);
      broad_phase.audit(now);
      ++events;
    }
    broad_phase.advance(t, pairs);
    now = t;
  }

  void compare_with_brute_force() {
    for (auto a = boxes.begin(); a != boxes.end(); ++a) {
      for (auto b = std::next(a); b != boxes.end(); ++b) {
        INFO("bodies " << a->first << " and " << b->first << " at " << now);
        const bool overlap = oracle::overlap_after(exact(a->second), exact(b->second), now);
        REQUIRE(pairs.now.contains({a->first, b->first}) == overlap);
      }
    }
  }

  Random random;
  bool coarse;
  KineticSweepAndPrune<Degree> broad_phase;
  std::map<BodyId, KineticBox<Degree>> boxes;
  Pairs pairs;
  double now = 0;
  double side = 12;
  std::size_t events = 0;
};

TEMPLATE_TEST_CASE_SIG("Kinetic sweep and prune under stress", "[broad_phase]", ((int Degree), Degree), 1, 2) {
  const ListedAxes listed = GENERATE(ListedAxes::one, ListedAxes::two, ListedAxes::three);
  std::size_t events = 0;
  std::size_t reports = 0;
  for (const bool coarse : {false, true}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      INFO("degree " << Degree << (coarse ? ", coarse" : ", fine") << " numbers, seed " << seed << ", listed axes "
                     << static_cast<int>(listed));
      Stress<Degree> stress(seed, coarse, listed);
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
    Stress<Degree> stress(seed, false, listed);
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
  Stress<1> stress(9, false, GENERATE(ListedAxes::one, ListedAxes::two, ListedAxes::three));
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
