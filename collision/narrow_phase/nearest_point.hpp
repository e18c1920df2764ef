// The point of a triangle nearest to another point.
#pragma once

#include "collision/narrow_phase/separating_axes.hpp"
#include "collision/vectors.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>

namespace kds::collision {

/// v over its length, without overflow or underflow. Precondition: not zero.
inline Eigen::Vector3d unit(const Eigen::Vector3d& v) {
  const double largest = v.cwiseAbs().maxCoeff();
  const Eigen::Vector3d scaled = v / largest;
  return scaled / std::sqrt(dot(scaled, scaled));
}

/// The point of a triangle nearest to another point, and the part of the triangle that it lies on.
struct NearestPoint {
  Eigen::Vector3d point;
  int dimension;      ///< 0: a vertex, 1: inside an edge, 2: inside the triangle
  std::size_t index;  ///< of the vertex or edge; edge i leads from vertex i to vertex i + 1 (mod 3)
};
NearestPoint nearest_point(const PlacedTriangle& triangle, const Eigen::Vector3d& to);

}  // namespace kds::collision
