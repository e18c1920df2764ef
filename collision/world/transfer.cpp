// How the bodies of one world are divided among several, each for a part of the scene, and come back into one.
#include "collision/motions.hpp"
#include "collision/world/engine.hpp"

#include <algorithm>
#include <span>
#include <vector>

namespace kds::collision {

template <class Motion>
bool Engine<Motion>::is_divisible() const {
  const bool told_of_work = options_.report_pairs || options_.report_pieces;
  if (failure_ || told_of_work || options_.response == Response::callback) return false;
  if (volumes_.any_from_callers() || volumes_.end_of_bent() > 0 || self_contacts_.next_time() < never) return false;
  return resting_.remembers_nothing() && reports_.empty();
}

template <class Motion>
std::vector<BodySlot> Engine<Motion>::take_in(const Engine& from, std::span<const BodySlot> slots,
                                              std::span<const BodySlot> known, const IgnoredPairs& ignored) {
  require_editable("World::take_in");
  count_edit();
  return change_or_fail([&] {
    std::vector<BodySlot> taken, entering;
    taken.reserve(slots.size()), entering.reserve(slots.size());
    for (const BodySlot there : slots) {
      const Body& body = from.bodies_[there];
      if (body.shape && has_mesh(body.shape->shape)) make_room_for_meshes();
      const BodySlot slot = bodies_.take_in(from.bodies_, there);
      volumes_.add(slot, {});
      scripts_.take_in(slot, from.scripts_, there);
      tumbling_.take_in(slot, from.tumbling_, there);
      if (from.resting_.has_met(there)) resting_.note_meeting(slot);
      taken.push_back(slot);
      if (body.entered) {
        entering.push_back(slot);
      } else if (has_begun(slot)) {
        bodies_.wait(slot);
      }
    }
    relate(from, slots, taken, known, ignored);
    enter(entering, Begin::moving);
    return taken;
  });
}

/// Which of the bodies that are taken in are attached to each other, and which pairs of these, or of one of these and
/// one that was here before, are ignored.
template <class Motion>
void Engine<Motion>::relate(const Engine& from, std::span<const BodySlot> slots, std::span<const BodySlot> taken,
                            std::span<const BodySlot> known, const IgnoredPairs& ignored) {
  const auto& attachments = from.bodies_.attachments();
  if (attachments.empty() && ignored.empty()) return;
  const auto number = [this](BodySlot slot) { return bodies_.number(slot); };
  const auto slot_among = [&](std::span<const BodySlot> here, BodySlot of) {
    const auto found = std::ranges::lower_bound(here, of, {}, number);
    return found != here.end() && number(*found) == of ? *found : no_body;
  };
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const BodySlot owner = attachments.owner(slots[i]);
    if (owner != no_body) bodies_.attach(taken[i], slot_among(taken, from.bodies_.number(owner)));
    ignored.each_partner(number(taken[i]), [&](BodySlot partner) {
      for (const BodySlot other : {slot_among(taken, partner), slot_among(known, partner)}) {
        if (other != no_body) bodies_.ignore(taken[i], other, true);
      }
    });
  }
}

template <class Motion>
void Engine<Motion>::let_go(std::span<const BodySlot> slots) {
  require_editable("World::let_go");
  count_edit();
  change_or_fail([&] {
    for (const BodySlot slot : slots) take_out(slot);
    reports_.become({});
  });
}

template <class Motion>
void Engine<Motion>::go_on_overlapping(std::span<const Overlap> overlaps) {
  for (const Overlap& overlap : overlaps) pairs_.go_on_overlapping(overlap.a, overlap.b, overlap.passes_at);
}

template <class Motion>
std::vector<typename Engine<Motion>::Overlap> Engine<Motion>::overlaps() const {
  std::vector<Overlap> all;
  pairs_.every_overlap([&](BodySlot a, BodySlot b, double passes_at) { all.push_back({a, b, passes_at}); });
  return all;
}

template <class Motion>
void Engine<Motion>::go_on_from(BodySlot slot, const BodyProgress<Motion>& progress) {
  bodies_.move(slot, progress.motion);
  bodies_[slot].meetings = progress.meetings, bodies_[slot].burst_start = progress.burst_start;
  tumbling_.go_on_from(slot, progress.turning);
}

template <class Motion>
std::vector<Timers::Image::One> Engine<Motion>::note_passed(double t) {
  for (const BodySlot slot : bodies_.take_waiting(bodies_.waits())) bodies_[slot].entered = true;
  while (scripts_.next_time() <= t) {
    for (const auto& [slot, motion] : scripts_.take_next()) {
      bodies_.accelerate_freely(slot, motion);
      bodies_[slot].entered = true;
      for (const BodySlot sensor : bodies_.attachments().sensors(slot)) bodies_[sensor].entered = true;
    }
  }
  std::vector<Timers::Image::One> rung;
  while (timers_.next_time() <= t) {
    const double time = timers_.next_time();
    rung.push_back({time, timers_.take_next()});
  }
  return rung;
}

template <class Motion>
void Engine<Motion>::set_aside() {
  change_or_fail([&] {
    pairs_.clear();
    walls_.forget_all();
    counters_.broad_phase = counters_.broad_phase + broad_phase_->counters();
    make_broad_phase();
  });
}

template <class Motion>
void Engine<Motion>::go_on(double t, std::span<const Overlap> overlaps) {
  change_or_fail([&] {
    clock_ = {t, t + options_.window};
    callers_now_ = t;
    count_edit();
    bodies_.take_waiting(bodies_.waits());
    for (BodySlot slot = 0; slot < bodies_.slots(); ++slot) {
      if (bodies_.alive(slot) && !bodies_[slot].entered && has_begun(slot)) bodies_.wait(slot);
    }
    tumbling_.go_on();
    walls_.become();
    rebuild_broad_phase();
    go_on_overlapping(overlaps);
  });
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class Engine<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
