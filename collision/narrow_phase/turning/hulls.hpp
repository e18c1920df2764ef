// Triangles and boxes as convex hulls of points, in the coordinates of their bodies.
#pragma once

#include "collision/shapes/feature.hpp"
#include "collision/vectors.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>

namespace kds::collision {

/// A convex hull, with the directions of its faces and edges. Unit vectors are rounded, where not said otherwise.
template <std::size_t Points, std::size_t Normals>
struct Hull {
  static constexpr std::size_t normal_count = Normals;

  std::array<Eigen::Vector3d, Points> points;
  std::array<Eigen::Vector3d, Normals> normals;
  std::array<Eigen::Vector3d, 3> edges;
  double radius;  ///< no point is farther from the origin of the body
  double doubt;   ///< the normals are off by less
};

using TriangleHull = Hull<3, 1>;
using BoxHull = Hull<8, 3>;

namespace detail {
template <std::size_t Points, std::size_t Normals>
void set_radius(Hull<Points, Normals>& hull) {
  hull.radius = 0;
  for (const Eigen::Vector3d& x : hull.points) hull.radius = std::max(hull.radius, norm(x) * (1 + 0x1p-50));
}
}  // namespace detail

/// Edge k runs from corner k to the next. The normal is the product of two unit vectors, each known to 3 u, u = 2^-53,
/// which errs by 9 u, over their sine, whose length adds as much: 2^-48 over the sine is charged.
inline TriangleHull triangle_hull(const std::array<Eigen::Vector3d, 3>& corners) {
  TriangleHull hull;
  hull.points = corners;
  for (std::size_t k = 0; k < 3; ++k) hull.edges[k] = normalized(corners[(k + 1) % 3] - corners[k]);
  const Eigen::Vector3d normal = cross(hull.edges[0], hull.edges[1]);
  const double sine = norm(normal);
  hull.normals[0] = normal / sine;
  hull.doubt = 0x1p-48 / sine;
  detail::set_radius(hull);
  return hull;
}

/// Corner i is on the upper side of axis d where bit d of i is set. Normals and edges are the axes, exactly.
inline BoxHull box_hull(const Eigen::Vector3d& half) {
  BoxHull hull;
  for (std::size_t i = 0; i < 8; ++i) {
    hull.points[i] = {i & 1 ? half[0] : -half[0], i & 2 ? half[1] : -half[1], i & 4 ? half[2] : -half[2]};
  }
  for (int d = 0; d < 3; ++d) hull.normals[static_cast<std::size_t>(d)] = Eigen::Vector3d::Unit(d);
  hull.edges = hull.normals;
  hull.doubt = 0;
  detail::set_radius(hull);
  return hull;
}

}  // namespace kds::collision
