// The point of a convex hull that is nearest to the origin, in doubles.
#pragma once

#include "collision/vectors.hpp"

#include <Eigen/Core>
#include <boost/container/static_vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace kds::collision {

/// The point of a convex set that is nearest to the origin.
template <class Support>
struct NearestToOrigin {
  Eigen::Vector3d point;  ///< zero if the origin is inside, up to roundings
  double bound;           ///< all of the set is farther from the origin than this, up to roundings; below 0: not known
  /// The point is, up to roundings, the sum of these points of the set times the weights, which are positive and have
  /// the sum 1.
  boost::container::static_vector<Support, 4> corners;
  std::array<double, 4> weights;
};

namespace detail {

inline const Eigen::Vector3d& point_of(const Eigen::Vector3d& support) { return support; }

/// The point nearest to the origin of the hull of one to four points.
struct NearestOfSimplex {
  Eigen::Vector3d point;          ///< zero if the origin is inside, up to roundings
  unsigned kept;                  ///< of which points it is a sum, a bit for each
  std::array<double, 4> weights;  ///< of these, in their order
};
/// The nearest point of all hulls of the last point and any of the points before it. In doubles; for points that are
/// nearly in a plane or on a line the result is only as good as roundings allow.
NearestOfSimplex nearest_with_last(const std::array<Eigen::Vector3d, 4>& points, std::size_t count);

}  // namespace detail

/// The point nearest to the origin of a convex set that is known by its farthest points: `farthest(direction)` returns
/// one, or a type of its own for which point_of() does. Off by some roundings of the coordinates; the bound tells where
/// `most_rounds` were too few. Paper: [Gilbert88].
template <class Farthest>
auto nearest_to_origin(const Farthest& farthest, const Eigen::Vector3d& first_guess, int most_rounds = 40) {
  using detail::point_of;
  using Support = decltype(farthest(first_guess));
  constexpr double enough = 0x1p-50;  // relative to the square of the distance
  const Support first = farthest(Eigen::Vector3d(-first_guess));
  NearestToOrigin<Support> nearest{point_of(first), -1, {first}, {1}};
  for (int round = 0; round < most_rounds; ++round) {
    const double square = squared_norm(nearest.point);
    if (!(square > 0)) break;
    const Support next = farthest(Eigen::Vector3d(-nearest.point));
    const double along = dot(nearest.point, point_of(next));
    nearest.bound = std::max(nearest.bound, along / std::sqrt(square));
    if (!(square - along > enough * square) || nearest.corners.size() == 4) break;
    if (std::any_of(nearest.corners.begin(), nearest.corners.end(),
                    [&](const Support& corner) { return point_of(corner) == point_of(next); })) {
      break;
    }
    nearest.corners.push_back(next);
    std::array<Eigen::Vector3d, 4> points;
    points.fill(point_of(next));
    for (std::size_t i = 0; i < nearest.corners.size(); ++i) points[i] = point_of(nearest.corners[i]);
    // The nearest point of the corners without the new one is known: it is the one so far.
    const detail::NearestOfSimplex nearer = detail::nearest_with_last(points, nearest.corners.size());
    if (!(squared_norm(nearer.point) < square)) {
      nearest.corners.pop_back();
      break;
    }
    nearest.point = nearer.point;
    nearest.weights = nearer.weights;
    for (std::size_t i = nearest.corners.size(); i-- > 0;) {
      if (!(nearer.kept >> i & 1)) nearest.corners.erase(nearest.corners.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
  return nearest;
}

}  // namespace kds::collision
