// Motions of FCL's conservative advancement.
#pragma once

#include "tests/benchmarks/turning/query.hpp"

#include <fcl/math/motion/interp_motion.h>

namespace turning {

/// From one pose to another at a constant rate, about the centre of the body. FCL's overload of `continuousCollide`
/// for two poses makes the same motion, but does not set its reference point, and the constructor from two poses and a
/// reference point sets no velocities: there times depend on what was in memory before.
inline fcl::InterpMotion<double> fcl_motion(const kds::certificates::RigidMotion<1>& motion, double from, double to) {
  const Eigen::Isometry3d first = pose(motion, from), last = pose(motion, to);
  return {first.linear(), first.translation(), last.linear(), last.translation(), Eigen::Vector3d::Zero()};
}

}  // namespace turning
