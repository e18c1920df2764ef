// The parts of a surface that bends, and a tree over them: what stays as it is while the vertices move.
#pragma once

#include "collision/shapes/mesh.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace kds::collision {

/// A triangle, or a segment or a point: what a leaf of the tree holds.
///
/// Paper: [Curtis08]: each vertex and each edge is owned by one of the elements that share it, so that a walk over
/// pairs of elements meets each pair of features once.
struct SurfaceElement {
  std::array<std::uint32_t, 3> vertices;  ///< of which `corners` count
  std::uint32_t index;                    ///< of a triangle: in its mesh
  std::uint8_t corners;
  std::uint8_t owned_vertices;  ///< bit k: vertices[k]
  std::uint8_t owned_edges;     ///< bit k: the edge from vertices[k] to the next

  bool is_face() const { return corners == 3; }
};

/// A binary tree over the elements of a surface. Its shape is chosen once, from where the vertices are then, and is
/// right for any motion: only its boxes grow when parts that were near each other go apart (MovingSurface).
///
/// Boxes are split across the longest side at the median of the elements' centres, so that the depth is log2(n) rounded
/// up. Cost: O(n log n) to build, 2 n - 1 nodes.
class SurfaceTree {
 public:
  /// A box of the tree, which is around one element or around two smaller boxes.
  struct Node {
    std::uint32_t first;  ///< of a leaf: its element; else the first of two children, which stand side by side
    bool is_leaf;
  };

  /// Of a mesh. Triangles without area are welcome, as they may come and go while a mesh bends. Throws InvalidMesh if
  /// there is no triangle, an index is out of range, a triangle names a vertex twice, or a coordinate is not finite or
  /// beyond Mesh::largest_coordinate.
  SurfaceTree(std::span<const Eigen::Vector3d> positions, std::span<const Mesh::Triangle> triangles);

  static SurfaceTree point();
  static SurfaceTree segment();

  /// The root first, children after their parents.
  std::span<const Node> nodes() const { return nodes_; }
  std::span<const SurfaceElement> elements() const { return elements_; }
  std::size_t vertices() const { return vertices_; }

  /// The triangles 2 i and 2 i + 1 are the face i, and their common edge is no edge, owned by no element. Precondition:
  /// each has the diagonal from its first vertex to the last (of an even one) or to the second (of an odd one).
  void join_pairs_of_triangles();
  /// Whether two vertices are those of such a diagonal.
  bool is_diagonal(std::uint32_t a, std::uint32_t b) const;

  /// Throws AuditFailure unless each element is in one leaf, and each vertex that elements use and each edge is owned
  /// by one of them (edges: at most one).
  void audit() const;

 private:
  SurfaceTree(std::size_t vertices, SurfaceElement element);
  void build(std::span<const Eigen::Vector3d> positions);

  std::size_t vertices_;
  std::vector<SurfaceElement> elements_;
  std::vector<Node> nodes_;
  std::vector<std::array<std::uint32_t, 2>> diagonals_;  ///< the lower vertex first
};

}  // namespace kds::collision
