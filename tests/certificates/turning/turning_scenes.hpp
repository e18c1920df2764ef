// Pairs of bodies that turn, at random and as degenerate as can be.
#pragma once

#include "certificates/turning/rigid_motion.hpp"
#include "tests/support/random_numbers.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <cstddef>

namespace kds::tests {

/// Coarse numbers, whose certificates often touch zero, or numbers with all their bits.
inline Eigen::Vector3d turning_vector(Random& random, bool coarse) {
  Eigen::Vector3d v;
  for (int d = 0; d < 3; ++d) v[d] = coarse ? random.integer(-3, 3) : random.between(-2, 2);
  return v;
}

/// Of small integers, or of any length.
inline Eigen::Quaterniond turning_orientation(Random& random, bool coarse) {
  for (;;) {
    std::array<double, 4> q{};
    const double length = coarse ? 1 : random.scaled(-3, 3);
    for (double& x : q) x = coarse ? random.integer(-1, 1) : length * random.between(-1, 1);
    if (q[0] != 0 || q[1] != 0 || q[2] != 0 || q[3] != 0) return {q[0], q[1], q[2], q[3]};
  }
}

template <int Degree>
struct TurningScene {
  certificates::RigidMotion<Degree> a, b;
  double time = 0;  ///< near which things happen, s
  double span = 1;  ///< in which the bodies move and turn by some units, s
};

template <int Degree>
certificates::RigidMotion<Degree> turning_motion(Random& random, bool coarse, double rate, double start) {
  certificates::RigidMotion<Degree> motion;
  for (auto& c : motion.path.coefficients) c = turning_vector(random, coarse);
  motion.path.start = start;
  motion.orientation = turning_orientation(random, coarse);
  motion.angular_velocity = turning_vector(random, coarse) * rate;
  if (random.one_in(8)) motion.angular_velocity.setZero();
  if (random.one_in(6)) motion.orientation.setIdentity();
  return motion;
}

/// Rates from 1e-9 to 1e4 rad/s, starts now, some time ago or a million seconds ago; in one half of the scenes the
/// spins have something in common.
template <int Degree>
TurningScene<Degree> turning_scene(Random& random, bool coarse) {
  const double rate = coarse ? 1 : (random.one_in(2) ? 1.0 : std::pow(10.0, random.between(-9, 4)));
  const auto start = [&] {
    switch (random.below(4)) {
      case 0:
        return 0.0;
      case 1:
        return coarse ? double(random.integer(-3, 3)) : random.between(-3, 3);
      case 2:
        return coarse ? 0.0 : -1e6 + random.between(-3, 3);
      default:
        return coarse ? 1.0 : random.between(-100, 0);
    }
  };
  TurningScene<Degree> scene;
  scene.a = turning_motion<Degree>(random, coarse, rate, start());
  const double start_b = random.one_in(2) ? scene.a.start() : start();
  scene.b = turning_motion<Degree>(random, coarse, rate, start_b);
  constexpr std::array<double, 6> ratios{1, -1, 2, 0.5, -2, 3};
  if (random.one_in(2)) {  // one axis, rates of a simple ratio
    scene.b.angular_velocity = scene.a.angular_velocity * ratios[random.below(6)];
  }
  if (random.one_in(4)) scene.b.orientation = scene.a.orientation;
  if (random.one_in(4)) {  // one path
    const double own = scene.b.start();
    if (own == scene.a.start()) scene.b.path = scene.a.path;
  }
  scene.time = coarse ? random.integer(-2, 2) : (random.one_in(4) ? scene.a.start() : random.between(-1, 1));
  // Long ago started, origins would be far away: they are where they are now.
  for (auto* motion : {&scene.a, &scene.b}) {
    const double ago = scene.time - motion->start();
    if (std::abs(ago) < 50) continue;
    for (std::size_t i = 1; i <= Degree; ++i) motion->path.coefficients[i] /= std::pow(std::abs(ago), double(i));
  }
  scene.span = rate > 1 ? 1 / rate : 1;
  return scene;
}

}  // namespace kds::tests
