// What follows from a contact of bodies that turn.
#pragma once

#include <Eigen/Core>

namespace kds::collision {

/// Two bodies that turn at a contact: how they move after it, the impulse on b, and the angular impulses on both.
template <class Motion>
struct TurningImpact {
  Motion a, b;
  Eigen::Vector3d impulse = Eigen::Vector3d::Zero();
  Eigen::Vector3d turn_a = Eigen::Vector3d::Zero();
  Eigen::Vector3d turn_b = Eigen::Vector3d::Zero();
  double speed = 0;       ///< with which they approach
  double least = 0;       ///< with which they part for a shortest flight
  bool approach = false;  ///< at the contact; if not they move as before
};

/// Whether a contact is one of a collapse (turning/collapse.hpp), and what has become of that.
enum class Collapse {
  none,
  parted,  ///< all of its bodies part
  stuck    ///< nothing parts them: they are between bodies that close in
};

}  // namespace kds::collision
