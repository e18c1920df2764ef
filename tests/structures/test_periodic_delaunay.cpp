// The Delaunay triangulation of a plane that repeats itself, against exact brute force over copies of the points.
#include "certificates/plane_motion.hpp"
#include "kds/testing/trial.hpp"
#include "structures/delaunay.hpp"
#include "structures/periodic_delaunay.hpp"
#include "tests/structures/exact_torus.hpp"
#include "tests/structures/random_values.hpp"
#include "tests/support/throws.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <tuple>
#include <vector>

namespace test_periodic_delaunay {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::PeriodOffset;
using certificates::Periods;
using certificates::PlaneMotion;
using structures::PeriodicDelaunayRule;
using structures::PeriodicMesh;
using testing::Findings;
using testing::TrialOptions;
using testing::try_rule;
using Path = PlaneMotion<1>;
using Rule = PeriodicDelaunayRule<Path>;

Path line(double x, double y, double speed_x = 0, double speed_y = 0, double start = 0) {
  return {{{{{x, speed_x}}, {{y, speed_y}}}}, start};
}

/// Runs to the end with an audit at every event; the number of things that are wrong between events, of which one in
/// `looked_at` is looked at.
int run_out(Kinetic<Rule>& structure, MovingSet<Path>& set, double now, double end, int looked_at = 1) {
  Simulator simulator(now, structure);
  int wrong = 0, states = 0;
  while (simulator.step(end)) {
    simulator.audit();
    if (simulator.next_time() > simulator.now() && states++ % looked_at == 0)
      wrong += check_periodic(structure.rule(), set, simulator.now());
  }
  simulator.advance_to(end);
  simulator.audit();
  return wrong + check_periodic(structure.rule(), set, end);
}

/// The edges, each seen from either end: from, to, and the offset in between.
using EdgeSet = std::multiset<std::tuple<Id, Id, std::int64_t, std::int64_t>>;
EdgeSet edges_of(const PeriodicMesh& mesh) {
  EdgeSet edges;
  for (PeriodicMesh::Edge h = 0; h < 3 * mesh.end_triangle(); ++h) {
    if (mesh.in_use(h / 3)) edges.emplace(mesh.origin(h), mesh.target(h), mesh.offset(h).x, mesh.offset(h).y);
  }
  return edges;
}

/// Periods for random motions of a kind: of about the size of their places.
Periods periods_for(Kind kind, std::uint64_t seed) {
  constexpr Periods sizes[] = {{1, 1}, {2, 3}, {0.7, 1.9}, {8, 0.5}};
  if (kind == Kind::scales) return {1e6, 2e6};
  if (kind == Kind::late || kind == Kind::coarse) return {10, 7};
  return sizes[seed % 4];
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("a kinetic periodic triangulation is Delaunay, exactly", "[periodic_delaunay]",
                       ((int Degree), Degree), 1, 2) {
  std::size_t events = 0;
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = 960; seed < (Degree == 1 ? 964u : 961u); ++seed) {
      CAPTURE(Degree, static_cast<int>(kind), seed);
      const TrialOptions options{seed, kind, Degree == 1 ? 8 : 4, seed % 5, 8, seed % 2 == 0 ? never : 0.4, 6};
      const Findings found = try_rule(options, PeriodicDelaunayRule<PlaneMotion<Degree>>(periods_for(kind, seed)),
                                      random_plane_motion<Degree>, check_periodic<Degree>);
      CHECK(found.first == "");
      events += found.events.size();
    }
  }
  CHECK(events > 20);
}

TEST_CASE("a periodic triangulation is the middle of that of many copies", "[periodic_delaunay]") {
  const std::uint64_t seed = 970;
  CAPTURE(seed);
  Random random(seed);
  const Id n = 15;
  const Periods periods{2, 1};
  MovingSet<Path> set, copies;
  for (Id id = 0; id < n; ++id) {
    set.insert(id, random_plane_motion<1>(random, Kind::generic, 0), 0);
    for (Id copy = 0; copy < 49; ++copy) {  // the point itself is number 24
      Path path = set[id];
      path.coordinate[0].c[0] += 2.0 * (static_cast<int>(copy % 7) - 3);
      path.coordinate[1].c[0] += static_cast<int>(copy / 7) - 3;
      copies.insert(id + n * copy, path, 0);
    }
  }
  Kinetic<Rule> torus(set, 0, Rule(periods));
  Kinetic<structures::DelaunayRule<Path>> plane(copies, 0);
  Simulator simulator(0, torus, plane);
  for (double t = 0; t < 0.5; t += 0.0625) {
    simulator.advance_to(t);
    EdgeSet expected;
    const structures::TriangleMesh& mesh = plane.rule().mesh();
    for (structures::TriangleMesh::Edge h = 0; h < 3 * mesh.end_triangle(); ++h) {
      if (!mesh.in_use(h / 3) || !mesh.finite(h / 3) || mesh.origin(h) / n != 24) continue;
      const Id to = mesh.target(h) / n;
      expected.emplace(mesh.origin(h) % n, mesh.target(h) % n, to % 7 - std::int64_t{3}, to / 7 - std::int64_t{3});
    }
    CHECK(edges_of(torus.rule().mesh()) == expected);
  }
  CHECK(torus.measures().events > 10);
}

TEST_CASE("a periodic triangulation keeps to its measures", "[periodic_delaunay]") {
  const std::uint64_t seed = 980;
  CAPTURE(seed);
  Random random(seed);
  MovingSet<Path> set;
  const std::uint64_t n = 50;
  for (Id id = 0; id < n; ++id) set.insert(id, random_plane_motion<1>(random, Kind::generic, 0), 0);
  Kinetic<Rule> structure(set, 0);
  Simulator simulator(0, structure);
  sign_counters = {};
  simulator.advance_to(1);
  CHECK(sign_counters.searches < 20);  // An edge that has just been flipped is known to be the negative of the old one.
  CHECK(sign_counters.exact < 20);
  simulator.audit();
  CHECK(check_periodic(structure.rule(), set, 1) == 0);
  const Measures m = structure.measures();
  CHECK(m.events > n);
  CHECK(m.external == m.events);  // efficient
  CHECK(m.most_touched <= 7);     // responsive: 5 edges, 2 areas
  CHECK(m.most_held == 5 * n);    // compact
  CHECK(m.most_per_element < n);
  CHECK(structure.rule().rebuilds() == 0);
}

TEST_CASE("of none, one, two and three points", "[periodic_delaunay][degeneracy]") {
  MovingSet<Path> set;
  Kinetic<Rule> structure(set, 0, Rule({3, 1}));
  const PeriodicMesh& mesh = structure.rule().mesh();
  CHECK(structure.rule().flat());
  set.insert(5, line(0.25, 0.5, 7, -3), 0);
  CHECK(edges_of(mesh).size() == 6);
  CHECK(structure.next_time() == never);  // Its copies move with it.
  CHECK(check_periodic(structure.rule(), set, 0) == 0);
  set.insert(2, line(1.75, 0, -2, 0), 0);
  CHECK(edges_of(mesh).size() == 12);
  CHECK(check_periodic(structure.rule(), set, 0) == 0);
  set.insert(9, line(2.25, 0.75, 1, 1), 0);
  CHECK(run_out(structure, set, 0, 1) == 0);
  set.remove(5, 1);
  CHECK(run_out(structure, set, 1, 2) == 0);
  set.remove(2, 2);
  set.remove(9, 2);
  CHECK(structure.rule().flat());
  structure.audit(2);
  set.insert(0, line(0, 0), 2);
  CHECK(check_periodic(structure.rule(), set, 2) == 0);
}

TEST_CASE("square lattices, at rest and sheared", "[periodic_delaunay][degeneracy]") {
  for (const Id side : {1u, 2u, 3u, 5u}) {
    CAPTURE(side);
    MovingSet<Path> set;
    const Id n = side * side;
    for (Id id = 0; id < n; ++id) set.insert(id, line(id % side, id / side), 0);
    Kinetic<Rule> structure(set, 0, Rule({1.0 * side, 1.0 * side}));
    CHECK(structure.next_time() == never);
    CHECK(check_periodic(structure.rule(), set, 0) == 0);
    // The rows slide over each other, and all cells are on circles again and again.
    for (Id id = 0; id < n; ++id) set.update(id, line(id % side, id / side, id / side), 0);
    CHECK(run_out(structure, set, 0, 2, static_cast<int>(side)) == 0);
    for (Id id = 0; id < n; id += 2) set.remove(id, 2);
    CHECK(run_out(structure, set, 2, 3) == 0);
  }
}

TEST_CASE("a vertex in the middle of a square of others is removed by flips", "[periodic_delaunay][degeneracy]") {
  MovingSet<Path> set;
  for (Id id = 0; id < 25; ++id) set.insert(id, line(id % 5, id / 5), 0);
  for (Id id = 25; id < 50; ++id) set.insert(id, line(id % 5 + 0.5, (id - 25) / 5 + 0.5), 0);
  Kinetic<Rule> structure(set, 0, Rule({5, 5}));
  const std::uint64_t before = structure.rule().rebuilds();
  for (Id id = 25; id < 50; ++id) set.remove(id, 0);
  structure.audit(0);
  CHECK(check_periodic(structure.rule(), set, 0) == 0);
  CHECK(structure.rule().rebuilds() == before);
}

TEST_CASE("points cross the ends of the rectangle, and may be put back into it", "[periodic_delaunay]") {
  const std::uint64_t seed = 985;
  CAPTURE(seed);
  Random random(seed);
  const Periods periods{0.75, 1.5};
  const Id n = 12;
  MovingSet<Path> set, wrapped;
  for (Id id = 0; id < n; ++id) {
    const auto dyadic = [&] { return random.integer(-64, 64) / 64.0; };
    const double x = dyadic(), y = dyadic(), speed_x = 8 * dyadic(), speed_y = dyadic();
    set.insert(id, line(x, y, speed_x, speed_y), 0);
    wrapped.insert(id, set[id], 0);
  }
  Kinetic<Rule> structure(set, 0, Rule(periods)), other(wrapped, 0, Rule(periods));
  Simulator simulator(0, structure, other);
  std::uint64_t jumps = 0, expensive = 0;
  for (double t = 0.125; t <= 6; t += 0.125) {
    simulator.advance_to(t);
    for (Id id = 0; id < n; ++id) {
      Path path = certificates::restarted(wrapped[id], t);
      for (const std::size_t d : {std::size_t{0}, std::size_t{1}}) {
        double& place = path.coordinate[d].c[0];
        const double inside = place - periods[d] * std::floor(place / periods[d]);
        jumps += inside != place;
        place = inside;
      }
      const std::uint64_t certificates = other.counters().certificates;
      const std::size_t neighbours = other.rule().mesh().valence(id);
      wrapped.update(id, path, t);
      expensive += other.counters().certificates - certificates > 3 * neighbours;
    }
    simulator.audit();
  }
  CHECK(jumps > 100);
  CHECK(expensive == 0);
  CHECK(other.rule().rebuilds() == 0);
  CHECK(structure.measures().events > 100);
  CHECK(check_periodic(structure.rule(), set, 6) == 0);
  CHECK(check_periodic(other.rule(), wrapped, 6) == 0);
  // The same triangles, whichever copies the points are: the ends of their edges without the offsets.
  const auto ends = [](const PeriodicMesh& mesh) {
    std::multiset<std::array<Id, 2>> result;
    for (const auto& [from, to, x, y] : edges_of(mesh)) result.insert({from, to});
    return result;
  };
  CHECK(ends(structure.rule().mesh()) == ends(other.rule().mesh()));
}

TEST_CASE("points that are one up to periods share a vertex, until one goes its own way",
          "[periodic_delaunay][degeneracy]") {
  MovingSet<Path> set;
  const Path corners[] = {line(0, 0, 1), line(1, 0.5), line(0.5, 1.5), line(1.5, 1.5, -1, 0.5)};
  for (Id id = 0; id < 12; ++id) {
    Path path = corners[id % 4];
    path.coordinate[0].c[0] += 2.0 * (id / 4);  // in another copy of the rectangle
    path.coordinate[1].c[0] -= 6.0 * (id / 4);
    set.insert(id, path, 0);
  }
  Kinetic<Rule> structure(set, 0, Rule({2, 3}));
  CHECK(structure.rule().mesh().size() == 2 * 4);
  CHECK(structure.rule().vertex(4) == structure.rule().vertex(8));
  CHECK(structure.rule().has_shared_vertices());
  CHECK(check_periodic(structure.rule(), set, 0) == 0);
  Simulator simulator(0, structure);
  int wrong = 0;
  for (Id id = 0; id < 9; ++id) {
    simulator.advance_to(0.125 * (id + 1));
    if (id % 3 == 0) set.remove(id, simulator.now());
    if (id % 3 == 1) set.update(id, line(0.25 * id, 1, 0.5), simulator.now());
    simulator.audit();
    wrong += check_periodic(structure.rule(), set, simulator.now());
  }
  CHECK(wrong == 0);
}

TEST_CASE("all points run through one point at one time, and where the clock is coarse",
          "[periodic_delaunay][degeneracy]") {
  std::uint64_t rebuilds = 0;
  for (std::uint64_t seed = 990; seed < 996; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const double start = seed < 993 ? 0 : 0x1p51;  // Its neighbours are half a second apart.
    MovingSet<Path> set;
    for (Id id = 0; id < 9; ++id) {
      if (seed < 993) {
        const double vx = random.integer(-8, 8), vy = random.integer(-8, 8), x = random.integer(-1, 1) * 0x1p-20;
        set.insert(id, line(x - vx, -vy, vx, vy), start);
      } else {
        set.insert(id, random_plane_motion<1>(random, Kind::generic, start), start);
      }
    }
    Kinetic<Rule> structure(set, start, Rule({5, 3}));
    CHECK(run_out(structure, set, start, start + 1.5, 16) == 0);
    rebuilds += structure.rule().rebuilds();
  }
  CHECK(rebuilds > 0);  // The last resort is tested too.
}

TEST_CASE("periodic triangulations of sampled points", "[periodic_delaunay][bounded]") {
  using certificates::BoundedPoint;
  MovingSet<BoundedPoint> set;
  const auto sample = [](Id id, double t) {
    return BoundedPoint{{0.37 * id + 0.25 * id * t, 0.59 * id - 0.5 * t * (id % 3)}, 2.0, t};
  };
  set.sample_with(sample, 0.01);
  for (Id id = 0; id < 7; ++id) set.insert(id, sample(id, 0), 0);
  Kinetic<PeriodicDelaunayRule<BoundedPoint>> structure(set, 0);
  Simulator simulator(0, structure);
  int other = 0;
  EdgeSet before = edges_of(structure.rule().mesh());
  for (double t = 0.25; t <= 3; t += 0.25) {
    simulator.advance_to(t);
    simulator.audit();
    other += edges_of(structure.rule().mesh()) != before;
    before = edges_of(structure.rule().mesh());
  }
  CHECK(other > 3);
  CHECK(set.samples() > 7);
}

TEST_CASE("periods and offsets out of range are refused", "[periodic_delaunay]") {
  CHECK_THROWS_AS(Rule({0, 1}), std::invalid_argument);
  CHECK_THROWS_AS(Rule({1, -1}), std::invalid_argument);
  CHECK_THROWS_AS(Rule({1, std::nan("")}), std::invalid_argument);
  CHECK_THROWS_WITH(Rule({1, 0x1p901}), Catch::StartsWith("PeriodicDelaunay: a period must be > 0 and at most 2^900"));
  MovingSet<Path> set;
  Kinetic<Rule> structure(set, 0);
  set.insert(0, line(0, 0), 0);
  set.insert(1, line(0x1p51 + 0.5, 0), 0);  // which is a double
  CHECK(check_periodic(structure.rule(), set, 0) == 0);
  CHECK_THROWS_WITH(set.insert(2, line(1e17, 0), 0),
                    Catch::Contains("a point is more than 2^52 periods away from point"));
  CHECK_THROWS_AS(set.insert(3, line(0, 0), 0), std::logic_error);
}

}  // namespace test_periodic_delaunay
