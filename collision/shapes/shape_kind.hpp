// What each kind of shape says of itself, for shape.cpp to pass on.
#pragma once

#include "collision/shapes/rounded_core.hpp"
#include "collision/shapes/shape.hpp"
#include "collision/shapes/support.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <span>

namespace kds::collision::detail {

/// What the axes of a turned shape may be off orthonormal, and what adding up its extents may round.
inline constexpr double rotation_margin = 16 * 0x1p-52;

/// Exactly representable orientations (the identity, quarter turns) give exact axes, which need no margin.
inline bool is_signed_permutation(const Eigen::Matrix3d& m) {
  return ((m.array() == 0) || (m.array().abs() == 1)).all();
}

inline void grow(PlacedShape& placed, double margin) {
  placed.low.array() -= margin;
  placed.high.array() += margin;
}

/// Specialised for each alternative of Shape, with
/// - `name`, as in scenes;
/// - `has_half_axes`: whether PlacedShape::half_axes are set;
/// - `place(shape, placed)`: checks the numbers of the shape, naming the member that is wrong in std::invalid_argument,
///   and fills in the bounds and axes of `placed`, whose shape and rotation are there already;
/// - `extent(shape, placed, direction)`: see extent() in shape.hpp;
/// - `support(shape, placed, direction)`: see supporting_feature() in support.hpp; of convex solids;
/// - `rounded_box(shape)`, see rounded_box.hpp; `moments(shape, mass)`, of inertia, about the axes through the centre;
///   `outline(shape, pen)`, which draws with the pen.line() and pen.arc() of drawing/outline.cpp: of rounded boxes;
/// - `measures(shape)`: see measures() in shape.hpp;
/// - `archive(archive, shape, placed, meshes)`: for snapshots, the numbers of the shape, and what is not a function of
///   them and of the rotation to the last bit. A mesh is named by its number among the meshes of the snapshot.
template <class Alternative>
struct ShapeKind;

/// The meshes of a snapshot, and the number of that of the shape at hand.
struct NumberedMeshes {
  std::span<const std::shared_ptr<const Mesh>> meshes;
  std::uint32_t& number;
};

/// The coordinates of a vector, one by one.
template <class Archive>
void archive_vector(Archive& archive, Eigen::Vector3d& v) {
  archive(v[0], v[1], v[2]);
}

}  // namespace kds::collision::detail
