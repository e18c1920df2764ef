// The k nearest of all points against exact brute force.
#include "kds/testing/trial.hpp"
#include "structures/k_nearest.hpp"
#include "tests/structures/exact_plane.hpp"
#include "tests/structures/random_values.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

namespace test_k_nearest {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::PlaneMotion;
using structures::DelaunayRule;
using structures::KNearestRule;
using structures::VoronoiCellsRule;
using testing::Findings;
using testing::TrialOptions;
using testing::try_rule;

/// Of each point as many different places as there are, or k; in order; and nothing else is nearer than the last.
template <int Degree>
int check_nearest(const KNearestRule<PlaneMotion<Degree>>& rule, const MovingSet<PlaneMotion<Degree>>& set,
                  double now) {
  const ExactPlane plane(set, now);
  const auto& delaunay = rule.inner().inner();
  std::vector<Id> places;
  for (const Id id : plane.ids()) {
    if (delaunay.vertex(id) == id) places.push_back(id);
  }
  int wrong = 0;
  for (const Id id : plane.ids()) {
    const std::vector<Id>& nearest = rule.nearest(id);
    const Id vertex = delaunay.vertex(id);
    wrong += nearest != rule.nearest(vertex);
    if (delaunay.flat()) {
      wrong += !nearest.empty();
      continue;
    }
    wrong += nearest.size() != std::min(rule.count(), places.size() - 1);
    std::set<Id> listed(nearest.begin(), nearest.end());
    wrong += listed.size() != nearest.size() || listed.count(vertex) > 0;
    for (std::size_t i = 0; i < nearest.size(); ++i) {
      wrong += !set.contains(nearest[i]) || delaunay.vertex(nearest[i]) != nearest[i];
      wrong += i > 0 && plane.compare_distances(id, nearest[i - 1], id, nearest[i]) > 0;
    }
    for (const Id other : places) {
      if (nearest.empty() || other == vertex || listed.count(other) > 0) continue;
      wrong += plane.compare_distances(id, nearest.back(), id, other) > 0;
    }
  }
  return wrong;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("the k nearest of all points are that, exactly, while k changes", "[k_nearest]",
                       ((int Degree), Degree), 1, 2) {
  using Rule = KNearestRule<PlaneMotion<Degree>>;
  const auto edit = [](auto& structure, Random& random, double now) {
    const std::size_t count = random.below(6);
    if (random.one_in(4)) structure.edit([&](Rule& rule, auto& repair) { rule.set_count(count, repair); }, now);
  };
  std::size_t events = 0;
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = Degree == 1 ? 640 : 641; seed < (Degree == 1 ? 644u : 642u); ++seed) {
      CAPTURE(Degree, static_cast<int>(kind), seed);
      const TrialOptions options{seed, kind, 6, 2 + 4 * (seed % 3), 12, seed % 2 == 0 ? never : 0.4, 16};
      const Findings found =
          try_rule(options, Rule(1 + seed % 4), random_plane_motion<Degree>, check_nearest<Degree>, edit);
      CHECK(found.first == "");
      events += found.events.size();
    }
  }
  CHECK(events > (Degree == 1 ? 400 : 40));
}

TEST_CASE("the k nearest keep to their measures", "[k_nearest]") {
  const std::uint64_t seed = 650, n = 60;
  CAPTURE(seed);
  Random random(seed);
  MovingSet<PlaneMotion<1>> set;
  for (Id id = 0; id < n; ++id) set.insert(id, random_plane_motion<1>(random, Kind::generic, 0), 0);
  Kinetic<DelaunayRule<PlaneMotion<1>>> triangulation(set, 0);
  Kinetic<VoronoiCellsRule<PlaneMotion<1>>> cells(triangulation, 0);
  Kinetic<KNearestRule<PlaneMotion<1>>> nearest(cells, 0, KNearestRule<PlaneMotion<1>>(4));
  Simulator simulator(0, triangulation, cells, nearest);
  simulator.advance_to(1);
  simulator.audit();
  const Measures m = nearest.measures();
  CHECK(check_nearest(nearest.rule(), set, 1) == 0);
  CHECK(m.events > 100);
  CHECK(m.most_held <= 5 * 4 * n);  // compact
}

}  // namespace test_k_nearest
