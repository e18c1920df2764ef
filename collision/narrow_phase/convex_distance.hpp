// Convex sets with corners, and how far two of them are apart, in doubles.
#pragma once

#include "collision/narrow_phase/hull_distance.hpp"
#include "collision/narrow_phase/shape_distance.hpp"
#include "collision/vectors.hpp"

#include <Eigen/Core>
#include <boost/container/small_vector.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace kds::collision {

/// The convex hull of some points, grown by a radius.
class Convex {
 public:
  using Corners = boost::container::small_vector<Eigen::Vector3d, 8>;

  explicit Convex(Corners corners, double radius = 0) : corners_(std::move(corners)), radius_(radius) {
    for (const Eigen::Vector3d& corner : corners_) middle_ += corner / static_cast<double>(corners_.size());
    for (const Eigen::Vector3d& corner : corners_)
      corner_distance_ = std::max(corner_distance_, norm(corner - middle_));
  }

  double radius() const { return radius_; }
  const Eigen::Vector3d& middle() const { return middle_; }
  /// All of it is within this distance from the middle.
  double bounding_radius() const { return corner_distance_ + radius_; }

  /// Of the corners.
  const Eigen::Vector3d& farthest(const Eigen::Vector3d& along) const {
    const Eigen::Vector3d* best = &corners_[0];
    double most = dot(*best, along);
    for (const Eigen::Vector3d& corner : corners_) {
      if (const double here = dot(corner, along); here > most) most = here, best = &corner;
    }
    return *best;
  }

 private:
  Corners corners_;
  double radius_;
  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();
  double corner_distance_ = 0;
};

/// A point of the difference of two sets.
struct ConvexDifference {
  Eigen::Vector3d of_a, of_b, way;
};
inline const Eigen::Vector3d& point_of(const ConvexDifference& difference) { return difference.way; }

inline NearestToOrigin<ConvexDifference> nearest_of_cores(const Convex& a, const Convex& b) {
  constexpr int most_rounds = 200;  // a hull of many corners is as a ball, and takes some dozens
  const auto farthest = [&](const Eigen::Vector3d& along) {
    const Eigen::Vector3d &of_a = a.farthest(Eigen::Vector3d(-along)), &of_b = b.farthest(along);
    return ConvexDifference{of_a, of_b, of_b - of_a};
  };
  return nearest_to_origin(farthest, Eigen::Vector3d(b.middle() - a.middle()), most_rounds);
}

/// How far they are apart, and where.
inline ShapeDistance distance_of(const Convex& a, const Convex& b) {
  const NearestToOrigin<ConvexDifference> nearest = nearest_of_cores(a, b);
  ShapeDistance found{0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  for (std::size_t i = 0; i < nearest.corners.size(); ++i) {
    found.of_a += nearest.weights[i] * nearest.corners[i].of_a;
    found.of_b += nearest.weights[i] * nearest.corners[i].of_b;
  }
  const double of_cores = norm(nearest.point);
  if (of_cores > 0) {
    const Eigen::Vector3d normal = nearest.point / of_cores;
    const double radii = a.radius() + b.radius();
    // Where they overlap, the point that divides the way between the cores as the radii do is in both.
    const double part = of_cores < radii ? of_cores / radii : 1;
    found.of_a += part * a.radius() * normal;
    found.of_b -= part * b.radius() * normal;
    found.distance = std::max(0.0, of_cores - radii);
  }
  return found;
}

}  // namespace kds::collision
