// The half-space of a body in world orientation.
#pragma once

#include "collision/body_motion.hpp"
#include "collision/motions.hpp"
#include "collision/shapes/half_space.hpp"
#include "collision/shapes/shape.hpp"
#include "collision/vectors.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace kds::collision {

/// The shape in the orientation of its body.
template <class Motion>
PlacedShape placed_plane(const PlacedShape& shape, const Motion& motion) {
  if constexpr (turns<Motion>) {
    const Eigen::Vector4d q = motion.orientation.coeffs() / norm(motion.orientation);
    return place(shape.shape, Eigen::Quaterniond(q));
  } else {
    return shape;
  }
}

/// The half-space in world orientation: a body of a world that turns its bodies has the orientation of its motion, and
/// keeps it (checked_pieces.hpp). Precondition: the shape is one.
template <class Motion>
HalfSpace half_space_of(const PlacedShape& shape, const Motion& motion) {
  return placed_half_space(placed_plane(shape, motion));
}

}  // namespace kds::collision
