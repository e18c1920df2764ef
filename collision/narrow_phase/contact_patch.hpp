// Where two touching shapes meet: the middle of what their supporting features share.
#pragma once

#include <Eigen/Core>

#include <span>
#include <vector>

namespace kds::collision {

/// Middle of what two supporting features share, seen along the contact normal. The vertices of `b` are relative to a
/// centre that lies at `offset` from that of `a`; the result is relative to the centre of `a`, halfway between the
/// two features along the normal. One vertex: that vertex; two segments: where they come closest; otherwise the
/// middle of the overlap of the two polygons' projections.
Eigen::Vector3d patch_centre(std::span<const Eigen::Vector3d> a, std::span<const Eigen::Vector3d> b,
                             const Eigen::Vector3d& offset, const Eigen::Vector3d& normal);

/// The corners of what they share: the ends of a stretch, or the vertices of a polygon; one point where they have no
/// more in common. Between these corners all that is affine (how fast points approach) is greatest and least at them.
std::vector<Eigen::Vector3d> patch_corners(std::span<const Eigen::Vector3d> a, std::span<const Eigen::Vector3d> b,
                                           const Eigen::Vector3d& offset, const Eigen::Vector3d& normal);

}  // namespace kds::collision
