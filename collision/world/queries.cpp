// What can be asked of a world.
#include "collision/degrees.hpp"
#include "collision/world.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace kds::collision {

template <int Degree>
bool World<Degree>::touching(BodySlot a, BodySlot b) const {
  bodies_.at(a), bodies_.at(b);
  return pairs_.mode(a, b) == ContactMode::transparent && pairs_.overlapping(a, b);
}

template <int Degree>
bool World<Degree>::held(BodySlot a, BodySlot b) const {
  bodies_.at(a), bodies_.at(b);
  return resting_.find(std::min(a, b), std::max(a, b)) != Resting::none;
}

template <int Degree>
bool World<Degree>::held_at_wall(BodySlot a, int wall) const {
  bodies_.at(a);
  if (wall < 0 || wall > 5) {
    throw std::out_of_range("World::held_at_wall: there is no wall " + std::to_string(wall) + ", they are 0 to 5");
  }
  return resting_.find(a, no_body, wall) != Resting::none;
}

template <int Degree>
typename World<Degree>::Motion World<Degree>::free_motion(BodySlot id) const {
  bodies_.at(id);
  if (!resting_.rests(id)) return bodies_.motion(id);
  Motion motion = bodies_.motion(id).restarted(now());
  for (std::size_t i = 2; i <= Degree; ++i) motion.coefficients[i] = bodies_.free_term(id, i, now());
  return motion;
}

template <int Degree>
WorldCounters World<Degree>::counters() const {
  WorldCounters counters = counters_;
  counters.broad_phase = counters_.broad_phase + broad_phase_->counters();  // and those of before it was loaded
  return counters;
}

#define KDS_INSTANTIATE(degree) template class World<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
