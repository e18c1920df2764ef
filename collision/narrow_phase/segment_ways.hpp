// Shortest connections from a triangle to a segment.
#pragma once

#include "collision/narrow_phase/separating_axes.hpp"

#include <Eigen/Core>

namespace kds::collision {

/// A connection from a triangle to a segment. It is perpendicular to nothing (from corner to end), to a line, or to a
/// plane: as that from their sum, a prism, to the centre of the segment.
struct SegmentWay {
  Eigen::Vector3d apart = Eigen::Vector3d::Zero();
  int dimension = 0;
  Eigen::Vector3d along = Eigen::Vector3d::Zero();  ///< of a line, or across a plane; not unit
  Eigen::Vector3d at = Eigen::Vector3d::Zero();     ///< where the centre would be, anywhere on the line or plane
  double part = 0;                                  ///< where on the segment it ends: from -1 to 1
};

/// The shortest one from a triangle to the segment centre +- half, unless that goes through it.
SegmentWay shortest_way(const PlacedTriangle& triangle, const Eigen::Vector3d& centre, const Eigen::Vector3d& half);

/// Where a segment about `centre` is nearest to a triangle.
struct NearestStretch {
  Eigen::Vector3d core;   ///< on the segment: the middle of its nearest points, up to the tolerance
  Eigen::Vector3d point;  ///< on the triangle
  double low, high;       ///< the interval of nearest points; -1 and 1 are the ends of the segment
};
NearestStretch nearest_stretch(const PlacedTriangle& triangle, const Eigen::Vector3d& centre,
                               const Eigen::Vector3d& half, double tolerance);

}  // namespace kds::collision
