// A box with edges along the axes of its body.
#pragma once

#include <Eigen/Core>

namespace kds::collision {

/// All points between two corners, coordinate by coordinate; low < high.
struct AlignedBox {
  Eigen::Vector3d low, high;
};

}  // namespace kds::collision
