// Bodies of several parts as shapes.
#pragma once

#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/mesh.hpp"
#include "collision/shapes/shape_kind.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace kds::collision {

class PartTree;

/// Parts that make no compound. The message names what is wrong; `part` is the number of the wrong part, from 0, if
/// there is one: then it begins "compound: part 3: ".
class InvalidCompound : public std::invalid_argument {
 public:
  explicit InvalidCompound(const std::string& what, std::optional<std::size_t> part = {})
      : std::invalid_argument("compound: " + (part ? "part " + std::to_string(*part) + ": " : std::string()) + what),
        part_(part) {}

  std::optional<std::size_t> part() const { return part_; }

 private:
  std::optional<std::size_t> part_;
};

/// A part of a compound: a box, a hull or a mesh, and where it is in the body.
struct CompoundPart {
  Shape shape;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();               ///< of its centre, in units of length
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< in the axes of the body
};

/// The parts of a compound, immutable: hulls and meshes whose points are about the centre of the body.
///
/// Contacts are those of the parts: a compound is in contact while one of them is. Parts may overlap, touch, or be far
/// from each other. Faces that lie inside of the whole, where parts touch, are faces all the same.
class CompoundParts {
 public:
  /// Throws InvalidCompound if there is none, or one is neither a hull nor a mesh of scale 1, or, of those with a tree,
  /// cannot be placed.
  explicit CompoundParts(std::vector<Shape> parts);

  std::span<const Shape> parts() const { return parts_; }
  bool has_mesh() const { return has_mesh_; }
  /// Boxes around groups of parts; null of a few parts (part_tree.hpp).
  const PartTree* tree() const { return tree_.get(); }

 private:
  std::vector<Shape> parts_;
  bool has_mesh_ = false;
  std::shared_ptr<const PartTree> tree_;
};

/// The compound of the parts. Each becomes a hull or a mesh of its points turned, moved by the position, and rounded:
/// these doubles *are* the part from here on. A point of a part that is not turned is rounded once, if at all. A box is
/// the hull of its corners, which are numbered as those of a box; points of hulls, and vertices and triangles of meshes
/// keep their numbers.
///
/// Throws InvalidCompound, in one line: "compound: has no parts", "compound: part 3: is a sphere; parts are boxes,
/// hulls and meshes", and "compound: part 3: " with what place() says of its shape and orientation, or Polytope and
/// Mesh of the points that it is made of.
Compound compound(std::span<const CompoundPart> parts);

namespace detail {

/// Sets the parts of a shape whose shape and rotation are set: those of a compound, else none. None, too, if it cannot
/// be placed: then place_turned() throws.
void place_parts(PlacedShape& placed);

/// Whether the parts of two placed shapes have the same bounds.
bool same_parts(const PlacedShape& a, const PlacedShape& b);

template <>
struct ShapeKind<Compound> {
  static constexpr const char* name = "compound";
  static constexpr bool has_half_axes = false;

  static void place(const Compound& compound, PlacedShape& placed);
  static std::array<double, 2> extent(const Compound& compound, const PlacedShape& placed,
                                      const Eigen::Vector3d& direction);

  static Eigen::Vector3d measures(const Compound&) { return Eigen::Vector3d::Ones(); }

  /// The points and triangles of all parts, a hull as one without triangles: of a compound that several bodies share,
  /// by each of them.
  template <class Archive>
  static void archive(Archive& archive, Compound& compound, PlacedShape&, const NumberedMeshes&);
};

/// A part as it is written.
struct PartPoints {
  std::vector<Eigen::Vector3d> points;
  std::vector<Mesh::Triangle> triangles;  ///< none of a hull
};
std::vector<PartPoints> points_of_parts(const Compound& compound);
/// Throws std::runtime_error, naming the part, if there is no such compound.
Compound compound_of_points(std::vector<PartPoints> parts);

template <class Archive>
void ShapeKind<Compound>::archive(Archive& archive, Compound& compound, PlacedShape&, const NumberedMeshes&) {
  std::vector<PartPoints> parts;
  if constexpr (!Archive::loading) parts = points_of_parts(compound);
  archive.each(parts, [&](PartPoints& part) {
    archive.each(part.points, [&](Eigen::Vector3d& point) { archive_vector(archive, point); });
    archive(part.triangles);
  });
  if constexpr (Archive::loading) compound = compound_of_points(std::move(parts));
}

}  // namespace detail

}  // namespace kds::collision
