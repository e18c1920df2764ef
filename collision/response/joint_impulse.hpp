// Impulses at several places at once, of bodies that may turn.
#pragma once

#include "collision/response/turning_impulse.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <span>

namespace kds::collision {

/// A body that is struck at several places at once.
struct JointBody {
  Mobility mobility;
  RigidVelocity velocity;
  Eigen::Vector3d angular_impulse = Eigen::Vector3d::Zero();  ///< that it has been given
};

/// Where two of them touch. The arms end at one point.
struct JointPlace {
  std::uint32_t a, b;            ///< places among the bodies; not both are fixed
  Eigen::Vector3d normal;        ///< unit, from a to b
  Eigen::Vector3d arm_a, arm_b;  ///< from either's centre of mass
  double least;                  ///< >= 0: they are to part at least this fast
  double push = 0;               ///< the impulse on b along the normal that was found
};

/// Changes the velocities so that at each place the two bodies part at least as fast as they are to: by impulses along
/// the normals that only push, without friction; of these, by those that change the velocities least, measured by
/// masses and moments of inertia. So momenta are kept, and what bodies lose is what they would in an impact without
/// rebound [Moreau88]. Energy grows by no more than it takes to part so fast.
///
/// Projected successive over-relaxation [Cryer71], and where that takes too long, as of a light body under one that is
/// a thousand times as heavy, active sets [Lawson74], for up to 64 places. Returns whether it has found the impulses,
/// each rate of parting up to an eighth of the least one; if not (bodies between two fixed ones that close in, say) no
/// velocity changes.
///
/// Cost: some 50 ns a place and sweep; few sweeps for few places, joint_sweeps at most; then n^4 operations at most.
bool part_jointly(std::span<JointBody> bodies, std::span<JointPlace> places);

inline constexpr int joint_sweeps = 512;

}  // namespace kds::collision
