// The smallest gap of the course: against all pairs by exact signs, with edits.
#include "examples/smallest_gap.hpp"
#include "kds/simulator.hpp"
#include "tests/structures/random_values.hpp"

#include <catch2/catch.hpp>

#include <cstdint>
#include <vector>

namespace test_smallest_gap {
namespace {

using namespace kds;
using namespace kds::tests;
using examples::Narrower;
using examples::SmallestGapRule;

/// Whether the pair is in order and no other pair of values is closer, all by exact signs.
bool right(const SmallestGapRule& rule, const MovingSet<Motion<2>>& x, double now) {
  const auto [low, high] = rule.pair();
  const auto in_order = [&](Id a, Id b) { return sign_after(certificates::Order<2>{x[a], x[b]}, now) >= 0; };
  if (low == high || !in_order(low, high)) return false;
  for (const Id a : x.ids()) {
    for (const Id b : x.ids()) {
      if (a == b || !in_order(a, b)) continue;
      if (sign_after(Narrower{x[low], x[high], x[a], x[b]}, now) < 0) return false;
    }
  }
  return true;
}

/// Random changes and advances; the number of states that were wrong.
int mistakes(std::uint64_t seed, Kind kind, std::uint64_t& events) {
  Random random(seed);
  Model<2> model;
  MovingSet<Motion<2>> set;
  double now = beginning(kind);
  for (std::uint32_t id = 0; id < 8; ++id) {
    model.motions[2 * id] = random_motion<2>(random, kind, now);
    set.insert(2 * id, model.motions[2 * id], now);
  }
  Kinetic<SmallestGapRule> gap(set, now);
  Simulator simulator(now, gap);
  int wrong = 0;
  const auto compare = [&] { wrong += set.size() >= 2 && !right(gap.rule(), set, simulator.now()); };
  for (int step = 0; step < 25; ++step) {
    const double target = now + random_delay(random, kind);
    while (simulator.step(target)) {
      simulator.audit();
      if (simulator.next_time() > simulator.now()) compare();
    }
    simulator.advance_to(now = target);
    const auto change = random_change(random, kind, now, 16, model);
    using What = Change<2>::What;
    if (change.what == What::insert) set.insert(change.id, change.motion, now);
    if (change.what == What::remove) set.remove(change.id, now);
    if (change.what == What::update) set.update(change.id, change.motion, now);
    simulator.audit();
    if (simulator.next_time() > simulator.now()) compare();
  }
  events += gap.measures().events;
  return wrong;
}

}  // namespace

TEST_CASE("the smallest gap is right after every event and edit", "[smallest_gap]") {
  std::uint64_t events = 0;
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = 900; seed < 904; ++seed) {
      CAPTURE(static_cast<int>(kind), seed);
      CHECK(mistakes(seed, kind, events) == 0);
    }
  }
  CHECK(events > 500);
}

TEST_CASE("the smallest gap keeps to its measures", "[smallest_gap]") {
  const std::uint64_t seed = 910, n = 40;
  CAPTURE(seed);
  Random random(seed);
  MovingSet<Motion<2>> set;
  for (Id id = 0; id < n; ++id) set.insert(id, random_motion<2>(random, Kind::generic, 0), 0);
  Kinetic<SmallestGapRule> gap(set, 0);
  Simulator simulator(0, gap);
  while (simulator.step(2)) {
  }
  simulator.audit();
  const Measures m = gap.measures();
  CHECK(m.events > n);
  CHECK(m.external > 0);
  CHECK(m.external < m.events);
  CHECK(m.held == 2 * n - 3);              // compact: n - 1 neighbours, n - 2 matches
  CHECK(m.most_touched <= 3 + 3 * 6 + 1);  // responsive: three pairs, and for each gap a way to the top
}

}  // namespace test_smallest_gap
