#include "collision/world/contact_response.hpp"

#include "collision/motion_range.hpp"
#include "collision/motions.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <tuple>

namespace kds::collision {

template <class Motion>
ContactResponse<Motion>::ContactResponse(WorldParts<Motion>& parts, MotionUpdates<Motion>& motions,
                                         ListenerCalls<Motion>& calls, const Guard& guard)
    : options_(parts.options),
      clock_(parts.clock),
      counters_(parts.counters),
      bodies_(parts.bodies),
      reports_(parts.reports),
      resting_(parts.resting),
      pairs_(parts.pairs),
      self_contacts_(parts.self_contacts),
      motions_(motions),
      calls_(calls),
      guard_(guard),
      bending_(parts.bodies, parts.options),
      bounces_(parts, motions, calls, bending_) {}

template <class Motion>
void ContactResponse<Motion>::process_pair() {
  const auto meeting = pairs_.take_next();
  const BodySlot a = meeting.a;
  const BodySlot b = meeting.b;
  const auto contact = [&] { return pairs_.contact(a, b, clock_.now, meeting.found); };
  if (!meeting.separates) return process_contact(a, b, contact());
  // A pair that was let pass has separated: it may meet again from now on.
  if (pairs_.mode(a, b) == ContactMode::resolved) return;
  ++counters_.separations;
  const PairEvent event = calls_.event_of(a, b, contact());
  calls_.tell([&](auto& listener, auto& world) { listener.separation(world, event); });
}

template <class Motion>
void ContactResponse<Motion>::process_self_contact() {
  const auto meeting = self_contacts_.take_next();
  const PairEvent event = calls_.event_of(meeting.slot, meeting.slot, self_contacts_.contact(meeting.slot));
  ++(meeting.separates ? counters_.separations : counters_.contacts);
  calls_.tell([&](auto& listener, auto& world) {
    meeting.separates ? listener.separation(world, event) : listener.contact(world, event);
  });
}

template <class Motion>
void ContactResponse<Motion>::process_contact(BodySlot a, BodySlot b, const Contact& contact) {
  const PairEvent event = calls_.event_of(a, b, contact);
  ++counters_.contacts;
  if (pairs_.mode(a, b) == ContactMode::transparent) {
    return calls_.tell([&](auto& listener, auto& world) { listener.contact(world, event); });
  }
  const auto state = [&] {
    return std::tuple(bodies_.motion(a), bodies_.motion(b), bodies_.kept_shape(a), bodies_.kept_shape(b));
  };
  const auto before = bending_.bend(a, b) ? std::optional(state()) : std::nullopt;
  const bool elastic = options_.response == Response::elastic;
  bool suppressed = false;
  bool passes = false;
  const bool responds = bodies_[a].inverse_mass + bodies_[b].inverse_mass > 0;
  if (responds || !(elastic || options_.law)) {
    const std::uint64_t burst = count_meeting(a, b);
    suppressed = passes = burst > patience();  // No response helps: between fixed bodies that close in, say.
    counters_.rebounds_suppressed += passes;
    if (elastic && !passes) suppressed = bounces_.respond(a, b, contact, burst);
  }
  const auto after = [&] {
    if (!bodies_.contains(event.a) || !bodies_.contains(event.b)) return;
    if (resting_.find(a, b) != RestingPart<Motion>::none) return;
    if (!bodies_.may_collide(a, b)) return;  // any more
    // A pair that still approaches (two fixed bodies, or a callback that left them so) passes through. So does one with
    // a mesh that bends if nothing has changed: contact is within a tolerance, and would be found again.
    const bool again = before && *before == state();
    // Whether the broad phase still has the pair does not matter: the callback may have parted their boxes by a
    // rounding.
    if (passes || again || bounces_.parting(a, b, contact) < 0) let_through(a, b, contact);
  };
  try {
    if (options_.law && responds && !passes) respond_by_law(a, b, contact);
    calls_.tell([&](auto& listener, auto& world) {
      listener.contact(world, event);
      if (suppressed) listener.rebound_suppressed(world, event);
    });
  } catch (...) {
    if (guard_.whole()) after();
    throw;
  }
  after();
}

/// What the law throws is like what a listener throws.
template <class Motion>
void ContactResponse<Motion>::respond_by_law(BodySlot a, BodySlot b, const Contact& contact) {
  const Meeting meeting{contact.time, contact.point, contact.normal, meeting_body(a), meeting_body(b)};
  Velocities after_a = meeting.a.before, after_b = meeting.b.before;
  calls_.tell([&](auto&, auto&) {
    options_.law->respond(meeting, after_a, after_b);
    require_lawful(a, meeting.a.before, after_a);
    require_lawful(b, meeting.b.before, after_b);
  });
  if (after_a != meeting.a.before) change_velocities(a, after_a);
  if (after_b != meeting.b.before) change_velocities(b, after_b);
  resting_.solve();
}

template <class Motion>
MeetingBody ContactResponse<Motion>::meeting_body(BodySlot slot) const {
  const auto& path = bodies_.path(slot);
  const auto& body = bodies_[slot];
  MeetingBody result{
      path.position(clock_.now), {path.velocity(clock_.now)}, body.inverse_mass, body.restitution, body.user_data};
  if constexpr (turns<Motion>) result.before.angular = bodies_.motion(slot).angular_velocity;
  return result;
}

template <class Motion>
void ContactResponse<Motion>::require_lawful(BodySlot slot, const Velocities& before, const Velocities& after) const {
  const auto in_range = [](const Eigen::Vector3d& v, double most) { return v.cwiseAbs().maxCoeff() <= most; };
  if (!in_range(after.linear, largest_magnitude) || !in_range(after.angular, largest_rate)) {
    throw std::invalid_argument("ContactLaw::respond: a velocity is not finite, or too great");
  }
  if (bodies_.fixed(slot) && after != before) {
    throw std::logic_error("ContactLaw::respond: it changes the velocity of a fixed body");
  }
  if (!turns<Motion> && after.angular != before.angular) {
    throw std::logic_error("ContactLaw::respond: it turns a body that keeps its orientation");
  }
}

template <class Motion>
void ContactResponse<Motion>::change_velocities(BodySlot slot, const Velocities& after) {
  Motion motion = bodies_.motion(slot).restarted(clock_.now);
  auto& path = [&]() -> auto& {
    if constexpr (turns<Motion>) {
      motion.angular_velocity = after.angular;
      return motion.path;
    } else {
      // What it leans on may not hold it from now on.
      for (std::size_t i = 2; i <= Motion::degree && resting_.rests(slot); ++i) {
        motion.coefficients[i] = bodies_.free_term(slot, i, clock_.now);
      }
      return motion;
    }
  }
  ();
  path.coefficients[1] = after.linear;
  ++counters_.motion_updates;
  motions_.move_freely(slot, motion);
}

template <class Motion>
void ContactResponse<Motion>::let_through(BodySlot a, BodySlot b, const Contact& contact) {
  pairs_.let_pass(a, b);
  reports_.add(Reports::Kind::passes, bodies_.id_of(a), bodies_.id_of(b), contact);
}

/// How often both have met others within ZenoPolicy::interval; a fixed body's meetings count only with another fixed
/// one.
template <class Motion>
std::uint64_t ContactResponse<Motion>::count_meeting(BodySlot a, BodySlot b) {
  const bool a_fixed = bodies_.fixed(a);
  const bool b_fixed = bodies_.fixed(b);
  const auto count = [this](BodySlot slot) { return bodies_.count_meeting(slot, clock_.now, options_.zeno.interval); };
  if (a_fixed != b_fixed) return count(a_fixed ? b : a);
  const std::uint64_t of_a = count(a);
  return std::min(of_a, count(b));
}

#define KDS_INSTANTIATE(motion) template class ContactResponse<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
