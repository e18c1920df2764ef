// Meshes that bend as shapes.
#pragma once

#include "collision/shapes/mesh_script.hpp"
#include "collision/shapes/shape_kind.hpp"

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace kds::collision {

/// Contact of a mesh that bends is reported while surfaces are no farther apart than this part of its bounding radius,
/// beyond their own radii (BendingContact). Its bounding volume has room for that (`box_margin` is four times as much),
/// so that contacts do not depend on the broad phase. Larger reports contact earlier.
inline constexpr double bending_tolerance = 0x1p-26;

/// The bounding box of a placed mesh that bends, about its centre, while it moves from one keyframe to the next.
struct BendingBounds {
  Eigen::Vector3d low, high;
  double until;  ///< s: the next keyframe; infinity after the last
};

/// From t on, turned by a rotation. Precondition, here and below: the shape is a BendingMesh.
BendingBounds bending_bounds(const PlacedShape& placed, const Eigen::Matrix3d& rotation, double t);
/// What extent() tells of all keyframes.
std::array<double, 2> bending_extent(const PlacedShape& placed, const Eigen::Matrix3d& rotation,
                                     const Eigen::Vector3d& direction, double t);

namespace detail {

template <>
struct ShapeKind<BendingMesh> {
  static constexpr const char* name = "bending mesh";
  static constexpr bool has_half_axes = false;

  /// Around all keyframes.
  static void place(const BendingMesh& shape, PlacedShape& placed);
  static std::array<double, 2> extent(const BendingMesh& shape, const PlacedShape& placed,
                                      const Eigen::Vector3d& direction);

  static Eigen::Vector3d measures(const BendingMesh&) { return Eigen::Vector3d::Ones(); }

  /// Writes the whole script, separately for each body; and the positions from which its tree was made, if they are not
  /// those of the first keyframe, since times of separations depend on the tree.
  template <class Archive>
  static void archive(Archive& archive, BendingMesh& shape, PlacedShape&, const NumberedMeshes&) {
    std::vector<MeshScript::Keyframe> keyframes;
    std::vector<Mesh::Triangle> triangles;
    std::vector<Eigen::Vector3d> former;
    if (shape.script) {
      keyframes.assign(shape.script->keyframes().begin(), shape.script->keyframes().end());
      triangles.assign(shape.script->triangles().begin(), shape.script->triangles().end());
      if (shape.script->form().positions != keyframes[0].positions) former = shape.script->form().positions;
    }
    const auto each_vector = [&](Eigen::Vector3d& v) { archive_vector(archive, v); };
    archive.each(keyframes, [&](MeshScript::Keyframe& keyframe) {
      archive(keyframe.time);
      archive.each(keyframe.positions, each_vector);
    });
    archive(triangles);
    archive.each(former, each_vector);
    if constexpr (Archive::loading) {
      try {
        if (former.empty()) {
          shape.script = std::make_shared<const MeshScript>(std::move(keyframes), std::move(triangles));
        } else {
          const MeshScript before({{0, std::move(former)}}, std::move(triangles));
          shape.script = std::make_shared<const MeshScript>(before.with(std::move(keyframes)));
        }
      } catch (const std::invalid_argument& error) {
        throw std::runtime_error(std::string("snapshot: a mesh that bends: ") + error.what());
      }
    }
  }
};

}  // namespace detail

}  // namespace kds::collision
