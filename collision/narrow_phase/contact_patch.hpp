// Where two touching shapes meet: the middle of the overlap of their supporting features.
#pragma once

#include <Eigen/Core>

#include <span>
#include <vector>

namespace kds::collision {

/// Middle of the overlap of two supporting features, seen along the contact normal. The vertices of `b` are relative to
/// a centre that lies at `offset` from that of `a`; the result is relative to the centre of `a`, halfway between the
/// two features along the normal. One vertex: that vertex; two segments: where they come closest; otherwise the middle
/// of the overlap of the two polygons' projections.
Eigen::Vector3d patch_centre(std::span<const Eigen::Vector3d> a, std::span<const Eigen::Vector3d> b,
                             const Eigen::Vector3d& offset, const Eigen::Vector3d& normal);

/// The corners of the overlap: the ends of a segment, or the vertices of a polygon; one point if the overlap is a
/// point. Affine functions on the overlap (the speed of approach of its points) are greatest and least at these
/// corners.
std::vector<Eigen::Vector3d> patch_corners(std::span<const Eigen::Vector3d> a, std::span<const Eigen::Vector3d> b,
                                           const Eigen::Vector3d& offset, const Eigen::Vector3d& normal);

}  // namespace kds::collision
