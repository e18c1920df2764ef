// What is beyond the edges of triangles and around the vertices of a mesh, and where it is flat.
#include "collision/shapes/mesh_neighbours.hpp"

#include "collision/shapes/mesh.hpp"
#include "kds/arithmetic/lattice.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace kds::collision::test_mesh_neighbours {
namespace {

using Eigen::Vector3d;
using Triangles = std::vector<Mesh::Triangle>;

constexpr std::uint32_t none = MeshNeighbours::none;

/// Four triangles around a vertex, 4, in a square whose corners are 0 to 3.
struct Square {
  std::vector<Vector3d> vertices{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1, 0}};
  Triangles triangles{{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
};

TEST_CASE("mesh neighbours: around a vertex in one plane everything is flat, and at the border nothing") {
  const Square square;
  const MeshNeighbours neighbours(square.vertices, square.triangles);
  for (std::uint32_t i = 0; i < 4; ++i) {
    CHECK(neighbours.beyond(i, 0) == none);
    CHECK(neighbours.beyond(i, 1) == (i + 2) % 4);
    CHECK(neighbours.beyond(i, 2) == (i + 3) % 4);
    CHECK_FALSE(neighbours.flat_edge(i, 0));
    CHECK(neighbours.flat_edge(i, 1));
    CHECK(neighbours.flat_edge(i, 2));
    CHECK_FALSE(neighbours.flat_corner(i, 0));
    CHECK_FALSE(neighbours.flat_corner(i, 1));
    CHECK(neighbours.flat_corner(i, 2));
    CHECK(neighbours.around(i).size() == 3);
  }
  const auto around = neighbours.around(4);
  CHECK(std::equal(around.begin(), around.end(), std::array<std::uint32_t, 4>{0, 1, 2, 3}.begin()));
}

TEST_CASE("mesh neighbours: one unit in the last place is not flat", "[degenerate]") {
  Square square;
  square.vertices[4][2] = next_up(0.0);
  const MeshNeighbours neighbours(square.vertices, square.triangles);
  for (std::uint32_t i = 0; i < 4; ++i) {
    CHECK_FALSE(neighbours.flat_edge(i, 1));
    CHECK_FALSE(neighbours.flat_corner(i, 2));
    CHECK(neighbours.beyond(i, 1) == (i + 2) % 4);
  }
}

TEST_CASE("mesh neighbours: triangles that share places and no indices, one of them twice, are neighbours",
          "[degenerate]") {
  const Square square;
  std::vector<Vector3d> vertices;
  Triangles triangles;
  for (const std::size_t i : {0, 1, 2, 3, 1}) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (const std::uint32_t corner : square.triangles[i]) vertices.push_back(square.vertices[corner]);
    triangles.push_back({first, first + 1, first + 2});
  }
  vertices[2][2] = -0.0;
  const MeshNeighbours neighbours(vertices, triangles);
  for (std::uint32_t i = 0; i < 5; ++i) {
    CHECK_FALSE(neighbours.flat_edge(i, 0));
    CHECK(neighbours.flat_edge(i, 1));
    CHECK(neighbours.flat_edge(i, 2));
    CHECK(neighbours.flat_corner(i, 2));
    CHECK(neighbours.around(3 * i + 2).size() == 4);
  }
}

TEST_CASE("mesh neighbours: a fold is not flat, whether it is open or shut", "[degenerate]") {
  const std::vector<Vector3d> vertices{{0, 0, 0}, {1, 0, 0}, {0.25, 1, 0}, {0.75, 1, 0}, {0.5, -1, 1}, {0.5, -1, 0}};
  const auto flat = [&](const Triangles& triangles) {
    const MeshNeighbours neighbours(vertices, triangles);
    return neighbours.flat_edge(0, 0);
  };
  CHECK_FALSE(flat({{0, 1, 2}}));
  CHECK_FALSE(flat({{0, 1, 2}, {1, 0, 3}}));  // one on the other
  CHECK_FALSE(flat({{0, 1, 2}, {1, 0, 4}}));
  CHECK(flat({{0, 1, 2}, {1, 0, 5}}));
  CHECK(flat({{0, 1, 2}, {1, 0, 4}, {1, 0, 5}}));  // and a fin on the edge
  const Triangles with_fin{{0, 1, 2}, {1, 0, 4}, {1, 0, 5}};
  const MeshNeighbours neighbours(vertices, with_fin);
  CHECK(neighbours.beyond(0, 0) == 5);
  CHECK_FALSE(neighbours.flat_corner(0, 0));
}

}  // namespace
}  // namespace kds::collision::test_mesh_neighbours
