#include "collision/world/transfer/transfer.hpp"

#include "collision/motions.hpp"

#include <algorithm>
#include <span>
#include <vector>

namespace kds::collision {

template <class Motion>
bool Transfer<Motion>::is_divisible() const {
  const bool told_of_work = parts_.options.report_pairs || parts_.options.report_pieces;
  if (!guard_.whole() || told_of_work) return false;
  if (parts_.volumes.any_from_callers()) return false;
  return parts_.resting.divisible() && parts_.reports.empty();
}

template <class Motion>
std::vector<BodySlot> Transfer<Motion>::take_in(const Transfer& from, std::span<const BodySlot> slots,
                                                std::span<const BodySlot> known, const IgnoredPairs& ignored) {
  edits_.begin("World::take_in");
  edits_.count();
  return guard_.change([&] {
    std::vector<BodySlot> taken, entering;
    taken.reserve(slots.size()), entering.reserve(slots.size());
    for (const BodySlot there : slots) {
      const auto& body = from.parts_.bodies[there];
      if (body.shape && has_mesh(body.shape->shape)) membership_.make_room_for_meshes();
      const BodySlot slot = parts_.bodies.take_in(from.parts_.bodies, there);
      parts_.volumes.add(slot, {});
      parts_.scripts.take_in(slot, from.parts_.scripts, there);
      parts_.tumbling.take_in(slot, from.parts_.tumbling, there);
      taken.push_back(slot);
      if (body.entered) {
        entering.push_back(slot);
      } else if (has_begun(slot)) {
        parts_.bodies.wait(slot);
      }
    }
    relate(from.parts_.bodies, slots, taken, known, ignored);
    const auto slot_of = [&](BodySlot number) {
      const BodySlot slot = slot_among(taken, number);
      return slot != no_body ? slot : slot_among(known, number);
    };
    for (std::size_t i = 0; i < slots.size(); ++i) {
      parts_.resting.go_on_from(taken[i], from.parts_.resting.kept()[slots[i]], slot_of);
    }
    parts_.resting.require_listed();
    membership_.enter(entering, Pairs<Motion>::Begin::moving);
    return taken;
  });
}

/// Which of the bodies that are taken in are attached to each other, and which pairs of these, or of one of these and
/// one that was here before, are ignored.
template <class Motion>
void Transfer<Motion>::relate(const Bodies<Motion>& from, std::span<const BodySlot> slots,
                              std::span<const BodySlot> taken, std::span<const BodySlot> known,
                              const IgnoredPairs& ignored) {
  const auto& attachments = from.attachments();
  if (attachments.empty() && ignored.empty()) return;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const BodySlot owner = attachments.owner(slots[i]);
    if (owner != no_body) parts_.bodies.attach(taken[i], slot_among(taken, from.number(owner)));
    ignored.each_partner(parts_.bodies.number(taken[i]), [&](BodySlot partner) {
      for (const BodySlot other : {slot_among(taken, partner), slot_among(known, partner)}) {
        if (other != no_body) parts_.bodies.ignore(taken[i], other, true);
      }
    });
  }
}

/// Of these slots, which are in the order of numbers, that of a body by its number; `no_body` if it is not among them.
template <class Motion>
BodySlot Transfer<Motion>::slot_among(std::span<const BodySlot> slots, BodySlot of) const {
  const auto number = [this](BodySlot slot) { return parts_.bodies.number(slot); };
  const auto found = std::ranges::lower_bound(slots, of, {}, number);
  return found != slots.end() && number(*found) == of ? *found : no_body;
}

template <class Motion>
void Transfer<Motion>::let_go(std::span<const BodySlot> slots) {
  edits_.begin("World::let_go");
  edits_.count();
  guard_.change([&] {
    for (const BodySlot slot : slots) parts_.resting.let_go(slot), membership_.take_out(slot);
    parts_.reports.become({});
  });
}

template <class Motion>
void Transfer<Motion>::go_on_overlapping(std::span<const Overlap> overlaps) {
  for (const Overlap& overlap : overlaps) parts_.pairs.go_on_overlapping(overlap.a, overlap.b, overlap.passes_at);
}

template <class Motion>
std::vector<typename Transfer<Motion>::Overlap> Transfer<Motion>::overlaps() const {
  std::vector<Overlap> all;
  parts_.pairs.every_overlap([&](BodySlot a, BodySlot b, double passes_at) { all.push_back({a, b, passes_at}); });
  return all;
}

template <class Motion>
BodyProgress<Motion> Transfer<Motion>::progress(BodySlot slot) const {
  const auto& body = parts_.bodies[slot];
  return {parts_.bodies.motion(slot), body.meetings, body.burst_start, parts_.tumbling.progress(slot)};
}

template <class Motion>
void Transfer<Motion>::go_on_from(BodySlot slot, const BodyProgress<Motion>& progress) {
  parts_.bodies.move(slot, progress.motion);
  parts_.bodies[slot].meetings = static_cast<std::uint32_t>(progress.meetings);
  parts_.bodies[slot].burst_start = progress.burst_start;
  parts_.tumbling.go_on_from(slot, progress.turning);
}

template <class Motion>
void Transfer<Motion>::note_passed(double t) {
  for (const BodySlot slot : parts_.bodies.take_waiting(parts_.bodies.waits())) parts_.bodies[slot].entered = true;
  while (parts_.scripts.next_time() <= t) {
    for (const auto& [slot, motion] : parts_.scripts.take_next()) {
      parts_.bodies.accelerate_freely(slot, motion);
      parts_.bodies[slot].entered = true;
      for (const BodySlot sensor : parts_.bodies.attachments().sensors(slot)) parts_.bodies[sensor].entered = true;
    }
  }
  while (parts_.timers.next_time() <= t) parts_.timers.take_next();
}

template <class Motion>
void Transfer<Motion>::set_aside() {
  guard_.change([&] {
    parts_.resting.set_aside();
    parts_.pairs.clear();
    parts_.walls.forget_all();
    parts_.counters.broad_phase = parts_.all_counters().broad_phase;
    parts_.make_broad_phase();
  });
}

template <class Motion>
void Transfer<Motion>::go_on(double t, std::span<const Overlap> overlaps) {
  guard_.change([&] {
    parts_.clock = {t, t + parts_.options.window};
    callers_.now = t;
    edits_.count();
    parts_.bodies.take_waiting(parts_.bodies.waits());
    for (BodySlot slot = 0; slot < parts_.bodies.slots(); ++slot) {
      if (parts_.bodies.alive(slot) && !parts_.bodies[slot].entered && has_begun(slot)) parts_.bodies.wait(slot);
    }
    parts_.tumbling.go_on();
    parts_.resting.go_on();
    parts_.walls.become();
    for (BodySlot slot = 0; slot < parts_.bodies.slots(); ++slot) parts_.self_contacts.enter(slot);
    parts_.rebuild_broad_phase();
    go_on_overlapping(overlaps);
  });
}

#define KDS_INSTANTIATE(motion) template class Transfer<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
