// The motion of one body seen from another.
#pragma once

#include "certificates/point_motion.hpp"
#include "collision/vectors.hpp"
#include "kds/arithmetic/ball.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>

namespace kds::collision {

/// Centre of b minus centre of a: coefficients of a polynomial in tau, the time since the epoch of the pair. Bodies do
/// not rotate, so this is all that moves in a pair.
template <int Degree>
struct RelativeMotion {
  std::array<Eigen::Vector3d, std::size_t{Degree} + 1> coefficients;
  std::array<double, std::size_t{Degree} + 1> uncertainty{};  ///< how far each coefficient may be from the true one
  double epoch = 0;                              ///< s; the clock's value at tau = 0

  Eigen::Vector3d position(double tau) const {
    if constexpr (Degree == 1) {
      return coefficients[0] + tau * coefficients[1];
    } else {
      return coefficients[0] + tau * (coefficients[1] + tau * coefficients[2]);
    }
  }
  Eigen::Vector3d velocity(double tau) const {
    if constexpr (Degree == 1) {
      return coefficients[1];
    } else {
      return coefficients[1] + (2 * tau) * coefficients[2];
    }
  }
  Eigen::Vector3d acceleration() const {
    if constexpr (Degree == 1) {
      return Eigen::Vector3d::Zero();
    } else {
      return 2 * coefficients[2];
    }
  }
};

/// The motion of b seen from a. The epoch is the later of the two starts: a function of the motions alone.
template <int Degree>
RelativeMotion<Degree> relative_to(const certificates::PointMotion<Degree>& a,
                                   const certificates::PointMotion<Degree>& b) {
  RelativeMotion<Degree> relative;
  relative.epoch = std::max(a.start, b.start);
  const auto r = certificates::relative_motion<Ball<double>>(a, b, relative.epoch);
  for (std::size_t i = 0; i <= Degree; ++i) {
    for (std::size_t d = 0; d < 3; ++d) {
      relative.coefficients[i][static_cast<Eigen::Index>(d)] = r[d].c[i].middle;
      relative.uncertainty[i] += r[d].c[i].radius;
    }
  }
  return relative;
}

}  // namespace kds::collision
