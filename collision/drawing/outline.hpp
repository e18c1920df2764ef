// The lines by which a shape is recognised, for renderers of lines.
#pragma once

#include "collision/shapes/shape.hpp"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace kds::collision {

/// From one point to another, in units of length.
using Segment = std::array<Eigen::Vector3d, 2>;

/// Lines on the surface of a shape, in its own axes about its centre: the edges of boxes and hulls, the edges of the
/// triangles of a mesh, each once; three great circles of a ball; of a capsule the two circles about its axis, four
/// lines along it and four half circles. A mesh that bends is as it is at t (s), others do not depend on it. A circle
/// is drawn as `sides` lines, rounded up to a multiple of four. Corners are exact, points of circles rounded.
///
/// Cost: O(lines); a mesh of n triangles has about 3 n / 2.
std::vector<Segment> outline(const Shape& shape, double t = 0, int sides = 24);

}  // namespace kds::collision
