// How fast two bodies that turn approach at a point.
#pragma once

#include "certificates/turning/rigid_motion.hpp"
#include "collision/vectors.hpp"

#include <Eigen/Core>

#include <cmath>

namespace kds::collision {

/// The velocities of two bodies at one time, and how their points move from one to the other.
template <int Degree>
class PointRates {
 public:
  using RigidMotion = certificates::RigidMotion<Degree>;

  PointRates(const RigidMotion& a, const RigidMotion& b, double t)
      : a_(a.path.position(t)),
        b_(b.path.position(t)),
        velocity_a_(a.path.velocity(t)),
        velocity_b_(b.path.velocity(t)),
        spin_a_(a.angular_velocity),
        spin_b_(b.angular_velocity),
        acceleration_(b.path.acceleration(t) - a.path.acceleration(t)) {}

  /// Velocity of the point of b that is at x, less that of the point of a.
  Eigen::Vector3d velocity(const Eigen::Vector3d& x) const {
    const Eigen::Vector3d of_a = velocity_a_ + cross(spin_a_, x - a_);
    const Eigen::Vector3d of_b = velocity_b_ + cross(spin_b_, x - b_);
    return of_b - of_a;
  }
  /// The same of their accelerations.
  Eigen::Vector3d acceleration(const Eigen::Vector3d& x) const {
    return acceleration_ + cross(spin_b_, cross(spin_b_, x - b_)) - cross(spin_a_, cross(spin_a_, x - a_));
  }
  /// What roundings can make of a velocity at x: motions that begin after an impulse err by as much.
  double noise(const Eigen::Vector3d& x) const {
    return 0x1p-46 *
           (norm(velocity_a_) + norm(velocity_b_) + norm(spin_a_) * norm(x - a_) + norm(spin_b_) * norm(x - b_));
  }

 private:
  Eigen::Vector3d a_, b_, velocity_a_, velocity_b_, spin_a_, spin_b_, acceleration_;
};

}  // namespace kds::collision
