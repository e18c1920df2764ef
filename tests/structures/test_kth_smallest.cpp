// The k-th smallest value: by exact signs, with edits of the values and of the rank.
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"
#include "kds/testing/trial.hpp"
#include "structures/kth_smallest.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>

namespace test_kth_smallest {
namespace {

using namespace kds;
using namespace kds::testing;
using structures::KthSmallestRule;

template <int Degree>
int check_rank(const KthSmallestRule<Motion<Degree>>& rule, const MovingSet<Motion<Degree>>& x, double now) {
  if (x.size() <= rule.rank()) return rule.kth() != nobody;
  if (!x.contains(rule.kth())) return 1;
  std::size_t smaller = 0, not_greater = 0;
  for (const Id id : x.ids()) {
    const int sign = sign_after(certificates::Order<Degree>{x[id], x[rule.kth()]}, now);
    smaller += sign > 0;
    not_greater += sign >= 0;
  }
  return smaller > rule.rank() || not_greater <= rule.rank();
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("the k-th smallest value is that, exactly, for ranks that change", "[kth_smallest]",
                       ((int Degree), Degree), 1, 2, 3) {
  using Rule = KthSmallestRule<Motion<Degree>>;
  const auto edit = [](auto& structure, Random& random, double now) {
    if (!random.one_in(4)) return;
    const std::size_t rank = random.below(10);
    structure.edit([rank](Rule& rule, auto& repair) { rule.set_rank(rank, repair); }, now);
  };
  std::size_t events = 0;
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = 500; seed < 503; ++seed) {
      CAPTURE(Degree, static_cast<int>(kind), seed);
      const TrialOptions options{seed, kind, 24, 3 + 6 * (seed % 3), 24, seed % 2 == 0 ? never : 0.4};
      const Findings found =
          try_rule(options, Rule(seed % 3 * 4), random_motion<Degree>, check_rank<Degree>, edit);
      CHECK(found.first == "");
      events += found.events.size();
    }
  }
  CHECK(events > 200);
}

TEST_CASE("a median keeps to its measures", "[kth_smallest]") {
  const std::uint64_t seed = 510, n = 101;
  CAPTURE(seed);
  Random random(seed);
  MovingSet<Motion<1>> set;
  for (Id id = 0; id < n; ++id) set.insert(id, random_motion<1>(random, Kind::generic, 0), 0);
  Kinetic<KthSmallestRule<Motion<1>>> median(set, 0, KthSmallestRule<Motion<1>>(50));
  Simulator simulator(0, median);
  simulator.advance_to(3);
  simulator.audit();
  const Measures m = median.measures();
  CHECK(m.external > 30);
  CHECK(m.held == n - 1);                                        // compact
  CHECK(m.most_touched <= 1 + 4 * std::ceil(std::log2(2 * n)));  // responsive
  CHECK(m.most_per_element <= 2 + std::ceil(std::log2(n)));      // local
}

}  // namespace test_kth_smallest
