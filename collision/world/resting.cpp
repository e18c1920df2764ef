// What the world does for its resting contacts, and says of them.
#include "collision/world.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace kds::collision {

template <int Degree>
Eigen::Vector3d World<Degree>::free_acceleration(BodyId id) const {
  if constexpr (Degree >= 2) {
    return bodies_[id].force;
  } else {
    return Eigen::Vector3d::Zero();
  }
}

template <int Degree>
void World<Degree>::take_up(BodyId id, const Motion& motion) {
  ++counters_.motion_updates;
  set_motion(id, motion, false);
  reports_.add(Reports::Kind::moved, id, no_body, {.time = now_});
}

template <int Degree>
void World<Degree>::changed(BodyId a, BodyId b) {
  const PairSlot pair = find_pair(a, b);
  if (pair != no_pair) mark_dirty(pair);
}

template <int Degree>
void World<Degree>::tell_held(BodyId a, BodyId b) {
  ++counters_.held;
  reports_.add(Reports::Kind::held, a, b, contact_at(moving(a), moving(b), now_));
}

template <int Degree>
bool World<Degree>::held(BodyId a, BodyId b) const {
  body(a), body(b);
  return resting_.find(std::min(a, b), std::max(a, b)) != Resting::none;
}

template <int Degree>
bool World<Degree>::held_at_wall(BodyId a, int wall) const {
  body(a);
  if (wall < 0 || wall > 5) {
    throw std::out_of_range("World::held_at_wall: there is no wall " + std::to_string(wall) + ", they are 0 to 5");
  }
  return resting_.find(a, no_body, wall) != Resting::none;
}

template <int Degree>
typename World<Degree>::Motion World<Degree>::free_motion(BodyId id) const {
  const Body& b = body(id);
  if (!resting_.rests(id)) return movers_[id].motion;
  Motion motion = movers_[id].motion.restarted(now());
  if constexpr (Degree >= 2) motion.coefficients[2] = b.force;
  return motion;
}

template class World<1>;
template class World<2>;

}  // namespace kds::collision
