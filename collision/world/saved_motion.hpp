// Which motions and moments of inertia a snapshot may have: those that can come about from what callers may give
// (shape.hpp), with room for rounding. What is computed of others overflows, and may not end.
#pragma once

#include "certificates/point_motion.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace kds::collision::image {

/// Whether contacts can have brought a body to turn so fast, in rad/s: the quotient of a speed and a length in range is
/// at most 2^410.
inline bool can_have_come_about(const Eigen::Vector3d& angular_velocity) {
  constexpr double fastest = 0x1p450;
  return angular_velocity.allFinite() && angular_velocity.cwiseAbs().maxCoeff() <= fastest;
}

/// The same of a path: coefficients in range, of which each has been multiplied by powers of a time in range.
template <int Degree>
bool can_have_come_about(const certificates::PointMotion<Degree>& path) {
  constexpr int range = 205, room = 40, greatest = 1023;  // exponents of 2
  if (!path.finite() || !(path.start >= -std::ldexp(1.0, range))) return false;
  for (int k = 0; k <= Degree; ++k) {
    const double most = std::ldexp(1.0, std::min(range * (Degree + 1 - k) + room, greatest));
    if (!(path.coefficients[static_cast<std::size_t>(k)].cwiseAbs().maxCoeff() <= most)) return false;
  }
  return true;
}

/// Of a moment of inertia, or its inverse: the product of a mass and the square of a length in range is from 2^-615 to
/// 2^615, and the least moment of a body is down to 2^-40 of its greatest.
inline bool is_moment(double moment) {
  constexpr double greatest = 0x1p660, least = 0x1p-660;
  return moment >= least && moment <= greatest;
}

}  // namespace kds::collision::image
