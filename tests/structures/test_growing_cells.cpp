// The cells between segments that grow, against a subdivision by brute force.
#include "structures/growing_cells.hpp"
#include "structures/plane_cells.hpp"
#include "tests/structures/growing_definition.hpp"
#include "tests/structures/plane_by_slabs.hpp"
#include "tests/support/exact_rational.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace test_growing_cells {
namespace {

using namespace kds;
using namespace kds::tests;
using namespace kds::tests::growing;
using structures::Divider;
using structures::PlaneCells;
using Vector = PlaneBySlabs::Vector;

Rational rational_of(Exact value) {
  Rational result;
  while (value.sign() != 0) {
    const double part = value.approximate();
    result += oracle::rational(part);
    value = value - Exact(part);
  }
  return result;
}
Vector vector_of(const structures::LinePoint& point) {
  const auto& [x, y, w] = point.exact();
  return {rational_of(x) / rational_of(w), rational_of(y) / rational_of(w)};
}

/// The number of ways in which cells differ from those by slabs.
int differences(const PlaneCells& cells, const PlaneBySlabs& expected) {
  cells.audit();
  std::vector<Vector> vertices;
  for (const auto& vertex : cells.vertices()) vertices.push_back(vector_of(vertex));
  int wrong = !std::equal(vertices.begin(), vertices.end(), expected.vertices.begin(), expected.vertices.end());
  std::set<PlaneBySlabs::Edge> edges;
  for (PlaneCells::Index h = 0; h < cells.half_edges().size(); h += 2) {
    edges.insert({vertices[cells.half_edges()[h].from], vertices[cells.to(h)]});
  }
  wrong += edges != expected.edges || edges.size() != cells.edges();
  std::vector<oracle::Integer> areas;
  Rational sum;
  for (PlaneCells::Index cell = 0; cell < cells.size(); ++cell) {
    const Rational area = rational_of(cells.area(cell, 200));
    sum += area;
    if (cell == PlaneCells::outside) continue;
    areas.push_back(PlaneBySlabs::rounded(area));
  }
  std::sort(areas.begin(), areas.end());
  const auto near = [](const oracle::Integer& a, const oracle::Integer& b) {
    return abs(a - b) < (oracle::Integer(1) << 50);
  };
  wrong += !std::equal(areas.begin(), areas.end(), expected.areas.begin(), expected.areas.end(), near);
  // What each edge adds to the cell on one side it takes from that on the other, up to rounding.
  return wrong + (oracle::abs(sum) > oracle::power_of_two(-150));
}

/// The tracks of a scene by the definition.
std::vector<PlaneBySlabs::Part> tracks(Structure& structure) {
  const double now = structure.simulator.now();
  std::vector<PlaneBySlabs::Part> parts;
  for (const Id id : structure.ends.ids()) {
    const GrowingEnd& end = structure.ends[id];
    const Vector p = Definition::origin(end), v = Definition::velocity(end);
    const auto place = [&](const Rational& t) -> Vector { return {p[0] + v[0] * t, p[1] + v[1] * t}; };
    if (end.whole) {
      if (v != Vector{}) parts.push_back({p, v, std::nullopt});
    } else if (end.path.start < now) {
      const Rational until = structure.definition.exact_stop(id).value_or(oracle::rational(now));
      parts.push_back({p, v, std::array{place(oracle::rational(end.path.start)), place(until)}});
    }
  }
  return parts;
}
PlaneCells cells_of(const Structure& structure) {
  return structures::cells_of(structure.segments.rule(), structure.ends, structure.simulator.now());
}

}  // namespace

TEST_CASE("cells between growing segments are those by brute force, whatever comes, goes or coincides",
          "[growing_cells]") {
  std::size_t seen = 0, holes = 0;
  for (const Scene scene : {Scene::generic, Scene::lattice, Scene::crossroads, Scene::coarse_clock}) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      CAPTURE(static_cast<int>(scene), seed);
      Random random(seed);
      Structure structure(beginning(scene));
      Id count = 0;
      if (seed % 2 == 0) {
        const double side = scene == Scene::coarse_clock ? 0x1p-9 : 8;
        for (const double at : {-side, side}) {
          structure.insert(count++, line_at(at, 0, 0, 1));
          structure.insert(count++, line_at(0, at, 1, 0));
        }
      }
      for (int i = 0; i < 8; ++i) {
        GrowingEnd end = random_end(random, scene, structure.simulator.now());
        structure.insert(count++, end);
        for (Polynomial<1>& x : end.path.coordinate) x.c[1] = -x.c[1];
        if (!end.whole) structure.insert(count++, end);
      }
      for (int step = 0; step < 4; ++step) {
        const double delay = step == 3 ? 4 : 0.375 * static_cast<double>(random.below(4));
        REQUIRE(structure.run_to(structure.simulator.now() + span(scene) * delay) == 0);
        const PlaneCells cells = cells_of(structure);
        CHECK(differences(cells, PlaneBySlabs(tracks(structure))) == 0);
        seen += cells.size() - 1;
        for (PlaneCells::Index cell = 1; cell < cells.size(); ++cell) holes += cells.loops(cell).size() - 1;
        const Id id = static_cast<Id>(random.below(count));
        if (structure.ends.contains(id) && random.one_in(2)) structure.remove(id);
        structure.insert(count++, random_end(random, scene, structure.simulator.now()));
      }
    }
  }
  CHECK(seen > 500);
  CHECK(holes > 10);
}

TEST_CASE("cells between growing segments: degeneracies", "[growing_cells][degeneracy]") {
  Structure structure(0);
  Id count = 0;
  const auto square = [&](double low, double high) {
    for (const double side : {low, high}) {
      structure.insert(count++, line_at(side, 0, 0, 1));
      structure.insert(count++, line_at(0, side, 1, 0));
    }
  };
  const auto segment = [&](double x, double y, double vx, double vy) {
    structure.insert(count++, end_at(x, y, vx, vy));
    structure.insert(count++, end_at(x, y, -vx, -vy));
  };
  const auto areas = [](const PlaneCells& cells) {
    std::vector<double> result;
    for (PlaneCells::Index cell = 1; cell < cells.size(); ++cell) result.push_back(cells.area(cell, 60).approximate());
    std::sort(result.begin(), result.end());
    return result;
  };
  /// The cells after a time.
  const auto after = [&](double t) {
    REQUIRE(structure.run_to(t) == 0);
    PlaneCells cells = cells_of(structure);
    CHECK(differences(cells, PlaneBySlabs(tracks(structure))) == 0);
    return cells;
  };
  SECTION("a square of lines is one cell, and what is outside of it another; two lines that cross make none") {
    structure.insert(count++, line_at(0, 0, 0, 1));
    structure.insert(count++, line_at(0, 0, 1, 0));
    CHECK(after(1).size() == 1);
    CHECK(after(1).vertices().empty());
    square(-2, 2);
    CHECK(areas(after(1)) == std::vector<double>{4, 4, 4, 4});
  }
  SECTION("segments that come to one point at one time stop there") {
    square(-2, 2);
    structure.insert(count++, end_at(-2, 0, 1, 0));
    structure.insert(count++, end_at(0, -2, 0, 1));
    structure.insert(count++, end_at(2, 2, -1, -1));
    CHECK(after(1.5).size() == 2);
    const PlaneCells cells = after(9);
    CHECK(areas(cells) == std::vector<double>{4, 6, 6});
  }
  SECTION("ends that come to one border at one time, of segments that are parallel") {
    square(-4, 4);
    for (const double y : {-2.0, 0.0, 2.0}) segment(0, y, 1, 0);
    const PlaneCells growing = after(2);
    CHECK(growing.size() == 2);
    CHECK(growing.loops(1).size() == 4);  // around the cell, and around each segment
    CHECK(areas(growing) == std::vector<double>{64});
    CHECK(areas(after(4)) == std::vector<double>{16, 16, 16, 16});
  }
  SECTION("ends that come to one segment from both sides at one time, at one point of it") {
    square(-4, 4);
    segment(0, 0, 0, 8);
    structure.insert(count++, end_at(-4, 1, 1, 0));
    structure.insert(count++, end_at(4, 1, -1, 0));
    const PlaneCells cells = after(9);
    CHECK(areas(cells) == std::vector<double>{12, 12, 20, 20});
    CHECK(cells.vertices().size() == 10);
  }
  SECTION("tracks that lie on one another, and are the same, are there once") {
    square(-4, 4);
    segment(0, 0, 1, 0);
    segment(0, 0, 1, 0);
    segment(1, 0, 2, 0);
    segment(0, 1, 0, 1);
    CHECK(areas(after(20)).size() == 3);
  }
  SECTION("a cell within a cell") {
    square(-8, 8);
    for (const double side : {-1.0, 1.0}) {
      segment(0, side, 4, 0);
      segment(side, 0, 0, 4);
    }
    const PlaneCells cells = after(0.25);  // each comes to the two beside it at its ends
    CHECK(areas(cells) == std::vector<double>{4, 252});
  }
  SECTION("of an end that has not begun, or rests, there is nothing") {
    square(-4, 4);
    structure.insert(count++, end_at(0, 0, 0, 0));
    structure.insert(count++, end_at(1, 1, 1, 0, 5));
    CHECK(after(3).vertices().size() == 4);
    CHECK(after(6).vertices().size() == 6);
  }
  SECTION("where an end has stopped stays, also when what stopped it has another motion, or is gone") {
    square(-4, 4);
    structure.insert(count++, end_at(-4, 0, 1, 0));
    structure.insert(count, end_at(1, -4, 0, 2));
    structure.insert(count + 1, end_at(4, 3, -2, 0));
    structure.insert(count + 2, end_at(-4, 3, 2, 0));
    CHECK(areas(after(9)) == std::vector<double>{8, 15, 20, 21});
    structure.remove(count);
    CHECK(areas(after(9)) == std::vector<double>{8, 56});
    structure.remove(count + 1);
    CHECK(areas(after(10)) == std::vector<double>{64});
    CHECK(after(10).vertices().size() > 6);
  }
}

TEST_CASE("cells between growing segments that fill a square have together its area, and are convex",
          "[growing_cells]") {
  const std::uint64_t seed = 20;
  CAPTURE(seed);
  Random random(seed);
  Structure structure(0);
  Id count = 0;
  for (const double side : {0.0, 16.0}) {
    structure.insert(count++, line_at(side, 0, 0, 1));
    structure.insert(count++, line_at(0, side, 1, 0));
  }
  const int segments = 40;
  for (int i = 0; i < segments; ++i) {
    const double x = random.between(0, 16), y = random.between(0, 16), vx = random.between(-1, 1),
                 vy = random.between(-1, 1);
    structure.insert(count++, end_at(x, y, vx, vy));
    structure.insert(count++, end_at(x, y, -vx, -vy));
  }
  while (structure.simulator.step(1e6)) {
  }
  const PlaneCells cells = cells_of(structure);
  cells.audit();
  REQUIRE(cells.size() == segments + 2);
  CHECK(cells.loops(PlaneCells::outside).size() == 1);
  Exact sum;
  int bends = 0;
  for (PlaneCells::Index cell = 1; cell < cells.size(); ++cell) {
    CHECK(cells.loops(cell).size() == 1);
    sum = sum + cells.area(cell, 100);
    const auto loop = cells.loop(cells.loops(cell)[0]);
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const auto& half_edge = cells.half_edges()[loop[i]];
      auto line = cells.dividers()[half_edge.divider].line;
      if (loop[i] % 2 == 1) line.direction = {-line.direction[0], -line.direction[1]};
      bends += side(cells.vertices()[cells.to(loop[(i + 1) % loop.size()])], line) < 0;
    }
  }
  CHECK(bends == 0);
  CHECK(oracle::abs(rational_of(sum) - Rational(256)) < oracle::power_of_two(-90));
}

}  // namespace test_growing_cells
