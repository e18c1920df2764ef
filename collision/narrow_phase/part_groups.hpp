// The parts of a shape, and boxes around groups of them.
#pragma once

#include "collision/shapes/part_tree.hpp"
#include "collision/shapes/shape.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <span>

namespace kds::collision {

/// The parts of a compound; any other shape is its own only part.
inline std::span<const PlacedShape> parts_of(const PlacedShape& shape) {
  if (shape.parts) return *shape.parts;
  return {&shape, 1};
}

/// The parts of a shape in groups of groups: those of its tree, or a single one.
class PartGroups {
 public:
  explicit PartGroups(const PlacedShape& shape) : shape_(shape), tree_(part_tree(shape)) {
    if (tree_ && !shape.rotation.isIdentity(0)) rotation_ = shape.rotation.cwiseAbs();
  }

  bool has_tree() const { return tree_ != nullptr; }
  const PlacedShape& shape() const { return shape_; }
  /// Precondition, here and below where a node is returned: there is a tree.
  const PartTree::Node& node(std::uint32_t group) const { return tree_->nodes()[group]; }
  bool is_leaf(std::uint32_t group) const { return !tree_ || node(group).is_leaf(); }
  std::uint32_t first_child(std::uint32_t group) const { return node(group).first; }

  /// Around the boxes of its parts, in the axes of the world; `least` and `greatest` corner. A box that is turned is
  /// held by one that is larger; 2^-40 of the size of the shape is far above the roundings of that.
  std::array<Eigen::Vector3d, 2> box(std::uint32_t group) const {
    if (group == 0) return {shape_.low, shape_.high};
    const PartTree::Node& at = node(group);
    if (rotation_.isZero(0)) return {at.low, at.high};
    const Eigen::Vector3d centre = shape_.rotation * (0.5 * (at.low + at.high));
    const Eigen::Vector3d half =
        rotation_ * (0.5 * (at.high - at.low)) + Eigen::Vector3d::Constant(0x1p-40 * shape_.bounding_radius);
    return {centre - half, centre + half};
  }

  /// Calls take(number) for the parts of a leaf.
  template <class Take>
  void each_part(std::uint32_t leaf, const Take& take) const {
    if (tree_) {
      for (const std::uint32_t part : tree_->parts_of(node(leaf))) take(part);
    } else {
      const auto count = static_cast<std::uint32_t>(parts_of(shape_).size());
      for (std::uint32_t part = 0; part < count; ++part) take(part);
    }
  }

 private:
  const PlacedShape& shape_;
  const PartTree* tree_;
  Eigen::Matrix3d rotation_ = Eigen::Matrix3d::Zero();  ///< magnitudes; zero of a shape that is not turned
};

}  // namespace kds::collision
