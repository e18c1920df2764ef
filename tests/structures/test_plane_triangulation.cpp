// Delaunay triangulation and convex hull against exact brute force.
#include "certificates/plane_motion.hpp"
#include "structures/convex_hull.hpp"
#include "structures/delaunay.hpp"
#include "tests/structures/exact_plane.hpp"
#include "tests/structures/run_structure.hpp"
#include "tests/structures/sampled_orbits.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace {

using namespace kds;
using namespace kds::tests;
using certificates::PlaneMotion;
using structures::ConvexHullRule;
using structures::Criterion;
using structures::DelaunayRule;
using structures::PlaneTriangulationRule;
using structures::TriangleMesh;

/// Every triangle turns left, every edge of the hull has all points on its left, no point is inside a circle; and there
/// are as many triangles as the vertices must have.
template <int Degree, Criterion What>
int check_triangulation(const PlaneTriangulationRule<PlaneMotion<Degree>, What>& rule,
                        const MovingSet<PlaneMotion<Degree>>& set, double now) {
  const ExactPlane plane(set, now);
  const auto ids = plane.ids();
  const TriangleMesh& mesh = rule.mesh();
  int wrong = 0;
  if (rule.flat()) {
    for (const Id a : ids) {
      for (const Id b : ids) {
        for (const Id c : ids) wrong += a < b && b < c && plane.orientation(a, b, c) != 0;
      }
    }
    return wrong;
  }
  std::size_t vertices = 0, triangles = 0;
  for (const Id id : ids) {
    vertices += mesh.contains(id);
    wrong += rule.vertex(id) != id && !plane.same(id, rule.vertex(id));
    wrong += mesh.contains(id) != (rule.vertex(id) == id);
  }
  const std::vector<Id> hull = rule.hull();
  for (std::uint32_t t = 0; t < mesh.end_triangle(); ++t) {
    if (!mesh.in_use(t) || !mesh.finite(t)) continue;
    ++triangles;
    const Id a = mesh.origin(3 * t), b = mesh.origin(3 * t + 1), c = mesh.origin(3 * t + 2);
    wrong += plane.orientation(a, b, c) <= 0;
    if (What != Criterion::delaunay) continue;
    for (const Id d : ids) wrong += d != a && d != b && d != c && plane.inside(a, b, c, d) > 0;
  }
  wrong += triangles != 2 * vertices - 2 - hull.size();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Id a = hull[i], b = hull[(i + 1) % hull.size()];
    for (const Id c : ids) wrong += plane.orientation(a, b, c) < 0;
  }
  return wrong;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("a kinetic Delaunay triangulation is Delaunay, exactly", "[delaunay]", ((int Degree), Degree), 1,
                       2) {
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = 800; seed < (Degree == 1 ? 803u : 801u); ++seed) {
      CAPTURE(Degree, static_cast<int>(kind), seed);
      std::vector<KineticEvent> log;
      const RunOptions options{Degree == 1 ? 10 : 6, 4 + 4 * (seed % 3), 12, seed % 2 == 0 ? never : 0.4, 6};
      CHECK(run_structure(seed, kind, options, DelaunayRule<PlaneMotion<Degree>>{}, random_plane_motion<Degree>,
                          check_triangulation<Degree, Criterion::delaunay>, log) == 0);
    }
  }
}

TEMPLATE_TEST_CASE_SIG("a kinetic convex hull is the hull, exactly", "[hull]", ((int Degree), Degree), 1, 2) {
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = 810; seed < 813; ++seed) {
      CAPTURE(Degree, static_cast<int>(kind), seed);
      std::vector<KineticEvent> log;
      const RunOptions options{12, 4 + 4 * (seed % 3), 14, seed % 2 == 0 ? never : 0.4, 2};
      CHECK(run_structure(seed, kind, options, ConvexHullRule<PlaneMotion<Degree>>{}, random_plane_motion<Degree>,
                          check_triangulation<Degree, Criterion::hull>, log) == 0);
    }
  }
}

namespace {

using Delaunay1 = Kinetic<DelaunayRule<PlaneMotion<1>>>;
using Hull1 = Kinetic<ConvexHullRule<PlaneMotion<1>>>;

PlaneMotion<1> line(double x, double y, double speed_x = 0, double speed_y = 0, double start = 0) {
  return {{{{{x, speed_x}}, {{y, speed_y}}}}, start};
}

/// Runs to the end with an audit at every event; the number of things that are wrong between events.
template <class Structure, class Set>
int run_out(Structure& structure, Set& set, double now, double end) {
  Simulator simulator(now, structure);
  int wrong = 0;
  std::uint64_t events = 0;
  while (simulator.step(end)) {
    simulator.audit();
    if (simulator.next_time() > simulator.now()) wrong += check_triangulation(structure.rule(), set, simulator.now());
    if (++events > 20000) return -1;
  }
  simulator.advance_to(end);
  simulator.audit();
  return wrong + check_triangulation(structure.rule(), set, end);
}

}  // namespace

TEST_CASE("triangulations keep to their measures", "[delaunay][hull]") {
  const std::uint64_t seed = 820;
  CAPTURE(seed);
  Random random(seed);
  MovingSet<PlaneMotion<1>> set;
  const std::uint64_t n = 80;
  for (Id id = 0; id < n; ++id) {
    set.insert(id, line(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)), 0);
  }
  Delaunay1 delaunay(set, 0);
  Hull1 hull(set, 0);
  Simulator simulator(0, delaunay, hull);
  sign_counters = {};
  simulator.advance_to(3);
  CHECK(sign_counters.searches <
        20);  // Edges that have just been flipped, whose value is zero up to rounding, need none.
  CHECK(sign_counters.exact < 20);
  simulator.audit();
  CHECK(delaunay.rule().hull() == hull.rule().hull());
  const Measures d = delaunay.measures(), h = hull.measures();
  CHECK(d.events > n);
  CHECK(d.external > 0.9 * d.events);  // efficient: the rest are edges of the hull that come to lead another way
  CHECK(d.most_touched <= 20);         // responsive: 5 edges from both sides, 6 areas
  CHECK(d.most_held <= 5 * n);         // compact
  CHECK(h.most_held <= 3 * n);
  CHECK(h.most_touched <= 20);
  CHECK(h.external < h.events);
  CHECK(d.most_per_element < n);
  CHECK(delaunay.rule().rebuilds() == 0);
  CHECK(hull.rule().rebuilds() == 0);
}

TEST_CASE("a bounce leaves a triangulation as it is, and a jump does not", "[delaunay]") {
  const std::uint64_t seed = 825;
  CAPTURE(seed);
  Random random(seed);
  MovingSet<PlaneMotion<1>> set;
  for (Id id = 0; id < 60; ++id) set.insert(id, random_plane_motion<1>(random, Kind::generic, 0), 0);
  Delaunay1 delaunay(set, 0);
  Simulator simulator(0, delaunay);
  int other = 0, expensive = 0, wrong = 0;
  for (Id id = 0; id < 60; ++id) {
    simulator.advance_to(0.01 * id);
    const auto neighbours = [&] {
      std::vector<Id> result;
      for (Id end = 0; end < 60; ++end) {
        if (end != id && delaunay.rule().mesh().connected(id, end)) result.push_back(end);
      }
      return result;
    };
    const auto before = neighbours();
    const auto certificates = delaunay.counters().certificates;
    auto path = certificates::restarted(set[id], simulator.now());
    path.coordinate[0].c[1] = -path.coordinate[0].c[1];
    set.update(id, path, simulator.now());
    other += neighbours() != before;
    expensive += delaunay.counters().certificates - certificates > 4 * before.size() + 12;
    if (id % 10 == 0) {
      set.update(id, line(5 + id, 5), simulator.now());
      simulator.audit();
      wrong += check_triangulation(delaunay.rule(), set, simulator.now());
      CHECK(neighbours() != before);
    }
  }
  simulator.audit();
  CHECK(other == 0);
  CHECK(expensive == 0);
  CHECK(wrong == 0);
  CHECK(delaunay.rule().rebuilds() == 0);
}

// --- degeneracies

TEST_CASE("four points of a square lattice are on one circle, for a moment and for good", "[delaunay][degeneracy]") {
  MovingSet<PlaneMotion<1>> set;
  for (Id id = 0; id < 25; ++id) set.insert(id, line(id % 5, id / 5), 0);
  Delaunay1 still(set, 0);
  Hull1 hull(set, 0);
  CHECK(still.next_time() == never);
  CHECK(check_triangulation(still.rule(), set, 0) == 0);
  CHECK(hull.rule().hull().size() == 16);  // with those on the edges
  // All rows begin to shear: every square ceases to be one at once, and comes to be one again a unit later.
  for (Id id = 0; id < 25; ++id) set.update(id, line(id % 5, id / 5, id / 5), 0);
  CHECK(run_out(still, set, 0, 3) == 0);
  CHECK(still.measures().events >= 16);
}

TEST_CASE("three points that become collinear and stay", "[delaunay][hull][degeneracy]") {
  MovingSet<PlaneMotion<1>> set;
  const Id a = set.add(line(0, 0), 0), b = set.add(line(4, 0), 0), c = set.add(line(1, 2, 0.5, -1), 0);
  const Id d = set.add(line(2, -3), 0);
  Delaunay1 delaunay(set, 0);
  Hull1 hull(set, 0);
  Simulator simulator(0, delaunay, hull);
  simulator.advance_to(2);
  CHECK(hull.rule().hull() == std::vector<Id>{a, d, b});  // At 2+ it is inside...
  set.update(c, line(2, 0, 0.125, 0, 2), 2);
  CHECK(hull.rule().hull() == std::vector<Id>{a, d, b, c});  // ... but here it is on the edge for good.
  simulator.audit();
  CHECK(check_triangulation(hull.rule(), set, 2) == 0);
  CHECK(check_triangulation(delaunay.rule(), set, 2) == 0);
  simulator.advance_to(17);
  CHECK(hull.rule().hull() == std::vector<Id>{a, d, b, c});
  simulator.advance_to(19);  // It has passed b on their line, and goes on.
  simulator.audit();
  CHECK(check_triangulation(hull.rule(), set, 19) == 0);
  CHECK(check_triangulation(delaunay.rule(), set, 19) == 0);
}

TEST_CASE("points that move together keep their triangulation", "[delaunay][hull][degeneracy]") {
  const std::uint64_t seed = 830;
  CAPTURE(seed);
  Random random(seed);
  MovingSet<PlaneMotion<2>> set;
  for (Id id = 0; id < 30; ++id) {
    set.insert(id, {{{{{random.between(-1, 1), 0.1, 0.3}}, {{random.between(-1, 1), 0.2, -0.7}}}}, 0.5}, 0);
  }
  Kinetic<DelaunayRule<PlaneMotion<2>>> delaunay(set, 0);
  CHECK(delaunay.next_time() == never);
  CHECK(check_triangulation(delaunay.rule(), set, 0) == 0);
}

TEST_CASE("points that are one for good share a vertex, until one goes its own way", "[delaunay][degeneracy]") {
  MovingSet<PlaneMotion<1>> set;
  const PlaneMotion<1> corners[] = {line(0, 0, 1), line(3, 0), line(0, 3), line(2, 2, -1, 0.5)};
  for (Id id = 0; id < 12; ++id) set.insert(id, corners[id % 4], 0);
  Delaunay1 delaunay(set, 0);
  CHECK(delaunay.rule().mesh().size() == 2 * (4 + 1) - 4);
  CHECK(delaunay.rule().vertex(4) == delaunay.rule().vertex(8));
  CHECK(check_triangulation(delaunay.rule(), set, 0) == 0);
  Simulator simulator(0, delaunay);
  int wrong = 0;
  for (Id id = 0; id < 9; ++id) {
    simulator.advance_to(0.125 * (id + 1));
    if (id % 3 == 0) set.remove(id, simulator.now());
    if (id % 3 == 1) set.update(id, line(0.25 * id, 1, 0.5), simulator.now());
    simulator.audit();
    wrong += check_triangulation(delaunay.rule(), set, simulator.now());
  }
  CHECK(wrong == 0);
}

TEST_CASE("points on one line for good have no triangle, and a point beside it makes some",
          "[delaunay][hull][degeneracy]") {
  MovingSet<PlaneMotion<1>> set;
  Delaunay1 delaunay(set, 0);
  Hull1 hull(set, 0);
  Simulator simulator(0, delaunay, hull);
  for (Id id = 0; id < 8; ++id) {
    set.insert(id, line(id, 2.0 * id, 0.25 * id, 0.5 * id), 0);
    if (!delaunay.rule().flat() || !hull.rule().hull().empty()) FAIL("a triangle of collinear points");
  }
  CHECK_FALSE(simulator.step());
  set.insert(20, line(1, 0), 0);
  CHECK(delaunay.rule().mesh().valence(20) == 9);  // 8, and infinity
  simulator.audit();
  CHECK(check_triangulation(hull.rule(), set, 0) == 0);
  set.update(3, line(3, 7), 0);
  CHECK(check_triangulation(delaunay.rule(), set, 0) == 0);
  set.update(3, line(3, 6), 0);
  set.remove(20, 0);
  CHECK(delaunay.rule().flat());
  CHECK(hull.rule().flat());
  simulator.audit();
}

TEST_CASE("all points run through one point at one time", "[delaunay][hull][degeneracy]") {
  const std::uint64_t seed = 840;
  CAPTURE(seed);
  Random random(seed);
  MovingSet<PlaneMotion<1>> set;
  for (Id id = 0; id < 16; ++id) {
    const double vx = random.integer(-8, 8), vy = random.integer(-8, 8), x = random.integer(-1, 1) * 0x1p-20;
    set.insert(id, line(x - vx, -vy, vx, vy), 0);  // near the origin at 1, many of them there exactly
  }
  Delaunay1 delaunay(set, 0);
  CHECK(run_out(delaunay, set, 0, 4) == 0);
  Hull1 hull(set, 4);
  CHECK(hull.rule().hull() == delaunay.rule().hull());
}

TEST_CASE("where the clock is coarse many events fall on one of its times, and the state is right all the same",
          "[delaunay][hull][degeneracy]") {
  const double start = 0x1p51;  // Its neighbours are half a second apart.
  std::uint64_t rebuilds = 0;
  int wrong = 0;
  for (std::uint64_t seed = 850; seed < 862; ++seed) {
    Random random(seed);
    MovingSet<PlaneMotion<1>> set;
    for (Id id = 0; id < 9; ++id) {
      set.insert(
          id, line(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), start),
          start);
    }
    Delaunay1 delaunay(set, start);
    Hull1 hull(set, start);
    wrong += run_out(delaunay, set, start, start + 4) != 0;
    wrong += run_out(hull, set, start, start + 4) != 0;
    rebuilds += delaunay.rule().rebuilds() + hull.rule().rebuilds();
  }
  CHECK(wrong == 0);
  CHECK(rebuilds > 0);  // The last resort is tested too.
}

TEST_CASE("the walk of a small triangulation through edits of all kinds ends nowhere wrong", "[delaunay][hull]") {
  const std::uint64_t seed = 870;
  CAPTURE(seed);
  Random random(seed);
  MovingSet<PlaneMotion<1>> set;
  Delaunay1 delaunay(set, 0);
  Hull1 hull(set, 0);
  Simulator simulator(0, delaunay, hull);
  int wrong = 0;
  for (int step = 0; step < 400; ++step) {
    const auto ids = set.ids();
    const double now = simulator.now();
    const auto point = [&] { return line(random.integer(0, 4), random.integer(0, 4)); };  // many collinear, many one
    if (ids.size() < 4 || (random.one_in(2) && ids.size() < 14)) {
      set.add(point(), now);
    } else if (random.one_in(2)) {
      set.remove(ids[random.below(ids.size())], now);
    } else {
      set.update(ids[random.below(ids.size())], point(), now);
    }
    simulator.audit();
    wrong += check_triangulation(delaunay.rule(), set, now) + check_triangulation(hull.rule(), set, now);
  }
  CHECK(wrong == 0);
}

TEST_CASE("a Delaunay triangulation of sampled points is that of the truth where it is guaranteed",
          "[delaunay][bounded]") {
  using certificates::BoundedPoint;
  const std::uint64_t seed = 880;
  CAPTURE(seed);
  Random random(seed);
  const Id n = 12;
  const Orbits orbits(random, n);  // known to the sampler only
  const auto sample = [&](Id id, double t) { return BoundedPoint{orbits.position(id, t), orbits.speed(id), t}; };
  MovingSet<BoundedPoint> set;
  const double tick = 0.02, end = 8;
  set.sample_with(sample, tick);
  for (Id id = 0; id < n; ++id) set.insert(id, sample(id, 0), 0);
  Kinetic<DelaunayRule<BoundedPoint>> delaunay(set, 0);
  Simulator simulator(0, delaunay);
  InCircleTests tests;
  for (double t = 0.125; t <= end; t += 0.125) {
    simulator.advance_to(t);
    simulator.audit();
    tests.count(delaunay, set, orbits, t);
  }
  CHECK(tests.wrong == 0);
  CHECK(tests.guaranteed > 0.9 * tests.all);
  CHECK(set.samples() > n);
  CHECK(set.samples() < 0.5 * n * end / tick);  // Sampling everything every tick takes n end / tick.
}
