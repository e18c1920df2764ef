// Delaunay triangulation and convex hull of points on one line, on one circle, in one place, and at coarse clocks.
#include "certificates/plane_motion.hpp"
#include "structures/delaunay.hpp"
#include "tests/structures/check_triangulation.hpp"
#include "tests/structures/random_values.hpp"

#include <catch2/catch.hpp>

#include <cstdint>
#include <vector>

namespace test_plane_triangulation_degeneracies {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::PlaneMotion;
using structures::DelaunayRule;

}  // namespace

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
  for (std::uint64_t seed = 850; seed < 862; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    MovingSet<PlaneMotion<1>> set;
    for (Id id = 0; id < 9; ++id) {
      set.insert(
          id, line(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), start),
          start);
    }
    Delaunay1 delaunay(set, start);
    Hull1 hull(set, start);
    CHECK(run_out(delaunay, set, start, start + 4) == 0);
    CHECK(run_out(hull, set, start, start + 4) == 0);
    rebuilds += delaunay.rule().rebuilds() + hull.rule().rebuilds();
  }
  CHECK(rebuilds > 0);  // The last resort is tested too.
}

}  // namespace test_plane_triangulation_degeneracies
