// The bodies of a scene as a world takes them.
#pragma once

#include "collision/body_description.hpp"
#include "collision/body_motion.hpp"
#include "io/scene.hpp"

#include <algorithm>

namespace kds::io {

/// A piece as a motion of another degree, or of bodies that keep their orientation. Precondition: nothing is lost.
template <class Motion>
Motion to_motion(const MotionPiece& piece) {
  kds::collision::PathOf<Motion> path;
  const auto& given = piece.path.coefficients;
  std::copy_n(given.begin(), std::min(given.size(), path.coefficients.size()), path.coefficients.begin());
  path.start = piece.path.start;
  if constexpr (kds::collision::turns<Motion>) {
    return {path, piece.orientation, piece.angular_velocity};
  } else {
    return path;
  }
}

/// And back.
template <class Motion>
MotionPiece to_piece(const Motion& motion) {
  const auto& path = path_of(motion);
  MotionPiece piece;
  piece.path.coefficients.fill(Eigen::Vector3d::Zero());
  std::copy(path.coefficients.begin(), path.coefficients.end(), piece.path.coefficients.begin());
  piece.path.start = path.start;
  if constexpr (kds::collision::turns<Motion>) {
    piece.orientation = motion.orientation;
    piece.angular_velocity = motion.angular_velocity;
  }
  return piece;
}

/// A body of a scene.
template <class Motion>
kds::collision::BasicBodyDescription<Motion> describe(const SceneBody& body) {
  kds::collision::BasicBodyDescription<Motion> description;
  description.shape = body.shape;
  description.mass = body.mass;
  description.fixed = body.fixed;
  description.sensor = body.sensor;
  description.self_contacts = body.self_contacts;
  description.restitution = body.restitution;
  for (const MotionPiece& piece : body.motion) description.motion.push_back(to_motion<Motion>(piece));
  if constexpr (kds::collision::turns<Motion>) {
    description.inertia = body.inertia_tensor ? kds::collision::Inertia(*body.inertia_tensor) : body.inertia;
    description.friction = body.friction;
    description.tangential_restitution = body.tangential_restitution;
    description.rolling_friction = body.rolling_friction;
  } else {
    description.orientation = body.orientation;
  }
  return description;
}

}  // namespace kds::io
