#include "collision/shapes/heightfield.hpp"
#include "collision/world.hpp"
#include "tests/collision/event_log.hpp"
#include "tests/support/random_numbers.hpp"
#include "tests/support/throws.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace kds::collision::test_heightfield {
namespace {

using namespace tests;
using kds::tests::Random;
using kds::tests::throws;

std::shared_ptr<const Mesh> field(const std::vector<double>& heights, std::size_t columns, double x, double y) {
  return std::make_shared<const Mesh>(heightfield(heights, columns, x, y));
}

}  // namespace

TEST_CASE("a heightfield has its vertices over a grid about the origin, and its fronts above", "[mesh]") {
  const std::vector<double> heights{0, 1, 2, 3, 4, 5};
  const Mesh mesh = heightfield(heights, 3, 2, 4);
  REQUIRE(mesh.vertices().size() == 6);
  for (std::size_t i = 0; i < 6; ++i) {
    const Vector3d expected(i % 3 == 0 ? -2 : i % 3 == 1 ? 0 : 2, i < 3 ? -2 : 2, static_cast<double>(i));
    CHECK(mesh.vertices()[i] == expected);
  }
  REQUIRE(mesh.triangles().size() == 4);
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles()) {
    const Vector3d normal = (mesh.vertices()[b] - mesh.vertices()[a]).cross(mesh.vertices()[c] - mesh.vertices()[a]);
    CHECK(normal.z() > 0);
    area += normal.z() / 2;
  }
  CHECK(area == 16);  // seen from above
}

TEST_CASE("balls that fall on a heightfield meet it where it is", "[mesh]") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    // A plane, of which the distance is known: z = p x + q y.
    const double p = random.between(-1, 1), q = random.between(-1, 1);
    std::vector<double> heights;
    for (int j = 0; j < 6; ++j) {
      for (int i = 0; i < 9; ++i) heights.push_back(p * (i - 4) + q * 0.5 * (j - 2.5));
    }
    Scene<1> scene;
    scene.bodies.push_back(fixed_body<1>(MeshShape{field(heights, 9, 1, 0.5), 1}, motion<1>(zero)));
    const Vector3d start(random.between(-2, 2), random.between(-0.5, 0.5), 10);
    scene.bodies.push_back(ball<1>(0.25, start, {0, 0, -1}));
    scene.end_time = 20;
    WorldOptions options;
    options.response = Response::elastic;
    const auto events = run<1>(scene, options);
    REQUIRE(!events.empty());
    const double below = 0.25 * std::sqrt(1 + p * p + q * q);
    CHECK(std::abs(events[0].time() - (10 - below - p * start.x() - q * start.y())) < 1e-9);
    CHECK((events[0].contact.normal - Vector3d(-p, -q, 1).normalized()).norm() < 1e-9);
  }
}

TEST_CASE("a heightfield that is none is refused by name", "[mesh]") {
  const std::vector<double> six(6);
  const double infinite = std::numeric_limits<double>::infinity();
  throws([&] { heightfield(six, 1, 1, 1); }, "heightfield: columns: must be at least 2");
  throws([&] { heightfield(six, 0, 1, 1); }, "heightfield: columns: must be at least 2");
  throws([&] { heightfield(six, 4, 1, 1); }, "heightfield: heights: 6 numbers are no whole rows of 4");
  throws([&] { heightfield(six, 6, 1, 1); }, "heightfield: heights: 6 numbers are fewer than two rows of 6");
  throws([&] { heightfield({}, 2, 1, 1); }, "heightfield: heights: 0 numbers are fewer than two rows of 2");
  throws([&] { heightfield(six, 3, 0, 1); }, "heightfield: spacing: must be > 0 and finite");
  throws([&] { heightfield(six, 3, 1, infinite); }, "heightfield: spacing: must be > 0 and finite");
  throws(
      [&] {
        heightfield(std::vector<double>{0, 0, 0, infinite}, 2, 1, 1);
      },
      "heightfield: heights[3]: must be finite");
  throws([&] { heightfield(std::vector<double>{0, 0, 0, 1e300}, 2, 1, 1); }, "");  // as of any mesh
}

}  // namespace kds::collision::test_heightfield
