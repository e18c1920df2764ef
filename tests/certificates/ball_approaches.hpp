// Pairs of balls on paths of all kinds, for tests of what is quick about them.
#pragma once

#include "certificates/ball_separation.hpp"
#include "certificates/conjunction.hpp"
#include "tests/support/random_numbers.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace kds::tests {

/// The certificate without its quick answers.
template <int PathDegree>
struct PlainBalls {
  static constexpr int degree = certificates::BallSeparation<PathDegree>::degree;
  const certificates::BallSeparation<PathDegree>& balls;

  template <class Number>
  Polynomial<degree, Number> polynomial(double epoch) const {
    return balls.template polynomial<Number>(epoch);
  }
};

/// Balls that may meet, graze, part, move together or touch already, at sizes, distances and clocks of all magnitudes,
/// one of them seen to move along a line.
template <int PathDegree>
struct BallApproach {
  BallApproach(Random& random, int scale) {
    const double size = std::ldexp(1.0, scale);
    const bool coarse = random.one_in(3);
    const double start = random.one_in(2) ? 0 : std::ldexp(random.between(-1, 1), random.integer(0, 40));
    const double far = random.one_in(3) ? std::ldexp(size, random.integer(0, 30)) : 0;
    const auto vector = [&](double length) -> Eigen::Vector3d {
      if (!coarse) return length * Eigen::Vector3d(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
      return length / 4 * Eigen::Vector3d(random.integer(-4, 4), random.integer(-4, 4), random.integer(-4, 4));
    };
    for (auto* path : {&a, &b}) {
      path->start = start + (random.one_in(2) ? 0 : random.between(-2, 2));
      path->coefficients[0] = Eigen::Vector3d::Constant(far) + vector(3 * size);
      path->coefficients[1] = random.one_in(6) ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : vector(4 * size);
    }
    if (random.one_in(8)) b.coefficients[1] = a.coefficients[1];
    if constexpr (PathDegree == 2) b.coefficients[2] = a.coefficients[2] = vector(size);
    radius_a = coarse ? size / 4 * random.integer(1, 4) : size * random.between(0.01, 1);
    radius_b = coarse ? size / 4 * random.integer(1, 4) : size * random.between(0.01, 1);
    now = std::max(a.start, b.start) + (coarse ? random.integer(0, 4) / 4.0 : random.between(0, 1));
    if (random.one_in(2)) {  // aimed at the other, more or less
      const Eigen::Vector3d there = a.position(now) - b.position(now);
      b.coefficients[1] += (a.velocity(now) - b.velocity(now)) + there * random.between(0.1, 2) + vector(size / 4);
      for (auto* path : {&a, &b}) path->coefficients[0] = 3 * path->coefficients[0];
    }
    // Just in touch, as after a bounce.
    if (random.one_in(4)) {
      const Eigen::Vector3d apart = b.position(now) - a.position(now);
      if (apart.norm() > radius_b) radius_a = apart.norm() - radius_b;
    }
  }
  certificates::PointMotion<PathDegree> a, b;
  double radius_a, radius_b, now;
};

/// BallSeparation::first_approach() by exact signs alone.
template <int PathDegree>
double plain_first_approach(const certificates::BallSeparation<PathDegree>& balls, double now, double horizon) {
  const PlainBalls<PathDegree> plain{balls};
  const DerivativeCertificate<PlainBalls<PathDegree>> parting{plain};
  return certificates::first_all_broken<PlainBalls<PathDegree>, DerivativeCertificate<PlainBalls<PathDegree>>>(
      now, horizon, {&plain, 1}, {&parting, 1});
}

}  // namespace kds::tests
