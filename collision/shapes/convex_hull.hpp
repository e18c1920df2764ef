// Convex hulls of points as shapes.
#pragma once

#include "collision/shapes/polytope.hpp"
#include "collision/shapes/shape_kind.hpp"

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace kds::collision {

/// The hull of the points; throws InvalidHull as Polytope does.
inline ConvexHull convex_hull(std::vector<Eigen::Vector3d> points) {
  return {std::make_shared<const Polytope>(std::move(points))};
}

namespace detail {

template <>
struct ShapeKind<ConvexHull> {
  static constexpr const char* name = "hull";
  static constexpr bool has_half_axes = false;

  static void place(const ConvexHull& hull, PlacedShape& placed);
  static std::array<double, 2> extent(const ConvexHull& hull, const PlacedShape& placed,
                                      const Eigen::Vector3d& direction);

  static Eigen::Vector3d measures(const ConvexHull&) { return Eigen::Vector3d::Ones(); }

  /// A face where three corners or more are that far along the direction, up to parallel_sine.
  static SupportingFeature support(const ConvexHull& hull, const PlacedShape& placed, const Eigen::Vector3d& direction);

  /// The points are written: of a hull that several bodies share, by each of them.
  template <class Archive>
  static void archive(Archive& archive, ConvexHull& hull, PlacedShape&, const NumberedMeshes&);
};

template <class Archive>
void ShapeKind<ConvexHull>::archive(Archive& archive, ConvexHull& hull, PlacedShape&, const NumberedMeshes&) {
  std::vector<Eigen::Vector3d> points;
  if constexpr (!Archive::loading) points.assign(hull.polytope->points().begin(), hull.polytope->points().end());
  archive.each(points, [&](Eigen::Vector3d& point) { archive_vector(archive, point); });
  if constexpr (Archive::loading) {
    try {
      hull = convex_hull(std::move(points));
    } catch (const InvalidHull& error) {
      throw std::runtime_error(std::string("snapshot: a hull: ") + error.what());
    }
  }
}

}  // namespace detail

}  // namespace kds::collision
