// Shapes of bodies, and what the rest of the module needs to know of any shape.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <memory>
#include <variant>

namespace kds::collision {

class Mesh;

/// What numbers may be, in any units: sizes and masses from smallest_size to largest_magnitude; coordinates, speeds and
/// halves of accelerations 0 or anything up to largest_magnitude, and times of the clock too. In this range squares of
/// lengths, and what the tests of meshes multiply (squares of a speed times three edges), neither overflow nor, for
/// sizes, underflow; beyond it contacts could be missed, so what is given beyond it is refused.
inline constexpr double smallest_size = 0x1p-205;      ///< 1.9e-62
inline constexpr double largest_magnitude = 0x1p205;  ///< 5.1e61

/// Of the edges of a mesh as it is scaled, in units of length: below, the axes that separate its triangles, products of
/// up to three edges, are too short to be told from nothing (`vanishing_axis`).
inline constexpr double shortest_edge = 0x1p-110;  ///< 7.7e-34

/// A ball about the body's centre. Radius > 0, in units of length.
struct Sphere {
  double radius;
};

/// A solid box about the body's centre. Half extents > 0, in units of length.
struct Box {
  Eigen::Vector3d half_extents;
};

/// A triangle surface shared by any number of bodies, scaled by `scale` > 0.
struct MeshShape {
  std::shared_ptr<const Mesh> mesh;
  double scale = 1;
};

using Shape = std::variant<Sphere, Box, MeshShape>;

/// A shape turned into the orientation it keeps: bodies translate and do not rotate.
struct PlacedShape {
  Shape shape;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  /// Half edges of a box in world orientation, rounded; these doubles *are* the box from here on.
  std::array<Eigen::Vector3d, 3> half_axes{};
  Eigen::Vector3d low = Eigen::Vector3d::Zero();   ///< corner of the bounding box about the centre, rounded outward
  Eigen::Vector3d high = Eigen::Vector3d::Zero();  ///< the other
  double bounding_radius = 0;                      ///< of the ball about the centre that holds the shape
};

/// Validates and places a shape. Throws std::invalid_argument naming the member that is wrong: sizes must be > 0 and in
/// the range above, a mesh must be there, the orientation must be a unit quaternion to 1e-6 (it is normalised). A mesh,
/// scaled, must reach no farther than Mesh::largest_coordinate, and have no edge below `shortest_edge`.
PlacedShape place(const Shape& shape, const Eigen::Quaterniond& orientation);
/// The same with the matrix that place() makes of the orientation, which must be a rotation up to its rounding.
PlacedShape place_turned(const Shape& shape, const Eigen::Matrix3d& rotation);

/// From where to where the shape reaches about its centre along a direction: least and greatest direction . x, rounded
/// outward, with the margin of its bounding box; in units of length times that of the direction. Of a mesh it costs a
/// look at all its vertices. Precondition: the direction is of three numbers -1, 0 or 1, not all zero.
std::array<double, 2> extent(const PlacedShape& shape, const Eigen::Vector3d& direction);

/// What place() makes of a ball that is not turned; throws as it does.
PlacedShape placed_ball(double radius);
/// Throws as place() does for a radius that is not finite, not > 0 or out of range.
void require_radius(double radius);
/// Throws std::invalid_argument, naming `what`, for a number that is not finite, not > 0, or out of the range of sizes.
void require_size(double value, const char* what);

}  // namespace kds::collision
