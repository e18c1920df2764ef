// All nearest neighbours against exact brute force.
#include "kds/testing/trial.hpp"
#include "structures/nearest_neighbours.hpp"
#include "tests/structures/exact_plane.hpp"
#include "tests/structures/random_values.hpp"

#include <catch2/catch.hpp>

#include <cstdint>
#include <optional>

namespace test_nearest_neighbours {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::PlaneMotion;
using structures::DelaunayRule;
using structures::NearestNeighboursRule;
using testing::Findings;
using testing::TrialOptions;
using testing::try_rule;

/// No other point is nearer than the one that it names, and it names one where there is one.
template <int Degree>
int check_nearest(const NearestNeighboursRule<PlaneMotion<Degree>>& rule, const MovingSet<PlaneMotion<Degree>>& set,
                  double now) {
  const ExactPlane plane(set, now);
  int wrong = 0;
  for (const Id id : plane.ids()) {
    const std::optional<Id> nearest = rule.nearest(id);
    if (!nearest) {
      wrong += plane.ids().size() > 1 && !rule.inner().flat();
      continue;
    }
    wrong += *nearest == id || !set.contains(*nearest);
    for (const Id other : plane.ids()) {
      wrong += other != id && plane.compare_distances(id, *nearest, id, other) > 0;
    }
  }
  return wrong;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("kinetic nearest neighbours are the nearest, exactly", "[nearest_neighbours]",
                       ((int Degree), Degree), 1, 2) {
  std::size_t events = 0;
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = Degree == 1 ? 620 : 621; seed < (Degree == 1 ? 623u : 622u); ++seed) {
      CAPTURE(Degree, static_cast<int>(kind), seed);
      const TrialOptions options{seed, kind, 6, 2 + 3 * (seed % 3), 9, seed % 2 == 0 ? never : 0.4, 16};
      const Findings found = try_rule(options, NearestNeighboursRule<PlaneMotion<Degree>>{},
                                      random_plane_motion<Degree>, check_nearest<Degree>);
      CHECK(found.first == "");
      events += found.events.size();
    }
  }
  CHECK(events > (Degree == 1 ? 200 : 20));
}

TEST_CASE("two points without a triangle are each other's neighbour, and one alone has none", "[nearest_neighbours]") {
  MovingSet<PlaneMotion<1>> set;
  const auto at = [](double x, double y) { return PlaneMotion<1>{{{{{x, 0}}, {{y, 0}}}}, 0}; };
  set.insert(3, at(0, 0), 0);
  Kinetic<DelaunayRule<PlaneMotion<1>>> triangulation(set, 0);
  Kinetic<NearestNeighboursRule<PlaneMotion<1>>> nearest(triangulation, 0);
  CHECK(nearest.rule().nearest(3) == std::nullopt);
  CHECK(nearest.rule().nearest(0) == std::nullopt);
  set.insert(5, at(2, 0), 0);
  CHECK(nearest.rule().nearest(3) == Id{5});
  set.insert(9, at(5, 0), 0);
  CHECK(nearest.rule().nearest(3) == std::nullopt);  // all on one line
  set.insert(7, at(0, 3), 0);
  CHECK(nearest.rule().nearest(7) == Id{3});
  CHECK(nearest.rule().nearest(9) == Id{5});
  set.insert(4, at(2, 0), 0);  // shares the vertex of 5
  CHECK(nearest.rule().nearest(4) == Id{5});
  CHECK(nearest.rule().nearest(5) == Id{4});
  set.remove(5, 0);
  CHECK(nearest.rule().nearest(4) == Id{3});
  CHECK(nearest.rule().nearest(9) == Id{4});
}

TEST_CASE("nearest neighbours keep to their measures", "[nearest_neighbours]") {
  const std::uint64_t seed = 630, n = 40;
  CAPTURE(seed);
  Random random(seed);
  MovingSet<PlaneMotion<1>> set;
  for (Id id = 0; id < n; ++id) set.insert(id, random_plane_motion<1>(random, Kind::generic, 0), 0);
  Kinetic<DelaunayRule<PlaneMotion<1>>> triangulation(set, 0);
  Kinetic<NearestNeighboursRule<PlaneMotion<1>>> nearest(triangulation, 0);
  Simulator simulator(0, triangulation, nearest);
  simulator.advance_to(1);
  simulator.audit();
  const Measures m = nearest.measures();
  CHECK(check_nearest(nearest.rule(), set, 1) == 0);
  CHECK(m.external == m.events + m.followed);
  CHECK(m.events > 10);
  CHECK(m.most_held <= 6 * n);  // compact
}

}  // namespace test_nearest_neighbours
