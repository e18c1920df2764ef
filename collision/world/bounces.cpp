#include "collision/world/bounces.hpp"

#include "collision/motions.hpp"
#include "collision/response/impulse.hpp"
#include "collision/vectors.hpp"

#include <algorithm>
#include <utility>

namespace kds::collision {

using Eigen::Vector3d;

template <class Motion>
Bounces<Motion>::Bounces(WorldParts<Motion>& parts, MotionUpdates<Motion>& motions, ListenerCalls<Motion>& calls,
                         const BendingBounces<Motion>& bending)
    : options_(parts.options),
      clock_(parts.clock),
      counters_(parts.counters),
      bodies_(parts.bodies),
      volumes_(parts.volumes),
      walls_(parts.walls),
      resting_(parts.resting),
      motions_(motions),
      calls_(calls),
      bending_(bending) {}

template <class Motion>
double Bounces<Motion>::parting(BodySlot a, BodySlot b, const Contact& contact) const {
  const auto& path_a = bodies_.path(a);
  const auto& path_b = bodies_.path(b);
  const double t = contact.time;
  const double rate = dot(contact.normal, path_b.velocity(t) - path_a.velocity(t));
  if (bending_.bend(a, b)) return rate + dot(contact.normal, bending_.velocity(a, b, contact));
  if constexpr (Motion::degree >= 3) {
    if (rate != 0) return rate;
    const auto at_a = path_a.restarted(t), at_b = path_b.restarted(t);
    double later = 0;
    for (std::size_t i = 2; i <= Motion::degree && later == 0; ++i) {
      later = dot(contact.normal, at_b.coefficients[i] - at_a.coefficients[i]);
    }
    return later;
  }
  return rate != 0 ? rate : dot(contact.normal, path_b.acceleration(t) - path_a.acceleration(t));
}

template <class Motion>
void Bounces<Motion>::process_wall() {
  const BodySlot id = walls_.next_body();
  const auto& body = bodies_[id];
  const int wall = walls_.next_wall();
  const int axis = wall / 2;
  const double out = wall % 2 != 0 ? 1 : -1;
  Motion motion = bodies_.motion(id).restarted(clock_.now);
  const double approach = motion.coefficients[1][axis] * out;
  double pressed = 0;
  if constexpr (Motion::degree >= 2) pressed = 2 * motion.coefficients[2][axis] * out;
  const double rebound = std::min(body.restitution, options_.walls->restitution) * approach;
  WallEvent event{bodies_.id_of(id), wall, {.time = clock_.now}, body.user_data};
  event.contact.normal = Vector3d::Zero();  // not a unit vector times -1, whose zeros would be negative
  event.contact.normal[axis] = out;
  event.contact.point = motion.coefficients[0];
  event.contact.point[axis] = out > 0 ? options_.walls->max[axis] : options_.walls->min[axis];
  const Vector3d point = event.contact.point - motion.coefficients[0];
  ++counters_.wall_contacts;
  const double size = motion.coefficients[0].cwiseAbs().maxCoeff() + body.bounding_radius;
  const bool clustered = resting_.clustered(id) && !bodies_.fixed(id);
  bool suppressed =
      !clustered && stays(rebound, pressed, size, bodies_.count_meeting(id, clock_.now, options_.zeno.interval));
  if (clustered && endless(bodies_.count_meeting(id, clock_.now, options_.zeno.interval))) {
    resting_.halt(id);
  } else if (clustered) {
    const bool rested = resting_.find(id, no_body, wall) != Resting::none;
    resting_.impact({.a = id, .wall = wall, .normal = event.contact.normal, .point = point},
                    std::min(body.restitution, options_.walls->restitution));
    suppressed = !rested && resting_.find(id, no_body, wall) != Resting::none;
    counters_.rebounds_suppressed += suppressed;
  } else if (suppressed) {
    ++counters_.rebounds_suppressed;
    resting_.add({.a = id, .wall = wall, .normal = event.contact.normal, .point = point});
  } else {
    motion.coefficients[1][axis] = -rebound * out;
    bounce_off_wall(id, motion);
  }
  if (!clustered) resting_.disturb(id);
  resting_.solve();
  const auto report = [&](auto& listener, auto& world) {
    listener.wall(world, event);
    if (suppressed) listener.rebound_suppressed_at_wall(world, event);
  };
  try {
    calls_.tell(report);
  } catch (...) {
    motions_.take_up_reported();
    throw;
  }
  motions_.take_up_reported();
}

/// If only this body is concerned, the parts of the world get its new motion after it has been reported, or before the
/// next change if a callback makes one.
template <class Motion>
void Bounces<Motion>::bounce_off_wall(BodySlot slot, const Motion& motion) {
  ++counters_.motion_updates;
  const bool others = !resting_.empty() || volumes_.any_ends() || !bodies_.attachments().empty();
  others ? motions_.set(slot, motion, false) : motions_.set_after_report(slot, motion);
}

/// Whether two bodies that meet rest on each other from now on, without rebound: see ZenoPolicy. `pressed`: relative
/// acceleration towards each other; `size`: magnitude of the coordinates.
template <class Motion>
bool Bounces<Motion>::stays(double rebound, double pressed, double size, std::uint64_t burst) const {
  if (!(rebound > 0) || burst > options_.zeno.contacts) return true;
  if (!(pressed > 0)) return false;
  // At a large clock the doubles are sparse: a flight must last for several of them. And it must rise by several
  // roundings of the coordinates: otherwise two bodies with a light one between them would bounce endlessly at a
  // distance that doubles cannot make smaller.
  const double spacing = next_up(std::abs(clock_.now)) - std::abs(clock_.now);
  const double shortest = std::max(options_.zeno.interval / std::max(options_.zeno.contacts, 1u), 16 * spacing);
  const double lowest = 0x1p-48 * size;
  return 2 * rebound < shortest * pressed || rebound * rebound < 2 * pressed * lowest;
}

/// Whether the number of meetings at nearly one time says that they will not end: true at each multiple of
/// ZenoPolicy::contacts.
template <class Motion>
bool Bounces<Motion>::endless(std::uint64_t burst) const {
  const std::uint64_t many = std::max(options_.zeno.contacts, 1u);
  return burst > many && burst % many == 0;
}

template <class Motion>
bool Bounces<Motion>::respond(BodySlot a, BodySlot b, const Contact& contact, std::uint64_t burst) {
  if (bending_.bend(a, b)) {
    bounce_off_surface(a, b, contact, burst);
    return false;
  }
  const bool often = burst > options_.zeno.contacts;
  const double restitution = often ? 0 : std::min(bodies_[a].restitution, bodies_[b].restitution);
  if (restitution < 1 && !bodies_.fixed(a) && !bodies_.fixed(b)) resting_.note_meeting(a, b);
  const auto approach = [&] { return parting(a, b, contact) < 0; };
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
  const bool suppressed = bounce_or_rest(a, b, contact, restitution, burst);
  // They still approach though they have bounced: the bodies that they lean on press them together, so they rest.
  if (rest() || !approach()) return suppressed;
  if (resting_.can_gather(a, b)) {
    resting_.gather(a), resting_.gather(b);
    return strike(a, b, contact, restitution) || suppressed;
  }
  begin_rest(a, b, contact);
  return true;
}

/// The mesh is fixed, so the other body leaves it with the velocity of the surface at the contact and the rebound.
template <class Motion>
void Bounces<Motion>::bounce_off_surface(BodySlot a, BodySlot b, const Contact& contact, std::uint64_t burst) {
  const BodySlot free = bodies_.fixed(a) ? b : a;
  const double rate = parting(a, b, contact);
  const Vector3d away = free == a ? Vector3d(-contact.normal) : contact.normal;
  const double change = std::max(bending_.rebound(a, b, contact, -rate, burst) - rate, 0.0);
  // Even a body that parts already begins a new piece: from here on what is near is looked at anew.
  Motion motion = bodies_.motion(free).restarted(contact.time);
  if (resting_.rests(free)) {
    motion.coefficients[1] = resting_.drive(free, away, dot(away, motion.coefficients[1]) + change);
  } else {
    Vector3d none = Vector3d::Zero();
    change_relative_velocity(none, motion.coefficients[1], away, change, 0, bodies_[free].inverse_mass);
  }
  resting_.leave(free);
  ++counters_.motion_updates;
  motions_.set(free, motion, false);
  resting_.disturb(free);
  resting_.solve();
}

/// A contact in a cluster. Whether the two rest on each other from now on.
template <class Motion>
bool Bounces<Motion>::strike(BodySlot a, BodySlot b, const Contact& contact, double restitution) {
  const bool rested = resting_.find(a, b) != Resting::none;
  const Vector3d point = contact.point - bodies_.path(a).position(contact.time);
  resting_.impact({.a = a, .b = b, .normal = contact.normal, .point = point}, restitution);
  resting_.solve();
  // If the bodies that lean on the two push them back towards each other, they stay together.
  if (resting_.find(a, b) == Resting::none && parting(a, b, contact) < 0) {
    resting_.impact({.a = a, .b = b, .normal = contact.normal, .point = point}, 0);
    resting_.solve();
  }
  const bool rests = resting_.find(a, b) != Resting::none;
  counters_.rebounds_suppressed += rests && !rested;
  return rests && !rested;
}

template <class Motion>
void Bounces<Motion>::begin_rest(BodySlot a, BodySlot b, const Contact& contact) {
  ++counters_.rebounds_suppressed;
  const Vector3d point = contact.point - bodies_.path(a).position(contact.time);
  resting_.add({.a = a, .b = b, .normal = contact.normal, .point = point});
  for (const BodySlot id : {a, b}) {
    if (!bodies_.fixed(id)) resting_.disturb(id);
  }
  resting_.solve();
}

/// A contact in no cluster. Whether the two rest on each other from now on.
template <class Motion>
bool Bounces<Motion>::bounce_or_rest(BodySlot a, BodySlot b, const Contact& contact, double restitution,
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
                      bodies_.finite_radius(a) + bodies_.finite_radius(b);
  if (stays(restitution * approach, pressed, size, burst)) {
    begin_rest(a, b, contact);
    return true;
  }
  change_relative_velocity(motion_a.coefficients[1], motion_b.coefficients[1], n, (1 + restitution) * approach,
                           bodies_[a].inverse_mass, bodies_[b].inverse_mass);
  for (const auto& [id, motion] : {std::pair<BodySlot, const Motion&>{a, motion_a}, {b, motion_b}}) {
    if (bodies_.fixed(id)) continue;
    ++counters_.motion_updates;
    motions_.set(id, motion, false);
    resting_.disturb(id);
  }
  resting_.solve();
  return false;
}

#define KDS_INSTANTIATE(motion) template class Bounces<motion>;
KDS_FOR_EACH_PATH(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
