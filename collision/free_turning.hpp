// What a world tells of a body that turns freely.
#pragma once

#include "collision/quaternion.hpp"

#include <Eigen/Core>

namespace kds::collision {

/// How a body that turns freely is turned at a time, and turns then.
struct FreeTurning {
  Eigen::Quaterniond orientation;    ///< of the body, of length 1 but for roundings
  Eigen::Vector3d angular_velocity;  ///< rad/s, here and below in the axes of the world
  Eigen::Vector3d angular_momentum;  ///< about the centre of mass; mass * length^2 / s
};

}  // namespace kds::collision
