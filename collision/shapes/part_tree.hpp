// Boxes and balls around groups of the parts of a compound.
#pragma once

#include "collision/shapes/compound.hpp"
#include "collision/shapes/shape.hpp"
#include "collision/vectors.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

namespace kds::collision {

/// A ball that holds a part, in the coordinates of its body.
struct BallOfPart {
  /// That about the box around the part, or that about the origin of the body if it is smaller. The box is turned as
  /// the part was placed, by a matrix that is a rotation up to roundings, for which 2^-40 of the lengths is charged.
  explicit BallOfPart(const PlacedShape& part) {
    const Eigen::Vector3d diagonal = part.high - part.low;
    radius = 0.5 * norm(diagonal) + 0x1p-40 * part.bounding_radius;
    if (radius < part.bounding_radius) {
      centre = part.rotation.transpose() * (0.5 * (part.low + part.high));
    } else {
      radius = part.bounding_radius;
    }
  }

  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius;
};

/// A binary tree over the parts of a compound, in the axes of the body: made once with the parts, for all bodies that
/// share them. A pair test looks at the parts of those leaves alone whose volumes the other body may meet.
///
/// A group is split at the median of the centres of its boxes, along the axis on which these lie farthest apart. Cost:
/// O(n log n) time, some 30 bytes a part.
class PartTree {
 public:
  /// A group of parts.
  struct Node {
    /// Around the boxes that place() puts around the parts of a body that is not turned.
    Eigen::Vector3d low, high;
    Eigen::Vector3d centre;  ///< of a ball that holds the balls of all parts (BallOfPart) of such a body
    double radius;           ///< of that ball
    double reach;            ///< the greatest distance of the centre of such a part's ball from the body's centre
    std::uint32_t first;     ///< of a leaf: its first place in order(); else the first of two children, side by side
    std::uint32_t count;     ///< of a leaf: its number of parts; else 0

    bool is_leaf() const { return count != 0; }
  };

  /// Leaves have up to so many parts, and a compound of no more has no tree. A look at a part costs about as much as
  /// one at a node.
  static constexpr std::size_t leaf_size = 8;

  /// Throws InvalidCompound for a part that place() refuses.
  explicit PartTree(std::span<const Shape> parts);

  std::span<const Node> nodes() const { return nodes_; }             ///< the root first
  std::span<const std::uint32_t> order() const { return order_; }    ///< the numbers of the parts, leaf by leaf
  std::span<const std::uint32_t> parts_of(const Node& leaf) const {  ///< in rising order
    return order().subspan(leaf.first, leaf.count);
  }

 private:
  void build(std::span<const PlacedShape> parts);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

/// The tree of a compound that has one, else null.
inline const PartTree* part_tree(const PlacedShape& shape) {
  const auto* const compound = std::get_if<Compound>(&shape.shape);
  return compound && compound->parts ? compound->parts->tree() : nullptr;
}

}  // namespace kds::collision
