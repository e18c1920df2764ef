// The vector arithmetic of the certificates by its short names, and that of quaternions.
#pragma once

#include "certificates/vectors.hpp"

#include <Eigen/Geometry>

#include <cmath>

namespace kds::collision {

using certificates::cross;
using certificates::dot;
using certificates::norm;
using certificates::normalized;
using certificates::squared_norm;

/// In one fixed order, as those.
inline double norm(const Eigen::Quaterniond& q) {
  return std::sqrt((q.x() * q.x() + q.z() * q.z()) + (q.y() * q.y() + q.w() * q.w()));
}

}  // namespace kds::collision
