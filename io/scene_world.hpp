// The bodies of a scene as a world takes them.
#pragma once

#include "collision/body_description.hpp"
#include "collision/body_motion.hpp"
#include "io/scene.hpp"

namespace kds::io {

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
  for (const MotionPiece& piece : body.motion) description.motion.push_back(kds::collision::motion_as<Motion>(piece));
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
