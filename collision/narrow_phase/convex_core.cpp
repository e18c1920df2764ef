#include "collision/narrow_phase/convex_core.hpp"

#include "collision/shapes/polytope.hpp"
#include "collision/shapes/shape_kinds.hpp"

#include <stdexcept>
#include <string>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

std::array<Vector3d, 8> box_corners(const Vector3d& half) {
  std::array<Vector3d, 8> corners;
  for (std::size_t i = 0; i < 8; ++i) {
    corners[i] = {i & 1 ? half[0] : -half[0], i & 2 ? half[1] : -half[1], i & 4 ? half[2] : -half[2]};
  }
  return corners;
}

const HullStructure& structure_of_box() {
  static const HullStructure structure = structure_of_hull(box_corners(Vector3d::Ones()));
  return structure;
}
const HullStructure& structure_of_segment() {
  static const HullStructure structure{{0, 1}, {{{0, 1}, {HullStructure::no_face, HullStructure::no_face}}}, {}};
  return structure;
}
const HullStructure& structure_of_point() {
  static const HullStructure structure{{0}, {}, {}};
  return structure;
}

}  // namespace

ConvexCore::ConvexCore(const Shape& shape) {
  const auto of_box = [&](const RoundedBox& box) {
    const Vector3d& half = box.half_extents;
    switch (box.dimension()) {
      case 3:
        own_ = box_corners(half);
        size_ = 8;
        structure_ = &structure_of_box();
        break;
      case 1:
        own_[0] = {0, 0, -half[2]}, own_[1] = {0, 0, half[2]};
        size_ = 2;
        structure_ = &structure_of_segment();
        break;
      default:
        own_[0] = Vector3d::Zero();
        size_ = 1;
        structure_ = &structure_of_point();
    }
    radius_ = box.radius;
  };
  const auto of_hull = [&](const Polytope& polytope) {
    hull_ = polytope.points();
    structure_ = &polytope.structure();
    normals_ = polytope.normals();
  };
  const auto of_others = [&](const auto&) {
    throw std::logic_error(std::string("ConvexCore: asked of a ") + kind_name(shape));
  };
  ask_form(shape, ByForm{of_box, of_hull, of_others});
}

Vector3d ConvexCore::normal(std::size_t face) const {
  if (!normals_.empty()) return normals_[face];
  const auto [a, b, c] = spanning_corners(structure_->faces[face]);
  return unit_normal(own_[a], own_[b], own_[c]);
}

}  // namespace kds::collision
