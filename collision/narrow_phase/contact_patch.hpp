// Where two touching polyhedra meet: supporting features and the middle of what they share.
#pragma once

#include "collision/narrow_phase/feature.hpp"
#include "collision/shapes/shape.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace kds::collision {

/// A vertex, edge or face of a box: per axis +1 or -1 for a side, 0 for "anywhere along it".
using BoxSide = Eigen::Matrix<int, 3, 1>;

/// Numbered as Feature says.
Feature box_feature(const BoxSide& side);

/// The part of a box farthest along a direction.
struct BoxSupport {
  Feature feature;
  std::vector<Eigen::Vector3d> vertices;  ///< relative to the centre; 1, 2, or 4 in cyclic order
};
BoxSupport box_support(const PlacedShape& box, const Eigen::Vector3d& direction);

/// Middle of what two supporting features share, seen along the contact normal. The vertices of `b` are relative to a
/// centre that lies at `offset` from that of `a`; the result is relative to the centre of `a`, halfway between the
/// two features along the normal. One vertex: that vertex; two segments: where they come closest; otherwise the
/// middle of the overlap of the two polygons' projections.
Eigen::Vector3d patch_centre(std::span<const Eigen::Vector3d> a, std::span<const Eigen::Vector3d> b,
                             const Eigen::Vector3d& offset, const Eigen::Vector3d& normal);

}  // namespace kds::collision
