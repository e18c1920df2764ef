// The closest pair against exact brute force.
#include "kds/testing/trial.hpp"
#include "structures/closest_pair.hpp"
#include "tests/structures/exact_plane.hpp"
#include "tests/structures/random_values.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <vector>

namespace test_closest_pair {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::PlaneMotion;
using structures::ClosestPairRule;
using structures::DelaunayRule;
using testing::Findings;
using testing::TrialOptions;
using testing::try_rule;

/// No pair is closer; where there is none, there are too few points, or all are on one line.
template <int Degree>
int check_pair(const ClosestPairRule<PlaneMotion<Degree>>& rule, const MovingSet<PlaneMotion<Degree>>& set,
               double now) {
  const ExactPlane plane(set, now);
  const auto ids = plane.ids();
  const auto pair = rule.pair();
  if (!pair) return ids.size() == 2 || (ids.size() > 2 && !rule.delaunay().flat());
  int wrong = !set.contains((*pair)[0]) || !set.contains((*pair)[1]) || (*pair)[0] >= (*pair)[1];
  if (wrong != 0) return wrong;
  for (const Id a : ids) {
    for (const Id b : ids) wrong += a < b && plane.compare_distances(a, b, (*pair)[0], (*pair)[1]) < 0;
  }
  return wrong;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("the kinetic closest pair is the closest, exactly", "[closest_pair]", ((int Degree), Degree), 1,
                       2) {
  std::size_t events = 0;
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = Degree == 1 ? 900 : 901; seed < (Degree == 1 ? 903u : 902u); ++seed) {
      CAPTURE(Degree, static_cast<int>(kind), seed);
      const TrialOptions options{seed, kind, 10, 2 + 4 * (seed % 3), 12, seed % 2 == 0 ? never : 0.4, 3};
      const Findings found = try_rule(options, ClosestPairRule<PlaneMotion<Degree>>{}, random_plane_motion<Degree>,
                                      check_pair<Degree>);
      CHECK(found.first == "");
      events += found.events.size();
    }
  }
  CHECK(events > 20);
}

TEST_CASE("the closest pair keeps to its measures", "[closest_pair]") {
  const std::uint64_t seed = 910;
  CAPTURE(seed);
  Random random(seed);
  MovingSet<PlaneMotion<1>> set;
  const std::uint64_t n = 60;
  for (Id id = 0; id < n; ++id) set.insert(id, random_plane_motion<1>(random, Kind::generic, 0), 0);
  Kinetic<DelaunayRule<PlaneMotion<1>>> triangulation(set, 0);
  Kinetic<ClosestPairRule<PlaneMotion<1>>> closest(triangulation, 0);
  Simulator simulator(0, triangulation, closest);
  simulator.advance_to(2);
  simulator.audit();
  const Measures m = closest.measures();
  CHECK(check_pair(closest.rule(), set, 2) == 0);
  CHECK(m.external > 10);
  CHECK(m.external < m.events);
  CHECK(m.followed > 10);
  CHECK(m.most_held <= 3 * n);                   // compact
  CHECK(m.most_touched <= 2 * std::log2(6 * n));  // responsive: an edge comes and one goes
}

TEST_CASE("of none, one, two, and of points that are one", "[closest_pair][degeneracy]") {
  MovingSet<PlaneMotion<1>> set;
  Kinetic<DelaunayRule<PlaneMotion<1>>> triangulation(set, 0);
  Kinetic<ClosestPairRule<PlaneMotion<1>>> closest(triangulation, 0);
  const auto at = [](double x, double y) { return PlaneMotion<1>{{{{{x, 0}}, {{y, 0}}}}, 0}; };
  CHECK_FALSE(closest.rule().pair());
  set.insert(4, at(0, 0), 0);
  CHECK_FALSE(closest.rule().pair());
  set.insert(1, at(5, 0), 0);
  CHECK(closest.rule().pair() == std::array<Id, 2>{1, 4});
  set.insert(2, at(0, 4), 0);
  CHECK(closest.rule().pair() == std::array<Id, 2>{2, 4});
  set.insert(9, at(5, 0), 0);
  CHECK(closest.rule().pair() == std::array<Id, 2>{1, 9});
  set.remove(1, 0);
  CHECK(closest.rule().pair() == std::array<Id, 2>{2, 4});
  set.remove(2, 0);
  CHECK(closest.rule().pair() == std::array<Id, 2>{4, 9});
  closest.audit(0);
}

}  // namespace test_closest_pair
