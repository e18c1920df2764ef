// How the triangles of a mesh go on beyond their edges and corners.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace kds::collision {

/// What is on the other side of the edges of each triangle, what is around each vertex, and where the surface is flat.
/// Edge i of a triangle leads from its corner i to the next. Vertices at one place count as one, so that triangles
/// that share no indices are neighbours too; a triangle whose corner lies inside another's edge is none.
///
/// A convex body meets an edge only from directions from which it is nearer to the edge than to the triangles on both
/// sides, and a corner only from where it is nearer than all edges that end there. If the two triangles lie in one
/// plane, which is told exactly, there are no such directions.
///
/// Cost: O(n log n) to find.
class MeshNeighbours {
 public:
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  MeshNeighbours(std::span<const Eigen::Vector3d> vertices, std::span<const std::array<std::uint32_t, 3>> triangles);

  /// The corner of the triangle on the other side of an edge that is not on the edge; `none` at the border of the
  /// mesh. Where several triangles meet, of that with which the surface goes on most nearly in one plane.
  std::uint32_t beyond(std::uint32_t triangle, std::size_t edge) const { return beyond_[triangle][edge]; }
  /// The vertices to which edges lead from one that triangles use.
  std::span<const std::uint32_t> around(std::uint32_t vertex) const {
    const std::uint32_t place = place_of_[vertex];
    return std::span(around_).subspan(first_[place], first_[place + 1] - first_[place]);
  }
  /// Whether a triangle lies in one plane with that beyond an edge, or with all that are around a corner, which is
  /// within them.
  bool flat_edge(std::uint32_t triangle, std::size_t edge) const { return (flat_[triangle] >> edge & 1) != 0; }
  bool flat_corner(std::uint32_t triangle, std::size_t corner) const { return (flat_[triangle] >> corner & 8) != 0; }

 private:
  std::vector<std::array<std::uint32_t, 3>> beyond_;
  std::vector<std::uint8_t> flat_;       ///< by triangle: a bit for each edge, then one for each corner
  std::vector<std::uint32_t> place_of_;  ///< by vertex: the lowest one at the same place
  std::vector<std::uint32_t> first_;     ///< by vertex: its first in around_
  std::vector<std::uint32_t> around_;
};

}  // namespace kds::collision
