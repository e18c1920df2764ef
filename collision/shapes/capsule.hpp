// Capsules as shapes.
#pragma once

#include "collision/shapes/shape_kind.hpp"

namespace kds::collision::detail {

template <>
struct ShapeKind<Capsule> {
  static constexpr const char* name = "capsule";
  static constexpr bool has_half_axes = false;

  static void place(const Capsule& capsule, PlacedShape& placed);
  static std::array<double, 2> extent(const Capsule& capsule, const PlacedShape& placed,
                                      const Eigen::Vector3d& direction);

  static Eigen::Vector3d measures(const Capsule& capsule) {
    return {capsule.radius, capsule.radius, capsule.half_length};
  }

  /// Vertex 0 is the end at -half_length, vertex 1 the other, and the edge what is between them.
  static SupportingFeature support(const Capsule& capsule, const PlacedShape& placed, const Eigen::Vector3d& direction);

  static RoundedCore core(const Capsule& capsule, const PlacedShape& placed) {
    return {{{placed.rotation.col(2), capsule.half_length}}, capsule.radius};
  }

  template <class Archive>
  static void archive(Archive& archive, Capsule& capsule, PlacedShape&, const NumberedMeshes&) {
    archive(capsule.radius, capsule.half_length);
  }
};

}  // namespace kds::collision::detail
