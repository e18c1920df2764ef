// Two boxes that move and turn for a second: what is asked of every method.
#pragma once

#include "certificates/turning/rigid_motion.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace turning {

struct Query {
  Eigen::Vector3d half_a, half_b;
  kds::certificates::RigidMotion<1> a, b;

  /// rad, of the body that turns more.
  double turn() const { return std::max(a.angular_velocity.norm(), b.angular_velocity.norm()); }
};

/// In how many calls methods that take only so much of a turn at a time are asked.
inline int calls(const Query& query, double radians) {
  return std::max(1, static_cast<int>(std::ceil(query.turn() / radians)));
}

/// Where a body is at t: its centre, and its orientation of unit length.
inline Eigen::Isometry3d pose(const kds::certificates::RigidMotion<1>& motion, double t) {
  const auto at = motion.restarted(t);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = at.orientation.normalized().toRotationMatrix();
  pose.translation() = at.path.position(t);
  return pose;
}

/// When the boxes first meet in [0, 1], s; > 1 if the method says that they do not.
/// FCL is asked frame by frame.
double fcl_contact(const Query& query, int frames);
double bullet_contact(const Query& query);

}  // namespace turning
