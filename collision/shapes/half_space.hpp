// Half-spaces as shapes.
#pragma once

#include "collision/shapes/shape_kind.hpp"

namespace kds::collision {

/// A half-space in world orientation. These doubles *are* the half-space from here on: its normal is a unit vector up
/// to four roundings, exactly one along an axis in an orientation that is exact. Precondition: the shape is one.
HalfSpace placed_half_space(const PlacedShape& placed);

namespace detail {

template <>
struct ShapeKind<HalfSpace> {
  static constexpr const char* name = "half-space";
  static constexpr bool has_half_axes = false;

  static void place(const HalfSpace& half_space, PlacedShape& placed);
  static std::array<double, 2> extent(const HalfSpace&, const PlacedShape&, const Eigen::Vector3d&);
  static Eigen::Vector3d measures(const HalfSpace&);

  template <class Archive>
  static void archive(Archive& archive, HalfSpace& half_space, PlacedShape&, const NumberedMeshes&) {
    archive_vector(archive, half_space.normal);
    archive(half_space.offset);
  }
};

}  // namespace detail

}  // namespace kds::collision
