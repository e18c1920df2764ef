// Where bodies that may rest on each other are, and whether they move.
#pragma once

#include "certificates/turning/turned_orientation.hpp"
#include "collision/vectors.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace kds::collision::turning_rest {

using Eigen::Quaterniond;
using Eigen::Vector3d;

/// Where a body is at a time.
class BodyFrame {
 public:
  template <class Motion>
  BodyFrame(const Motion& motion, double t)
      : origin_(motion.path.position(t)),
        turn_(certificates::turned_orientation(motion.orientation, motion.spin(), t)),
        length_(dot(turn_.vec(), turn_.vec()) + turn_.w() * turn_.w()) {}

  const Vector3d& origin() const { return origin_; }
  Vector3d out(const Vector3d& x) const { return origin_ + turned(x, turn_.w()); }
  Vector3d back(const Vector3d& x) const { return turned(x - origin_, -turn_.w()); }

 private:
  /// q x q^-1 = x + 2 v x (v x x + w x) / |q|^2, for q = (w, v).
  Vector3d turned(const Vector3d& x, double w) const {
    const Vector3d v = turn_.vec();
    const Vector3d turn = cross(v, x) + w * x;
    return x + (2 / length_) * cross(v, turn);
  }

  Vector3d origin_;
  Quaterniond turn_;
  double length_;
};

/// The greatest speed of a point of a body, seen from what moves with a velocity.
template <class Motion>
double surface_speed(const Motion& motion, const Vector3d& velocity, double radius, double t) {
  return norm(motion.path.velocity(t) - velocity) + norm(motion.angular_velocity) * radius;
}

}  // namespace kds::collision::turning_rest
