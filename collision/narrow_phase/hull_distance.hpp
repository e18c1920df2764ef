// The point of a convex hull that is nearest to the origin, in doubles.
#pragma once

#include "collision/vectors.hpp"

#include <Eigen/Core>
#include <boost/container/static_vector.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace kds::collision {

namespace detail {

using SmallSimplex = boost::container::static_vector<Eigen::Vector3d, 4>;

/// The point nearest to the origin of the plane, line or space that some points span, if it is between them: a
/// combination of all of them with positive weights.
inline bool nearest_inside(const SmallSimplex& p, Eigen::Vector3d& nearest) {
  if (p.size() == 1) {
    nearest = p[0];
    return true;
  }
  if (p.size() == 2) {
    const Eigen::Vector3d u = p[1] - p[0];
    const double part = -dot(p[0], u) / squared_norm(u);
    nearest = p[0] + part * u;
    return part > 0 && part < 1;
  }
  const Eigen::Vector3d u = p[1] - p[0], v = p[2] - p[0], n = cross(u, v);
  if (p.size() == 3) {
    const double square = squared_norm(n);
    const double of_v = dot(cross(p[0], u), n) / square;  // the weights of v and u
    const double of_u = dot(cross(v, p[0]), n) / square;
    nearest = n * (dot(n, p[0]) / square);
    return of_u > 0 && of_v > 0 && of_u + of_v < 1;
  }
  const Eigen::Vector3d w = p[3] - p[0];
  const double volume = dot(n, w);
  const double of_w = -dot(n, p[0]) / volume;
  const double of_u = -dot(cross(v, w), p[0]) / volume;
  const double of_v = -dot(cross(w, u), p[0]) / volume;
  nearest = Eigen::Vector3d::Zero();
  return of_u > 0 && of_v > 0 && of_w > 0 && of_u + of_v + of_w < 1;
}

/// Of up to four points keeps those whose hull has the point nearest to the origin, and returns that.
inline Eigen::Vector3d reduce_to_nearest(SmallSimplex& points) {
  double least = std::numeric_limits<double>::infinity();
  Eigen::Vector3d best = points[0];
  SmallSimplex kept;
  for (unsigned set = 1; set < 1u << points.size(); ++set) {
    SmallSimplex some;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (set >> i & 1) some.push_back(points[i]);
    }
    Eigen::Vector3d nearest;
    if (!nearest_inside(some, nearest) || !(squared_norm(nearest) < least)) continue;
    least = squared_norm(nearest);
    best = nearest;
    kept = some;
  }
  points = kept;
  return best;
}

}  // namespace detail

/// The point nearest to the origin of a convex set that is known by its farthest points, `farthest(direction)`; zero if
/// the origin is inside, up to roundings. A choice of direction for others to rely on or not: nothing is said of the
/// error. Paper: [Gilbert88].
template <class Farthest>
Eigen::Vector3d nearest_to_origin(const Farthest& farthest, const Eigen::Vector3d& first_guess) {
  constexpr int most_rounds = 40;
  constexpr double enough = 0x1p-50;  // relative to the square of the distance
  detail::SmallSimplex simplex{farthest(Eigen::Vector3d(-first_guess))};
  Eigen::Vector3d nearest = simplex[0];
  for (int round = 0; round < most_rounds; ++round) {
    const double square = squared_norm(nearest);
    const Eigen::Vector3d next = farthest(Eigen::Vector3d(-nearest));
    if (!(square > 0) || !(square - dot(nearest, next) > enough * square)) break;
    if (simplex.size() == 4 || std::find(simplex.begin(), simplex.end(), next) != simplex.end()) break;
    simplex.push_back(next);
    const Eigen::Vector3d nearer = detail::reduce_to_nearest(simplex);
    if (!(squared_norm(nearer) < square)) break;
    nearest = nearer;
    if (simplex.size() == 4) return Eigen::Vector3d::Zero();
  }
  return nearest;
}

}  // namespace kds::collision
