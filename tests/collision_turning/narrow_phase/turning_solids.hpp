// Bodies that turn, with the shape they have before it is placed: for tests of pairs of them.
#pragma once

#include "certificates/turning/rigid_motion.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "tests/support/random_numbers.hpp"
#include "tests/support/random_vectors.hpp"

#include <cmath>
#include <variant>

namespace kds::tests {

template <int Degree>
struct TurningSolid {
  collision::Shape shape;
  certificates::RigidMotion<Degree> motion;
  collision::PlacedShape placed = place(shape, Eigen::Quaterniond::Identity());

  collision::MovingShape<certificates::RigidMotion<Degree>> body() const { return {placed, motion}; }
  const collision::MeshShape& mesh() const { return std::get<collision::MeshShape>(shape); }
};

template <int Degree>
certificates::RigidMotion<Degree> motion_of(const Eigen::Vector3d& position, const Eigen::Vector3d& velocity,
                                            const Eigen::Vector3d& spin, double start = 0) {
  certificates::RigidMotion<Degree> motion{{{position, velocity}, start}};
  motion.angular_velocity = spin;
  return motion;
}

/// Of a body that is at `place` where its motion begins, in the last two seconds before 0, and turns slowly or fast, or
/// not at all. `speed`: bounds each coordinate of its velocity.
inline certificates::RigidMotion<2> random_turning_motion(Random& random, const Eigen::Vector3d& place, double speed) {
  const double rate = std::pow(10.0, random.between(-2, 1.5));
  auto motion = motion_of<2>(place, random_vector(random, speed), random_vector(random, rate), -random.between(0, 2));
  motion.path.coefficients[2] = random_vector(random, 1);
  motion.orientation =
      Eigen::Quaterniond(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
  if (random.one_in(5)) motion.angular_velocity.setZero();
  return motion;
}

}  // namespace kds::tests
