// The sorted list under any ranking against exact signs, and against the list of the examples.
#include "examples/list_in_forty_lines.hpp"
#include "kds/testing/trial.hpp"
#include "structures/ranked_list.hpp"
#include "tests/structures/random_values.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <variant>
#include <vector>

namespace test_ranked_list {
namespace {

using namespace kds;
using namespace kds::tests;
using structures::ByDirection;
using structures::ByValue;
using structures::NewNeighbour;
using structures::RankedListRule;
using Path = certificates::PlaneMotion<2>;

/// All elements, each two neighbours in order; those that stay equal by their ids.
template <class Rank>
int check_list(const RankedListRule<Rank>& rule, const MovingSet<typename Rank::Element>& set, double now) {
  const auto& order = rule.order();
  int wrong = order.size() != set.size();
  for (std::size_t i = 0; i < order.size(); ++i) {
    wrong += !set.contains(order[i]) || !rule.contains(order[i]) || rule.rank(order[i]) != i;
    wrong += rule.right(order[i]) != (i + 1 < order.size() ? order[i + 1] : nobody);
    if (i == 0) continue;
    const int sign = sign_after(rule.ranking().in_order(set[order[i - 1]], set[order[i]]), now);
    wrong += sign < 0 || (sign == 0 && order[i - 1] > order[i]);
  }
  for (Id id = 0; id < set.end_id(); ++id) wrong += rule.contains(id) != set.contains(id);
  return wrong;
}

/// The right neighbours, by what has been told alone.
struct ToldRule : StandsOn<RankedListRule<ByValue<Motion<1>>>> {
  static constexpr const char* name = "Told";
  std::vector<Id> right{};

  std::monostate certificate(Slot, const MovingSet<Motion<1>>&) const { return {}; }
  std::array<Id, 0> members(Slot) const { return {}; }
  Effect repair(Slot, Repair<Motion<1>>&) { return Effect::internal; }
  Effect follow(std::span<const NewNeighbour> changes, Repair<Motion<1>>&) {
    for (const auto& [left] : changes) {
      if (left >= right.size()) right.resize(left + std::size_t{1}, nobody);
      right[left] = inner().right(left);
    }
    return Effect::external;
  }
  template <class Archive>
  void archive(Archive& archive) {
    archive(right);
  }
};

}  // namespace

TEST_CASE("a list under any ranking is in order, exactly", "[ranked_list]") {
  std::size_t events = 0;
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = 640; seed < 643; ++seed) {
      CAPTURE(static_cast<int>(kind), seed);
      const testing::TrialOptions options{seed, kind, 24, 3 + 6 * (seed % 3), 24, seed % 2 == 0 ? never : 0.4};
      using Values = RankedListRule<ByValue<Motion<2>>>;
      const auto values = testing::try_rule(options, Values{}, random_motion<2>, check_list<ByValue<Motion<2>>>);
      CHECK(values.first == "");
      // The same events as those of the rule that the documentation shows.
      const auto no_check = [](const auto&, const auto&, double) { return 0; };
      CHECK(values.events ==
            testing::try_rule(options, examples::ListRule<Motion<2>>{}, random_motion<2>, no_check).events);
      using Points = RankedListRule<ByDirection<Path, 2>>;
      const auto points = testing::try_rule(options, Points(ByDirection<Path, 2>{{1, -0.5}}), random_plane_motion<2>,
                                            check_list<ByDirection<Path, 2>>);
      CHECK(points.first == "");
      events += values.events.size() + points.events.size();
    }
  }
  CHECK(events > 1000);
}

TEST_CASE("a list tells whose right neighbour has changed, and nothing else is needed", "[ranked_list]") {
  for (const Kind kind : all_kinds) {
    const std::uint64_t seed = 650;
    CAPTURE(static_cast<int>(kind), seed);
    const auto check = [](const ToldRule& rule, const MovingSet<Motion<1>>& set, double) {
      int wrong = 0;
      for (const Id id : set.ids()) wrong += rule.right[id] != rule.inner().right(id);
      return wrong;
    };
    CHECK(testing::try_rule({seed, kind, 24}, ToldRule{}, random_motion<1>, check).first == "");
  }
}

TEST_CASE("a list keeps to its measures", "[ranked_list]") {
  const std::uint64_t seed = 660;
  CAPTURE(seed);
  Random random(seed);
  MovingSet<Motion<1>> set;
  const Id n = 100;
  for (Id id = 0; id < n; ++id) set.insert(id, {{{random.between(-1, 1), random.between(-1, 1)}}, 0}, 0);
  Kinetic<RankedListRule<ByValue<Motion<1>>>> list(set, 0);
  Simulator simulator(0, list);
  simulator.advance_to(1);
  simulator.audit();
  const Measures m = list.measures();
  CHECK(m.events > 500);
  CHECK(m.events <= n * (n - 1) / 2);
  CHECK(m.external == m.events);
  CHECK(m.most_touched <= 3);
  CHECK(m.most_held == n - 1);
  CHECK(m.most_per_element <= 2);
}

}  // namespace test_ranked_list
