// Delaunay and regular triangulations in space against exact brute force.
#include "certificates/point_motion.hpp"
#include "certificates/weighted_point.hpp"
#include "kds/framework/reverse.hpp"
#include "kds/testing/trial.hpp"
#include "structures/spatial_triangulation.hpp"
#include "tests/structures/exact_space.hpp"
#include "tests/structures/random_values.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <vector>

namespace test_spatial_triangulation {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::PointMotion;
using certificates::WeightedPoint;
using structures::SpatialTriangulationRule;

/// A point of one of the hard kinds; its weight is of the size of the squared distances.
template <class Path>
Path random_element(Random& random, Kind kind, double now) {
  const auto path = random_point_motion<Path::degree>(random, kind, now);
  if constexpr (certificates::Weighted<Path>) {
    Path point{path, {}};
    for (double& c : point.weight_since_start.c) {
      const bool whole = kind == Kind::lattice || kind == Kind::resting;
      c = whole ? random.integer(0, 3) : (kind == Kind::scales ? random.between(0, 1e6) : random.unit());
    }
    return point;
  } else {
    return path;
  }
}

/// How many seeds are tried of each kind: one, or what KDS_SPATIAL_SEEDS says.
std::uint64_t seeds() {
  const char* wished = std::getenv("KDS_SPATIAL_SEEDS");
  return wished != nullptr ? std::strtoull(wished, nullptr, 10) : 1;
}

}  // namespace

TEMPLATE_TEST_CASE("a triangulation in space is the only regular one, exactly", "[space]", PointMotion<1>,
                   PointMotion<2>, (WeightedPoint<1, 0>), (WeightedPoint<2, 1>)) {
  using Path = TestType;
  std::size_t events = 0, checks = 0, hidden = 0;
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = 900; seed < 900 + seeds(); ++seed) {
      CAPTURE(Path::degree, static_cast<int>(kind), seed);
      const double window = kind == Kind::generic ? 0.4 : never;
      const testing::TrialOptions options{seed, kind, 8, 6 + seed % 3, 10, window, 4};
      const auto check = [&](const auto& rule, const auto& set, double now) {
        ++checks;
        hidden += rule.hidden().size();
        return check_space(rule, set, now);
      };
      const testing::Findings found =
          testing::try_rule(options, SpatialTriangulationRule<Path>{}, random_element<Path>, check);
      CHECK(found.first == "");
      events += found.events.size();
    }
  }
  CHECK(events > 40);
  CHECK(checks > 40);
  CHECK(hidden > 0);
  if (seeds() > 1) WARN(events << " events, " << checks << " checks against brute force");
}

TEST_CASE("triangulations in space keep to their measures", "[space]") {
  const std::uint64_t seed = 910;
  CAPTURE(seed);
  Random random(seed);
  MovingSet<PointMotion<1>> set;
  const std::uint64_t n = 60;
  for (Id id = 0; id < n; ++id) set.insert(id, random_element<PointMotion<1>>(random, Kind::mixed, 0), 0);
  Kinetic<SpatialTriangulationRule<PointMotion<1>>> delaunay(set, 0);
  Simulator simulator(0, delaunay);
  sign_counters = {};
  simulator.advance_to(0.3);
  CHECK(sign_counters.searches < 20);
  CHECK(sign_counters.exact < 20);
  simulator.audit();
  const Measures m = delaunay.measures();
  CHECK(m.events > 2 * n);
  CHECK(10 * m.external > 9 * m.events);
  CHECK(m.most_touched <= 36);
  CHECK(m.most_held <= 25 * n);
  CHECK(delaunay.rule().local_rebuilds() == 0);
  CHECK(delaunay.rule().rebuilds() == 0);
  std::size_t edges = 0, ends = 0;
  for (const Id id : set.ids()) ends += delaunay.rule().neighbours(id).size();
  for (const Id id : set.ids()) {
    for (const Id other : delaunay.rule().neighbours(id)) edges += other == structures::TetrahedronMesh::infinite;
  }
  const auto hull = delaunay.rule().hull();
  CHECK(hull.size() == 2 * edges - 4);  // Euler, of the hull: `edges` to infinity are its vertices.
  CHECK(ends > 10 * n);
}

TEST_CASE("a bounce leaves a triangulation in space as it is, and a jump does not", "[space]") {
  const std::uint64_t seed = 920;
  CAPTURE(seed);
  Random random(seed);
  MovingSet<PointMotion<1>> set;
  for (Id id = 0; id < 30; ++id) set.insert(id, random_element<PointMotion<1>>(random, Kind::mixed, 0), 0);
  Kinetic<SpatialTriangulationRule<PointMotion<1>>> delaunay(set, 0);
  Simulator simulator(0, delaunay);
  int other = 0, expensive = 0;
  for (Id id = 0; id < 30; ++id) {
    simulator.advance_to(0.01 * id);
    const auto before = delaunay.rule().neighbours(id);
    const auto star = delaunay.rule().mesh().star(id).size();
    const auto certificates = delaunay.counters().certificates;
    auto path = set[id].restarted(simulator.now());
    path.coefficients[1] = -path.coefficients[1];
    set.update(id, path, simulator.now());
    other += delaunay.rule().neighbours(id) != before;
    expensive += delaunay.counters().certificates - certificates > 5 * star;
    if (id % 10 != 0) continue;
    path.coefficients[0] = Eigen::Vector3d(5 + id, 5, 5);
    set.update(id, path, simulator.now());
    simulator.audit();
    CHECK(delaunay.rule().neighbours(id) != before);
  }
  CHECK(other == 0);
  CHECK(expensive == 0);
  CHECK(delaunay.rule().rebuilds() == 0);
}

TEST_CASE("a triangulation in space runs backwards through the same states", "[space][reverse]") {
  const std::uint64_t seed = 930;
  CAPTURE(seed);
  Random random(seed);
  using Path = WeightedPoint<1, 0>;
  MovingSet<Path> set;
  for (Id id = 0; id < 9; ++id) set.insert(id, random_element<Path>(random, Kind::mixed, 0), 0);
  Kinetic<SpatialTriangulationRule<Path>> regular(set, 0);
  Simulator simulator(0, regular);
  const auto tetrahedra = [&] {
    std::set<std::array<Id, 4>> result;
    const auto& mesh = regular.rule().mesh();
    for (std::uint32_t t = 0; t < mesh.end_tetrahedron(); ++t) {
      if (!mesh.in_use(t)) continue;
      auto corners = mesh.corners(t);
      std::sort(corners.begin(), corners.end());
      result.insert(corners);
    }
    return result;
  };
  const auto at_start = tetrahedra();
  simulator.advance_to(0.5);
  const auto half_way = tetrahedra();
  simulator.advance_to(2);
  CHECK(half_way != at_start);
  CHECK(tetrahedra() != half_way);
  reverse(simulator, set);
  simulator.advance_to(-0.5);
  simulator.audit();
  CHECK(tetrahedra() == half_way);
  simulator.advance_to(0);
  CHECK(tetrahedra() == at_start);
  CHECK(check_space(regular.rule(), set, 0) == 0);
}

}  // namespace test_spatial_triangulation
