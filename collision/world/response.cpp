// What follows from contacts: what is told, how bodies bounce, and which contacts last.
#include "collision/motions.hpp"
#include "collision/response/impulse.hpp"
#include "collision/vectors.hpp"
#include "collision/world.hpp"

#include <algorithm>
#include <utility>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

/// Rate at which b parts from a along the normal just after the contact; of two that have none, its first derivative
/// that is not zero, up to a factor.
template <int Degree>
double parting(const Contact& contact, const certificates::PointMotion<Degree>& a,
               const certificates::PointMotion<Degree>& b) {
  const double t = contact.time;
  const double rate = dot(contact.normal, b.velocity(t) - a.velocity(t));
  if constexpr (Degree >= 3) {
    if (rate != 0) return rate;
    const auto at_a = a.restarted(t), at_b = b.restarted(t);
    double later = 0;
    for (std::size_t i = 2; i <= Degree && later == 0; ++i) {
      later = dot(contact.normal, at_b.coefficients[i] - at_a.coefficients[i]);
    }
    return later;
  }
  return rate != 0 ? rate : dot(contact.normal, b.acceleration(t) - a.acceleration(t));
}

}  // namespace

template <class Motion>
void BasicWorld<Motion>::process_meeting() {
  const auto meeting = pairs_.take_next();
  const BodySlot a = meeting.a;
  const BodySlot b = meeting.b;
  const auto contact = [&] { return pairs_.contact(a, b, clock_.now, meeting.found); };
  if (!meeting.separates) return process_contact(a, b, contact());
  // What was let pass may meet again from now on.
  if (pairs_.mode(a, b) == ContactMode::resolved) return;
  ++counters_.separations;
  const PairEvent event = event_of(a, b, contact());
  tell([&](Listener& listener) { listener.separation(*this, event); });
}

template <class Motion>
void BasicWorld<Motion>::process_contact(BodySlot a, BodySlot b, const Contact& contact) {
  const PairEvent event = event_of(a, b, contact);
  ++counters_.contacts;
  if (pairs_.mode(a, b) == ContactMode::transparent) {
    return tell([&](Listener& listener) { listener.contact(*this, event); });
  }
  bool held = false;
  bool passes = false;
  if (options_.response == Response::elastic) {
    held = respond(a, b, contact);
  } else {
    held = passes = count_meeting(a, b) > patience();
    counters_.held += held;
  }
  // A pair that is still pressed together (nobody can or will move it) passes through.
  const auto after = [&] {
    if (!contains(event.a) || !contains(event.b) || resting_.find(a, b) != Resting::none) return;
    // Whether the broad phase still has the pair does not matter: the callback may have parted their boxes by a
    // rounding.
    if (!passes && !(parting(contact, bodies_.motion(a), bodies_.motion(b)) < 0)) return;
    pairs_.let_pass(a, b);
    reports_.add(Reports::Kind::passes, event.a, event.b, event.contact);
  };
  try {
    tell([&](Listener& listener) {
      listener.contact(*this, event);
      if (held) listener.held(*this, event);
    });
  } catch (...) {
    if (!failure_) after();
    throw;
  }
  after();
}

template <class Motion>
void BasicWorld<Motion>::process_wall() {
  const BodySlot id = walls_.next_body();
  const Body& body = bodies_[id];
  const int wall = walls_.next_wall();
  const int axis = wall / 2;
  const double out = wall % 2 != 0 ? 1 : -1;
  Motion motion = bodies_.motion(id).restarted(clock_.now);
  const double approach = motion.coefficients[1][axis] * out;
  double pressed = 0;
  if constexpr (Motion::degree >= 2) pressed = 2 * motion.coefficients[2][axis] * out;
  const double rebound = std::min(body.restitution, options_.walls->restitution) * approach;
  WallEvent event{bodies_.id_of(id), wall, {.time = clock_.now}};
  event.contact.normal = Vector3d::Zero();  // not a unit vector times -1, whose zeros would be negative
  event.contact.normal[axis] = out;
  event.contact.point = motion.coefficients[0];
  event.contact.point[axis] = out > 0 ? options_.walls->max[axis] : options_.walls->min[axis];
  const Vector3d point = event.contact.point - motion.coefficients[0];
  ++counters_.wall_contacts;
  const double size = motion.coefficients[0].cwiseAbs().maxCoeff() + body.bounding_radius;
  const bool clustered = resting_.clustered(id) && !bodies_.fixed(id);
  bool held = !clustered && stays(rebound, pressed, size, count_meeting(id));
  if (clustered && endless(count_meeting(id))) {
    resting_.halt(id);
  } else if (clustered) {
    const bool rested = resting_.find(id, no_body, wall) != Resting::none;
    resting_.impact({.a = id, .wall = wall, .normal = event.contact.normal, .point = point},
                    std::min(body.restitution, options_.walls->restitution));
    held = !rested && resting_.find(id, no_body, wall) != Resting::none;
    counters_.held += held;
  } else if (held) {
    ++counters_.held;
    resting_.add({.a = id, .wall = wall, .normal = event.contact.normal, .point = point});
  } else {
    motion.coefficients[1][axis] = -rebound * out;
    ++counters_.motion_updates;
    set_motion(id, motion, false);
  }
  if (!clustered) resting_.disturb(id);
  resting_.solve();
  tell([&](Listener& listener) {
    listener.wall(*this, event);
    if (held) listener.held_at_wall(*this, event);
  });
}

/// Both have met others so often; a fixed body's meetings count only with another fixed one.
template <class Motion>
std::uint64_t BasicWorld<Motion>::count_meeting(BodySlot a, BodySlot b) {
  const bool a_fixed = bodies_.fixed(a);
  const bool b_fixed = bodies_.fixed(b);
  if (a_fixed != b_fixed) return count_meeting(a_fixed ? b : a);
  const std::uint64_t of_a = count_meeting(a);
  return std::min(of_a, count_meeting(b));
}

template <class Motion>
std::uint64_t BasicWorld<Motion>::count_meeting(BodySlot id) {
  Body& body = bodies_[id];
  if (clock_.now - body.burst_start > options_.zeno.interval) {
    body.meetings = 0;
    body.burst_start = clock_.now;
  }
  return ++body.meetings;
}

/// Whether what meets is held: see ZenoPolicy. `pressed`: relative acceleration towards each other; `size`: of the
/// coordinates.
template <class Motion>
bool BasicWorld<Motion>::stays(double rebound, double pressed, double size, std::uint64_t burst) const {
  if (!(rebound > 0) || burst > options_.zeno.contacts) return true;
  if (!(pressed > 0)) return false;
  // Near a large clock doubles are sparse: a flight lasts some of them at least. And it rises by some roundings of the
  // coordinates: bodies with a light one between them bounce for ever where positions cannot come nearer.
  const double spacing = next_up(std::abs(clock_.now)) - std::abs(clock_.now);
  const double shortest = std::max(options_.zeno.interval / std::max(options_.zeno.contacts, 1u), 16 * spacing);
  const double lowest = 0x1p-48 * size;
  return 2 * rebound < shortest * pressed || rebound * rebound < 2 * pressed * lowest;
}

/// Whether so many meetings at nearly one time are a sign that there will be more without end.
template <class Motion>
bool BasicWorld<Motion>::endless(std::uint64_t burst) const {
  const std::uint64_t many = std::max(options_.zeno.contacts, 1u);
  return burst > many && burst % many == 0;
}

template <class Motion>
bool BasicWorld<Motion>::respond(BodySlot a, BodySlot b, const Contact& contact) {
  if (bodies_[a].inverse_mass + bodies_[b].inverse_mass == 0) return false;
  const std::uint64_t burst = count_meeting(a, b);
  if (burst > patience()) {  // Holding does not help: the pair is left as it is, and so passes through.
    ++counters_.held;
    pairs_.let_pass(a, b);
    const PairEvent event = event_of(a, b, contact);
    reports_.add(Reports::Kind::passes, event.a, event.b, event.contact);
    return true;
  }
  const bool often = burst > options_.zeno.contacts;
  const double restitution = often ? 0 : std::min(bodies_[a].restitution, bodies_[b].restitution);
  if (restitution < 1 && !bodies_.fixed(a) && !bodies_.fixed(b)) resting_.note_meeting(a, b);
  const auto approach = [&] { return parting(contact, bodies_.motion(a), bodies_.motion(b)) < 0; };
  const auto rest = [&] { return resting_.find(a, b) != Resting::none; };
  if (resting_.clustered(a) || resting_.clustered(b)) {
    if (endless(burst)) {
      resting_.halt(a), resting_.halt(b);
      if (rest() && !approach()) return false;
    }
    return strike(a, b, contact, restitution);
  }
  if (often && resting_.can_gather(a, b)) {
    resting_.gather(a), resting_.gather(b);
    return strike(a, b, contact, restitution);
  }
  const bool held = bounce_or_hold(a, b, contact, restitution, burst);
  // What neither bounces nor is held by itself is held by what it leans on.
  if (rest() || !approach()) return held;
  if (resting_.can_gather(a, b)) {
    resting_.gather(a), resting_.gather(b);
    return strike(a, b, contact, restitution) || held;
  }
  hold(a, b, contact);
  return true;
}

/// A contact in a cluster. Whether the two are held from now on.
template <class Motion>
bool BasicWorld<Motion>::strike(BodySlot a, BodySlot b, const Contact& contact, double restitution) {
  const bool rested = resting_.find(a, b) != Resting::none;
  const Vector3d point = contact.point - bodies_.path(a).position(contact.time);
  resting_.impact({.a = a, .b = b, .normal = contact.normal, .point = point}, restitution);
  resting_.solve();
  // What the others that lean on the two have turned back towards each other stays together.
  if (resting_.find(a, b) == Resting::none && parting(contact, bodies_.motion(a), bodies_.motion(b)) < 0) {
    resting_.impact({.a = a, .b = b, .normal = contact.normal, .point = point}, 0);
    resting_.solve();
  }
  const bool rests = resting_.find(a, b) != Resting::none;
  counters_.held += rests && !rested;
  return rests && !rested;
}

template <class Motion>
void BasicWorld<Motion>::hold(BodySlot a, BodySlot b, const Contact& contact) {
  ++counters_.held;
  const Vector3d point = contact.point - bodies_.path(a).position(contact.time);
  resting_.add({.a = a, .b = b, .normal = contact.normal, .point = point});
  resting_.disturb(a), resting_.disturb(b);
  resting_.solve();
}

/// A contact in no cluster. Whether the two are held from now on.
template <class Motion>
bool BasicWorld<Motion>::bounce_or_hold(BodySlot a, BodySlot b, const Contact& contact, double restitution,
                                        std::uint64_t burst) {
  Motion motion_a = bodies_.motion(a).restarted(contact.time);
  Motion motion_b = bodies_.motion(b).restarted(contact.time);
  const Vector3d& n = contact.normal;
  const auto relative = [&](std::size_t order) {
    return dot(n, motion_b.coefficients[order] - motion_a.coefficients[order]);
  };
  const double approach = -relative(1);
  double pressed = 0;
  if constexpr (Motion::degree >= 2) pressed = -2 * relative(2);
  const double size = motion_a.coefficients[0].cwiseAbs().maxCoeff() + motion_b.coefficients[0].cwiseAbs().maxCoeff() +
                      bodies_[a].bounding_radius + bodies_[b].bounding_radius;
  if (stays(restitution * approach, pressed, size, burst)) {
    hold(a, b, contact);
    return true;
  }
  change_relative_velocity(motion_a.coefficients[1], motion_b.coefficients[1], n, (1 + restitution) * approach,
                           bodies_[a].inverse_mass, bodies_[b].inverse_mass);
  for (const auto& [id, motion] : {std::pair<BodySlot, const Motion&>{a, motion_a}, {b, motion_b}}) {
    if (bodies_.fixed(id)) continue;
    ++counters_.motion_updates;
    set_motion(id, motion, false);
    resting_.disturb(id);
  }
  resting_.solve();
  return false;
}

template <class Motion>
void BasicWorld<Motion>::take_up(BodySlot id, const Motion& motion) {
  ++counters_.motion_updates;
  set_motion(id, motion, false);
  reports_.add(Reports::Kind::moved, bodies_.id_of(id), bodies_.id_of(id), {.time = clock_.now});
}

template <class Motion>
void BasicWorld<Motion>::tell_held(BodySlot a, BodySlot b) {
  ++counters_.held;
  const PairEvent event = event_of(a, b, contact_at(bodies_.moving(a), bodies_.moving(b), clock_.now));
  reports_.add(Reports::Kind::held, event.a, event.b, event.contact);
}

template <class Motion>
void BasicWorld<Motion>::tell_resting(bool begins, const detail::RestingContact& resting) {
  const BodySlot b = resting.b == no_body ? resting.a : resting.b;
  reports_.add_resting(begins, bodies_.id_of(resting.a), bodies_.id_of(b), contact_of(resting), resting.wall);
}

template <class Motion>
void BasicWorld<Motion>::tell_passes(const detail::RestingContact& resting) {
  reports_.add(Reports::Kind::passes, bodies_.id_of(resting.a), bodies_.id_of(resting.b), contact_of(resting));
}

template <class Motion>
Contact BasicWorld<Motion>::contact_of(const detail::RestingContact& resting) const {
  Contact contact{.time = clock_.now, .point = bodies_.path(resting.a).position(clock_.now) + resting.point};
  contact.normal = resting.normal;
  return contact;
}

#define KDS_INSTANTIATE(motion) template class BasicWorld<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
