// Trees of oriented bounding boxes around the triangles of a mesh.
#pragma once

#include "collision/lanes.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace kds::collision {

/// A box turned in any direction, and what is in it. In floats, lengths in the tree's unit(): a box has to hold its
/// triangles for certain, but need not be tight to the last bit, and four floats are handled at a time.
struct ObbNode {
  std::array<Lanes, 3> axes;  ///< row k: coordinate k of the directions of the three edges, orthonormal up to rounding
  Lanes centre;               ///< in the model's coordinates
  Lanes half_extents;         ///< along the axes; grown so that the box holds its triangles in spite of rounding
  float radius;               ///< of the ball about the centre around the box, rounded up
  std::uint32_t first;        ///< of a leaf: its first place in leaf_triangles(); else the first of two children
  std::uint32_t count;        ///< of a leaf: its number of triangles; else 0

  bool is_leaf() const { return count != 0; }
};

/// A triangle as the leaves keep it.
struct LeafTriangle {
  std::array<std::uint32_t, 3> vertices;
  std::uint32_t index;  ///< in the mesh
};

/// A binary tree of oriented boxes, built once for a mesh.
///
/// Paper: [Gottschalk96] section 4: the axes of a box are the principal directions of the area-weighted triangles;
/// a box is split across its longest axis at the mean of the triangles' centres, if that fails across the next.
/// Differs: a split that puts less than an eighth of the triangles on one side is moved to the median, which makes the
/// building O(n log n) and the depth at most log n / log (8/7); where the model's own axes, or in small boxes the
/// edges of the triangles, bound the box by a smaller surface than the principal directions they are taken instead
/// (principal directions of symmetric sets are arbitrary).
class ObbTree {
 public:
  /// Precondition: valid triangles (Mesh checks them).
  ObbTree(std::span<const Eigen::Vector3d> vertices, std::span<const std::array<std::uint32_t, 3>> triangles);

  /// The length in which the boxes are measured: all coordinates of the model lie in [-1, 1].
  double unit() const { return unit_; }
  std::span<const ObbNode> nodes() const { return nodes_; }  ///< the root first; children stand side by side
  std::span<const LeafTriangle> leaf_triangles() const { return leaf_triangles_; }

  /// Checks that every triangle is in exactly one leaf and inside every box above it; throws AuditFailure.
  void audit(std::span<const Eigen::Vector3d> vertices) const;

  /// Most triangles in a leaf. Measured on rings of 64 and knots of 6 000 triangles, see the benchmark: box tests cost
  /// about as much as triangle tests that fail early, and single triangles in leaves prune best.
  static constexpr std::uint32_t leaf_size = 1;

 private:
  double unit_ = 1;
  std::vector<ObbNode> nodes_;
  std::vector<LeafTriangle> leaf_triangles_;
};

}  // namespace kds::collision
