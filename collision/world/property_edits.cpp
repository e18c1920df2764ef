// How the properties of bodies are changed, and timers are set.
#include "collision/motions.hpp"
#include "collision/shapes/shape.hpp"
#include "collision/world/engine.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace kds::collision {

/// What rests on a body, or below it, is to be balanced anew. Its script goes on. Precondition: it has entered, and
/// `motion` is the one that it would have without its contacts.
template <class Motion>
void Engine<Motion>::move_freely(BodySlot slot, const Motion& motion) {
  resting_.leave(slot);
  set_motion(slot, tumbling_.has(slot) ? tumbling_.take_up(slot, motion, clock_.now) : motion, false);
  resting_.disturb(slot);
}

template <class Motion>
void Engine<Motion>::set_mass(BodyId id, double mass) {
  require_editable("World::set_mass");
  const BodySlot slot = bodies_.slot_of(id);
  require_size(mass, "World::set_mass: mass");
  if (bodies_.fixed(slot)) {
    throw std::invalid_argument("World::set_mass: body " + std::to_string(id) + " is fixed, and has none");
  }
  count_edit();
  change_or_fail([&] {
    const double factor = mass / bodies_[slot].mass;
    bodies_.set_mass(slot, mass);
    if constexpr (turns<Motion>) {
      if (tumbling_.has(slot)) tumbling_.scale(slot, factor);
    }
    if (resting_.carries(slot)) move_freely(slot, free_motion(id));
  });
}

template <class Motion>
void Engine<Motion>::set_restitution(BodyId id, double restitution) {
  require_editable("World::set_restitution");
  const BodySlot slot = bodies_.slot_of(id);
  if (!(restitution >= 0 && restitution <= 1)) {
    throw std::invalid_argument("World::set_restitution: restitution: must be in [0, 1]");
  }
  count_edit();
  bodies_[slot].restitution = restitution;
}

/// The body leaves the broad phase and comes back with the new filter. In between its pairs have ended, except for
/// those that overlap.
template <class Motion>
void Engine<Motion>::set_filter(BodyId id, std::uint32_t category, std::uint32_t collides_with) {
  require_editable("World::set_filter");
  const BodySlot slot = bodies_.slot_of(id);
  const CollisionFilter before = bodies_.filter(slot);
  const CollisionFilter after(category, collides_with);
  if (before.number() == after.number()) return;
  count_edit();
  if (!bodies_[slot].entered) return bodies_.set_filter(slot, after);
  change_or_fail([&] {
    // What is due by now belongs to the filter before.
    while (broad_phase_->advance(clock_.now, pairs_)) {
    }
    const Motion free = free_motion(id);
    if (bodies_.collides(slot)) broad_phase_->remove(slot, clock_.now, pairs_);
    bodies_.set_filter(slot, after);
    pairs_.filter_changed(slot, before);
    if (bodies_.collides(slot)) {
      const KineticBox<Motion::degree> box = volumes_.renew(slot);
      const Entry entry{slot, &box};
      broad_phase_->insert({&entry, 1}, clock_.now, pairs_);
    }
    volumes_.schedule(slot);
    if (resting_.drop_filtered(slot)) move_freely(slot, free);
  });
}

template <class Motion>
void Engine<Motion>::set_user_data(BodyId id, std::uint64_t user_data) {
  bodies_[bodies_.slot_of(id)].user_data = user_data;
}

template <class Motion>
TimerId Engine<Motion>::set_timer(double t) {
  require_editable("World::set_timer");
  if (!(t >= clock_.now && t < never)) {
    throw std::invalid_argument("World::set_timer: " + std::to_string(t) + " is not a finite time from now on (" +
                                std::to_string(clock_.now) + ")");
  }
  count_edit();
  return timers_.set(t);
}

template <class Motion>
bool Engine<Motion>::cancel_timer(TimerId timer) {
  require_editable("World::cancel_timer");
  count_edit();
  return timers_.cancel(timer);
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class Engine<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
