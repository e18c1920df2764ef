#include "collision/world/membership.hpp"

#include "collision/in_parts.hpp"
#include "collision/motions.hpp"
#include "collision/profile.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>
#include <span>
#include <vector>

namespace kds::collision {

template <class Motion>
Membership<Motion>::Membership(WorldParts<Motion>& parts, MotionUpdates<Motion>& motions)
    : options_(parts.options),
      clock_(parts.clock),
      profile_(parts.profile()),
      bodies_(parts.bodies),
      volumes_(parts.volumes),
      walls_(parts.walls),
      reports_(parts.reports),
      resting_(parts.resting),
      pairs_(parts.pairs),
      unbounded_(parts.unbounded),
      self_contacts_(parts.self_contacts),
      broad_phase_(parts.broad_phase),
      parts_(parts),
      motions_(motions) {}

template <class Motion>
void Membership<Motion>::make_room_for_meshes() {
  if (!volumes_.make_room_for_meshes()) return;
  for (BodySlot slot = 0; slot < bodies_.slots(); ++slot) {
    if (bodies_[slot].entered) motions_.update_volume(slot, volumes_.box(slot));
  }
}

/// Tells the broad phase of all bodies that are about to enter; if they do so in several parts, before the first.
template <class Motion>
void Membership<Motion>::expect_waiting() {
  constexpr std::size_t sample = 256;
  parts_.expected = bodies_.slots();
  const std::span<const BodySlot> waiting = bodies_.waiting();
  const std::size_t step = std::max<std::size_t>(waiting.size() / sample, 1);
  std::vector<Entry> entries;
  std::vector<KineticBox<Motion::degree>> boxes;
  boxes.reserve(waiting.size() / step + 1);
  for (std::size_t i = 0; i < waiting.size(); i += step) {
    const BodySlot slot = waiting[i];
    if (slot == no_body || !bodies_.in_broad_phase(slot) || volumes_.from_caller(slot)) continue;
    boxes.push_back(volumes_.renew(slot));
    entries.push_back({slot, &boxes.back()});
  }
  broad_phase_->expect(bodies_.waits(), static_cast<BodySlot>(bodies_.slots()), entries, clock_.now);
}

template <class Motion>
void Membership<Motion>::enter_waiting(std::size_t most) {
  if (most < bodies_.waits() && parts_.expected < bodies_.slots()) expect_waiting();
  enter(bodies_.take_waiting(most), Begin::entering);
}

template <class Motion>
void Membership<Motion>::enter(std::span<const BodySlot> entering, Begin begin) {
  // Events of the others that are due now come first, so that they are not attributed to the new bodies.
  while (broad_phase_->advance(clock_.now, pairs_)) {
  }
  std::vector<BodySlot> unbounded;
  std::vector<Entry> entries;
  entries.reserve(entering.size());
  for (const BodySlot slot : entering) {
    auto& body = bodies_[slot];
    if (!body.alive || body.entered) continue;
    body.entered = true;
    if (bodies_.unbounded(slot)) {
      unbounded.push_back(slot);
      continue;
    }
    entries.push_back({slot, nullptr});
  }
  const auto boxes = std::make_unique_for_overwrite<KineticBox<Motion::degree>[]>(entries.size());
  // The functions of callers are called by the calling thread, and in order.
  const std::size_t threads = volumes_.any_from_callers() ? 1 : threads_for(entries.size(), options_.threads);
  in_parts(entries.size(), threads, [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      entries[i].box = new (&boxes[i]) KineticBox<Motion::degree>(volumes_.renew(entries[i].slot));  // not copied there
    }
  });
  const std::span<const Entry> all(entries);
  std::size_t colliding = entries.size();
  if (bodies_.filters()) {
    const auto rest = std::stable_partition(entries.begin(), entries.end(),
                                            [&](const Entry& entry) { return bodies_.in_broad_phase(entry.slot); });
    colliding = static_cast<std::size_t>(rest - entries.begin());
  }
  pairs_.set_begin(begin);
  {
    const Stopwatch watch(profile_, Work::update);
    broad_phase_->insert(all.first(colliding), clock_.now, pairs_);
  }
  if (!unbounded_.empty()) {
    for (const Entry& entry : entries) unbounded_.begin_pairs(entry.slot);
  }
  for (const BodySlot slot : unbounded) unbounded_.add(slot, begin);
  pairs_.set_begin(Begin::moving);
  walls_.schedule(entries);
  for (const Entry& entry : entries) {
    if (!self_contacts_.enter(entry.slot) || begin != Begin::entering) continue;
    const BodyId id = bodies_.id_of(entry.slot);
    reports_.add(Reports::Kind::overlap, id, id, self_contacts_.contact(entry.slot));
  }
  if (!volumes_.any_ends()) return;
  for (const Entry& entry : entries) volumes_.schedule(entry.slot);
}

template <class Motion>
void Membership<Motion>::take_out(BodySlot slot) {
  if (motions_.awaiting_report() == slot) motions_.forget_reported();
  resting_.forget(slot);
  if (self_contacts_.touching(slot)) {  // Reports the separation, or nothing if the overlap has not been reported yet.
    const BodyId id = bodies_.id_of(slot);
    if (!reports_.take_back(Reports::Kind::overlap, id, id)) {
      reports_.add(Reports::Kind::separation, id, id, self_contacts_.contact(slot));
    }
  }
  self_contacts_.remove(slot);
  parts_.scripts.clear(slot);
  parts_.tumbling.remove(slot);
  walls_.remove(slot);
  if (bodies_[slot].entered && bodies_.in_broad_phase(slot)) broad_phase_->remove(slot, clock_.now, pairs_);
  unbounded_.remove(slot);
  volumes_.remove(slot);
  pairs_.remove(slot);
  reports_.forget(bodies_.id_of(slot), bodies_[slot].user_data);
  bodies_.remove(slot);
}

/// Room that callers have asked for stays theirs.
template <class Motion>
void Membership<Motion>::fit_to_rest() {
  most_ = bodies_.size();
  if (parts_.reserved > 0) return;
  pairs_.fit();
  walls_.fit();
  broad_phase_->fit();
}

template <class Motion>
void Membership<Motion>::take_out_with_sensors(BodySlot slot) {
  while (!bodies_.attachments().sensors(slot).empty()) take_out(bodies_.attachments().sensors(slot).front());
  take_out(slot);
}

#define KDS_INSTANTIATE(motion) template class Membership<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
