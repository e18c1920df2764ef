// What callers ask of bodies that turn.
#include "collision/motions.hpp"
#include "collision/vectors.hpp"
#include "collision/world.hpp"
#include "collision/world/engine.hpp"

#include <stdexcept>
#include <string>

namespace kds::collision {

template <class Motion>
FreeTurning Queries<Motion>::free_turning(BodyId id) const requires(turns<Motion>) {
  const BodySlot slot = bodies_.slot_of(id);
  if (parts_.tumbling.has(slot)) return parts_.tumbling.turning(slot, now());
  if (bodies_[slot].inverse_inertia == 0) {
    throw std::invalid_argument("World::free_turning: nothing changes how body " + std::to_string(id) + " turns");
  }
  const Motion motion = bodies_.motion(slot).restarted(now());
  const double length = norm(motion.orientation);
  return {Eigen::Quaterniond(Eigen::Vector4d(motion.orientation.coeffs() / length)), motion.angular_velocity,
          motion.angular_velocity / bodies_[slot].inverse_inertia};
}

/// Here and not in world.cpp, since clang 14 would instantiate it for other motions too.
template <class Motion>
FreeTurning BasicWorld<Motion>::free_turning(BodyId id) const requires(turns<Motion>) {
  return engine_->queries().free_turning(id);
}

#define KDS_INSTANTIATE(motion)            \
  KDS_TEMPLATE_PART class Queries<motion>; \
  template FreeTurning BasicWorld<motion>::free_turning(BodyId) const;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
