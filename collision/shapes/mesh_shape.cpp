#include "collision/shapes/mesh_shape.hpp"

#include "collision/vectors.hpp"
#include "kds/number_text.hpp"

#include <cmath>

namespace kds::collision::detail {
namespace {

/// What a mesh and its scale make together.
void require_range(const Mesh& mesh, double scale) {
  const double edge = mesh.shortest_edge() * scale;
  const double radius = mesh.bounding_radius() * scale;
  if (!(edge >= shortest_edge)) {
    throw std::invalid_argument("scale: " + number_text(scale) + " makes an edge of the mesh " + number_text(edge) +
                                " long; at least " + power_text(shortest_edge) + " is supported");
  }
  if (!(radius <= Mesh::largest_coordinate * (1 + 0x1p-40) * std::sqrt(3.0))) {
    throw std::invalid_argument("scale: " + number_text(scale) + " makes the mesh reach " + number_text(radius) +
                                " from its origin; at most " + power_text(Mesh::largest_coordinate) +
                                " along each axis is supported");
  }
}

}  // namespace

void ShapeKind<MeshShape>::place(const MeshShape& shape, PlacedShape& placed) {
  if (!shape.mesh) throw std::invalid_argument("mesh: is missing");
  if (!std::isfinite(shape.scale)) throw std::invalid_argument("scale: must be finite");
  if (!(shape.scale > 0)) throw std::invalid_argument("scale: must be > 0");
  require_range(*shape.mesh, shape.scale);
  shape.mesh->extents(placed.rotation, shape.scale, placed.low, placed.high);
  const double radius = shape.mesh->bounding_radius() * shape.scale;
  grow(placed, box_margin * radius);
  placed.bounding_radius = radius * (1 + rotation_margin);
}

std::array<double, 2> ShapeKind<MeshShape>::extent(const MeshShape& shape, const PlacedShape& placed,
                                                   const Eigen::Vector3d& direction) {
  const double length = norm(direction) * (1 + rotation_margin);
  const std::array<double, 2> ends = shape.mesh->extent(placed.rotation, shape.scale, direction);
  const double margin = (box_margin + rotation_margin) * placed.bounding_radius * length;
  return {ends[0] - margin, ends[1] + margin};
}

}  // namespace kds::collision::detail
