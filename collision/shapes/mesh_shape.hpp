// Meshes as shapes.
#pragma once

#include "collision/shapes/mesh.hpp"
#include "collision/shapes/shape_kind.hpp"

#include <stdexcept>
#include <string>

namespace kds::collision::detail {

template <>
struct ShapeKind<MeshShape> {
  static constexpr const char* name = "mesh";
  static constexpr bool has_half_axes = false;

  static void place(const MeshShape& shape, PlacedShape& placed);
  static std::array<double, 2> extent(const MeshShape& shape, const PlacedShape& placed,
                                      const Eigen::Vector3d& direction);

  static Eigen::Vector3d measures(const MeshShape& shape) { return Eigen::Vector3d::Constant(shape.scale); }

  template <class Archive>
  static void archive(Archive& archive, MeshShape& shape, PlacedShape&, const NumberedMeshes& numbered) {
    archive(numbered.number, shape.scale);
    if (numbered.number >= numbered.meshes.size()) {
      throw std::runtime_error("snapshot: a body has mesh " + std::to_string(numbered.number) + ", and there are " +
                               std::to_string(numbered.meshes.size()));
    }
    shape.mesh = numbered.meshes[numbered.number];
  }
};

}  // namespace kds::collision::detail
