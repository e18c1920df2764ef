// What follows from contacts: reports, and pairs that are let pass.
#include "collision/motions.hpp"
#include "collision/world/engine.hpp"

#include <algorithm>
#include <optional>
#include <tuple>
#include <utility>

namespace kds::collision {
template <class Motion>
void Engine<Motion>::process_meeting() {
  const auto meeting = pairs_.take_next();
  const BodySlot a = meeting.a;
  const BodySlot b = meeting.b;
  const auto contact = [&] { return pairs_.contact(a, b, clock_.now, meeting.found); };
  if (!meeting.separates) return process_contact(a, b, contact());
  // A pair that was let pass has separated: it may meet again from now on.
  if (pairs_.mode(a, b) == ContactMode::resolved) return;
  ++counters_.separations;
  const PairEvent event = event_of(a, b, contact());
  tell([&](Listener& listener) { listener.separation(world_, event); });
}

template <class Motion>
void Engine<Motion>::process_self_contact() {
  const auto meeting = self_contacts_.take_next();
  const PairEvent event = event_of(meeting.slot, meeting.slot, self_contacts_.contact(meeting.slot));
  ++(meeting.separates ? counters_.separations : counters_.contacts);
  tell([&](Listener& listener) {
    meeting.separates ? listener.separation(world_, event) : listener.contact(world_, event);
  });
}

template <class Motion>
void Engine<Motion>::process_contact(BodySlot a, BodySlot b, const Contact& contact) {
  const PairEvent event = event_of(a, b, contact);
  ++counters_.contacts;
  if (pairs_.mode(a, b) == ContactMode::transparent) {
    return tell([&](Listener& listener) { listener.contact(world_, event); });
  }
  const auto state = [&] {
    return std::tuple(bodies_.motion(a), bodies_.motion(b), bodies_[a].shape, bodies_[b].shape);
  };
  const auto before = bends(a, b) ? std::optional(state()) : std::nullopt;
  const bool elastic = options_.response == Response::elastic;
  bool suppressed = false;
  bool passes = false;
  if (!elastic || bodies_[a].inverse_mass + bodies_[b].inverse_mass > 0) {
    const std::uint64_t burst = count_meeting(a, b);
    suppressed = passes = burst > patience();  // No response helps: between fixed bodies that close in, say.
    counters_.rebounds_suppressed += passes;
    if (elastic && !passes) suppressed = respond(a, b, contact, burst);
  }
  const auto after = [&] {
    if (!bodies_.contains(event.a) || !bodies_.contains(event.b) || resting_.find(a, b) != Resting::none) return;
    if (!bodies_.may_collide(a, b)) return;  // any more
    // A pair that still approaches (two fixed bodies, or a callback that left them so) passes through. So does one with
    // a mesh that bends if nothing has changed: contact is within a tolerance, and would be found again.
    const bool again = before && *before == state();
    // Whether the broad phase still has the pair does not matter: the callback may have parted their boxes by a
    // rounding.
    if (passes || again || parting(a, b, contact) < 0) let_through(a, b, contact);
  };
  try {
    tell([&](Listener& listener) {
      listener.contact(world_, event);
      if (suppressed) listener.rebound_suppressed(world_, event);
    });
  } catch (...) {
    if (!failure_) after();
    throw;
  }
  after();
}

template <class Motion>
void Engine<Motion>::let_through(BodySlot a, BodySlot b, const Contact& contact) {
  pairs_.let_pass(a, b);
  reports_.add(Reports::Kind::passes, bodies_.id_of(a), bodies_.id_of(b), contact);
}

/// How often both have met others within ZenoPolicy::interval; a fixed body's meetings count only with another fixed
/// one.
template <class Motion>
std::uint64_t Engine<Motion>::count_meeting(BodySlot a, BodySlot b) {
  const bool a_fixed = bodies_.fixed(a);
  const bool b_fixed = bodies_.fixed(b);
  if (a_fixed != b_fixed) return count_meeting(a_fixed ? b : a);
  const std::uint64_t of_a = count_meeting(a);
  return std::min(of_a, count_meeting(b));
}

template <class Motion>
std::uint64_t Engine<Motion>::count_meeting(BodySlot id) {
  Body& body = bodies_[id];
  if (clock_.now - body.burst_start > options_.zeno.interval) {
    body.meetings = 0;
    body.burst_start = clock_.now;
  }
  return ++body.meetings;
}

template <class Motion>
void Engine<Motion>::take_up(BodySlot id, const Motion& motion) {
  if constexpr (turns<Motion>) {
    if (tumbling_.is_alone(id)) look_at(id);
  }
  if (!tumbling_.has(id)) return change_motion(id, motion);
  Motion taken_up = tumbling_.take_up(id, motion, clock_.now);
  // What does not turn goes on as given, from its start on: what is carried then keeps its place exactly.
  if constexpr (turns<Motion>) {
    if (taken_up.angular_velocity.isZero(0)) taken_up.path = motion.path;
  }
  change_motion(id, taken_up);
}

template <class Motion>
void Engine<Motion>::change_motion(BodySlot id, const Motion& motion) {
  ++counters_.motion_updates;
  set_motion(id, motion, false);
  reports_.add(Reports::Kind::moved, bodies_.id_of(id), bodies_.id_of(id), {.time = clock_.now});
}

template <class Motion>
void Engine<Motion>::tell_rebound_suppressed(BodySlot a, BodySlot b) {
  ++counters_.rebounds_suppressed;
  const PairEvent event = event_of(a, b, contact_at(bodies_.moving(a), bodies_.moving(b), clock_.now));
  reports_.add(Reports::Kind::rebound_suppressed, event.a, event.b, event.contact);
}

template <class Motion>
void Engine<Motion>::tell_resting(bool begins, const detail::RestingContact& resting) {
  const BodySlot b = resting.b == no_body ? resting.a : resting.b;
  reports_.add_resting(begins, bodies_.id_of(resting.a), bodies_.id_of(b), contact_of(resting), resting.wall);
}

template <class Motion>
void Engine<Motion>::tell_passes(const detail::RestingContact& resting) {
  reports_.add(Reports::Kind::passes, bodies_.id_of(resting.a), bodies_.id_of(resting.b), contact_of(resting));
}

template <class Motion>
Contact Engine<Motion>::contact_of(const detail::RestingContact& resting) const {
  Contact contact{.time = clock_.now, .point = bodies_.path(resting.a).position(clock_.now) + resting.point};
  contact.normal = resting.normal;
  return contact;
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class Engine<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
