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

/// The sum is taken in one fixed order, as in those.
inline double norm(const Eigen::Quaterniond& q) {
  return std::sqrt((q.x() * q.x() + q.z() * q.z()) + (q.y() * q.y() + q.w() * q.w()));
}
inline Eigen::Quaterniond product(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return {(a.w() * b.w() - a.x() * b.x()) - (a.y() * b.y() + a.z() * b.z()),
          (a.w() * b.x() + a.x() * b.w()) + (a.y() * b.z() - a.z() * b.y()),
          (a.w() * b.y() + a.y() * b.w()) + (a.z() * b.x() - a.x() * b.z()),
          (a.w() * b.z() + a.z() * b.w()) + (a.x() * b.y() - a.y() * b.x())};
}

}  // namespace kds::collision
