// Bounding volumes of bodies: the caller's, those of the bounding sphere.
#include "tests/collision/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <vector>

namespace kds::collision::test_volumes {
namespace {

using namespace tests;

TEST_CASE("A caller's bounding volumes are renewed when they expire, as events of their own", "[world]") {
  for (const auto& [kind, name, what] : broad_phases) {
    INFO(name);
    EventLog<1> log;
    WorldOptions options;
    options.report_pairs = true;
    options.broad_phase = kind;
    options.rate = 10;
    World<1> world(options, &log);
    int calls = 0;
    auto careful = ball<1>(1, {0, 0, 0}, {1, 0, 0});
    // A box at rest that holds the ball for half a second.
    careful.box = [&](double t, const certificates::PointMotion<1>& path) {
      ++calls;
      const Vector3d from = path.position(t);
      KineticBox<1> result{motion<1>(from - Vector3d(1, 1, 1), zero, zero, t),
                           motion<1>(from + Vector3d(1.5, 1, 1), zero, zero, t)};
      result.valid_until = t + 0.5;
      return result;
    };
    world.add_body(careful);
    world.add_body(ball<1>(1, {8.25, 0, 0}));
    world.advance_to(4.25);
    CHECK(calls == 9);  // at 0, 0.5 ... 4
    world.audit();
    world.advance_to(10.25);
    CHECK(calls == 21);
    REQUIRE(log.count(Kind::contact) == 1);
    CHECK(log.of(Kind::contact)[0].time() == 6.25);
    REQUIRE(log.count(Kind::pair_began) == 1);
    CHECK(log.of(Kind::pair_began)[0].time() == 6);  // the first of the boxes that reaches 7.25
    CHECK(log.count(Kind::separation) == 1);
  }
}

TEST_CASE("The window does not matter to volumes that expire", "[world]") {
  for (const double window : {0.1, 0.7, never}) {
    WorldOptions options;
    options.window = window;
    World<1> world(options);
    int calls = 0;
    auto careful = ball<1>(1, {0, 0, 0}, {1, 0, 0});
    careful.box = [&](double t, const certificates::PointMotion<1>& path) {
      ++calls;
      auto result = box_around(path, Vector3d::Constant(-1), Vector3d::Constant(1));
      result.valid_until = t + 1;
      return result;
    };
    world.add_body(careful);
    world.advance_to(5.5);
    CHECK(calls == 6);
  }
}

TEST_CASE("The volume of the bounding sphere holds the shape in any orientation", "[world]") {
  WorldOptions options;
  options.report_pairs = true;
  std::vector<double> began;
  for (const auto volume : {BoundingVolume::shape, BoundingVolume::sphere}) {
    EventLog<1> log;
    World<1> world(options, &log);
    auto a = box<1>({1, 1, 1}, {0, 0, 0});
    a.volume = volume;
    world.add_body(a);
    world.add_body(ball<1>(1, {10, 0, 0}, {-1, 0, 0}));
    world.advance_to(20);
    REQUIRE(log.count(Kind::pair_began) == 1);
    began.push_back(log.of(Kind::pair_began)[0].time());
    REQUIRE(log.count(Kind::contact) == 1);
    CHECK(log.of(Kind::contact)[0].time() == 8);
  }
  CHECK(began[0] == 8);
  CHECK(began[1] == Approx(9 - std::sqrt(3.0)));
}

}  // namespace
}  // namespace kds::collision::test_volumes
