// Voronoi cells against what is exactly true of their points, and in numbers.
#include "kds/testing/trial.hpp"
#include "structures/voronoi_cells.hpp"
#include "tests/structures/exact_plane.hpp"
#include "tests/structures/random_values.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <span>
#include <stdexcept>
#include <variant>
#include <vector>

namespace test_voronoi_cells {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::PlaneMotion;
using structures::DelaunayRule;
using structures::NeighboursChange;
using structures::VoronoiCell;
using structures::VoronoiCellsRule;
using testing::Findings;
using testing::TrialOptions;
using testing::try_rule;

/// A point and two neighbours that follow each other turn left, and their circle is empty; first and last neighbours
/// have all points on one side. So the triangles are those of a Delaunay triangulation, and go round the point.
template <int Degree>
int check_neighbours(const VoronoiCellsRule<PlaneMotion<Degree>>& rule, const MovingSet<PlaneMotion<Degree>>& set,
                     double now) {
  const ExactPlane plane(set, now);
  int wrong = 0;
  for (const Id id : plane.ids()) {
    const std::vector<Id>& around = rule.neighbours(id);
    if (rule.inner().flat()) {
      wrong += !around.empty();
      continue;
    }
    const Id at = rule.inner().vertex(id);
    wrong += !plane.same(id, at) || std::set<Id>(around.begin(), around.end()).size() != around.size();
    wrong += around.size() < (rule.bounded(id) ? 3u : 2u) || std::count(around.begin(), around.end(), at) > 0;
    for (std::size_t i = 0; i + !rule.bounded(id) < around.size(); ++i) {
      const Id a = around[i], b = around[(i + 1) % around.size()];
      wrong += !set.contains(a) || !set.contains(b) || plane.orientation(at, a, b) <= 0;
      for (const Id other : plane.ids()) wrong += plane.inside(at, a, b, other) > 0;
    }
    if (rule.bounded(id)) {
      wrong += around.front() != *std::min_element(around.begin(), around.end());
      continue;
    }
    for (const Id other : plane.ids()) {
      wrong += plane.orientation(at, around.front(), other) < 0 || plane.orientation(around.back(), at, other) < 0;
    }
  }
  return wrong;
}

/// Looks at the neighbours of those points only of which it is told.
template <class Path>
struct ToldRule : StandsOn<VoronoiCellsRule<Path>> {
  static constexpr const char* name = "Told";
  std::vector<std::vector<Id>> known{};
  std::vector<std::uint8_t> known_bounded{};
  int for_nothing = 0;

  std::monostate certificate(Slot, const MovingSet<Path>&) const { return {}; }
  std::array<Id, 0> members(Slot) const { return {}; }
  Effect repair(Slot, Repair<Path>&) { return Effect::internal; }
  Effect follow(std::span<const NeighboursChange> changes, Repair<Path>&) {
    const auto& cells = this->inner();
    std::set<Id> ids;
    for (const auto& change : changes) ids.insert(change.id);
    for (const Id id : ids) {
      if (id >= known.size()) known.resize(id + std::size_t{1}), known_bounded.resize(id + std::size_t{1}, 1);
      const bool is_vertex = cells.inner().mesh().contains(id);
      const std::vector<Id> around = is_vertex ? cells.neighbours(id) : std::vector<Id>{};
      const std::uint8_t bounded = !is_vertex || cells.bounded(id);
      for_nothing += known[id] == around && known_bounded[id] == bounded;
      known[id] = around, known_bounded[id] = bounded;
    }
    return Effect::external;
  }
  template <class Archive>
  void archive(Archive& archive) {
    archive(known, known_bounded, for_nothing);
  }
};

template <int Degree>
int check_told(const ToldRule<PlaneMotion<Degree>>& rule, const MovingSet<PlaneMotion<Degree>>& set, double now) {
  const auto& cells = rule.inner();
  int wrong = rule.for_nothing;
  for (Id id = 0; id < std::max<std::size_t>(rule.known.size(), set.end_id()); ++id) {
    const bool is_vertex = cells.inner().mesh().contains(id);
    const bool is_known = id < rule.known.size() && !rule.known[id].empty();
    wrong += is_vertex != is_known;
    if (is_vertex && is_known) {
      wrong += rule.known[id] != cells.neighbours(id) || rule.known_bounded[id] != cells.bounded(id);
    }
  }
  return wrong + check_neighbours<Degree>(cells, set, now);
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("the neighbours of kinetic Voronoi cells are right, exactly, and so is what they tell",
                       "[voronoi_cells]", ((int Degree), Degree), 1, 2) {
  std::size_t events = 0;
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = Degree == 1 ? 660 : 661; seed < (Degree == 1 ? 663u : 662u); ++seed) {
      CAPTURE(Degree, static_cast<int>(kind), seed);
      const TrialOptions options{seed, kind, 6, 2 + 3 * (seed % 3), 9, seed % 2 == 0 ? never : 0.4, 8};
      const Findings found = try_rule(options, ToldRule<PlaneMotion<Degree>>{}, random_plane_motion<Degree>,
                                      check_told<Degree>);
      CHECK(found.first == "");
      events += found.events.size();
    }
  }
  CHECK(events > 200);
}

TEST_CASE("cells are where they should be, bounded or not", "[voronoi_cells]") {
  MovingSet<PlaneMotion<1>> points;
  const auto at = [](double x, double y) { return PlaneMotion<1>{{{{{x, 0}}, {{y, 0}}}}, 0}; };
  Kinetic<DelaunayRule<PlaneMotion<1>>> triangulation(points, 0);
  Kinetic<VoronoiCellsRule<PlaneMotion<1>>> cells(triangulation, 0);
  points.insert(0, at(-2, 0), 0);
  points.insert(1, at(2, 0), 0);
  CHECK(cells.rule().neighbours(0).empty());
  CHECK_THROWS_WITH(cells.rule().cell(0, points, 0), Catch::Contains("nothing is known of a point 0"));
  points.insert(2, at(0, 4), 0);
  points.insert(3, at(0, -4), 0);
  points.insert(4, at(0, 0), 0);
  using Ids = std::vector<Id>;
  using Vectors = std::vector<VoronoiCell::Vector>;
  const VoronoiCell middle = cells.rule().cell(4, points, 0);
  CHECK(middle.bounded);
  CHECK(middle.neighbours == Ids{0, 3, 1, 2});
  CHECK(middle.vertices == Vectors{{-1, -2}, {1, -2}, {1, 2}, {-1, 2}});
  const VoronoiCell right = cells.rule().cell(1, points, 0);
  CHECK(!right.bounded);
  CHECK(right.neighbours == Ids{2, 4, 3});
  CHECK(right.vertices == Vectors{{1, 2}, {1, -2}});
  CHECK(right.directions == std::array<VoronoiCell::Vector, 2>{{{4, 2}, {4, -2}}});
  CHECK_THROWS_AS(cells.rule().cell(7, points, 0), std::out_of_range);
  points.insert(5, at(2, 0), 0);  // shares the cell of 1
  CHECK(cells.rule().cell(5, points, 0).vertices == right.vertices);
  points.remove(4, 0);
  CHECK(cells.rule().neighbours(4).empty());
  cells.audit(0);
}

TEST_CASE("the corners of cells are as far from their points as from the neighbours, and from no point less",
          "[voronoi_cells]") {
  const std::uint64_t seed = 665;
  CAPTURE(seed);
  Random random(seed);
  MovingSet<PlaneMotion<2>> points;
  for (Id id = 0; id < 30; ++id) points.insert(id, random_plane_motion<2>(random, Kind::generic, 0), 0);
  Kinetic<DelaunayRule<PlaneMotion<2>>> triangulation(points, 0);
  Kinetic<VoronoiCellsRule<PlaneMotion<2>>> cells(triangulation, 0);
  Simulator simulator(0, triangulation, cells);
  int corners = 0, wrong = 0;
  for (double t = 0.1; t < 1; t += 0.1) {
    simulator.advance_to(t);
    for (const Id id : points.ids()) {
      const VoronoiCell cell = cells.rule().cell(id, points, t);
      const std::size_t n = cell.neighbours.size();
      wrong += cell.vertices.size() + !cell.bounded != n;
      const auto distance = [&](const VoronoiCell::Vector& from, Id to) {
        const auto p = points[to](t);
        return std::hypot(from[0] - p[0], from[1] - p[1]);
      };
      const auto is_corner = [&](const VoronoiCell::Vector& place, Id a, Id b) {
        const double radius = distance(place, id), small = 1e-9 * (1 + radius);
        wrong += std::abs(distance(place, a) - radius) > small || std::abs(distance(place, b) - radius) > small;
        for (const Id other : points.ids()) wrong += distance(place, other) < radius - small;
        ++corners;
      };
      for (std::size_t i = 0; i < cell.vertices.size(); ++i) {
        is_corner(cell.vertices[i], cell.neighbours[i], cell.neighbours[(i + 1) % n]);
      }
      if (cell.bounded) continue;
      for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) {  // a place far out on either ray
        const auto& from = end == 0 ? cell.vertices.front() : cell.vertices.back();
        const auto& along = cell.directions[end];
        const VoronoiCell::Vector place{from[0] + 10 * along[0], from[1] + 10 * along[1]};
        const Id neighbour = end == 0 ? cell.neighbours.front() : cell.neighbours.back();
        is_corner(place, neighbour, neighbour);
      }
    }
  }
  CHECK(wrong == 0);
  CHECK(corners > 1000);
  const Measures m = cells.measures();
  CHECK(m.events == 0);  // it has no certificates
  CHECK(m.most_held == 0);
  CHECK(m.followed > 20);
  CHECK(m.external == m.followed);
}

}  // namespace test_voronoi_cells
