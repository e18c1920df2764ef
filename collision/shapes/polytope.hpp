// Convex hulls of points, immutable and shared by bodies.
#pragma once

#include "collision/shapes/aligned_box.hpp"
#include "collision/shapes/feature.hpp"
#include "collision/shapes/hull_structure.hpp"
#include "collision/shapes/mesh.hpp"
#include "collision/shapes/shape.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace kds::collision {

/// A convex polytope, the hull of points in units of length, relative to the model's origin, which is the centre of the
/// bodies that use it; it may be anywhere.
///
/// Its corners and edges are named by the indices of the points, its faces by their places in structure().faces.
/// Corners that are in one plane only up to roundings make several faces.
class Polytope {
 public:
  /// Throws InvalidHull: naming the point, if a coordinate is not finite or beyond 2^100; if there are fewer than four
  /// points, or they lie in one plane (structure_of_hull()); or if the corners of a face lie in a line but for
  /// roundings, so that its surface is no mesh.
  explicit Polytope(std::vector<Eigen::Vector3d> points);

  std::span<const Eigen::Vector3d> points() const { return points_; }
  const HullStructure& structure() const { return structure_; }

  /// Of each face the unit normal that points out, rounded once.
  std::span<const Eigen::Vector3d> normals() const { return normals_; }

  /// The surface, closed, with the same points as vertices, in triangles that are counter-clockwise seen from outside.
  const std::shared_ptr<const Mesh>& surface() const { return surface_; }
  /// A feature of the surface as one of the polytope: an edge between two triangles of a face is in that face.
  Feature feature_of(const Feature& of_surface) const;
  /// Whether a corner or an edge belongs to a face.
  bool is_part_of(const Feature& feature, const Feature& face) const;

  /// The polytope as a box, if its corners are exactly those of a box with edges along the axes.
  const std::optional<AlignedBox>& box() const { return box_; }

  /// Radius of the ball about the origin that holds all corners, rounded up.
  double bounding_radius() const { return bounding_radius_; }

 private:
  std::vector<Eigen::Vector3d> points_;
  HullStructure structure_;
  std::vector<Eigen::Vector3d> normals_;
  std::vector<std::uint32_t> face_of_;  ///< by triangles of the surface
  std::shared_ptr<const Mesh> surface_;
  std::optional<AlignedBox> box_;
  double bounding_radius_ = 0;
};

/// The mesh of a mesh shape, or the surface of a hull. Precondition: the shape is one of the two.
MeshShape surface_of(const Shape& shape);

/// Three corners of a face that span its plane, counter-clockwise seen from outside: of its list they are the first and
/// those that are a third and two thirds of it further.
std::array<std::uint32_t, 3> spanning_corners(std::span<const std::uint32_t> face);
/// The unit normal of the plane of three points, from double-doubles: known to some roundings where the sine of their
/// angle is above 2^-46, as it is in a mesh.
Eigen::Vector3d unit_normal(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

}  // namespace kds::collision
