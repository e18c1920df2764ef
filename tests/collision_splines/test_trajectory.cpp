// A trajectory of cubic pieces, as docs/splines.md shows it.
#include "collision/world.hpp"
#include "tests/collision/event_log.hpp"

#include <catch2/catch.hpp>

#include <span>
#include <vector>

namespace kds::collision::test_trajectory {
namespace {

using Eigen::Vector3d;

struct WayPoint {
  double time;
  Vector3d place;
  Vector3d velocity;
};

/// A cubic from each point to the next; at the last one the body stays.
BodyDescription<3> along(const Shape& shape, std::span<const WayPoint> points) {
  using Path = certificates::PointMotion<3>;
  BodyDescription<3> body;
  body.shape = shape;
  body.fixed = true;  // nothing turns it from its way
  body.motion.clear();
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const auto& [t0, p0, v0] = points[i];
    const auto& [t1, p1, v1] = points[i + 1];
    body.motion.push_back(Path::cubic(p0, v0, p1, v1, t0, t1));
  }
  body.motion.push_back(Path::line(points.back().place, Vector3d::Zero(), points.back().time));
  return body;
}

TEST_CASE("Curves: two gripping hands that cross each other's way", "[splines][trajectory]") {
  tests::EventLog<3> log;
  World<3> world({}, &log);
  const Vector3d rest = Vector3d::Zero();
  const std::vector<WayPoint> left{{0, {-4, 0, 0}, rest}, {1, {0, 1, 0}, {4, 0, 0}}, {2, {4, 0, 0}, rest}};
  const std::vector<WayPoint> right{{0, {4, 0, 0}, rest}, {1, {0, 1.5, 0}, {-4, 0, 0}}, {2, {-4, 0, 0}, rest}};
  world.add_body(along(Box{{0.5, 0.5, 0.5}}, left));
  world.add_body(along(Sphere{0.5}, right));
  world.advance_to(3);
  const auto& events = log.events;
  REQUIRE(events.size() == 2);
  // Both reach x = 0 at t = 1, half a length apart in y: they meet before and part after, by symmetry as long.
  CHECK(events[0].kind == tests::Kind::contact);
  CHECK(events[1].kind == tests::Kind::separation);
  CHECK(events[0].time() + events[1].time() == Approx(2));
  CHECK(events[0].time() < 1);
  // At the ends they are where they were told to be, and rest.
  CHECK(world.motion(0).position(3) == Vector3d(4, 0, 0));
  CHECK(world.motion(1).velocity(3) == rest);
}

}  // namespace
}  // namespace kds::collision::test_trajectory
