// The motion of one body relative to another.
#pragma once

#include "certificates/point_motion.hpp"
#include "collision/vectors.hpp"
#include "kds/arithmetic/ball.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>

namespace kds::collision {

/// Centre of b minus centre of a: coefficients of a polynomial in tau, the time since the epoch of the pair. It is the
/// whole motion of a pair of bodies that keep their orientations. (Those that turn: turning/pair_frame.hpp.) It is the
/// plain form, certificates::relative_motion(), whose bounds meshes need by coefficient; pairs of convex shapes have a
/// quicker one (quick_motion.hpp).
template <int Degree>
struct RelativeMotion {
  std::array<Eigen::Vector3d, std::size_t{Degree} + 1> coefficients;
  std::array<double, std::size_t{Degree} + 1> uncertainty{};  ///< bound on the error of each coefficient
  double epoch = 0;                                           ///< s; the clock's value at tau = 0

  Eigen::Vector3d position(double tau) const {
    if constexpr (Degree == 1) {
      return coefficients[0] + tau * coefficients[1];
    } else if constexpr (Degree == 2) {
      return coefficients[0] + tau * (coefficients[1] + tau * coefficients[2]);
    } else {
      return derivative(0, tau);
    }
  }
  Eigen::Vector3d velocity(double tau) const {
    if constexpr (Degree == 1) {
      return coefficients[1];
    } else if constexpr (Degree == 2) {
      return coefficients[1] + (2 * tau) * coefficients[2];
    } else {
      return derivative(1, tau);
    }
  }
  Eigen::Vector3d acceleration() const requires(Degree <= 2) {
    if constexpr (Degree == 1) {
      return Eigen::Vector3d::Zero();
    } else {
      return 2 * coefficients[2];
    }
  }

  /// Coefficient number `order` about tau.
  Eigen::Vector3d coefficient(int order, double tau) const {
    double factorial = 1;
    for (int k = 2; k <= order; ++k) factorial *= k;
    return derivative(order, tau) / factorial;
  }

  /// Derivative number `order` at tau, by Horner's rule.
  Eigen::Vector3d derivative(int order, double tau) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int i = Degree; i >= order; --i) {
      double factor = 1;
      for (int k = 0; k < order; ++k) factor *= i - k;
      sum = sum * tau + factor * coefficients[static_cast<std::size_t>(i)];
    }
    return sum;
  }
};

/// The motion of b relative to a. The epoch is the later of the two starts: a function of the motions alone.
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
