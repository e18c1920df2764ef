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

/// Of a point, a segment or a box, which has so many dimensions.
const HullStructure& structure_of_box(int dimension) {
  static const HullStructure structures[]{
      {{0}, {}, {}},
      {{0, 1}, {{{0, 1}, {HullStructure::no_face, HullStructure::no_face}}}, {}},
      structure_of_hull(box_corners(Vector3d::Ones())),
  };
  return structures[dimension == 3 ? 2 : dimension];
}

}  // namespace

ConvexCore::ConvexCore(const Shape& shape) {
  const auto of_box = [&](const RoundedBox& box) {
    const int dimension = box.dimension();
    const Vector3d& half = box.half_extents;
    if (dimension == 3) own_ = box_corners(half);
    if (dimension == 1) own_[0] = {0, 0, -half[2]}, own_[1] = {0, 0, half[2]};
    if (dimension == 0) own_[0] = Vector3d::Zero();
    size_ = std::size_t{1} << dimension;
    structure_ = &structure_of_box(dimension);
    radius_ = box.radius;
  };
  const auto of_hull = [&](const Polytope& polytope) {
    hull_ = polytope.points();
    structure_ = &polytope.structure();
  };
  const auto of_others = [&](const auto&) {
    throw std::logic_error(std::string("ConvexCore: asked of a ") + kind_name(shape));
  };
  ask_form(shape, ByForm{of_box, of_hull, of_others});
}

}  // namespace kds::collision
