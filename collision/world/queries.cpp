// The simple queries of a world.
#include "collision/motions.hpp"
#include "collision/world/engine.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::collision {

template <class Motion>
bool Engine<Motion>::touching(BodyId a, BodyId b) const {
  const BodySlot of_a = bodies_.slot_of(a);
  const BodySlot of_b = bodies_.slot_of(b);
  if (a == b) return self_contacts_.touching(of_a);
  return pairs_.mode(of_a, of_b) == ContactMode::transparent && pairs_.overlapping(of_a, of_b);
}

/// All are collected first, since `visit` may change the world.
template <class Motion>
void Engine<Motion>::visit_partners(BodyId id, BodyVisitor visit) const {
  require_whole("World::visit_partners");
  const BodySlot slot = bodies_.slot_of(id);
  std::vector<BodySlot> found = resting_.partners(slot);
  pairs_.visit_overlapped(slot, [&](BodySlot other) { found.push_back(other); });
  std::vector<BodyId> ids;
  for (const BodySlot other : found) ids.push_back(bodies_.id_of(other));
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  for (const BodyId other : ids) visit(other);
}

template <class Motion>
bool Engine<Motion>::resting(BodyId a, BodyId b) const {
  const auto [first, second] = bodies_.in_order(bodies_.slot_of(a), bodies_.slot_of(b));
  return resting_.holds(first, second);
}

template <class Motion>
bool Engine<Motion>::resting_at_wall(BodyId a, int wall) const {
  const BodySlot slot = bodies_.slot_of(a);
  if (wall < 0 || wall > 5) {
    throw std::out_of_range("World::resting_at_wall: there is no wall " + std::to_string(wall) + ", they are 0 to 5");
  }
  return resting_.holds(slot, no_body, wall);
}

template <class Motion>
typename Engine<Motion>::Motion Engine<Motion>::free_motion(BodyId id) const {
  const BodySlot slot = bodies_.slot_of(id);
  if (!resting_.carries(slot)) return bodies_.motion(slot);
  Motion motion = bodies_.motion(slot).restarted(now());
  for (std::size_t i = 2; i <= Motion::degree; ++i) {
    const Eigen::Vector3d term = bodies_.free_term(slot, i, now());
    if constexpr (turns<Motion>) {
      motion.path.coefficients[i] = term;
    } else {
      motion.coefficients[i] = term;
    }
  }
  return motion;
}

template <class Motion>
WorldCounters Engine<Motion>::counters() const {
  WorldCounters counters = counters_;
  counters.broad_phase = counters_.broad_phase + broad_phase_->counters();  // and before it was loaded
  return counters;
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class Engine<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
