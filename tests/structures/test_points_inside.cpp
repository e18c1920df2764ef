// Points in balls and boxes that move, against exact signs.
#include "kds/framework/kinetic.hpp"
#include "kds/framework/reverse.hpp"
#include "kds/framework/snapshot.hpp"
#include "kds/simulator.hpp"
#include "structures/points_inside.hpp"
#include "tests/structures/random_values.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

namespace test_points_inside {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::PlaneMotion;
using certificates::PointMotion;
using structures::BallRegion;
using structures::BoxRegion;
using structures::InsideChange;
using structures::PointsInsideRule;

void make(Random& random, Kind kind, double now, PlaneMotion<1>& path) {
  path = random_plane_motion<1>(random, kind, now);
}
void make(Random& random, Kind kind, double now, PlaneMotion<2>& path) {
  path = random_plane_motion<2>(random, kind, now);
}
void make(Random& random, Kind kind, double now, PointMotion<1>& path) {
  path = random_point_motion<1>(random, kind, now);
}
template <class Path>
void make(Random& random, Kind kind, double now, BallRegion<Path>& ball) {
  make(random, kind, now, ball.centre);
  ball.radius = random_motion<Path::degree>(random, kind, now);
}
template <class Path>
void make(Random& random, Kind kind, double now, BoxRegion<Path>& box) {
  make(random, kind, now, box.low);
  make(random, kind, now, box.high);
}
template <class T>
T made(Random& random, Kind kind, double now) {
  T result{};
  make(random, kind, now, result);
  return result;
}

/// Who is inside, by what it has been told alone.
template <class Region>
struct ToldRule : StandsOn<PointsInsideRule<Region>> {
  using Point = typename Region::Point;
  static constexpr const char* name = "Told";
  std::vector<std::array<Id, 2>> inside{};  ///< region and point, ascending
  int wrong = 0;

  std::monostate certificate(Slot, const MovingSet<Point>&) const { return {}; }
  std::array<Id, 0> members(Slot) const { return {}; }
  Effect repair(Slot, Repair<Point>&) { return Effect::internal; }
  Effect follow(std::span<const InsideChange> changes, Repair<Point>&) {
    for (const auto& [what, region, point] : changes) {
      const std::array<Id, 2> pair{region, point};
      const auto at = std::lower_bound(inside.begin(), inside.end(), pair);
      const bool known = at != inside.end() && *at == pair;
      wrong += known != (what == InsideChange::What::left);
      if (known && what == InsideChange::What::left) inside.erase(at);
      if (!known && what == InsideChange::What::entered) inside.insert(at, pair);
    }
    return Effect::external;
  }
  template <class Archive>
  void archive(Archive& archive) {
    archive(inside, wrong);
  }
};

template <class Region>
struct Scene {
  using Point = typename Region::Point;
  MovingSet<Point> points{};
  MovingSet<Region> region_set{};
  Kinetic<ElementsRule<Region>> regions;
  Kinetic<PointsInsideRule<Region>> inside;
  Kinetic<ToldRule<Region>> told;
  Simulator<Kinetic<ElementsRule<Region>>, Kinetic<PointsInsideRule<Region>>, Kinetic<ToldRule<Region>>> simulator;

  explicit Scene(double begin)
      : regions(region_set, begin),
        inside(points, regions, begin),
        told(inside, begin),
        simulator(begin, regions, inside, told) {}

  /// Pairs that are not as the exact signs of all sides say.
  int wrong() const {
    int count = told.rule().wrong;
    std::size_t pairs = 0;
    for (const Id r : region_set.ids()) {
      std::vector<Id> in;
      for (const Id p : points.ids()) {
        bool all = true;
        for (std::size_t side = 0; side < Region::sides; ++side) {
          kds::detail::with_certificate(region_set[r].side(side, points[p], 1), [&](const auto& certificate) {
            all = all && sign_after(certificate, simulator.now()) >= 0;
          });
        }
        count += all != inside.rule().contains(r, p);
        if (all) in.push_back(p);
      }
      count += in != inside.rule().points_in(r) || in.size() != inside.rule().count(r);
      for (const Id p : in) {
        count += !std::binary_search(told.rule().inside.begin(), told.rule().inside.end(), std::array<Id, 2>{r, p});
      }
      pairs += in.size();
    }
    return count + (pairs != told.rule().inside.size());
  }
  int run_to(double t) {
    int count = 0;
    while (simulator.step(t)) {
      simulator.audit();
      if (simulator.next_time() > simulator.now()) count += wrong();
    }
    simulator.advance_to(t);
    return count + wrong();
  }
};

}  // namespace

TEMPLATE_TEST_CASE("points are in the regions that they are in", "[points_inside]", BallRegion<PlaneMotion<1>>,
                   BoxRegion<PlaneMotion<1>>, BallRegion<PointMotion<1>>, BoxRegion<PlaneMotion<2>>) {
  using Point = typename TestType::Point;
  std::uint64_t events = 0;
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = 420; seed < 424; ++seed) {
      CAPTURE(static_cast<int>(kind), seed);
      Random random(seed);
      Scene<TestType> scene(beginning(kind));
      for (Id id = 0; id < 8; ++id)
        scene.points.insert(id, made<Point>(random, kind, beginning(kind)), beginning(kind));
      for (Id id = 0; id < 3; ++id) {
        scene.region_set.insert(2 * id, made<TestType>(random, kind, beginning(kind)), beginning(kind));
      }
      int wrong = scene.wrong();
      for (int step = 0; step < 10; ++step) {
        wrong += scene.run_to(scene.simulator.now() + random_delay(random, kind));
        const double now = scene.simulator.now();
        const Id point = static_cast<Id>(random.below(8)), region = 2 * static_cast<Id>(random.below(3));
        switch (random.below(4)) {
          case 0:
            scene.points.update(point, made<Point>(random, kind, now), now);
            break;
          case 1:
            scene.region_set.update(region, made<TestType>(random, kind, now), now);
            break;
          case 2:
            scene.region_set.remove(region, now);
            wrong += scene.inside.rule().contains(region, point);
            scene.region_set.insert(region, made<TestType>(random, kind, now), now);
            break;
          default:
            scene.points.remove(point, now);
            wrong += scene.inside.rule().contains(region, point);
            scene.points.insert(point, made<Point>(random, kind, now), now);
        }
        scene.simulator.audit();
        wrong += scene.wrong();
      }
      const Snapshot snapshot = save(scene.simulator, scene.points, scene.region_set);
      const double end = scene.simulator.now();
      wrong += scene.run_to(end + random_delay(random, kind));
      const auto before = scene.inside.measures().events;
      const double last = scene.simulator.now();
      restore(snapshot, scene.simulator, scene.points, scene.region_set);
      wrong += scene.wrong();
      wrong += scene.run_to(last);
      wrong += scene.inside.measures().events != before;
      reverse(scene.simulator, scene.points, scene.region_set);
      wrong += scene.run_to(scene.simulator.now() + random_delay(random, kind));
      CHECK(wrong == 0);
      events += scene.inside.measures().events;
    }
  }
  CHECK(events > 100);
}

TEST_CASE("a disc that grows takes in points one by one, and none while its radius is negative", "[points_inside]") {
  using Disc = BallRegion<PlaneMotion<1>>;
  Scene<Disc> scene(0);
  const auto at = [](double x, double y) { return PlaneMotion<1>{{{{{x, 0}}, {{y, 0}}}}, 0}; };
  scene.points.insert(0, at(0, 0), 0);
  scene.points.insert(1, at(3, 4), 0);
  scene.region_set.insert(7, {at(0, 0), {{{-1, 1}}, 0}}, 0);
  const auto points = [&] { return scene.inside.rule().points_in(7); };
  CHECK(points().empty());
  scene.simulator.advance_to(1);
  CHECK(points() == std::vector<Id>{0});
  scene.simulator.advance_to(5.5);
  CHECK(points() == std::vector<Id>{0});
  scene.simulator.advance_to(6);
  CHECK(points() == std::vector<Id>{0, 1});
  CHECK(scene.inside.measures().external == 2);
  CHECK_FALSE(scene.inside.rule().contains(3, 0));
  CHECK(scene.inside.rule().count(7) == 2);
  CHECK(scene.inside.rule().count(3) == 0);
  Kinetic<ToldRule<Disc>> late(scene.inside, 6);  // is told who is inside already
  CHECK(late.rule().inside == std::vector<std::array<Id, 2>>{{7, 0}, {7, 1}});
  scene.region_set.remove(7, 6);
  CHECK(scene.inside.rule().count(7) == 0);
  CHECK((late.rule().inside.empty() && late.rule().wrong == 0));
}

TEST_CASE("points of one moving rectangle are counted, each event one more or one less", "[points_inside]") {
  const std::uint64_t seed = 430, n = 200;
  CAPTURE(seed);
  Random random(seed);
  using Rectangle = BoxRegion<PlaneMotion<1>>;
  MovingSet<PlaneMotion<1>> points;
  MovingSet<Rectangle> rectangles;
  const auto at = [](double x, double y, double vx) { return PlaneMotion<1>{{{{{x, vx}}, {{y, 0}}}}, 0}; };
  rectangles.insert(0, {at(-0.5, -0.5, 0.25), at(0.5, 0.5, 0.25)}, 0);
  for (Id id = 0; id < n; ++id) points.insert(id, random_plane_motion<1>(random, Kind::generic, 0), 0);
  std::size_t last = 0;
  int wrong = 0;
  const auto one_more_or_less = [&](const PointsInsideRule<Rectangle>& rule, const KineticEvent& event) {
    const std::size_t count = rule.count(0);
    const bool changed = count == last + 1 || count + 1 == last;
    wrong += changed != (event.effect == Effect::external) || (!changed && count != last);
    last = count;
  };
  Kinetic<ElementsRule<Rectangle>> regions(rectangles, 0);
  Kinetic<PointsInsideRule<Rectangle>, decltype(one_more_or_less)> inside(points, regions, 0, {}, one_more_or_less);
  Simulator simulator(0, regions, inside);
  last = inside.rule().count(0);
  simulator.advance_to(2);
  simulator.audit();
  const Measures m = inside.measures();
  CHECK(wrong == 0);
  CHECK(m.external > 50);
  CHECK(m.most_touched <= 4);   // responsive
  CHECK(m.most_held <= 4 * n);  // compact
}

}  // namespace test_points_inside
