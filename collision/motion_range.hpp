// What the numbers of motions may be.
#pragma once

#include "certificates/point_motion.hpp"
#include "certificates/turning/rigid_motion.hpp"
#include "collision/shapes/shape.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <sstream>
#include <stdexcept>
#include <string>

namespace kds::collision {

/// Greatest magnitude of the components of an angular velocity, rad/s.
inline constexpr double largest_rate = 0x1p200;  ///< 1.6e60
/// What turns more slowly, in rad/s, counts as still where pieces of time and bounds are made: it turns by less than
/// 2^-190 rad in all the time that a clock has.
inline constexpr double slowest_rate = 0x1p-400;  ///< 3.9e-121

/// Whether all numbers of a motion are finite and in range.
template <int Degree>
bool in_range(const certificates::PointMotion<Degree>& motion) {
  bool all = std::abs(motion.start) <= largest_magnitude;
  for (const Eigen::Vector3d& c : motion.coefficients) {
    for (int d = 0; d < 3; ++d) all = all && std::abs(c[d]) <= largest_magnitude;
  }
  return all;
}

template <int Degree>
bool in_range(const certificates::RigidMotion<Degree>& motion) {
  bool all = in_range(motion.path) && motion.finite();
  for (int d = 0; d < 3; ++d) all = all && std::abs(motion.angular_velocity[d]) <= largest_rate;
  const double length = motion.orientation.coeffs().cwiseAbs().maxCoeff();
  return all && length >= smallest_size && length <= largest_magnitude;
}

/// Throws std::invalid_argument, naming the motion by `name` and the member that is wrong. Precondition: !in_range().
template <int Degree>
[[noreturn]] void refuse_motion(const certificates::PointMotion<Degree>& motion, const std::string& name) {
  if (!motion.finite()) throw std::invalid_argument(name + ": must be finite");
  std::string member = "start";
  double value = motion.start;
  for (std::size_t i = 0; i <= Degree; ++i) {
    for (int d = 0; d < 3; ++d) {
      if (!(std::abs(motion.coefficients[i][d]) > largest_magnitude)) continue;
      member = "coefficients[" + std::to_string(i) + "]";
      value = motion.coefficients[i][d];
    }
  }
  std::ostringstream text;
  text << name << "." << member << ": " << value << " is beyond 2^205 (5.1e61) in magnitude";
  throw std::invalid_argument(text.str());
}

template <int Degree>
[[noreturn]] void refuse_motion(const certificates::RigidMotion<Degree>& motion, const std::string& name) {
  if (!in_range(motion.path)) refuse_motion(motion.path, name + ".path");
  const auto& q = motion.orientation.coeffs();
  std::ostringstream text;
  const bool finite = (q - q).sum() == 0;  // max may ignore a NaN, the sum does not
  if (!(finite && q.cwiseAbs().maxCoeff() >= smallest_size && q.cwiseAbs().maxCoeff() <= largest_magnitude)) {
    text << name << ".orientation: must be finite, and its greatest component between 2^-205 and 2^205 in magnitude";
  } else {
    text << name << ".angular_velocity: must be finite, and each component at most 2^200 (1.6e60) rad/s";
  }
  throw std::invalid_argument(text.str());
}

}  // namespace kds::collision
