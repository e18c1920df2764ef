// Delaunay triangulation and convex hull against exact brute force.
#include "certificates/plane_motion.hpp"
#include "kds/testing/trial.hpp"
#include "structures/convex_hull.hpp"
#include "structures/delaunay.hpp"
#include "tests/structures/check_triangulation.hpp"
#include "tests/structures/random_values.hpp"
#include "tests/structures/sampled_orbits.hpp"
#include "tests/structures/to_log.hpp"

#include <catch2/catch.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace test_plane_triangulation {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::PlaneMotion;
using structures::ConvexHullRule;
using structures::Criterion;
using structures::DelaunayRule;
using testing::Findings;
using testing::TrialOptions;
using testing::try_rule;

}  // namespace

TEMPLATE_TEST_CASE_SIG("a kinetic Delaunay triangulation is Delaunay, exactly", "[delaunay]", ((int Degree), Degree), 1,
                       2, 3) {
  std::size_t events = 0;
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = 800; seed < (Degree == 1 ? 803u : 801u); ++seed) {
      CAPTURE(Degree, static_cast<int>(kind), seed);
      const double window = seed % 2 == 0 ? never : 0.4;
      TrialOptions options{seed, kind, Degree == 1 ? 10 : 6, 4 + 4 * (seed % 3), 12, window, 6};
      if (Degree == 3) options.steps = 2, options.first = options.most = 7;  // signs of degree 12, exact at each check
      const Findings found = try_rule(options, DelaunayRule<PlaneMotion<Degree>>{}, random_plane_motion<Degree>,
                                      check_triangulation<Degree, Criterion::delaunay>);
      CHECK(found.first == "");
      events += found.events.size();
    }
  }
  CHECK(events > 20);
}

TEMPLATE_TEST_CASE_SIG("a kinetic convex hull is the hull, exactly", "[hull]", ((int Degree), Degree), 1, 2) {
  std::size_t events = 0;
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = 810; seed < 813; ++seed) {
      CAPTURE(Degree, static_cast<int>(kind), seed);
      const TrialOptions options{seed, kind, 12, 4 + 4 * (seed % 3), 14, seed % 2 == 0 ? never : 0.4, 2};
      const Findings found = try_rule(options, ConvexHullRule<PlaneMotion<Degree>>{}, random_plane_motion<Degree>,
                                      check_triangulation<Degree, Criterion::hull>);
      CHECK(found.first == "");
      events += found.events.size();
    }
  }
  CHECK(events > 20);
}

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

}  // namespace test_plane_triangulation
