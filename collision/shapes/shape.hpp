// Shapes of bodies, and what the rest of the module needs to know of any shape.
#pragma once

#include "collision/quaternion_alignment.hpp"

#include <Eigen/Core>

#include <array>
#include <memory>
#include <variant>
#include <vector>

namespace kds::collision {

class CompoundParts;
class Mesh;
class MeshScript;
class Polytope;
struct RoundedCore;

/// What numbers may be, in any units: sizes and masses from smallest_size to largest_magnitude; coordinates, speeds and
/// halves of accelerations 0 or anything up to largest_magnitude, and times of the clock too. In this range squares of
/// lengths, and what the tests of meshes multiply (squares of a speed times three edges), neither overflow nor, for
/// sizes, underflow; beyond it contacts could be missed, so what is given beyond it is refused.
inline constexpr double smallest_size = 0x1p-205;     ///< 1.9e-62
inline constexpr double largest_magnitude = 0x1p205;  ///< 5.1e61

/// The least length of the edges of a mesh after scaling, in units of length: below it the axes that separate its
/// triangles, products of up to three edges, are too short to be told from zero (`vanishing_axis`).
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

/// All that is nearer than `radius` > 0 to the segment of the length 2 `half_length` on the z axis of the body, whose
/// middle is its centre. In units of length. A half length of 0 makes a ball: it is placed as the Sphere that it is.
struct Capsule {
  double radius;
  double half_length;
};

/// A solid polytope, the convex hull of points, shared by any number of bodies: made by convex_hull()
/// (convex_hull.hpp).
struct ConvexHull {
  std::shared_ptr<const Polytope> polytope;
};

/// A triangle surface that bends with time, shared by any number of bodies.
struct BendingMesh {
  std::shared_ptr<const MeshScript> script;
};

/// All points x with normal . x <= offset, seen from the body's centre: a floor, a wall. The normal is of unit length
/// up to 1e-6 (it is normalised); the offset is in units of length. It has no bounds, so its body is in no broad phase:
/// it is tested with each body that it may collide with (world/unbounded.hpp).
struct HalfSpace {
  Eigen::Vector3d normal;
  double offset = 0;
};

/// Boxes, hulls and meshes that are one body, each at its place in it, shared by any number of bodies: made by
/// compound() (compound.hpp).
struct Compound {
  std::shared_ptr<const CompoundParts> parts;
};

/// Each kind says in a file of its own what the functions below have to know of it: sphere.hpp, box.hpp,
/// mesh_shape.hpp, capsule.hpp, convex_hull.hpp, half_space.hpp, compound.hpp. To add one: a struct, its place in this
/// list, its file, and its row in the table of pair tests (narrow_phase/narrow_phase.cpp). Snapshots name a kind by its
/// number in the list.
using Shape = std::variant<Sphere, Box, MeshShape, Capsule, ConvexHull, BendingMesh, HalfSpace, Compound>;

/// "sphere", "box", "mesh", "capsule", "hull", "bending mesh", "half-space", "compound".
const char* kind_name(const Shape& shape);

/// The numbers of the shape: half of what it measures along its own axes; of a mesh its scale, thrice; of a capsule its
/// radius twice, and its half length; of a hull and a compound 1, thrice; of a half-space infinity, thrice.
Eigen::Vector3d measures(const Shape& shape);

/// The radius of a ball; 0 of other shapes.
inline double ball_radius(const Shape& shape) {
  const auto* const ball = std::get_if<Sphere>(&shape);
  return ball ? ball->radius : 0;
}

/// Whether the shape is or has a surface that is tested in doubles, with a margin: bounding volumes need room for that.
bool has_mesh(const Shape& shape);

/// Whether the shape need not be convex, so that it may touch a convex one in several places at once.
inline bool concave(const Shape& shape) {
  return std::holds_alternative<MeshShape>(shape) || std::holds_alternative<Compound>(shape);
}

/// Whether the shape changes while the body rests.
inline bool bends(const Shape& shape) { return std::holds_alternative<BendingMesh>(shape); }

/// Whether no ball holds the shape: its bounds are infinite.
inline bool unbounded(const Shape& shape) { return std::holds_alternative<HalfSpace>(shape); }

/// The mesh of a MeshShape, else null.
std::shared_ptr<const Mesh> mesh_of(const Shape& shape);

/// The bounding box of a mesh is grown by this part of its radius, which is enough for paths of a quarter of a million
/// radii: see MeshClearance (mesh_margins.hpp), which grows volumes where it is not. Larger has more pairs tested.
inline constexpr double box_margin = 0x1p-24;

/// A shape turned into an orientation. The bodies of a World keep theirs; those of a TurningWorld have it in their
/// motion.
struct PlacedShape {
  Shape shape;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  /// Half edges of a box in world orientation, rounded; these doubles *are* the box from here on. Unset for others.
  std::array<Eigen::Vector3d, 3> half_axes{};
  Eigen::Vector3d low = Eigen::Vector3d::Zero();   ///< corner of the bounding box about the centre, rounded outward
  Eigen::Vector3d high = Eigen::Vector3d::Zero();  ///< the other
  double bounding_radius = 0;                      ///< of the ball about the centre that holds the shape
  /// Of a compound its parts, each in the same orientation and about the same centre. Null for others.
  std::shared_ptr<const std::vector<PlacedShape>> parts{};
};

/// Validates and places a shape. Throws std::invalid_argument naming the member that is wrong: sizes must be > 0 and in
/// the range above, a mesh must be there, the orientation must be a unit quaternion to 1e-6 (it is normalised). A mesh,
/// scaled, must reach no farther than Mesh::largest_coordinate, and have no edge below `shortest_edge`.
PlacedShape place(const Shape& shape, const Eigen::Quaterniond& orientation);
/// The same with the matrix that place() makes of the orientation, which must be a rotation up to its rounding.
PlacedShape place_turned(const Shape& shape, const Eigen::Matrix3d& rotation);
/// Whether it is what place_turned() makes of its shape and rotation, which throws if they cannot be placed.
bool is_placed(const PlacedShape& shape);

/// The shape as a zonotope grown by a radius. Precondition: it is no mesh, hull, half-space or compound.
RoundedCore rounded_core(const PlacedShape& shape);

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
