// How far apart two shapes are, and where they are nearest to each other.
#pragma once

#include "collision/shapes/shape.hpp"

#include <Eigen/Core>

namespace kds::collision {

/// The distance of two shapes, and a point of each that is so far from that of the other.
struct ShapeDistance {
  double distance;  ///< 0 where they have a point in common
  Eigen::Vector3d of_a;
  Eigen::Vector3d of_b;  ///< the same point, up to roundings, where they have one in common
};

/// Of two shapes about their centres, that of `a` in the origin and that of `b` in a point; the points are told from
/// there. Meshes are surfaces, all others solid. Of meshes that bend, where they are at the time t.
///
/// In doubles: off by some roundings of the coordinates. Of hulls that are thinner than a hundred-thousandth of their
/// length it may be off by 1e-9 of that, and points in common farther from each other. Precondition: what place() makes
/// of shapes.
///
/// Cost: of two convex shapes a dozen looks at their corners; of meshes such looks at the boxes of their trees and at
/// triangles, as many as are nearly nearest; of compounds at the boxes around groups of their parts, and at parts that
/// are nearly nearest; of a mesh that bends at each triangle.
ShapeDistance shape_distance(const PlacedShape& a, const PlacedShape& b, const Eigen::Vector3d& centre_of_b,
                             double t = 0);

}  // namespace kds::collision
