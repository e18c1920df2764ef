// Voronoi cells, Gabriel graph and alpha complex of a plane that repeats itself, against exact brute force over copies.
#include "kds/testing/trial.hpp"
#include "structures/alpha_complex.hpp"
#include "structures/gabriel_graph.hpp"
#include "structures/periodic_delaunay.hpp"
#include "structures/voronoi_cells.hpp"
#include "tests/structures/exact_torus.hpp"
#include "tests/structures/periodic_motion.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace test_shapes_on_periodic_delaunay {
namespace {

using namespace kds;
using namespace kds::tests;
using Path = certificates::PlaneMotion<1>;
using Delaunay = structures::PeriodicDelaunayRule<Path>;
using Cells = structures::VoronoiCellsRule<Path, Delaunay>;
using Gabriel = structures::GabrielGraphRule<Path, Delaunay>;
using Alpha = structures::AlphaComplexRule<Path, Delaunay>;
using testing::Findings;
using testing::TrialOptions;
using testing::try_rule;
using Copy = ExactTorus::Copy;

std::vector<Id> vertices_of(const ExactTorus& torus, const Delaunay& delaunay) {
  std::vector<Id> ids = torus.ids();
  std::erase_if(ids, [&](Id id) { return delaunay.vertex(id) != id; });
  return ids;
}
bool is(const Copy& copy, const Copy& other) {
  return copy.id == other.id && copy.along == other.along && copy.up == other.up;
}
/// Whether none of all copies is such that f gives true; a and b are passed over.
template <class F>
bool no_other(const ExactTorus& torus, const std::vector<Id>& vertices, const Copy& a, const Copy& b, const F& f) {
  for (const Id id : vertices) {
    for (Copy copy : torus.copies_near(id, a.id)) {
      copy.along += a.along, copy.up += a.up;
      if (!is(copy, a) && !is(copy, b) && f(copy)) return false;
    }
  }
  return true;
}

/// A point and two neighbours that follow each other turn left, and their circle is empty. Around all points these
/// triangles are as large as three rectangles: so they go round each point once.
int check_cells(const Cells& rule, const MovingSet<Path>& set, double now) {
  const ExactTorus torus(set, rule.inner().periods(), now);
  int wrong = 0;
  oracle::Polynomial area;
  const std::vector<Id> vertices = vertices_of(torus, rule.inner());
  for (const Id id : vertices) {
    const auto& around = rule.neighbours(id);
    wrong +=
        !rule.bounded(id) || around.size() < 3 || around.front() != *std::min_element(around.begin(), around.end());
    for (std::size_t i = 0; i < around.size(); ++i) {
      const std::array<Copy, 3> triangle{Copy{id, 0, 0}, exact_copy(around[i]),
                                         exact_copy(around[(i + 1) % around.size()])};
      wrong += torus.sign(torus.area(triangle)) <= 0;
      wrong += torus.inside(triangle);
      area = area + torus.area(triangle);
    }
  }
  const oracle::Polynomial whole = torus.whole_area();
  return wrong + (!vertices.empty() && torus.sign(area - (whole + whole + whole)) != 0);
}

/// All pairs of copies in whose closed disc there is no other: each once.
int check_gabriel(const Gabriel& rule, const MovingSet<Path>& set, double now) {
  const ExactTorus torus(set, rule.inner().periods(), now);
  const std::vector<Id> vertices = vertices_of(torus, rule.inner());
  std::vector<std::array<Id, 2>> edges;
  for (const Id a : vertices) {
    for (const Id b : vertices) {
      if (b < a) continue;
      const Copy from{a, 0, 0};
      for (const Copy& to : torus.copies_near(b, a)) {
        if (a == b && std::pair(to.along, to.up) <= std::pair(from.along, from.up)) continue;  // or the way back
        const auto within = [&](const Copy& copy) { return torus.outside_disc(from, to, copy) <= 0; };
        if (no_other(torus, vertices, from, to, within)) edges.push_back({a, b});
      }
    }
  }
  std::sort(edges.begin(), edges.end());
  return rule.edges() != edges;
}

/// By the definition, of all edges and triangles that the triangulation has.
int check_alpha(const Alpha& rule, const MovingSet<Path>& set, double now) {
  const auto& delaunay = rule.inner();
  const auto& mesh = delaunay.mesh();
  const ExactTorus torus(set, delaunay.periods(), now);
  const std::vector<Id> vertices = vertices_of(torus, delaunay);
  int wrong = 0;
  const auto is_small = [&](std::uint32_t half_edge) {
    const auto [a, b, c] = mesh.corners(half_edge);
    return torus.compare_circle(rule.radius(), {exact_copy(a), exact_copy(b), exact_copy(c)}) >= 0;
  };
  std::size_t triangles = 0, edges = 0;
  for (std::uint32_t t = 0; t < mesh.end_triangle(); ++t) {
    if (!mesh.in_use(t)) continue;
    wrong += rule.contains_triangle(t) != is_small(3 * t);
    triangles += is_small(3 * t);
  }
  for (std::uint32_t edge = 0; edge < mesh.end_edge(); ++edge) {
    if (!mesh.contains_edge(edge)) continue;
    const auto h = mesh.half_edge(edge);
    const auto corners = mesh.corners(h);
    const Copy a = exact_copy(corners[0]), b = exact_copy(corners[1]);
    const auto within = [&](const Copy& copy) { return torus.outside_disc(a, b, copy) < 0; };
    const bool alone = torus.compare_diameter(rule.radius(), a, b) >= 0 && no_other(torus, vertices, a, b, within);
    const bool expected = alone || is_small(h) || is_small(mesh.twin(h));
    wrong += rule.contains_edge(edge) != expected;
    edges += expected;
  }
  return wrong + (rule.edges().size() != edges) + (rule.triangles().size() != triangles);
}

/// Runs trials of a rule on few points, one among them, in a square that repeats itself.
template <class Rule, class Check, class Edit>
void try_on_periodic(std::uint64_t first_seed, const Rule& rule, const Check& check, const Edit& edit) {
  std::size_t events = 0;
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = first_seed; seed < first_seed + 3; ++seed) {
      CAPTURE(static_cast<int>(kind), seed);
      const TrialOptions options{seed, kind, 6, 2 * (seed % 3), 6, seed % 2 == 0 ? never : 0.4, 16};
      const Findings found = try_rule(options, rule, random_periodic_motion, check, edit);
      CHECK(found.first == "");
      events += found.events.size();
    }
  }
  CHECK(events > 200);
}

}  // namespace

TEST_CASE("Voronoi cells of a periodic triangulation", "[periodic_delaunay][voronoi_cells]") {
  try_on_periodic(1343, Cells{}, check_cells, testing::NoRuleEdits{});
}

TEST_CASE("the Gabriel graph of a periodic triangulation", "[periodic_delaunay][gabriel_graph]") {
  try_on_periodic(1340, Gabriel{}, check_gabriel, testing::NoRuleEdits{});
}

TEST_CASE("the alpha complex of a periodic triangulation, for radii that change",
          "[periodic_delaunay][alpha_complex]") {
  const auto edit = [](auto& structure, Random& random, double now) {
    const double radius = random.between(0.1, 0.6);
    structure.edit([&](Alpha& rule, auto& repair) { rule.set_radius(radius, repair); }, now);
  };
  try_on_periodic(1350, Alpha(0.3), check_alpha, edit);
}

TEST_CASE("the cells of a rectangle that repeats itself fill it, whatever the points cross", "[periodic_delaunay]") {
  const std::uint64_t seed = 1360;
  CAPTURE(seed);
  Random random(seed);
  for (const Id n : {1u, 2u, 3u, 12u}) {
    CAPTURE(n);
    MovingSet<Path> points;
    for (Id id = 0; id < n; ++id) points.insert(id, random_periodic_motion(random, Kind::generic, 0), 0);
    Kinetic<Delaunay> triangulation(points, 0, Delaunay({2, 3}));
    Kinetic<Cells> cells(triangulation, 0);
    Simulator simulator(0, triangulation, cells);
    for (double t = 0.5; t < 4; t += 0.5) {
      simulator.advance_to(t);
      double area = 0;
      for (const Id id : points.ids()) {
        const auto cell = cells.rule().cell(id, points, t);
        CHECK(cell.vertices.size() == cell.neighbours.size());
        for (std::size_t i = 0; i < cell.vertices.size(); ++i) {
          const auto& [x, y] = cell.vertices[i];
          const auto& [u, v] = cell.vertices[(i + 1) % cell.vertices.size()];
          area += (x * v - y * u) / 2;
        }
      }
      CHECK(area == Approx(6));
    }
  }
}

TEST_CASE("a point alone in a plane that repeats itself is its own neighbour", "[periodic_delaunay][degeneracy]") {
  MovingSet<Path> points;
  Kinetic<Delaunay> triangulation(points, 0, Delaunay({4, 3}));
  Kinetic<Cells> cells(triangulation, 0);
  Kinetic<Gabriel> gabriel(triangulation, 0);
  Kinetic<Alpha> alpha(triangulation, 0, Alpha(2.5));
  points.insert(5, Path{{{{{1, 1}}, {{1, 0}}}}, 0}, 0);
  const auto cell = cells.rule().cell(5, points, 0);
  CHECK(cell.neighbours == std::vector<Id>(6, 5));
  CHECK(gabriel.rule().edges() == std::vector<std::array<Id, 2>>{{5, 5}, {5, 5}});  // to the right, and upwards
  CHECK(alpha.rule().triangles().size() == 2);  // whose circles have a diameter of 5
  CHECK(alpha.rule().edges().size() == 3);
  alpha.edit([](Alpha& rule, auto& repair) { rule.set_radius(1.75, repair); }, 0);
  CHECK(alpha.rule().edges() == std::vector<std::array<Id, 2>>{{5, 5}});  // upwards only
  Simulator simulator(0, triangulation, cells, gabriel, alpha);
  simulator.advance_to(100);
  simulator.audit();
  points.remove(5, 100);
  CHECK(gabriel.rule().edges().empty());
  CHECK(cells.rule().neighbours(5).empty());
}

}  // namespace test_shapes_on_periodic_delaunay
