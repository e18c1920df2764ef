// The point of a convex hull that is nearest to the origin, in doubles.
#pragma once

#include "collision/vectors.hpp"

#include <Eigen/Core>
#include <boost/container/static_vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace kds::collision {

/// Of a convex set what is nearest to the origin.
template <class Support>
struct NearestToOrigin {
  Eigen::Vector3d point;  ///< zero if the origin is inside, up to roundings
  double bound;           ///< all of the set is farther from the origin than this, up to roundings; below 0: not known
  /// The point is the sum of these points of the set, times the weights, which are not negative and have the sum 1.
  boost::container::static_vector<Support, 4> corners;
  std::array<double, 4> weights;
};

namespace detail {

inline const Eigen::Vector3d& point_of(const Eigen::Vector3d& support) { return support; }

/// The weights with which the point nearest to the origin of the line, plane or space that the first `count` of some
/// points span is their sum. False if one is not positive: then that point is not between them.
inline bool nearest_inside(const std::array<Eigen::Vector3d, 4>& p, std::size_t count, std::array<double, 4>& weights) {
  const Eigen::Vector3d u = p[1] - p[0], v = p[2] - p[0], w = p[3] - p[0];
  if (count == 1) {
    weights[0] = 1;
    return true;
  }
  if (count == 2) {
    weights[1] = -dot(p[0], u) / squared_norm(u);
  } else if (count == 3) {
    const Eigen::Vector3d n = cross(u, v);
    const double square = squared_norm(n);
    weights[1] = dot(cross(v, p[0]), n) / square;
    weights[2] = dot(cross(p[0], u), n) / square;
  } else {
    const double volume = dot(cross(u, v), w);
    weights[1] = -dot(cross(v, w), p[0]) / volume;
    weights[2] = -dot(cross(w, u), p[0]) / volume;
    weights[3] = -dot(cross(u, v), p[0]) / volume;
  }
  weights[0] = 1;
  bool between = true;
  for (std::size_t i = 1; i < count; ++i) {
    weights[0] -= weights[i];
    between = between && weights[i] > 0;
  }
  return between && weights[0] > 0;
}

/// Of one to four points keeps those whose hull has the point nearest to the origin. What roundings have made of it is
/// a point of the hull in any case, so that it is never too near.
template <class Support>
void reduce_to_nearest(NearestToOrigin<Support>& of) {
  constexpr double roundings = 0x1p-46;  // within which four points around the origin have it inside, of their size
  double least = std::numeric_limits<double>::infinity();
  unsigned kept = 0;  // a bit for each point
  for (unsigned set = 1; set < 1u << of.corners.size(); ++set) {
    std::array<Eigen::Vector3d, 4> some;
    some.fill(point_of(of.corners[0]));
    std::size_t count = 0;
    for (std::size_t i = 0; i < of.corners.size(); ++i) {
      if (set >> i & 1) some[count++] = point_of(of.corners[i]);
    }
    std::array<double, 4> weights{};
    if (!nearest_inside(some, count, weights)) continue;
    Eigen::Vector3d nearest = Eigen::Vector3d::Zero();
    double size = 0;
    for (std::size_t i = 0; i < count; ++i) {
      nearest += weights[i] * some[i];
      size = std::max(size, some[i].cwiseAbs().maxCoeff());
    }
    if (count == 4 && nearest.cwiseAbs().maxCoeff() <= roundings * size) nearest.setZero();
    if (!(squared_norm(nearest) < least)) continue;
    least = squared_norm(nearest);
    of.point = nearest;
    of.weights = weights;
    kept = set;
  }
  for (std::size_t i = of.corners.size(); i-- > 0;) {
    if (!(kept >> i & 1)) of.corners.erase(of.corners.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

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
    NearestToOrigin<Support> nearer = nearest;
    nearer.corners.push_back(next);
    detail::reduce_to_nearest(nearer);
    if (!(squared_norm(nearer.point) < square)) break;
    nearest = nearer;
  }
  return nearest;
}

}  // namespace kds::collision
