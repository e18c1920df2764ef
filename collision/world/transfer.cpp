// How the bodies of one world become those of others, each for a part of the scene, and those of one again.
#include "collision/motions.hpp"
#include "collision/world/engine.hpp"

#include <span>
#include <vector>

namespace kds::collision {

template <class Motion>
bool Engine<Motion>::is_divisible() const requires(!turns<Motion>) {
  const bool told_of_work = options_.report_pairs || options_.report_pieces;
  if (failure_ || told_of_work || options_.response == Response::callback) return false;
  if (scripts_.next_time() < never || timers_.next_time() < never || self_contacts_.next_time() < never) return false;
  if (volumes_.any_from_callers() || volumes_.end_of_bent() > 0) return false;
  return bodies_.ignored().empty() && bodies_.attachments().empty() && resting_.empty() && reports_.empty();
}

template <class Motion>
std::vector<BodySlot> Engine<Motion>::take_in(const Engine& from,
                                              std::span<const BodySlot> numbers) requires(!turns<Motion>) {
  require_editable("World::take_in");
  count_edit();
  return change_or_fail([&] {
    std::vector<BodySlot> taken, entering;
    taken.reserve(numbers.size()), entering.reserve(numbers.size());
    for (const BodySlot number : numbers) {
      const Body& body = from.bodies_[number];
      if (body.shape && has_mesh(body.shape->shape)) make_room_for_meshes();
      const BodySlot slot = bodies_.take_in(from.bodies_, number);
      volumes_.add(slot, {});
      if constexpr (!turns<Motion>) {
        if (from.resting_.has_met(number)) resting_.note_meeting(slot);
      }
      taken.push_back(slot);
      if (body.entered) {
        entering.push_back(slot);
      } else {
        bodies_.wait(slot);
      }
    }
    enter(entering, Begin::moving);
    return taken;
  });
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
void Engine<Motion>::go_on_from(BodySlot slot, const BodyProgress<Motion>& progress) requires(!turns<Motion>) {
  bodies_.go_on_from(slot, progress);
}

template <class Motion>
void Engine<Motion>::note_meeting(BodySlot slot) requires(!turns<Motion>) {
  if constexpr (!turns<Motion>) resting_.note_meeting(slot);
}

template <class Motion>
bool Engine<Motion>::has_met(BodySlot slot) const requires(!turns<Motion>) {
  if constexpr (turns<Motion>) {
    return false;
  } else {
    return resting_.has_met(slot);
  }
}

template <class Motion>
void Engine<Motion>::note_entered() {
  bodies_.take_waiting(bodies_.waiting().size());
  for (BodySlot slot = 0; slot < bodies_.slots(); ++slot) bodies_[slot].entered = bodies_.alive(slot);
}

template <class Motion>
void Engine<Motion>::set_aside() requires(!turns<Motion>) {
  change_or_fail([&] {
    pairs_.clear();
    walls_.forget_all();
    counters_.broad_phase = counters_.broad_phase + broad_phase_->counters();
    make_broad_phase();
  });
}

template <class Motion>
void Engine<Motion>::go_on(double t, std::span<const Overlap> overlaps) requires(!turns<Motion>) {
  change_or_fail([&] {
    clock_ = {t, t + options_.window};
    callers_now_ = t;
    count_edit();
    bodies_.take_waiting(bodies_.waiting().size());
    for (BodySlot slot = 0; slot < bodies_.slots(); ++slot) {
      if (bodies_.alive(slot) && !bodies_[slot].entered) bodies_.wait(slot);
    }
    walls_.become();
    rebuild_broad_phase();
    go_on_overlapping(overlaps);
  });
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class Engine<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
