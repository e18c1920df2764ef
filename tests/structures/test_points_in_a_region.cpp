// Points in one region, of the examples: against exact signs of all sides, with edits of points and region.
#include "examples/points_in_a_region.hpp"
#include "kds/testing/trial.hpp"
#include "tests/structures/random_values.hpp"

#include <catch2/catch.hpp>

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <variant>

namespace test_points_in_a_region {
namespace {

using namespace kds;
using namespace kds::tests;
using certificates::PlaneMotion;
using certificates::PointMotion;
using examples::PointsInRule;
using structures::BallRegion;
using structures::BoxRegion;

template <class Path>
Path random_path(Random& random, Kind kind, double now) {
  if constexpr (certificates::dimensions<Path> == 2) {
    return random_plane_motion<Path::degree>(random, kind, now);
  } else {
    return random_point_motion<Path::degree>(random, kind, now);
  }
}
// Some contain nothing at first; the others are made wider.
template <class Path>
void renew(BallRegion<Path>& ball, Random& random, Kind kind, double now) {
  ball = {random_path<Path>(random, kind, now), random_motion<Path::degree>(random, kind, now)};
  if (!random.one_in(4)) ball.radius.position.c[0] += 1;
}
template <int Degree>
void renew(BoxRegion<PlaneMotion<Degree>>& box, Random& random, Kind kind, double now) {
  using Path = PlaneMotion<Degree>;
  box = {random_path<Path>(random, kind, now), random_path<Path>(random, kind, now)};
  if (random.one_in(4)) return;
  for (auto& axis : box.high.coordinate) axis.c[0] += 1;
}

template <class... C>
int sign_of(const std::variant<C...>& choice, double now) {
  return std::visit([now](const auto& certificate) { return sign_after(certificate, now); }, choice);
}
template <class C>
int sign_of(const C& certificate, double now) {
  return sign_after(certificate, now);
}

template <class R>
int check_inside(const PointsInRule<R>& rule, const MovingSet<typename R::Point>& points, double now) {
  int wrong = 0;
  std::size_t count = 0;
  for (const Id id : points.ids()) {
    bool inside = true;
    for (std::size_t side = 0; side < R::sides; ++side) {
      inside = inside && sign_of(rule.region.side(side, points[id], 1), now) >= 0;
    }
    wrong += inside != rule.inside.contains(id);
    count += inside;
  }
  return wrong + (count != rule.count);
}

}  // namespace

TEMPLATE_TEST_CASE("points are in a region of the examples or not, after every event and edit", "[points_in_a_region]",
                   BoxRegion<PlaneMotion<1>>, BallRegion<PlaneMotion<1>>, BoxRegion<PlaneMotion<2>>,
                   BallRegion<PointMotion<1>>) {
  using Path = typename TestType::Point;
  std::size_t events = 0, edits = 0;
  for (const Kind kind : all_kinds) {
    for (std::uint64_t seed = 930; seed < 938; ++seed) {
      CAPTURE(static_cast<int>(kind), seed);
      Random random(seed);
      PointsInRule<TestType> rule{};
      renew(rule.region, random, kind, beginning(kind));
      const auto edit = [&](auto& structure, Random& of_edit, double now) {
        if (!of_edit.one_in(2)) return;
        TestType other;
        renew(other, of_edit, kind, now);
        structure.edit([&](auto& changed, auto& repair) { changed.change_region(other, repair); }, now);
        ++edits;
      };
      // The region is no element: reverse() does not turn it.
      const auto found =
          testing::try_rule({.seed = seed, .kind = kind, .steps = 30, .first = 16, .most = 24, .backwards = false},
                            rule, random_path<Path>, check_inside<TestType>, edit);
      CHECK(found.first == "");
      events += found.events.size();
    }
  }
  CHECK(events > 400);
  CHECK(edits > 200);
}

TEST_CASE("a region is turned round by its rule's edit where time runs back", "[points_in_a_region]") {
  using Disc = BallRegion<PlaneMotion<1>>;
  const std::uint64_t seed = 940;
  CAPTURE(seed);
  Random random(seed);
  MovingSet<PlaneMotion<1>> points;
  for (Id id = 0; id < 40; ++id) points.insert(id, random_path<PlaneMotion<1>>(random, Kind::generic, 0), 0);
  const Disc disc{{}, {{{0.25, 0.5}}, 0}};
  Kinetic<PointsInRule<Disc>> structure(points, 0, PointsInRule<Disc>{disc});
  Simulator simulator(0, structure);
  const std::size_t before = structure.rule().count;
  simulator.advance_to(1);
  CHECK(structure.rule().count > before);
  reverse(simulator, points);
  structure.edit([&](auto& rule, auto& repair) { rule.change_region(reversed(disc), repair); }, simulator.now());
  simulator.audit();
  while (simulator.step(0)) simulator.audit();
  CHECK(structure.rule().count == before);
  CHECK(check_inside(structure.rule(), points, simulator.now()) == 0);
}

}  // namespace test_points_in_a_region
