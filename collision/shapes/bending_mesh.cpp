#include "collision/shapes/bending_mesh.hpp"

#include "collision/vectors.hpp"

#include <algorithm>
#include <limits>

namespace kds::collision::detail {
namespace {

/// Least and greatest direction . v of the vertices at all keyframes.
std::array<double, 2> ends_along(const BendingMesh& shape, const Eigen::Matrix3d& rotation,
                                 const Eigen::Vector3d& direction) {
  std::array<double, 2> ends{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const auto& keyframe : shape.script->keyframes()) {
    for (const Eigen::Vector3d& v : keyframe.positions) {
      const double along = dot(direction, placed_vertex(rotation, 1, v));
      ends = {std::min(ends[0], along), std::max(ends[1], along)};
    }
  }
  return ends;
}

}  // namespace

void ShapeKind<BendingMesh>::place(const BendingMesh& shape, PlacedShape& placed) {
  if (!shape.script) throw std::invalid_argument("script: is missing");
  for (int d = 0; d < 3; ++d) {
    const auto ends = ends_along(shape, placed.rotation, Eigen::Vector3d::Unit(d));
    placed.low[d] = ends[0];
    placed.high[d] = ends[1];
  }
  const double radius = shape.script->bounding_radius();
  require_size(radius, "script: the radius");
  grow(placed, box_margin * radius);
  placed.bounding_radius = radius * (1 + box_margin);
}

std::array<double, 2> ShapeKind<BendingMesh>::extent(const BendingMesh& shape, const PlacedShape& placed,
                                                     const Eigen::Vector3d& direction) {
  const double length = norm(direction) * (1 + rotation_margin);
  const auto ends = ends_along(shape, placed.rotation, direction);
  const double margin = (box_margin + rotation_margin) * placed.bounding_radius * length;
  return {ends[0] - margin, ends[1] + margin};
}

}  // namespace kds::collision::detail
