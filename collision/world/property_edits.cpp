// How the properties of bodies are changed, and timers are set.
#include "collision/motions.hpp"
#include "collision/shapes/shape.hpp"
#include "collision/world/engine.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace kds::collision {

/// The bodies that rest on a body, or that it rests on, have to be solved for anew. Its script goes on. Precondition:
/// it has entered, and `motion` is the one that it would have without its contacts.
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

/// Changes with which others a body that has entered may collide. The body leaves the broad phase, which ends all its
/// pairs except those that overlap, and enters it again.
template <class Motion>
template <class Change>
void Engine<Motion>::filter_anew(BodySlot slot, const Change& change) {
  // Events of the broad phase that are due happen before the change.
  while (broad_phase_->advance(clock_.now, pairs_)) {
  }
  const Motion free = free_motion(bodies_.id_of(slot));
  if (bodies_.in_broad_phase(slot)) broad_phase_->remove(slot, clock_.now, pairs_);
  unbounded_.end_pairs(slot);
  change();
  if (bodies_.in_broad_phase(slot)) {
    const KineticBox<Motion::degree> box = volumes_.renew(slot);
    const Entry entry{slot, &box};
    broad_phase_->insert({&entry, 1}, clock_.now, pairs_);
  }
  unbounded_.begin_pairs(slot);
  volumes_.schedule(slot);
  if (resting_.drop_filtered(slot)) move_freely(slot, free);
}

template <class Motion>
void Engine<Motion>::give_filter(BodySlot slot, const CollisionFilter& after) {
  const CollisionFilter before = bodies_.filter(slot);
  if (before == after) return;
  count_edit();
  if (!bodies_[slot].entered) return bodies_.set_filter(slot, after);
  const auto change = [&] {
    bodies_.set_filter(slot, after);
    pairs_.filter_changed(slot, before);
  };
  change_or_fail([&] { filter_anew(slot, change); });
}

template <class Motion>
void Engine<Motion>::set_filter(BodyId id, std::uint32_t category, std::uint32_t collides_with) {
  require_editable("World::set_filter");
  const BodySlot slot = bodies_.slot_of(id);
  give_filter(slot, {category, collides_with, bodies_.filter(slot).group});
}

template <class Motion>
void Engine<Motion>::set_group(BodyId id, std::uint32_t group) {
  require_editable("World::set_group");
  const BodySlot slot = bodies_.slot_of(id);
  CollisionFilter filter = bodies_.filter(slot);
  filter.group = group;
  give_filter(slot, filter);
}

template <class Motion>
void Engine<Motion>::ignore_pair(BodyId a, BodyId b, bool ignored) {
  require_editable("World::ignore_pair");
  const BodySlot of_a = bodies_.slot_of(a);
  const BodySlot of_b = bodies_.slot_of(b);
  if (a == b) throw std::invalid_argument("World::ignore_pair: body " + std::to_string(a) + " and itself are no pair");
  if (bodies_.ignored().contains(of_a, of_b) == ignored) return;
  count_edit();
  if (!bodies_[of_a].entered || !bodies_[of_b].entered) return bodies_.ignore(of_a, of_b, ignored);
  const auto change = [&] {
    bodies_.ignore(of_a, of_b, ignored);
    pairs_.ignoring_changed(of_a, of_b);
  };
  change_or_fail([&] { filter_anew(of_a, change); });
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
  count_edit(false);
  return timers_.set(t);
}

template <class Motion>
bool Engine<Motion>::cancel_timer(TimerId timer) {
  require_editable("World::cancel_timer");
  count_edit(false);
  return timers_.cancel(timer);
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class Engine<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
