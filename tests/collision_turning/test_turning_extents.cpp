// The volumes of hulls and meshes that turn: they hold all vertices at all times, and are no larger than they need to
// be.
#include "collision/shapes/compound.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "collision/world.hpp"
#include "collision/world/turning/turning_extents.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/support/random_numbers.hpp"
#include "tests/support/random_vectors.hpp"

#include <catch2/catch.hpp>

#include <Eigen/Geometry>

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

namespace test_turning_extents {
namespace {

using namespace kds;
using namespace kds::collision;
using certificates::RigidMotion;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using kds::tests::Random;
using kds::tests::random_vector;

/// About its origin or not.
struct Body {
  Shape shape;
  std::vector<Vector3d> points;
};

Body random_body(Random& random, int kind) {
  const Vector3d size(std::ldexp(1.0, -static_cast<int>(random.below(8))),
                      std::ldexp(1.0, -static_cast<int>(random.below(8))),
                      std::ldexp(1.0, 10 - static_cast<int>(random.below(20))));
  if (kind == 0) {
    std::vector<Vector3d> points;
    for (int i = 0; i < 12; ++i) points.emplace_back(random_vector(random, 1).cwiseProduct(size) + 0.3 * size);
    return {convex_hull(points), points};
  }
  auto mesh = samples::torus(8, 4);
  std::vector<Vector3d> vertices;
  const Quaterniond turned =
      Quaterniond(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), 1).normalized();
  for (const Vector3d& v : mesh->vertices()) vertices.emplace_back(turned * v.cwiseProduct(size) + 0.2 * size);
  const auto changed = std::make_shared<const Mesh>(
      vertices, std::vector<Mesh::Triangle>(mesh->triangles().begin(), mesh->triangles().end()));
  const double scale = random.between(0.5, 2);
  if (kind == 1) {
    for (Vector3d& v : vertices) v *= scale;
    return {MeshShape{changed, scale}, vertices};
  }
  const Vector3d place = random_vector(random, 2).cwiseProduct(size);
  const Compound whole = compound(std::vector<CompoundPart>{{MeshShape{changed}}, {MeshShape{changed}, place}});
  const std::size_t count = vertices.size();
  for (std::size_t i = 0; i < count; ++i) vertices.emplace_back(vertices[i] + place);
  return {whole, vertices};
}

TEST_CASE("the volumes of hulls, meshes and compounds of meshes hold them however far they turn", "[turning]") {
  const std::uint64_t seed = 12;
  CAPTURE(seed);
  Random random(seed);
  for (int round = 0; round < 300; ++round) {
    CAPTURE(round);
    const auto [shape, points] = random_body(random, round % 3);
    RigidMotion<1> motion{{{Vector3d::Zero(), Vector3d::Zero()}}};
    if (round % 5 != 0) motion.angular_velocity = random_vector(random, 3);
    if (round % 7 == 0) motion.angular_velocity = Vector3d(0, 0, 2);
    if (round % 11 == 0) motion.angular_velocity = Vector3d(2e-9, 0, 2);  // nearly along an axis
    motion.orientation = Quaterniond(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), 1);
    const PlacedShape placed = place(shape, Quaterniond::Identity());
    const Vector3d half = turning_half_extents(placed, motion);
    CHECK(half.maxCoeff() <= placed.bounding_radius);
    Vector3d reached = Vector3d::Zero();
    for (int k = 0; k < 100; ++k) {
      for (const Vector3d& x : points) reached = reached.cwiseMax(motion.position(x, 0.05 * k).vector.cwiseAbs());
    }
    CHECK((half - reached).minCoeff() >= 0);
  }
}

TEST_CASE("a rod that is a hull or a mesh has the volume of the box that it is, nearly", "[turning]") {
  const Vector3d half(0.125, 0.125, 2);
  std::vector<Vector3d> corners;
  for (int k = 0; k < 8; ++k)
    corners.emplace_back(half.cwiseProduct(Vector3d(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1)));
  for (const Vector3d& spin : {Vector3d(0, 0, 0), Vector3d(0, 0, 1), Vector3d(1, 2, 3)}) {
    const RigidMotion<1> motion{{{Vector3d::Zero(), Vector3d::Zero()}}, Quaterniond(1, 0.5, 0, 0), spin};
    const auto extents = [&](const Shape& shape) {
      return turning_half_extents(place(shape, Quaterniond::Identity()), motion);
    };
    const Vector3d of_box = extents(Box{half});
    CHECK((extents(convex_hull(corners)) - of_box).norm() < 1e-11);
    CHECK((extents(MeshShape{samples::cuboid(half)}) - of_box).norm() < 1e-4);
  }
}

}  // namespace
}  // namespace test_turning_extents
