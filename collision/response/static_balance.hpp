// Whether bodies that touch can stay where they are: static equilibrium with friction, and impacts that it takes.
#pragma once

#include "collision/response/turning_impulse.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <vector>

namespace kds::collision {

/// A body that is to stay where it is.
struct Load {
  double mass = 1;
  double size = 1;               ///< a length: torques are measured by it
  Eigen::Vector3d acceleration;  ///< that it would have if nothing touched it
};

/// A point at which two bodies push each other: b along the normal and sideways, a the opposite way.
struct Foothold {
  static constexpr std::uint32_t fixed = ~std::uint32_t{0};
  std::uint32_t a;  ///< place among the loads, or `fixed`; not both
  std::uint32_t b;
  Eigen::Vector3d arm_a, arm_b;  ///< from the centre of mass to the point; of a fixed body unused
  Eigen::Vector3d normal;        ///< unit, from a to b
  double friction = 0;           ///< the force across the normal over that along it, at most
  /// Unit, across the normal, if the two slide on each other: the way in which a pulls b, with all of the friction.
  /// Zero if they do not.
  Eigen::Vector3d pull = Eigen::Vector3d::Zero();
};

/// Whether there are forces, each within the cone of friction of its foothold, that hold all bodies: that add up to the
/// opposite of their weights, and have no torque. Where two slide on each other the force is in one direction alone.
///
/// Accelerated gradient descent [Nesterov83] on the sum of the squares of what is not balanced: each force takes a step
/// against the acceleration that is left at its point, and is projected on its cone, which is the circular one. What is
/// left in the end is measured from the forces: so `true` is never wrong by more than balance_rounding. `false` is
/// given too where it is not known after some steps, at the limits of friction above all.
///
/// The arithmetic is the same bits everywhere. Cost: 30 ns a foothold and step; 32 steps for a body on four points, 200
/// for a stack of five, 2 048 at most. `left`, unless it is null, gets for each body what is left of its accelerations
/// in the end, as a part of the greatest one.
bool balanced(std::span<const Load> loads, std::span<const Foothold> footholds, std::vector<double>* left = nullptr);

/// What may be left of an acceleration, and of an angular acceleration times the size of its body, relative to the
/// greatest acceleration. A body of which the centre of mass is beyond the edge of its support by less than this part
/// of its size counts as held.
inline constexpr double balance_rounding = 0x1p-16;

/// A body that lies on others, and how an impact would make it move if it were alone.
struct StruckBody {
  Mobility mobility;  ///< not that of a fixed body
  RigidVelocity velocity{};
  double size = 1;         ///< the distance of its farthest point from its centre
  double still_speed = 0;  ///< no faster than this, at no point, it counts as not moved

  bool still() const { return slower_than(still_speed); }
  /// At each of its points.
  bool slower_than(double speed) const;
};

/// Whether bodies that lie on each other take an impact without moving: whether there are impulses, each within the
/// cone of friction of its foothold, with which none of them is faster than its `still_speed`. The velocities become
/// those with the least kinetic energy that is found: what friction and unilateral contacts without rebound make of an
/// impact [Moreau88].
///
/// The same descent as above. Cost: as above, 512 steps at most, and none where nothing is too fast from the start.
bool takes_impact(std::span<StruckBody> bodies, std::span<const Foothold> footholds);

}  // namespace kds::collision
