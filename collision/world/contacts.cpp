// Contacts of the world, and how bodies respond to them.
#include "collision/profile.hpp"
#include "collision/response/impulse.hpp"
#include "collision/vectors.hpp"
#include "collision/world.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

/// Rate at which b parts from a along the normal just after the contact; of two that have none, its derivative.
template <int Degree>
double parting(const Contact& contact, const certificates::PointMotion<Degree>& a,
               const certificates::PointMotion<Degree>& b) {
  const double t = contact.time;
  const double rate = dot(contact.normal, b.velocity(t) - a.velocity(t));
  return rate != 0 ? rate : dot(contact.normal, b.acceleration(t) - a.acceleration(t));
}

}  // namespace

/// Balls need not be made into shapes for it.
template <int Degree>
Contact World<Degree>::contact_of(BodyId a, BodyId b, double t, const FoundTouch& found) const {
  const Mover& of_a = movers_[a];
  const Mover& of_b = movers_[b];
  if (of_a.radius > 0 && of_b.radius > 0) {
    return ball_contact_at(of_a.motion, of_b.motion, of_a.radius, t);
  }
  return contact_at(moving(a), moving(b), t, found);
}

/// Two bodies that overlap separate; what was let pass may meet again from now on.
template <int Degree>
void World<Degree>::process_separation(PairSlot slot, double t) {
  Pair& pair = pairs_[slot];
  contacts_.clear(slot);
  pair.overlapping = false;
  mark_dirty(slot);
  if (mode() == ContactMode::resolved) return;
  ++counters_.separations;
  const PairEvent event{pair.a, pair.b, contact_of(pair.a, pair.b, t)};
  tell([&](Listener& listener) { listener.separation(*this, event); });
}

template <int Degree>
void World<Degree>::process_contact(PairSlot slot, double t) {
  contacts_.clear(slot);
  Pair& pair = pairs_[slot];
  const FoundTouch found = slot < found_.size() ? found_[slot] : FoundTouch{};
  const PairEvent event{pair.a, pair.b, contact_of(pair.a, pair.b, t, found)};
  ++counters_.contacts;
  mark_dirty(slot);
  if (mode() == ContactMode::transparent) {
    pair.overlapping = true;
    return tell([&](Listener& listener) { listener.contact(*this, event); });
  }
  bool held = false;
  bool passes = false;
  if (options_.response == Response::elastic) {
    held = respond(slot, event.contact);
  } else {
    held = passes = count_meeting(event.a, event.b) > patience();
    counters_.held += held;
  }
  // A pair that is still pressed together (nobody can or will move it) passes through.
  const auto after = [&] {
    if (!contains(event.a) || !contains(event.b) || resting_.find(event.a, event.b) != Resting::none) return;
    // Whether the broad phase still has the pair does not matter: the callback may have parted their boxes by a
    // rounding.
    if (passes || parting(event.contact, movers_[event.a].motion, movers_[event.b].motion) < 0) {
      let_pass(event.a, event.b);
    }
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

/// Both have met others so often; a fixed body's meetings count only with another fixed one.
template <int Degree>
std::uint64_t World<Degree>::count_meeting(BodyId a, BodyId b) {
  const bool a_fixed = bodies_[a].inverse_mass == 0;
  const bool b_fixed = bodies_[b].inverse_mass == 0;
  if (a_fixed != b_fixed) return count_meeting(a_fixed ? b : a);
  const std::uint64_t of_a = count_meeting(a);
  return std::min(of_a, count_meeting(b));
}

template <int Degree>
std::uint64_t World<Degree>::count_meeting(BodyId id) {
  Body& body = bodies_[id];
  if (now_ - body.burst_start > options_.zeno.interval) {
    body.meetings = 0;
    body.burst_start = now_;
  }
  return ++body.meetings;
}

/// Whether what meets is held: see ZenoPolicy. `pressed`: relative acceleration towards each other; `size`: of the
/// coordinates.
template <int Degree>
bool World<Degree>::stays(double rebound, double pressed, double size, std::uint64_t burst) const {
  if (!(rebound > 0) || burst > options_.zeno.contacts) return true;
  if (!(pressed > 0)) return false;
  // Near a large clock doubles are sparse: a flight lasts some of them at least. And it rises by some roundings of the
  // coordinates: bodies with a light one between them bounce for ever where positions cannot come nearer.
  const double spacing = next_up(std::abs(now_)) - std::abs(now_);
  const double shortest = std::max(options_.zeno.interval / std::max(options_.zeno.contacts, 1u), 16 * spacing);
  const double lowest = 0x1p-48 * size;
  return 2 * rebound < shortest * pressed || rebound * rebound < 2 * pressed * lowest;
}

template <int Degree>
bool World<Degree>::respond(PairSlot slot, const Contact& contact) {
  const BodyId a = pairs_[slot].a;
  const BodyId b = pairs_[slot].b;
  const double inverse_a = bodies_[a].inverse_mass;
  const double inverse_b = bodies_[b].inverse_mass;
  if (inverse_a + inverse_b == 0) return false;
  Motion motion_a = movers_[a].motion.restarted(contact.time);
  Motion motion_b = movers_[b].motion.restarted(contact.time);
  const Vector3d& n = contact.normal;
  const auto relative = [&](std::size_t order) {
    return dot(n, motion_b.coefficients[order] - motion_a.coefficients[order]);
  };
  const double approach = -relative(1);
  const double restitution = std::min(bodies_[a].restitution, bodies_[b].restitution);
  double pressed = 0;
  if constexpr (Degree >= 2) pressed = -2 * relative(2);
  const std::uint64_t burst = count_meeting(a, b);
  if (burst > patience()) {  // Holding does not help: the pair is left as it is, and so passes through.
    ++counters_.held;
    let_pass(a, b);
    return true;
  }
  const double size = motion_a.coefficients[0].cwiseAbs().maxCoeff() + motion_b.coefficients[0].cwiseAbs().maxCoeff() +
                      bodies_[a].bounding_radius + bodies_[b].bounding_radius;
  const bool held = stays(restitution * approach, pressed, size, burst);
  if (held) {
    ++counters_.held;
    resting_.add({.a = a, .b = b, .normal = n});
    resting_.disturb(a), resting_.disturb(b);
  } else {
    change_relative_velocity(motion_a.coefficients[1], motion_b.coefficients[1], n, (1 + restitution) * approach,
                             inverse_a, inverse_b);
    for (const auto& [id, motion] : {std::pair<BodyId, const Motion&>{a, motion_a}, {b, motion_b}}) {
      if (bodies_[id].inverse_mass == 0) continue;
      ++counters_.motion_updates;
      set_motion(id, motion, false);
      resting_.disturb(id);
    }
  }
  resting_.settle();
  return held;
}

template class World<1>;
template class World<2>;

}  // namespace kds::collision
