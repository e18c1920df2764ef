// The part of a shape that is farthest along a direction.
#pragma once

#include "collision/shapes/feature.hpp"
#include "collision/shapes/shape.hpp"

#include <Eigen/Core>

#include <vector>

namespace kds::collision {

/// An edge counts as across a direction when the sine of the angle is below this: a choice between naming, say, an edge
/// and its end point, without effect on times.
inline constexpr double parallel_sine = 0x1p-30;

/// The part of a shape farthest along a direction.
struct SupportingFeature {
  Feature feature;
  std::vector<Eigen::Vector3d> vertices;  ///< relative to the centre; 1, 2, or more in cyclic order
};

/// Precondition: the direction is of unit length, and the shape no mesh, no half-space and no compound.
SupportingFeature supporting_feature(const PlacedShape& shape, const Eigen::Vector3d& direction);

}  // namespace kds::collision
