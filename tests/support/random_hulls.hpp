// Convex hulls of random points.
#pragma once

#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/polytope.hpp"
#include "collision/shapes/shape.hpp"

#include <Eigen/Core>

namespace kds::tests {

/// The hull of points(), which are made anew until they have one with a volume.
template <class Points>
collision::Shape hull_of_random(const Points& points) {
  for (;;) {
    try {
      return collision::convex_hull(points());
    } catch (const collision::InvalidHull&) {
    }
  }
}

/// On a lattice of halves, so that edges and faces of hulls are often parallel.
inline Eigen::Vector3d on_lattice(const Eigen::Vector3d& p) { return Eigen::Vector3d((2 * p).array().round() / 2); }

}  // namespace kds::tests
