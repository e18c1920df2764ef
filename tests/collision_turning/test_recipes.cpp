// The code of docs/recipes.md with bodies that turn: what is quoted there stands here.
#include "collision/response/mass_properties.hpp"
#include "collision/shapes/compound.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "collision/world.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <vector>

namespace test_recipes {
namespace {

using namespace kds::collision;
using Eigen::Vector3d;
using Turning = kds::certificates::RigidMotion<2>;
using Path = kds::certificates::PointMotion<2>;

TEST_CASE("recipe: a body that turns") {
  TurningWorld<2> world({.response = Response::elastic});
  world.add_body({.shape = Box{{9, 9, 1}},
                  .motion = {Turning{Path::line({0, 0, -1}, {0, 0, 0})}},
                  .fixed = true,
                  .friction = 0.5});
  const Turning thrown{.path = Path::parabola({0, 0, 2}, {1, 0, 0}, {0, 0, -10}), .angular_velocity = {0, 1, 2}};
  const BodyId die =
      world.add_body({.shape = Box{{0.25, 0.25, 0.25}}, .motion = {thrown}, .restitution = 0.25, .friction = 0.5});
  world.advance_to(0.5);
  const Turning now = world.motion(die).restarted(world.now());
  const Vector3d place = now.path.coefficients[0];
  const Eigen::Quaterniond orientation = now.orientation;  // to draw it
  CHECK(place == Vector3d(0.5, 0, 0.75));
  CHECK(orientation.angularDistance(Eigen::Quaterniond::Identity()) == Approx(0.5 * std::sqrt(5)));
  world.advance_to(10);
  CHECK(world.motion(die).path.position(10)[2] == Approx(0.25).margin(1e-6));
  CHECK(world.motion(die).angular_velocity == Vector3d(0, 0, 0));
}

TEST_CASE("recipe: a door on a hinge") {
  TurningWorld<2> world({.response = Response::elastic});
  std::vector<Vector3d> corners;  // about the hinge, as a body turns about its origin
  for (const double x : {0.0, 1.0}) {
    for (const double y : {-0.03125, 0.03125}) {
      for (const double z : {0.0, 2.0}) corners.emplace_back(x, y, z);
    }
  }
  const auto turning = [](double from, double rate, double start) {
    return Turning{.path = Path::line({0, 0, 0}, {0, 0, 0}, start),
                   .orientation = Eigen::Quaterniond(Eigen::AngleAxisd(from, Vector3d::UnitZ())),
                   .angular_velocity = {0, 0, rate}};
  };
  const BodyId door = world.add_body({.shape = convex_hull(corners),
                                      .motion = {turning(0, 0, 0), turning(0, 1.5, 1), turning(1.5, 0, 2)},
                                      .fixed = true});  // shut until 1 s, opens, and stays open from 2 s on
  const BodyId ball =
      world.add_body({.shape = Sphere{0.25}, .motion = {Turning{Path::line({0.75, 0.5, 1}, {0, 0, 0})}}});
  world.advance_to(3);
  CHECK(world.motion(door).angular_velocity == Vector3d(0, 0, 0));
  CHECK(world.motion(ball).path.velocity(3)[1] > 1);  // pushed away by the door
}

TEST_CASE("recipe: a body of several parts that turns") {
  const std::vector<CompoundPart> parts{{Box{{0.5, 0.0625, 0.0625}}}, {Box{{0.125, 0.25, 0.125}}, {0.5, 0, 0}}};
  const Compound hammer = compound(about_centre_of_mass(parts));  // free bodies turn about their origin
  TurningWorld<2> world({.response = Response::elastic});
  const Turning thrown{.path = Path::parabola({0, 0, 2}, {1, 0, 4}, {0, 0, -10}), .angular_velocity = {0, 3, 0.5}};
  const BodyId id = world.add_body({.shape = hammer, .motion = {thrown}, .mass = 2});
  world.advance_to(1);
  const Turning now = world.motion(id).restarted(world.now());
  const Vector3d end = now.position(Vector3d(-0.5, 0, 0), world.now()).vector;  // of a point of the body
  CHECK((end - now.path.coefficients[0]).norm() == Approx(0.5));
  CHECK((now.path.coefficients[0] - Vector3d(1, 0, 1)).norm() < 1e-12);
}

}  // namespace
}  // namespace test_recipes
