// Triangulations in space of lattices, of points in one plane, in one place, and at coarse clocks.
#include "certificates/point_motion.hpp"
#include "certificates/weighted_point.hpp"
#include "kds/simulator.hpp"
#include "structures/spatial_triangulation.hpp"
#include "tests/structures/exact_space.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace test_spatial_triangulation_degeneracies {
namespace {

using namespace kds;
using namespace kds::tests;
using Path = certificates::PointMotion<1>;
using Vector = Eigen::Vector3d;
using Delaunay = Kinetic<structures::SpatialDelaunayRule<Path>>;

Path line(const Vector& place, const Vector& velocity = Vector::Zero(), double start = 0) {
  return Path::line(place, velocity, start);
}

struct Outcome {
  int wrong = 0;
  std::size_t events = 0, times = 0;
};

/// Runs to the end with an audit at every event; checks when all events of a time are done.
template <class Structure, class Set>
Outcome run_out(Structure& structure, Set& set, double now, double end) {
  Simulator simulator(now, structure);
  Outcome outcome;
  outcome.wrong += check_space(structure.rule(), set, now);
  while (simulator.step(end)) {
    simulator.audit();
    if (++outcome.events > 5000) return {-1, 0, 0};
    if (simulator.next_time() <= simulator.now()) continue;
    ++outcome.times;
    outcome.wrong += check_space(structure.rule(), set, simulator.now());
  }
  simulator.advance_to(end);
  simulator.audit();
  outcome.wrong += check_space(structure.rule(), set, end);
  return outcome;
}

/// A cubic lattice; velocity(place) is that of the point there.
template <class Velocity>
void add_lattice(MovingSet<Path>& set, int x, int y, int z, const Velocity& velocity) {
  for (int i = 0; i < x * y * z; ++i) {
    const Vector place(i % x, i / x % y, i / (x * y));
    set.add(line(place, velocity(place)), 0);
  }
}

}  // namespace

TEST_CASE("a cubic lattice, at rest and moving in one piece, has one triangulation for good", "[space][degeneracy]") {
  for (const Vector& velocity : {Vector(0, 0, 0), Vector(1, 2, 0.5)}) {
    MovingSet<Path> set;
    add_lattice(set, 3, 2, 2, [&](const Vector&) { return velocity; });
    Delaunay delaunay(set, 0);
    CHECK(delaunay.next_time() == never);
    CHECK(run_out(delaunay, set, 0, 2).wrong == 0);
    CHECK(delaunay.rule().hull().size() == 2 * 12 - 4);  // all are on the hull, with those on its edges
  }
}

TEST_CASE("a cubic lattice that is sheared, stretched, flattened and cut has its events at few times",
          "[space][degeneracy]") {
  const auto run = [](int x, int y, int z, const auto& velocity) {
    MovingSet<Path> set;
    add_lattice(set, x, y, z, velocity);
    Delaunay delaunay(set, 0);
    const Outcome outcome = run_out(delaunay, set, 0, 2);
    CHECK(outcome.wrong == 0);
    return std::pair(outcome, delaunay.rule().rebuilds());
  };
  const auto [sheared, no_rebuild] = run(3, 2, 2, [](const Vector& p) { return Vector(p.y(), 0, 0); });
  CHECK(sheared.times == 1);  // At 1 the cubes are sheared cubes; what was a corner of one is that of its neighbour.
  CHECK(sheared.events >= 1);
  CHECK(no_rebuild == 0);
  const auto sliding = run(2, 2, 3, [](const Vector& p) { return Vector(p.z() == 1 ? 1 : -1, 0.25 * p.z(), 0); });
  CHECK(sliding.first.events > 5);
  CHECK(sliding.second == 0);
  CHECK(run(3, 2, 2, [](const Vector& p) { return Vector(p.x(), 0, 0); }).first.events == 0);
  // At 1 all are in one plane, or in one point; just after that all is the other way round.
  CHECK(run(2, 2, 3, [](const Vector& p) { return Vector(0, 0, -p.z()); }).second > 0);
  CHECK(run(2, 2, 3, [](const Vector& p) { return Vector(-p); }).second > 0);
}

TEST_CASE("one point flies through a cubic lattice, from corner to corner of cubes", "[space][degeneracy]") {
  MovingSet<Path> set;
  add_lattice(set, 2, 2, 3, [](const Vector& p) { return Vector(p == Vector(0, 0, 0) ? Vector(1, 1, 1) : p * 0); });
  Delaunay delaunay(set, 0);
  const Outcome outcome = run_out(delaunay, set, 0, 3.5);
  CHECK(outcome.wrong == 0);
  CHECK(outcome.events > 5);
}

TEST_CASE("points that stay in one place in space share a vertex, until one goes its own way", "[space][degeneracy]") {
  MovingSet<Path> set;
  const Path corners[] = {line({0, 0, 0}, {1, 0, 0}), line({3, 0, 0}), line({0, 3, 0}, {0, 0, 0.5}), line({0, 0, 4}),
                          line({2, 2, 2}, {-1, 0.5, 0})};
  for (Id id = 0; id < 15; ++id) set.insert(id, corners[id % 5], 0);
  Delaunay delaunay(set, 0);
  CHECK(delaunay.rule().hidden().size() == 10);
  CHECK(delaunay.rule().mesh().contains(14));  // the greatest id of those in its place
  CHECK(check_space(delaunay.rule(), set, 0) == 0);
  Simulator simulator(0, delaunay);
  int wrong = 0;
  for (Id id = 0; id < 15; ++id) {
    simulator.advance_to(0.125 * (id + 1));
    if (id % 3 == 0) set.remove(14 - id, simulator.now());
    if (id % 3 == 1) set.update(14 - id, line({0.25 * id, 1, 1}, {0.5, 0, 0}), simulator.now());
    simulator.audit();
    wrong += check_space(delaunay.rule(), set, simulator.now());
  }
  CHECK(wrong == 0);
}

TEST_CASE("points in one plane for good have no tetrahedron, and a point beside it makes some", "[space][degeneracy]") {
  MovingSet<Path> set;
  Delaunay delaunay(set, 0);
  Simulator simulator(0, delaunay);
  CHECK(delaunay.rule().hull().empty());
  for (Id id = 0; id < 8; ++id) {
    const double x = id % 3, y = id / 3;
    set.insert(id, line({x, y, x + y}, {y, x, x + y}), 0);
    CHECK(delaunay.rule().flat());
  }
  CHECK_FALSE(simulator.step());
  set.insert(20, line({1, 1, 9}), 0);
  CHECK(delaunay.rule().neighbours(20).size() == 9);  // 8, and infinity
  CHECK(check_space(delaunay.rule(), set, 0) == 0);
  set.insert(21, line({1, 1, -9}), 0);
  CHECK(check_space(delaunay.rule(), set, 0) == 0);
  simulator.audit();
  set.remove(20, 0);
  CHECK(check_space(delaunay.rule(), set, 0) == 0);
  set.remove(21, 0);
  CHECK(delaunay.rule().flat());
  simulator.audit();
}

TEST_CASE("all points run through one point of space at one time", "[space][degeneracy]") {
  const std::uint64_t seed = 940;
  CAPTURE(seed);
  Random random(seed);
  MovingSet<Path> set;
  for (Id id = 0; id < 9; ++id) {
    const Vector velocity(random.integer(-8, 8), random.integer(-8, 8), random.integer(-8, 8));
    set.insert(id, line(Vector(random.integer(-1, 1) * 0x1p-20, 0, 0) - velocity, velocity), 0);
  }
  Delaunay delaunay(set, 0);
  CHECK(run_out(delaunay, set, 0, 4).wrong == 0);
}

TEST_CASE("a walk through edits of points of a small lattice ends nowhere wrong", "[space][degeneracy]") {
  using Weighted = certificates::WeightedPoint<1, 0>;
  const std::uint64_t seed = 950;
  CAPTURE(seed);
  Random random(seed);
  MovingSet<Path> set;
  MovingSet<Weighted> weighted;
  Delaunay delaunay(set, 0);
  Kinetic<structures::RegularTriangulationRule<Weighted>> regular(weighted, 0);
  Simulator simulator(0, delaunay, regular);
  int wrong = 0;
  for (int step = 0; step < 120; ++step) {
    const auto ids = set.ids();
    // Many in one plane, on one line, on one sphere, and in one place.
    const auto path = line(Vector(random.integer(0, 2), random.integer(0, 2), random.integer(0, 2)));
    const Weighted point{path, {{random.integer(0, 2) / 2.0}}};
    if (ids.size() < 5 || (random.one_in(2) && ids.size() < 10)) {
      set.add(path, 0);
      weighted.add(point, 0);
    } else {
      const Id id = ids[random.below(ids.size())];
      if (random.one_in(2)) {
        set.remove(id, 0);
        weighted.remove(id, 0);
      } else {
        set.update(id, path, 0);
        weighted.update(id, point, 0);
      }
    }
    simulator.audit();
    if (step % 3 == 0) wrong += check_space(delaunay.rule(), set, 0) + check_space(regular.rule(), weighted, 0);
  }
  CHECK(wrong == 0);
}

TEST_CASE("where the clock is coarse many events of space fall on one of its times, and the state is right",
          "[space][degeneracy]") {
  const double start = 0x1p51;  // Its neighbours are half a second apart.
  std::uint64_t rebuilds = 0;
  for (std::uint64_t seed = 960; seed < 964; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    MovingSet<Path> set;
    const auto vector = [&] { return Vector(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)); };
    for (Id id = 0; id < 8; ++id) set.insert(id, line(vector(), vector(), start), start);
    Delaunay delaunay(set, start);
    CHECK(run_out(delaunay, set, start, start + 4).wrong == 0);
    rebuilds += delaunay.rule().rebuilds();
  }
  CHECK(rebuilds > 0);  // The last resort is tested too.
}

TEST_CASE("a point whose weight sinks is hidden, and appears where it leaves the others", "[space][degeneracy]") {
  using Weighted = certificates::WeightedPoint<1, 1>;
  MovingSet<Weighted> set;
  for (const Vector& place : {Vector(3, 3, 3), Vector(3, -3, -3), Vector(-3, 3, -3), Vector(-3, -3, 3)}) {
    set.add({line(place), {{1, 0}}}, 0);
  }
  const Id sinking = set.add({line({0, 0, 0}, {0.125, 0, 0}), {{0, -8}}}, 0);
  const Id flying = set.add({line({0, 0.5, 0}, {1, 0, 0}), {{-1000, 0}}}, 0);
  Kinetic<structures::RegularTriangulationRule<Weighted>> regular(set, 0);
  CHECK(regular.rule().mesh().contains(sinking));
  CHECK(regular.rule().hidden().contains(flying));
  std::vector<double> appears;
  Simulator simulator(0, regular);
  int wrong = 0;
  bool was_hidden = true;
  while (simulator.step(10)) {
    simulator.audit();
    wrong += check_space(regular.rule(), set, simulator.now());
    if (was_hidden && regular.rule().mesh().contains(flying)) appears.push_back(simulator.now());
    was_hidden = regular.rule().hidden().contains(flying);
  }
  CHECK(wrong == 0);
  CHECK(regular.rule().hidden().contains(sinking));
  REQUIRE(appears.size() == 1);
  CHECK(appears[0] > 2);  // at the hull: its weight is too small anywhere inside
}

}  // namespace test_spatial_triangulation_degeneracies
