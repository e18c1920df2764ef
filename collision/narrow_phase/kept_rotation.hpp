// The rotation of a body that keeps its orientation.
#pragma once

#include "collision/body_motion.hpp"
#include "collision/shapes/shape.hpp"

#include <Eigen/Core>

namespace kds::collision {

/// As a matrix, rounded: the rotation of the motion in worlds of bodies that turn, otherwise that of the placed shape.
template <class Motion>
Eigen::Matrix3d kept_rotation(const PlacedShape& shape, const Motion& motion) {
  if constexpr (turns<Motion>) {
    return motion.rotation(path_of(motion).start).matrix();
  } else {
    return shape.rotation;
  }
}

}  // namespace kds::collision
