// Bodies that turn, as lines.
#include "collision/drawing/draw_world.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

namespace kds::collision::test_turning_drawing {
namespace {

using Eigen::Vector3d;

TEST_CASE("A box that turns is drawn as it is turned at that time") {
  TurningWorld<1> world({});
  TurningWorld<1>::Motion motion;
  motion.path = certificates::PointMotion<1>::line({1, 0, 0}, {1, 0, 0});
  motion.orientation = Eigen::Quaterniond::Identity();
  motion.angular_velocity = {0, 0, std::numbers::pi / 2};
  world.add_body({.shape = Box{{1, 2, 3}}, .motion = {motion}});
  world.advance_to(0.5);
  std::size_t lines = 0;
  draw(world, [&](const Vector3d& from, const Vector3d& to, Drawn what) {
    ++lines;
    CHECK(what == Drawn::body);
    for (const Vector3d& x : {from, to}) {  // a quarter turn about z
      CHECK(((x - Vector3d(2, 0, 0)).cwiseAbs() - Vector3d(2, 1, 3)).norm() < 1e-12);
    }
  }, {}, 1);
  CHECK(lines == 12);
}

}  // namespace
}  // namespace kds::collision::test_turning_drawing
