// The bodies nearest to a point: against all bodies one by one, and against balls that overlap them or do not.
#include "collision/queries/nearest.hpp"

#include "collision/narrow_phase/nearest_of_shape.hpp"
#include "collision/queries/casts.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "tests/collision/queries/sample_bodies.hpp"
#include "tests/collision/sample_meshes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

namespace kds::collision::test_nearest {
namespace {

using Eigen::Vector3d;
using samples::body;
using samples::Random;
using samples::random_shape;

/// A rigid one, or one time in six a triangle that bends.
Shape any_shape(Random& random, const std::shared_ptr<const Mesh>& ring) {
  if (random.below(6) != 0) return random_shape(random, ring);
  std::vector<Vector3d> corners;
  for (int i = 0; i < 3; ++i) corners.push_back(random.vector(0.5));
  std::vector<Vector3d> later = corners;
  for (Vector3d& x : later) x += random.vector(0.2);
  return BendingMesh{std::make_shared<const MeshScript>(std::vector<MeshScript::Keyframe>{{0, corners}, {4, later}},
                                                        std::vector<Mesh::Triangle>{{0, 1, 2}})};
}

bool contains(const std::vector<BodyId>& ids, BodyId id) { return std::find(ids.begin(), ids.end(), id) != ids.end(); }

}  // namespace

TEST_CASE("the nearest of two balls, and a point inside", "[nearest]") {
  World<1> world(WorldOptions{});
  const BodyId near = world.add_body(body(Sphere{1}, {4, 0, 0}, {-1, 0, 0}));
  const BodyId far = world.add_body(body(Sphere{1}, {0, 10, 0}));
  world.advance_to(1);
  const auto two = nearest(world, {0, 0, 0}, 2);
  REQUIRE(two.size() == 2);
  CHECK(two[0].body == near);
  CHECK(two[0].distance == 2);
  CHECK(two[0].point == Vector3d(2, 0, 0));
  CHECK(two[1].body == far);
  CHECK(two[1].distance == 9);
  CHECK(nearest(world, {0, 0, 0}, 5).size() == 2);
  CHECK(nearest(world, {0, 0, 0}, 0).empty());
  const auto inside = nearest(world, {3, 0.5, 0}, 1);
  REQUIRE(inside.size() == 1);
  CHECK(inside[0].distance == 0);
  CHECK(inside[0].point == Vector3d(3, 0.5, 0));
  const auto others = nearest(world, {3, 0.5, 0}, 1, [&](BodyId id) { return id != near; });
  REQUIRE(others.size() == 1);
  CHECK(others[0].body == far);
}

TEST_CASE("bodies at one distance come in the order in which they were added", "[nearest]") {
  World<1> world(WorldOptions{});
  std::vector<BodyId> ids;
  for (const double x : {3.0, -3.0}) {
    for (int axis = 0; axis < 3; ++axis) ids.push_back(world.add_body(body(Sphere{1}, x * Vector3d::Unit(axis))));
  }
  const auto four = nearest(world, {0, 0, 0}, 4);
  REQUIRE(four.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) CHECK(four[i].body == ids[i]);
}

TEST_CASE("the nearest bodies are those of all bodies, in any units", "[nearest]") {
  const auto ring = samples::torus(8, 4);
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const double unit = std::ldexp(1.0, static_cast<int>(random.below(3)) * 20 - 20);
    World<1> world(WorldOptions{});
    std::vector<BodyId> ids;
    const std::size_t bodies = 1 + random.below(200);
    for (std::size_t i = 0; i < bodies; ++i) {
      const Shape shape = unit == 1 ? any_shape(random, ring) : Shape{Sphere{random.uniform(0.1, 0.6) * unit}};
      ids.push_back(
          world.add_body(body(shape, random.vector(20) * unit, random.vector(1) * unit, random.orientation())));
    }
    world.advance_to(1.5);
    for (int round = 0; round < 5; ++round) {
      const Vector3d at = random.vector(round == 4 ? 1000 : 20) * unit;
      const std::size_t count = 1 + random.below(8);
      const bool every_other = random.below(2) == 0;
      const BodyFilter filter = [&](BodyId id) { return !every_other || id % 2 == 0; };
      std::vector<NearBody> all;
      for (const BodyId id : ids) {
        if (!filter(id)) continue;
        const Vector3d centre = world.motion(id).position(1.5);
        const NearestOfShape of_body = nearest_of_shape(world.shape(id), at - centre, 1.5);
        all.push_back({id, of_body.distance, of_body.point + centre, at});
      }
      std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.distance < b.distance; });
      const auto few = nearest(world, at, count, filter);
      REQUIRE(few.size() == std::min(count, all.size()));
      for (std::size_t i = 0; i < few.size(); ++i) {
        CHECK(few[i].body == all[i].body);
        CHECK(few[i].distance == all[i].distance);
        CHECK(few[i].point == all[i].point);
        CHECK(few[i].from_point == at);
      }
    }
  }
}

TEST_CASE("a ball as large as the distance just touches", "[nearest]") {
  // Whether it overlaps is decided exactly, and of meshes with a margin of 2^-24 of their size at most.
  const auto ring = samples::torus(8, 4);
  int outside = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    World<1> world(WorldOptions{});
    const BodyId id = world.add_body(body(any_shape(random, ring), random.vector(1), {0, 0, 0}, random.orientation()));
    world.advance_to(1);
    const Vector3d at = random.vector(2);
    const auto near = nearest(world, at, 1);
    REQUIRE(near.size() == 1);
    const double distance = near[0].distance;
    CHECK(distance == Approx((near[0].point - at).norm()).margin(1e-14));
    if (distance == 0) {
      CHECK(contains(overlapping(world, place(Sphere{1e-12}, Eigen::Quaterniond::Identity()), at), id));
      continue;
    }
    ++outside;
    const auto ball = [](double radius) { return place(Sphere{radius}, Eigen::Quaterniond::Identity()); };
    CHECK(contains(overlapping(world, ball(distance + 1e-13), at), id));
    if (distance > 1e-6) CHECK_FALSE(contains(overlapping(world, ball(distance - 2e-7), at), id));
    const bool surface = has_mesh(world.shape(id).shape) || bends(world.shape(id).shape);
    if (!surface) CHECK_FALSE(contains(overlapping(world, ball(distance - std::min(1e-13, distance / 2)), at), id));
  }
  CHECK(outside > 100);
}

TEST_CASE("the bodies nearest to a shape are those of all bodies", "[nearest]") {
  const auto ring = samples::torus(8, 4);
  int overlaps = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    World<1> world(WorldOptions{});
    std::vector<BodyId> ids;
    const std::size_t bodies = 1 + random.below(40);
    for (std::size_t i = 0; i < bodies; ++i) {
      ids.push_back(
          world.add_body(body(any_shape(random, ring), random.vector(3), random.vector(1), random.orientation())));
    }
    world.advance_to(1.5);
    const PlacedShape shape = random.below(8) == 0
                                  ? place(HalfSpace{random.direction(), -4}, Eigen::Quaterniond::Identity())
                                  : place(any_shape(random, ring), random.orientation());
    const Vector3d at = random.vector(5);
    const std::size_t count = 1 + random.below(6);
    std::vector<NearBody> all;
    for (const BodyId id : ids) {
      const Vector3d centre = world.motion(id).position(1.5);
      const ShapeDistance of_body = shape_distance(shape, world.shape(id), centre - at, 1.5);
      all.push_back({id, of_body.distance, of_body.of_b + at, of_body.of_a + at});
      if (of_body.distance == 0) ++overlaps;
    }
    std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.distance < b.distance; });
    const auto few = nearest(world, shape, at, count);
    REQUIRE(few.size() == std::min(count, all.size()));
    for (std::size_t i = 0; i < few.size(); ++i) {
      CHECK(few[i].body == all[i].body);
      CHECK(few[i].distance == all[i].distance);
      CHECK(few[i].point == all[i].point);
      CHECK(few[i].from_point == all[i].from_point);
    }
    if (ids.size() < 2) continue;
    const ShapeDistance pair = distance_between(world, ids[0], ids[1]);
    CHECK((pair.of_b - pair.of_a).norm() == Approx(pair.distance).margin(1e-13));
    const auto of_first = nearest(world, world.shape(ids[0]), world.motion(ids[0]).position(1.5), bodies,
                                  [&](BodyId id) { return id == ids[1]; });
    REQUIRE(of_first.size() == 1);
    CHECK(of_first[0].distance == pair.distance);
  }
  CHECK(overlaps > 10);
}

TEST_CASE("nearest refuses what is no place", "[nearest]") {
  World<1> world(WorldOptions{});
  world.add_body(body(Sphere{1}, {0, 0, 0}));
  CHECK_THROWS_AS(nearest(world, {0, std::numeric_limits<double>::quiet_NaN(), 0}, 1), std::invalid_argument);
  CHECK_THROWS_AS(nearest(world, {0, 1e300, 0}, 1), std::invalid_argument);
  const PlacedShape ball = place(Sphere{1}, Eigen::Quaterniond::Identity());
  CHECK_THROWS_AS(nearest(world, ball, {0, 1e300, 0}, 1), std::invalid_argument);
  CHECK_THROWS_AS(nearest(world, PlacedShape{Sphere{1}}, {0, 0, 0}, 1), std::invalid_argument);
}

}  // namespace kds::collision::test_nearest
