#include "collision/shapes/feature.hpp"
#include "collision/shapes/mesh.hpp"
#include "tests/collision/sample_meshes.hpp"

#include <catch2/catch.hpp>

#include <limits>
#include <vector>

namespace test_mesh {
namespace {

using namespace kds::collision;
using namespace kds::collision::samples;

std::vector<Vector3d> corners() { return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}; }

/// The exception that building the mesh throws.
InvalidMesh error_of(const std::vector<Vector3d>& vertices, const std::vector<Mesh::Triangle>& triangles) {
  try {
    const Mesh mesh(vertices, triangles);
  } catch (const InvalidMesh& error) {
    return error;
  }
  FAIL("the mesh was accepted");
  return {InvalidMesh::Part::whole, 0, ""};
}

}  // namespace

TEST_CASE("A bad mesh is refused with the index of what is wrong") {
  SECTION("no triangles") {
    const InvalidMesh error = error_of(corners(), {});
    CHECK(error.part() == InvalidMesh::Part::whole);
    CHECK(std::string(error.what()) == "mesh: has no triangles");
  }
  SECTION("a vertex that is not a number") {
    auto vertices = corners();
    vertices[2][1] = std::numeric_limits<double>::quiet_NaN();
    const InvalidMesh error = error_of(vertices, {{0, 1, 2}});
    CHECK(error.part() == InvalidMesh::Part::vertex);
    CHECK(error.index() == 2);
    CHECK(std::string(error.what()) == "vertex 2: must be finite");
  }
  SECTION("an infinite vertex, even if no triangle uses it") {
    auto vertices = corners();
    vertices[3][0] = -std::numeric_limits<double>::infinity();
    CHECK(error_of(vertices, {{0, 1, 2}}).index() == 3);
  }
  SECTION("a coordinate so large that products overflow") {
    auto vertices = corners();
    vertices[1][2] = 1e60;
    CHECK(error_of(vertices, {{0, 1, 2}}).index() == 1);
  }
  SECTION("an index out of range") {
    const InvalidMesh error = error_of(corners(), {{0, 1, 2}, {1, 2, 4}});
    CHECK(error.part() == InvalidMesh::Part::triangle);
    CHECK(error.index() == 1);
    CHECK(std::string(error.what()) == "triangle 1: vertex 4 does not exist, there are 4");
  }
  SECTION("a vertex named twice") {
    const InvalidMesh error = error_of(corners(), {{0, 1, 2}, {0, 1, 3}, {2, 3, 2}});
    CHECK(error.index() == 2);
    CHECK(std::string(error.what()) == "triangle 2: names a vertex twice");
  }
  SECTION("two vertices at one place") {
    auto vertices = corners();
    vertices.push_back(vertices[1]);
    CHECK(error_of(vertices, {{0, 1, 4}}).index() == 0);
  }
  SECTION("corners in a line, up to rounding") {
    const Vector3d a{0.1, 0.2, 0.3};
    const Vector3d d{0.7, -0.3, 1.1};
    const InvalidMesh error = error_of({a, a + d / 3, a + d}, {{0, 1, 2}});
    CHECK(error.part() == InvalidMesh::Part::triangle);
    CHECK(std::string(error.what()) == "triangle 0: is degenerate, its corners lie in a line");
  }
}

TEST_CASE("A thin or tiny triangle is not degenerate") {
  CHECK_NOTHROW(Mesh({{0, 0, 0}, {1, 0, 0}, {0.5, 1e-12, 0}}, {{0, 1, 2}}));
  CHECK_NOTHROW(Mesh({{0, 0, 0}, {1e-25, 0, 0}, {0, 1e-25, 0}}, {{0, 1, 2}}));
}

TEST_CASE("Extents and radius of a mesh hold its placed vertices tightly") {
  Random random(11);
  const auto mesh = torus(8, 4);
  for (int trial = 0; trial < 100; ++trial) {
    const Eigen::Matrix3d rotation = random.orientation().toRotationMatrix();
    const double scale = random.uniform(0.1, 10);
    Vector3d low, high;
    mesh->extents(rotation, scale, low, high);
    Vector3d lowest = Vector3d::Constant(1e9), highest = -lowest;
    for (const Vector3d& v : mesh->placed_vertices(rotation, scale)) {
      CHECK(v.norm() <= mesh->bounding_radius() * scale * (1 + 0x1p-48));
      lowest = lowest.cwiseMin(v);
      highest = highest.cwiseMax(v);
    }
    CHECK(low == lowest);
    CHECK(high == highest);
  }
  CHECK(mesh->bounding_radius() == Approx(1.0).epsilon(1e-14));
}

TEST_CASE("Extents of an odd number of vertices leave out those that no triangle uses") {
  const Mesh mesh({{9, 9, 9}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}, {-9, -9, -9}}, {{1, 2, 3}});
  Vector3d low, high;
  mesh.extents(Eigen::Matrix3d::Identity(), 2, low, high);
  CHECK(low == Vector3d(0, 0, 0));
  CHECK(high == Vector3d(2, 4, 6));
  CHECK(mesh.extent(Eigen::Matrix3d::Identity(), 1, {0, 1, -1}) == std::array<double, 2>{-3, 2});
}

TEST_CASE("Features print as the event file wants them") {
  CHECK(to_string(Feature{}) == "-");
  CHECK(to_string(Feature::vertex(12)) == "v12");
  CHECK(to_string(Feature::edge(17, 3)) == "e3-17");
  CHECK(to_string(Feature::face(40)) == "f40");
  CHECK(Feature::edge(1, 2) == Feature::edge(2, 1));
}

}  // namespace test_mesh
