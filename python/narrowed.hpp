// Motions and bodies from Python as the world of some type of motion takes them.
#pragma once

#include "collision/body_description.hpp"
#include "collision/body_motion.hpp"
#include "collision/motion_range.hpp"
#include "python/rows.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds_python {

/// A motion of type M, named `name` in errors; throws std::invalid_argument where something would be lost.
template <class M>
M narrowed(const Motion& motion, const std::string& name) {
  const auto& c = motion.path.coefficients;
  for (std::size_t k = M::degree + 1; k < c.size(); ++k) {
    if (c[k].isZero(0)) continue;
    const std::string term = k == 2 ? ".acceleration" : ".higher[" + std::to_string(k - 3) + "]";
    throw std::invalid_argument(name + term + ": must be 0 in a world of degree " + std::to_string(M::degree));
  }
  if (!kds::collision::turns<M> && !motion.angular_velocity.isZero(0)) {
    throw std::invalid_argument(name + ".angular_velocity: must be 0 in a world that is not turning");
  }
  return kds::collision::motion_as<M>(motion);
}

/// A motion, and those that add_body() and update_motion() in Python name `then`.
template <class M>
std::vector<M> narrowed_script(const std::vector<Motion>& pieces) {
  std::vector<M> own;
  own.reserve(pieces.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const std::string name = i == 0 ? "motion" : "then[" + std::to_string(i - 1) + "]";
    own.push_back(narrowed<M>(pieces[i], name));
    if (!kds::collision::in_range(own.back())) kds::collision::refuse_motion(own.back(), name);
  }
  return own;
}

/// The same of several bodies, each of which has as many `pieces`, one body after the other.
template <class M>
std::vector<M> narrowed_scripts(const std::vector<kds::collision::BodyId>& ids, const std::vector<Motion>& pieces) {
  const std::size_t each = pieces.size() / std::max<std::size_t>(ids.size(), 1);
  std::vector<M> own;
  own.reserve(pieces.size());
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const std::string body = " of body " + std::to_string(ids[i]);
    for (std::size_t k = 0; k < each; ++k) {
      std::string name = k == 0 ? "motion" : "then[" + std::to_string(k - 1) + "]";
      if (k == 0 || ids.size() > 1) name += body;
      own.push_back(narrowed<M>(pieces[each * i + k], name));
      if (!kds::collision::in_range(own.back())) kds::collision::refuse_motion(own.back(), name);
    }
  }
  return own;
}

template <class M>
kds::collision::BasicBodyDescription<M> narrowed(const kds::collision::BasicBodyDescription<Motion>& body) {
  kds::collision::BasicBodyDescription<M> own;
  own.shape = body.shape;
  own.motion = narrowed_script<M>(body.motion);
  if constexpr (!kds::collision::turns<M>) {
    if (!body.motion.empty()) own.orientation = body.motion.front().orientation;
  }
  own.mass = body.mass;
  own.inertia = body.inertia;
  own.fixed = body.fixed;
  own.restitution = body.restitution;
  own.friction = body.friction;
  own.tangential_restitution = body.tangential_restitution;
  own.rolling_friction = body.rolling_friction;
  own.category = body.category;
  own.collides_with = body.collides_with;
  own.group = body.group;
  own.attached_to = body.attached_to;
  own.sensor = body.sensor;
  own.self_contacts = body.self_contacts;
  own.user_data = body.user_data;
  return own;
}

}  // namespace kds_python
