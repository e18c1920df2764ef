// Boxes grown by a radius.
#pragma once

#include <Eigen/Core>

namespace kds::collision {

/// All that is no farther than `radius` from a box about the centre of its body with edges along the body's axes. A box
/// has no radius; a ball has half extents of 0, and a capsule all but the last, so that the box is a point or a
/// segment. Units of length. Either no half extent is > 0, or the last alone, or all are.
struct RoundedBox {
  Eigen::Vector3d half_extents;
  double radius;

  /// How many of its edges have a length: 0, 1 or 3.
  int dimension() const { return half_extents[0] > 0 ? 3 : half_extents[2] > 0 ? 1 : 0; }
};

}  // namespace kds::collision
