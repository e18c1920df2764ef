#include "collision/world/motion_updates.hpp"

#include "collision/motions.hpp"
#include "collision/profile.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace kds::collision {

template <class Motion>
MotionUpdates<Motion>::MotionUpdates(WorldParts<Motion>& parts)
    : options_(parts.options),
      clock_(parts.clock),
      counters_(parts.counters),
      profile_(parts.profile()),
      bodies_(parts.bodies),
      scripts_(parts.scripts),
      tumbling_(parts.tumbling),
      volumes_(parts.volumes),
      walls_(parts.walls),
      reports_(parts.reports),
      resting_(parts.resting),
      pairs_(parts.pairs),
      broad_phase_(parts.broad_phase) {
  resting_.set_listener(*this);
}

template <class Motion>
void MotionUpdates<Motion>::set(BodySlot slot, const Motion& motion, bool jumped) {
  using Begin = typename Pairs<Motion>::Begin;
  const Stopwatch watch(profile_, Work::update);
  bodies_.move(slot, motion);
  pairs_.prefetch_pairs(slot);  // in parallel with the work of the broad phase
  if (jumped) pairs_.set_begin(Begin::jumping);
  if (bodies_.in_broad_phase(slot)) broad_phase_->update(slot, volumes_.renew(slot), clock_.now, pairs_);
  pairs_.set_begin(Begin::moving);
  pairs_.motion_changed(slot, jumped);
  walls_.schedule(slot);
  volumes_.schedule(slot);
  if (!bodies_.attachments().empty()) move_attached(slot, jumped);
}

template <class Motion>
void MotionUpdates<Motion>::give(BodySlot slot, const Motion& motion) {
  scripts_.clear(slot);
  ++counters_.motion_updates;
  bodies_.accelerate_freely(slot, motion);
  if (!bodies_[slot].entered) {
    bodies_.move(slot, motion);
    return wait_to_enter(slot);
  }
  const bool jumped = bodies_.is_jump(slot, motion, clock_.now);
  if (jumped) resting_.drop_all(slot);
  resting_.leave(slot);
  set(slot, motion, jumped);
  resting_.disturb(slot);
}

template <class Motion>
void MotionUpdates<Motion>::move_freely(BodySlot slot, const Motion& motion) {
  resting_.leave(slot);
  set(slot, tumbling_.has(slot) ? tumbling_.take_up(slot, motion, clock_.now) : motion, false);
  resting_.disturb(slot);
}

template <class Motion>
void MotionUpdates<Motion>::move_attached(BodySlot slot, bool jumped) {
  const Motion motion = bodies_.motion(slot);
  for (const BodySlot sensor : bodies_.attachments().sensors(slot)) {
    if (bodies_[sensor].entered) {
      set(sensor, motion, jumped);
    } else {
      bodies_.move(sensor, motion);
    }
  }
}

template <class Motion>
void MotionUpdates<Motion>::wait_to_enter(BodySlot slot) {
  if (!bodies_.waits(slot)) bodies_.wait(slot);
  for (const BodySlot sensor : bodies_.attachments().sensors(slot)) {
    bodies_.move(sensor, bodies_.motion(slot));
    if (!bodies_.waits(sensor)) bodies_.wait(sensor);
  }
}

template <class Motion>
void MotionUpdates<Motion>::update_volume(BodySlot slot, const KineticBox<Motion::degree>& box) {
  if (bodies_.in_broad_phase(slot)) broad_phase_->update(slot, box, clock_.now, pairs_);
  pairs_.box_changed(slot);
  volumes_.schedule(slot);
}

template <class Motion>
void MotionUpdates<Motion>::start_pieces(std::size_t most) {
  auto pieces = scripts_.take_next(most, [&](BodySlot slot) { return !bodies_[slot].entered; });
  std::sort(pieces.begin(), pieces.end(),
            [this](const auto& x, const auto& y) { return bodies_.before(x.slot, y.slot); });
  std::vector<char> jumps;
  for (auto& [slot, motion] : pieces) {
    if constexpr (turns<Motion>) {
      if (tumbling_.is_alone(slot)) look_at(slot);
      if (tumbling_.has(slot)) motion = tumbling_.take_up(slot, motion, clock_.now);
    }
    jumps.push_back(bodies_[slot].entered && bodies_.is_jump(slot, motion, clock_.now));
    if (jumps.back()) resting_.drop_all(slot);
    resting_.leave(slot);
    bodies_.move(slot, motion);
    bodies_.accelerate_freely(slot, motion);
    for (const BodySlot sensor : bodies_.attachments().sensors(slot)) bodies_.move(sensor, motion);
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const BodySlot slot = pieces[i].slot;
    if (bodies_[slot].entered) {
      ++counters_.motion_updates;
      set(slot, pieces[i].motion, jumps[i]);
      resting_.disturb(slot);
    } else {
      wait_to_enter(slot);
    }
    if (!options_.report_pieces) continue;
    const BodyId id = bodies_.id_of(slot);
    reports_.add(Reports::Kind::piece, id, id, {.time = clock_.now});
  }
}

template <class Motion>
void MotionUpdates<Motion>::set_after_report(BodySlot slot, const Motion& motion) {
  bodies_.move(slot, motion);
  reported_ = slot;
}

template <class Motion>
void MotionUpdates<Motion>::take_up_reported() {
  if (reported_ == no_body) return;
  const BodySlot slot = std::exchange(reported_, no_body);
  set(slot, Motion(bodies_.motion(slot)), false);
}

template <class Motion>
void MotionUpdates<Motion>::change(BodySlot slot, const Motion& motion) {
  ++counters_.motion_updates;
  set(slot, motion, false);
  reports_.add(Reports::Kind::moved, bodies_.id_of(slot), bodies_.id_of(slot), {.time = clock_.now});
}

template <class Motion>
void MotionUpdates<Motion>::take_up(BodySlot slot, const Motion& motion) {
  if constexpr (turns<Motion>) {
    if (tumbling_.is_alone(slot)) look_at(slot);
  }
  if (!tumbling_.has(slot)) return change(slot, motion);
  Motion taken_up = tumbling_.take_up(slot, motion, clock_.now);
  // What does not turn goes on as given, from its start on: what is carried then keeps its place exactly.
  if constexpr (turns<Motion>) {
    if (taken_up.angular_velocity.isZero(0)) taken_up.path = motion.path;
  }
  change(slot, taken_up);
}

template <class Motion>
void MotionUpdates<Motion>::tell_rebound_suppressed(BodySlot a, BodySlot b) {
  ++counters_.rebounds_suppressed;
  reports_.add(Reports::Kind::rebound_suppressed, bodies_.id_of(a), bodies_.id_of(b),
               contact_at(bodies_.moving(a), bodies_.moving(b), clock_.now));
}

template <class Motion>
void MotionUpdates<Motion>::tell_resting(bool begins, const detail::RestingContact& resting) {
  const BodySlot b = resting.b == no_body ? resting.a : resting.b;
  reports_.add_resting(begins, bodies_.id_of(resting.a), bodies_.id_of(b), contact_of(resting), resting.wall);
}

template <class Motion>
void MotionUpdates<Motion>::tell_passes(const detail::RestingContact& resting) {
  reports_.add(Reports::Kind::passes, bodies_.id_of(resting.a), bodies_.id_of(resting.b), contact_of(resting));
}

template <class Motion>
void MotionUpdates<Motion>::tell_touched(BodySlot slot) {
  reports_.add_once(Reports::Kind::moved, bodies_.id_of(slot), bodies_.id_of(slot), {.time = clock_.now});
}

template <class Motion>
Contact MotionUpdates<Motion>::contact_of(const detail::RestingContact& resting) const {
  Contact contact{.time = clock_.now, .point = bodies_.path(resting.a).position(clock_.now) + resting.point};
  contact.normal = resting.normal;
  return contact;
}

#define KDS_INSTANTIATE(motion) template class MotionUpdates<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
