// The smallest gap of the course: against all pairs by exact signs, with edits.
#include "examples/smallest_gap.hpp"
#include "kds/simulator.hpp"
#include "kds/testing/trial.hpp"
#include "tests/structures/random_values.hpp"

#include <catch2/catch.hpp>

#include <cstdint>

namespace test_smallest_gap {
namespace {

using namespace kds;
using namespace kds::tests;
using examples::ListRule;
using examples::Narrower;
using examples::SmallestGapRule;

/// Whether no other pair of values is closer, by exact signs.
int check_gap(const SmallestGapRule& rule, const MovingSet<Motion<2>>& x, double now) {
  if (!rule.pair()) return x.size() >= 2;
  const auto in_order = [&](Id a, Id b) { return sign_after(certificates::Order<2>{x[a], x[b]}, now) >= 0; };
  auto [low, high] = *rule.pair();
  int wrong = low >= high;
  if (!in_order(low, high)) std::swap(low, high);
  for (const Id a : x.ids()) {
    for (const Id b : x.ids()) {
      if (a != b && in_order(a, b)) wrong += sign_after(Narrower{x[low], x[high], x[a], x[b]}, now) < 0;
    }
  }
  return wrong;
}

}  // namespace

TEST_CASE("the smallest gap is right after every event and edit", "[smallest_gap]") {
  std::size_t events = 0;
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = 900; seed < 904; ++seed) {
      CAPTURE(static_cast<int>(kind), seed);
      const auto found = testing::try_rule({seed, kind, 24}, SmallestGapRule{}, random_motion<2>, check_gap);
      CHECK(found.first == "");
      events += found.events.size();
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
  Kinetic<ListRule<Motion<2>>> list(set, 0);
  Kinetic<SmallestGapRule> gap(list, 0);
  Simulator simulator(0, list, gap);
  while (simulator.step(2)) {
  }
  simulator.audit();
  const Measures m = gap.measures();
  CHECK(m.events > n);
  CHECK(m.followed == list.measures().events);
  CHECK(m.external > 0);
  CHECK(m.external < m.events);
  CHECK(m.held == n - 2);           // compact: n - 1 gaps
  CHECK(m.most_touched <= 3 * 6);   // responsive: three gaps, each with a way to the top
}

}  // namespace test_smallest_gap
