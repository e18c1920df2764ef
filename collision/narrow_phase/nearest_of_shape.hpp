// The point of a shape that is nearest to another point.
#pragma once

#include "collision/shapes/shape.hpp"

#include <Eigen/Core>

namespace kds::collision {

/// The point of a shape nearest to another point, and its distance from that.
struct NearestOfShape {
  double distance;        ///< 0 inside of a solid
  Eigen::Vector3d point;  ///< inside of a solid, the other point itself
};

/// The centre of the shape is the origin. Meshes are surfaces, all others solid. Of a mesh that bends, where it is at
/// the time t.
///
/// In doubles: off by some roundings of the coordinates; if the point lies on a triangle, by this times the ratio of
/// its longest edge to its height. Cost: in proportion to the triangles of a hull and of a mesh that bends, and to
/// their logarithm of a mesh, unless all of it is equally far.
NearestOfShape nearest_of_shape(const PlacedShape& shape, const Eigen::Vector3d& to, double t = 0);

}  // namespace kds::collision
