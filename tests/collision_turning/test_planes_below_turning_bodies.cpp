// Half-spaces in worlds whose bodies turn: what falls on them bounces and comes to rest.
#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/polytope.hpp"
#include "collision/world.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/collision_turning/half_space_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

namespace test_planes_below_turning_bodies {
namespace {

using namespace kds;
using namespace kds::collision;
using namespace kds::tests::planes;
using kds::tests::motion_of;
using kds::tests::Random;
using kds::tests::random_vector;

Quaterniond tilted(double angle, const Vector3d& axis) {
  const Vector3d v = std::sin(angle / 2) * axis.normalized();
  return {std::cos(angle / 2), v[0], v[1], v[2]};
}

/// Of a unit of mass or less; the mesh as well turns as a solid.
std::vector<Shape> shapes() {
  return {Sphere{0.5}, Box{{0.5, 0.25, 0.75}}, Capsule{0.25, 0.5}, MeshShape{samples::cuboid(Vector3d(0.5, 0.5, 0.25))},
          convex_hull({{0.5, 0.5, 0}, {-0.5, 0.5, 0}, {-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0, 0, 0.5}, {0, 0, -0.5}})};
}

bool still(const Turning& world, BodyId id) {
  const auto& motion = world.motion(id);
  return motion.angular_velocity.isZero(0) && motion.path.coefficients[1].isZero(0) &&
         motion.path.coefficients[2].isZero(0);
}

/// The lowest of a body along a direction, from the origin.
double lowest(const Turning& world, BodyId id, const Vector3d& normal = Vector3d::UnitZ()) {
  const auto& motion = world.motion(id);
  const double t = world.now();
  const Shape shape = world.shape(id).shape;
  const double centre = normal.dot(motion.origin(t).vector);
  if (const auto* const ball = std::get_if<Sphere>(&shape)) return centre - ball->radius;
  if (const auto* const capsule = std::get_if<Capsule>(&shape)) {
    return centre - capsule->radius -
           capsule->half_length * std::abs(normal.dot(motion.direction(Vector3d::UnitZ(), t).vector));
  }
  std::vector<Vector3d> points;
  if (const auto* const hull = std::get_if<ConvexHull>(&shape)) {
    points.assign(hull->polytope->points().begin(), hull->polytope->points().end());
  } else if (const auto* const mesh = std::get_if<MeshShape>(&shape)) {
    points.assign(mesh->mesh->vertices().begin(), mesh->mesh->vertices().end());
  } else {
    const Vector3d& half = std::get<Box>(shape).half_extents;
    const auto corners = samples::cuboid(half);
    points.assign(corners->vertices().begin(), corners->vertices().end());
  }
  double least = never;
  for (const Vector3d& x : points) least = std::min(least, normal.dot(motion.position(x, t).vector));
  return least;
}

/// A room of six planes, turned as a whole, and bodies that spin in it.
void fill_room(Turning& world, std::uint64_t seed) {
  add_room(world, 3, Quaterniond(1, 0.25, -0.5, 0.125));
  Random random(seed);
  for (std::size_t i = 0; i < 10; ++i) {
    const Vector3d at = random_vector(random, 1.5);
    add_flying(world, shapes()[i % 5], i, at, random);
  }
}

}  // namespace

TEST_CASE("a half-space is a floor for what turns", "[turning][half_space]") {
  Log log;
  Turning world(options(), &log);
  const BodyId floor = world.add_body({.shape = HalfSpace{Vector3d::UnitZ(), 0},
                                       .motion = {motion_of<2>({0, 0, 0}, {0, 0, 0}, {0, 0, 0})},
                                       .fixed = true,
                                       .friction = 0.5});
  Body die = thrown(Box{Vector3d::Constant(0.5)}, {0, 0, 2}, {1, 0, 0}, {3, 2, 1});
  die.restitution = 0.25, die.friction = 0.5;
  const BodyId id = world.add_body(die);
  world.advance_to(5);
  CHECK(log.count("contact") > 3);
  CHECK(world.resting(floor, id));
  CHECK(std::abs(world.motion(id).path.position(5)[2] - 0.5) < 1e-4);
}

TEST_CASE("what spins bounces off a half-space as off a box that is large enough", "[turning][half_space]") {
  for (const double friction : {0.0, 0.5}) {
    const auto run = [&](const Body& floor, Log& log) {
      Turning world(options(), &log);
      Body below = floor;
      below.friction = friction;
      world.add_body(below);
      double x = 0;
      for (const Shape& shape : shapes()) {
        Body body = thrown(shape, {x, 0, 2}, {0.5, 0.25, 0}, {2, 1, -3}, Quaterniond(1, 0.5, 0.25, -0.125));
        body.friction = friction;
        world.add_body(body);
        x += 4;
      }
      world.advance_to(1.25);
    };
    Log on_plane, on_box;
    run(ground(), on_plane);
    run(fixed(Box{Vector3d(64, 64, 4)}, {0, 0, -4}), on_box);
    REQUIRE(on_plane.events.size() == on_box.events.size());
    CHECK(on_plane.count("contact") > 5);
    std::array<bool, 6> met{};
    for (std::size_t i = 0; i < on_plane.events.size(); ++i) {
      const auto &x = on_plane.events[i], &y = on_box.events[i];
      CAPTURE(friction, i, x.b, x.contact.time);
      CHECK((x.what == y.what && x.a == y.a && x.b == y.b));
      if (!std::exchange(met[x.b], true)) CHECK(x.contact.time == y.contact.time);
      CHECK(std::abs(x.contact.time - y.contact.time) < 1e-9);
      CHECK((x.contact.point - y.contact.point).norm() < 1e-9);
      CHECK(x.contact.normal == Vector3d::UnitZ());
      CHECK((y.contact.normal - x.contact.normal).norm() < 1e-9);
    }
  }
}

TEST_CASE("a body that bounces off half-spaces keeps its energy", "[turning][half_space]") {
  for (const Shape& shape : shapes()) {
    CAPTURE(kind_name(shape));
    Log log;
    WorldOptions exact = options();
    exact.shortest_flight = 1e-12;
    Turning world(exact, &log);
    world.add_body(ground());
    world.add_body(half_space(Vector3d(0.6, 0, 0.8), -1));
    world.add_body(half_space(Vector3d(-0.6, 0, 0.8), -1));
    world.add_body(half_space(Vector3d(0, 0.6, 0.8), -1));
    world.add_body(half_space(Vector3d(0, -0.6, 0.8), -1));
    const BodyId id = world.add_body(thrown(shape, {0.1, 0.2, 2}, {1, 0, 0}, {3, 2, 1}));
    const auto energy = [&] {
      const FreeTurning turning = world.free_turning(id);
      const auto& path = world.motion(id).path;
      return gravity * path.position(world.now())[2] + path.velocity(world.now()).squaredNorm() / 2 +
             turning.angular_momentum.dot(turning.angular_velocity) / 2;
    };
    const double before = energy();
    world.advance_to(30);
    CHECK(log.count("contact") > 25);
    CHECK(log.count("passes") == 0);
    CHECK(world.counters().orientation_resets == 0);
    CHECK(std::abs(energy() / before - 1) < 1e-12);
    CHECK(lowest(world, id) > -1e-12);
  }
}

TEST_CASE("six half-spaces make a room that nothing leaves that spins, whatever the broad phase, over snapshots too",
          "[turning][half_space]") {
  for (const std::uint64_t seed : {1, 2}) {
    CAPTURE(seed);
    std::vector<Log::Event> expected;
    for (const BroadPhaseKind kind : all_methods) {
      for (const bool saves : {false, true}) {
        if (saves && kind != BroadPhaseKind::grid) continue;
        CAPTURE(static_cast<int>(kind), saves);
        Log log;
        auto world = std::make_unique<Turning>(options(kind), &log);
        fill_room(*world, seed);
        for (double t = 0.25; t <= 1.5; t += 0.25) {
          world->advance_to(t);
          world->audit();
          if (!saves) continue;
          const Snapshot saved = save(*world);
          world = std::make_unique<Turning>(options(kind), &log);
          restore(saved, *world);
        }
        if (expected.empty()) expected = log.events;
        CHECK(log.count("contact") > 20);
        CHECK((log.events == expected));
        const Quaterniond turn = Quaterniond(1, 0.25, -0.5, 0.125).normalized();
        for (BodyId id = 6; id < 16; ++id) {
          for (int d = 0; d < 6; ++d) {
            CHECK(lowest(*world, id, turn * ((d % 2 == 0 ? 1 : -1) * Vector3d::Unit(d / 2))) > -3 - 1e-9);
          }
        }
      }
    }
  }
}

TEST_CASE("what is thrown on a half-space comes to rest on it, and wakes without it", "[turning][half_space][rest]") {
  Log log;
  auto world = std::make_unique<Turning>(options(), &log);
  Body floor = ground();
  floor.friction = 0.5;
  world->add_body(floor);
  double x = 0;
  for (const Shape& shape : {shapes()[1], shapes()[3], shapes()[4], Shape(Box{Vector3d::Constant(0.5)})}) {
    Body body = thrown(shape, {x, 0, 1}, {0.25, 0, 0}, {2, 1, 0.5}, Quaterniond(1, 0.5, 0.25, 0));
    body.restitution = 0.25, body.friction = 0.5;
    world->add_body(body);
    x += 3;
  }
  world->advance_to(6);
  const Snapshot saved = save(*world);
  world = std::make_unique<Turning>(options(BroadPhaseKind::grid), &log);
  restore(saved, *world);
  world->audit();
  const std::size_t contacts = log.count("contact");
  world->advance_to(60);
  CHECK(log.count("contact") == contacts);
  CHECK(log.count("passes") == 0);
  for (BodyId id = 1; id <= 4; ++id) {
    CAPTURE(id);
    CHECK(world->resting(0, id));
    CHECK(still(*world, id));
    CHECK(std::abs(lowest(*world, id)) < 1e-4);
  }
  world->remove_body(0);
  world->advance_to(61);
  CHECK(log.count("wakes") >= 4);
  for (BodyId id = 1; id <= 4; ++id) CHECK(lowest(*world, id) < -4);
}

TEST_CASE("a box rests on a slope of a half-space if its friction allows", "[turning][half_space][rest]") {
  for (const double degrees : {20, 28}) {  // friction 0.5: up to 26.6
    CAPTURE(degrees);
    const Quaterniond slope = tilted(degrees * 3.14159265358979323846 / 180, {0.25, 1, 0});
    const Vector3d up = slope * Vector3d::UnitZ();
    Log log;
    Turning world(options(), &log);
    Body below = half_space(Vector3d::UnitZ(), 1, zero, slope);
    below.friction = 0.5;
    world.add_body(below);
    Body box = thrown(Box{Vector3d(0.5, 0.5, 0.25)}, 1.26 * up, zero, zero, slope);
    box.restitution = 0.25, box.friction = 0.5;
    const BodyId id = world.add_body(box);
    world.advance_to(1);
    CHECK(world.resting(0, id) == (degrees < 26));
    CHECK(still(world, id) == (degrees < 26));
  }
}

}  // namespace test_planes_below_turning_bodies
