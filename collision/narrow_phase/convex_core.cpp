#include "collision/narrow_phase/convex_core.hpp"

#include "collision/shapes/polytope.hpp"

#include <stdexcept>
#include <variant>

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

ConvexCore::ConvexCore(const Shape& shape) : structure_(&structure_of_point()) {
  if (const auto* const hull = std::get_if<ConvexHull>(&shape)) {
    hull_ = hull->polytope->points();
    structure_ = &hull->polytope->structure();
  } else if (const auto* const box = std::get_if<Box>(&shape)) {
    own_ = box_corners(box->half_extents);
    size_ = 8;
    structure_ = &structure_of_box();
  } else if (const auto* const capsule = std::get_if<Capsule>(&shape)) {
    own_[0] = {0, 0, -capsule->half_length};
    own_[1] = {0, 0, capsule->half_length};
    size_ = 2;
    structure_ = &structure_of_segment();
    radius_ = capsule->radius;
  } else if (const auto* const ball = std::get_if<Sphere>(&shape)) {
    own_[0] = Vector3d::Zero();
    size_ = 1;
    radius_ = ball->radius;
  } else {
    throw std::logic_error("ConvexCore: asked of a mesh");
  }
}

}  // namespace kds::collision
