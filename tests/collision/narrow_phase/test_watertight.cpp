// Nothing slips between triangles that share an edge or a vertex.
#include "tests/collision/narrow_phase/mesh_distances.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

namespace test_watertight {
namespace {

using namespace kds::collision;
using namespace kds::collision::samples;

constexpr double infinity = std::numeric_limits<double>::infinity();

template <int Degree>
struct Shot {
  PlacedShape target;
  PlacedShape bullet;
  RelativeMotion<Degree> motion;
  double arrival;  ///< when the bullet's tip or edge is at the place aimed at
};

template <int Degree>
void check(const Shot<Degree>& shot) {
  const MeshPair<Degree> pair(shot.target, shot.bullet, shot.motion);
  const auto found = pair.first_contact(0, infinity, ContactMode::resolved);
  REQUIRE(found);
  // The place aimed at is a point of the surface, up to a few roundings.
  REQUIRE(found->tau <= shot.arrival * (1 + 0x1p-48));
  REQUIRE(pair.touching(shot.arrival));
}

/// Turns z to a direction.
Eigen::Quaterniond towards(const Vector3d& direction) {
  const Vector3d axis = Vector3d::UnitZ().cross(direction);
  const double angle = std::atan2(axis.norm(), direction[2]);
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis.norm() > 0 ? axis.normalized() : Vector3d::UnitX()));
}

/// Places on shared edges and vertices of a mesh: its vertices, the middles of its edges, and others on them.
Vector3d aim(Random& random, const PlacedShape& target) {
  const auto triangles = triangles_of(target);
  const auto& t = triangles[random.below(static_cast<std::uint32_t>(triangles.size()))];
  const std::size_t i = random.below(3);
  const double part = std::array{0.0, 0.5, 1.0 / 3, random.uniform(0, 1)}[random.below(4)];
  return (1 - part) * t.vertices[i] + part * t.vertices[(i + 1) % 3];
}

}  // namespace

TEST_CASE("No vertex slips between triangles that share an edge or a vertex, at any scale") {
  for (const double scale : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    for (const double far : {1.0, 1e4}) {
      const std::uint64_t seed = 100;
      INFO("seed " << seed << ", scale " << scale << ", distance " << far);
      Random random(seed);
      const std::array meshes{ball_mesh(2), cuboid(), torus(8, 4)};
      for (int trial = 0; trial < 60; ++trial) {
        INFO("trial " << trial);
        Shot<1> shot;
        shot.target = placed(meshes[static_cast<std::size_t>(trial % 3)], scale, random.orientation());
        const Vector3d place = aim(random, shot.target);
        // From outside, along a direction that meets the surface.
        Vector3d direction = random.direction();
        if (direction.dot(place) > 0) direction = -direction;
        if (trial % 2 == 0) direction = -place.normalized();
        const double size = scale * std::array{1e-3, 1.0, 30.0}[random.below(3)];
        shot.bullet = placed(needle(), size, towards(direction));
        const double distance = far * (3 * scale + 3 * size);
        const double speed = std::array{1e-3, 1.0, 1e3}[random.below(3)];
        shot.arrival = distance / speed;
        shot.motion.coefficients = {place - distance * direction, speed * direction};
        check(shot);
      }
    }
  }
}

TEST_CASE("No edge slips between triangles that share an edge or a vertex") {
  const std::uint64_t seed = 101;
  INFO("seed " << seed);
  Random random(seed);
  const std::array meshes{ball_mesh(2), cuboid(), torus(8, 4)};
  for (int trial = 0; trial < 300; ++trial) {
    INFO("trial " << trial);
    Shot<1> shot;
    shot.target = placed(meshes[static_cast<std::size_t>(trial % 3)], 1, random.orientation());
    const double size = random.uniform(0.1, 2);
    shot.bullet = placed(cuboid(), size, random.orientation());
    const Vector3d there = aim(random, shot.target);
    const Vector3d on_bullet = aim(random, shot.bullet);
    const Vector3d direction = random.direction();
    const double distance = 10;
    shot.arrival = distance;
    shot.motion.coefficients = {there - on_bullet - distance * direction, direction};
    check(shot);
  }
}

TEST_CASE("A ball does not slip through a shared edge or vertex, however small") {
  const std::uint64_t seed = 102;
  INFO("seed " << seed);
  Random random(seed);
  const std::array meshes{ball_mesh(2), cuboid(), torus(8, 4)};
  for (int trial = 0; trial < 300; ++trial) {
    INFO("trial " << trial);
    Shot<1> shot;
    shot.target = placed(meshes[static_cast<std::size_t>(trial % 3)], 1, random.orientation());
    shot.bullet = place(Sphere{std::array{1e-9, 1e-3, 1.0}[random.below(3)]}, Eigen::Quaterniond::Identity());
    const Vector3d direction = random.direction();
    shot.arrival = 10;
    shot.motion.coefficients = {aim(random, shot.target) - 10 * direction, direction};
    check(shot);
  }
}

TEST_CASE("Nothing slips through on a curved path") {
  const std::uint64_t seed = 103;
  INFO("seed " << seed);
  Random random(seed);
  const std::array meshes{ball_mesh(2), cuboid(), torus(8, 4)};
  for (int trial = 0; trial < 300; ++trial) {
    INFO("trial " << trial);
    Shot<2> shot;
    shot.target = placed(meshes[static_cast<std::size_t>(trial % 3)], 1, random.orientation());
    Vector3d on_bullet = Vector3d::Zero();
    if (trial % 2 == 0) {
      shot.bullet = placed(cuboid(), 0.7, random.orientation());
      on_bullet = aim(random, shot.bullet);
    } else {
      shot.bullet = place(Sphere{std::array{1e-6, 1e-3, 0.5}[random.below(3)]}, Eigen::Quaterniond::Identity());
    }
    // Through the place aimed at when tau = arrival, from far away.
    shot.arrival = 2;
    const Vector3d velocity = 5 * random.direction();
    const Vector3d bend = std::array{1e-6, 1e-2, 1.0}[random.below(3)] * random.direction();
    shot.motion.coefficients = {aim(random, shot.target) - on_bullet - 2 * velocity + 4 * bend, velocity - 4 * bend,
                                bend};
    check(shot);
  }
}

TEST_CASE("Mesh sizes of 1e-6 next to 1e6") {
  const std::uint64_t seed = 104;
  INFO("seed " << seed);
  Random random(seed);
  const auto sphere = ball_mesh(2);
  for (int trial = 0; trial < 100; ++trial) {
    INFO("trial " << trial);
    Shot<1> shot;
    shot.target = placed(sphere, 1e6, random.orientation());
    const Vector3d there = aim(random, shot.target);
    const Vector3d direction = -there.normalized();
    shot.bullet = trial % 2 == 0 ? placed(torus(8, 4), 1e-6, random.orientation())
                                 : place(Sphere{1e-6}, Eigen::Quaterniond::Identity());
    const double distance = std::array{1e-5, 1.0, 1e6}[random.below(3)];
    shot.arrival = distance;
    shot.motion.coefficients = {there - distance * direction, direction};
    // The bullet's centre is on the surface at its arrival; half of the ring is beyond it by then.
    const MeshPair<1> pair(shot.target, shot.bullet, shot.motion);
    const auto found = pair.first_contact(0, infinity, ContactMode::resolved);
    REQUIRE(found);
    REQUIRE(found->tau <= distance);
    REQUIRE(found->tau >= distance - 1.1e-6 - 1e-8);
  }
}

}  // namespace test_watertight
