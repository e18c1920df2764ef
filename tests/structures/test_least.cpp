// The k least of moving elements: points by their distances from another that moves, by exact signs.
#include "certificates/plane_certificates.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/simulator.hpp"
#include "kds/testing/trial.hpp"
#include "structures/least.hpp"
#include "tests/structures/random_values.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace test_least {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::PlaneMotion;
using structures::LeastRule;
using testing::Findings;
using testing::TrialOptions;
using testing::try_rule;

/// Points by how far they are from a robot.
template <int Degree>
struct ByDistance {
  using Element = PlaneMotion<Degree>;
  Element robot{};
  certificates::DistanceOrder<Element> in_order(const Element& nearer, const Element& farther) const {
    return {robot, nearer, robot, farther};
  }
};

template <int Degree>
int check_nearest(const LeastRule<ByDistance<Degree>>& rule, const MovingSet<PlaneMotion<Degree>>& x, double now) {
  int wrong = 0;
  std::size_t nearest = 0;
  for (const Id id : x.ids()) {
    nearest += rule.contains(id);
    for (const Id other : x.ids()) {
      if (!rule.contains(id) || rule.contains(other)) continue;
      wrong += sign_after(rule.ranking().in_order(x[id], x[other]), now) < 0;
    }
    if (rule.last() != nobody && rule.contains(id)) {
      wrong += sign_after(rule.ranking().in_order(x[id], x[rule.last()]), now) < 0;
    }
  }
  wrong += nearest != std::min(rule.count(), x.size());
  wrong += (rule.last() != nobody) != (rule.count() > 0 && x.size() >= rule.count());
  return wrong + (rule.last() != nobody && !rule.contains(rule.last()));
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("the k nearest to a robot are that, exactly, while k and the robot change", "[least]",
                       ((int Degree), Degree), 1, 2) {
  using Rule = LeastRule<ByDistance<Degree>>;
  std::size_t events = 0;
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = 520; seed < 523; ++seed) {
      CAPTURE(Degree, static_cast<int>(kind), seed);
      const auto edit = [kind](auto& structure, Random& random, double now) {
        const std::size_t count = random.below(8);
        const ByDistance<Degree> ranking{random_plane_motion<Degree>(random, kind, now)};
        if (random.one_in(3)) structure.edit([&](Rule& rule, auto& repair) { rule.set_count(count, repair); }, now);
        if (random.one_in(3)) structure.edit([&](Rule& rule, auto& repair) { rule.set_ranking(ranking, repair); }, now);
      };
      TrialOptions options{seed, kind, 20, 3 + 6 * (seed % 3), 20, seed % 2 == 0 ? never : 0.4};
      options.backwards = false;  // as the robot moves
      const Findings found =
          try_rule(options, Rule(seed % 3 * 2), random_plane_motion<Degree>, check_nearest<Degree>, edit);
      CHECK(found.first == "");
      events += found.events.size();
    }
  }
  CHECK(events > 200);
}

}  // namespace test_least
