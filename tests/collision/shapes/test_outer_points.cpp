// The few points whose convex hull holds a mesh.
#include "collision/shapes/outer_points.hpp"

#include "collision/shapes/mesh.hpp"
#include "collision/vectors.hpp"
#include "tests/collision/sample_meshes.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace test_outer_points {

using namespace kds::collision;
using Eigen::Vector3d;
using kds::tests::Random;

TEST_CASE("no vertex of a mesh is beyond its outer points", "[shapes]") {
  const std::uint64_t seed = 352;
  CAPTURE(seed);
  Random random(seed);
  for (const auto& mesh : {samples::torus(8, 4), samples::torus(16, 5), samples::torus(80, 38), samples::cuboid(),
                           samples::ball_mesh(3), samples::needle()}) {
    const OuterPoints& points = mesh->outer_points();
    CAPTURE(mesh->vertices().size(), points.size());
    CHECK(&points == &mesh->outer_points());
    CHECK(points.size() % 8 == 0);
    CHECK(points.size() <= OuterPoints::most);
    const double unit = mesh->tree().unit();
    double widest = 0;
    for (int round = 0; round < 300; ++round) {
      const auto number = [&] { return random.between(-1, 1); };
      const double x = number(), y = number(), z = number();
      const Vector3d n = Vector3d(x, y, z).normalized();
      double of_points = -std::numeric_limits<double>::infinity(), of_mesh = of_points;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Vector3d point(points.x()[i], points.y()[i], points.z()[i]);
        of_points = std::max(of_points, unit * n.dot(point));
      }
      for (const Vector3d& vertex : mesh->vertices()) of_mesh = std::max(of_mesh, n.dot(vertex));
      CHECK(of_points >= of_mesh - 0x1p-22 * unit);
      widest = std::max(widest, of_points - of_mesh);
    }
    CHECK(widest < (mesh->vertices().size() <= OuterPoints::most ? 0x1p-22 : 0.5) * unit);
  }
}

TEST_CASE("outer points are repeated until there are a multiple of eight", "[shapes]") {
  OuterPoints points;
  CHECK(points.size() == 0);
  for (int i = 0; i < 9; ++i) points.add(Vector3d(i, 0, -i));
  REQUIRE(points.size() == 16);
  for (std::size_t i = 0; i < 16; ++i) {
    CHECK(points.x()[i] == static_cast<float>(std::min<std::size_t>(i, 8)));
    CHECK(points.y()[i] == 0);
    CHECK(points.z()[i] == -points.x()[i]);
  }
}

}  // namespace test_outer_points
