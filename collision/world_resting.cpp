// Contacts that are held: who leans on whom, what that does to their motions, and when it ends.
#include "collision/world.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

/// How far a held pair may part before it is let go, relative to the smaller bounding radius: balls that slide over
/// each other part by this from plane to plane, and fall back. Less makes that more exact, and costs more pieces.
constexpr double slack = 0x1p-20;
/// The same relative to the coordinates, which are rounded whenever a motion is restarted.
constexpr double coordinate_slack = 0x1p-40;

/// Normals as near as this are of one and the same place: cosine of the angle between them.
constexpr double same_normal = 1 - 0x1p-20;

template <int Degree>
bool is_mesh(const MovingShape<Degree>& body) {
  return std::holds_alternative<MeshShape>(body.shape.shape);
}

template <int Degree>
certificates::PointMotion<Degree> shifted(certificates::PointMotion<Degree> motion, const Vector3d& by) {
  motion.coefficients[0] += by;
  return motion;
}

template <int Degree>
double slack_of(const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t) {
  const double size = std::min(a.shape.bounding_radius, b.shape.bounding_radius);
  const double coordinates = a.motion.position(t).cwiseAbs().maxCoeff() + b.motion.position(t).cwiseAbs().maxCoeff();
  return std::max(slack * size, coordinate_slack * coordinates);
}

}  // namespace

template <int Degree>
typename World<Degree>::HoldSlot World<Degree>::find_hold(BodyId a, BodyId b, int wall) const {
  for (const HoldSlot slot : bodies_[a].holds) {
    const Hold& hold = holds_[slot];
    if (hold.a == a && hold.b == b && hold.wall == wall) return slot;
  }
  return no_hold;
}

/// Between meshes several may hold at once, in a groove, say; one for each normal.
template <int Degree>
void World<Degree>::add_hold(const Hold& hold) {
  for (const HoldSlot slot : bodies_[hold.a].holds) {
    Hold& other = holds_[slot];
    if (other.a != hold.a || other.b != hold.b || !(other.normal.dot(hold.normal) > same_normal)) continue;
    other.normal = hold.normal;
    other.fresh = true;
    return;
  }
  HoldSlot slot;
  if (free_holds_.empty()) {
    slot = static_cast<HoldSlot>(holds_.size());
    holds_.emplace_back();
    if (releases_.slots() < holds_.size()) releases_.resize(2 * holds_.size());
  } else {
    slot = free_holds_.back();
    free_holds_.pop_back();
  }
  holds_[slot] = hold;
  holds_[slot].alive = true;
  holds_[slot].fresh = true;
  bodies_[hold.a].holds.push_back(slot);
  if (hold.b != no_body) bodies_[hold.b].holds.push_back(slot);
}

template <int Degree>
void World<Degree>::drop_hold(HoldSlot slot) {
  Hold& hold = holds_[slot];
  hold.alive = false;
  releases_.clear(slot);
  free_holds_.push_back(slot);
  for (const BodyId id : {hold.a, hold.b}) {
    if (id == no_body) continue;
    auto& list = bodies_[id].holds;
    list.erase(std::find(list.begin(), list.end(), slot));
    disturb(id);
  }
  if (hold.b == no_body) return;
  const PairSlot pair = find_pair(hold.a, hold.b);
  if (pair != no_pair) mark_dirty(pair);
}

template <int Degree>
void World<Degree>::drop_holds(BodyId id) {
  while (!bodies_[id].holds.empty()) drop_hold(bodies_[id].holds.back());
}

/// The motion of a body has changed, or what holds it: those that are held with it are to be looked at.
template <int Degree>
void World<Degree>::disturb(BodyId id) {
  Body& b = bodies_[id];
  if (b.disturbed || !b.alive || !b.entered) return;
  bool as_given = true;
  if constexpr (Degree >= 2) as_given = b.inverse_mass == 0 || movers_[id].motion.coefficients[2] == b.force;
  if (b.holds.empty() && as_given) return;
  b.disturbed = true;
  disturbed_.push_back(id);
}

template <int Degree>
void World<Degree>::settle() {
  while (!disturbed_.empty()) {
    const BodyId id = disturbed_.back();
    disturbed_.pop_back();
    if (!contains(id) || !bodies_[id].disturbed) continue;
    bodies_[id].disturbed = false;
    if (bodies_[id].inverse_mass == 0) {
      for (const HoldSlot slot : bodies_[id].holds) disturb(holds_[slot].a == id ? holds_[slot].b : holds_[slot].a);
    } else {
      while (!settle_island(id)) {
      }
    }
  }
}

/// False if a hold had to be dropped: then it is to be called again. Each time there is one hold less.
template <int Degree>
bool World<Degree>::settle_island(BodyId id) {
  Island island = find_island(id);
  if (drop_broken(island)) return false;
  std::vector<Motion> motions;
  for (const BodyId each : island.bodies) motions.push_back(movers_[each].motion.restarted(now_));
  const std::vector<Motion> before = motions;
  if (!constrain(island, 1, motions)) return false;
  const auto take_up = [&] {
    for (std::size_t i = 0; i < island.free; ++i) {
      if (motions[i] == before[i]) continue;
      ++counters_.motion_updates;
      set_motion(island.bodies[i], motions[i], false);
      report(Pending::Kind::moved, island.bodies[i], no_body, {.time = now_});
    }
  };
  if constexpr (Degree >= 2) {
    const std::vector<Motion> stopped = motions;
    for (std::size_t i = 0; i < island.free; ++i) motions[i].coefficients[2] = bodies_[island.bodies[i]].force;
    if (!constrain(island, 2, motions)) {  // What is pulled away at once has been stopped all the same.
      motions = stopped;
      take_up();
      return false;
    }
  }
  take_up();
  for (const HoldSlot slot : island.holds) {
    holds_[slot].fresh = false;
    schedule_release(slot);
  }
  return true;
}

/// The bodies that lean on each other, directly or not, but not through fixed ones; in the order of their ids, so that
/// the arithmetic does not depend on how they were found.
template <int Degree>
typename World<Degree>::Island World<Degree>::find_island(BodyId id) {
  ++islands_;
  Island island;
  std::vector<BodyId> fixed;
  const auto visit = [&](BodyId next) {
    Body& b = bodies_[next];
    if (b.island == islands_) return;
    b.island = islands_;
    (b.inverse_mass == 0 ? fixed : island.bodies).push_back(next);
  };
  visit(id);
  for (std::size_t i = 0; i < island.bodies.size(); ++i) {
    const BodyId at = island.bodies[i];
    for (const HoldSlot slot : bodies_[at].holds) {
      const Hold& hold = holds_[slot];
      const BodyId other = hold.a == at ? hold.b : hold.a;
      const bool met_first = hold.a == at || bodies_[other].inverse_mass == 0;
      if (met_first) island.holds.push_back(slot);
      if (other != no_body) visit(other);
    }
  }
  std::sort(island.bodies.begin(), island.bodies.end());
  island.free = island.bodies.size();
  std::sort(fixed.begin(), fixed.end());
  island.bodies.insert(island.bodies.end(), fixed.begin(), fixed.end());
  for (std::size_t i = 0; i < island.bodies.size(); ++i) {
    bodies_[island.bodies[i]].island_place = static_cast<std::uint32_t>(i);
  }
  const auto key = [&](HoldSlot slot) {
    const Hold& h = holds_[slot];
    return std::tuple(h.a, h.b, h.wall, h.normal[0], h.normal[1], h.normal[2]);
  };
  std::sort(island.holds.begin(), island.holds.end(), [&](HoldSlot x, HoldSlot y) { return key(x) < key(y); });
  for (const HoldSlot slot : island.holds) {
    const Hold& hold = holds_[slot];
    const bool at_wall = hold.b == no_body;
    const double a = bodies_[hold.a].inverse_mass;
    const double b = at_wall ? 0 : bodies_[hold.b].inverse_mass;
    // The walls come after the bodies.
    const auto place_b = at_wall ? static_cast<std::uint32_t>(island.bodies.size()) : bodies_[hold.b].island_place;
    island.touches.push_back({bodies_[hold.a].island_place, place_b, hold.normal, a, b});
  }
  return island;
}

/// Lets go what has been given speed along its normal; what approaches meets anew, and may bounce.
template <int Degree>
bool World<Degree>::drop_broken(const Island& island) {
  bool any = false;
  for (const HoldSlot slot : island.holds) {
    const Hold& hold = holds_[slot];
    if (hold.fresh) continue;
    const Vector3d a = movers_[hold.a].motion.velocity(now_);
    const Vector3d b = hold.b == no_body ? Vector3d(Vector3d::Zero()) : movers_[hold.b].motion.velocity(now_);
    const double largest = std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff());
    if (std::abs(hold.normal.dot(b - a)) <= rate_rounding * largest) continue;
    drop_hold(slot);
    any = true;
  }
  return any;
}

/// Velocities (order 1) or accelerations (2) by least constraint. False if a hold had to be dropped: one that parts, or
/// one that cannot be held.
template <int Degree>
bool World<Degree>::constrain(Island& island, std::size_t order, std::vector<Motion>& motions) {
  std::vector<Vector3d> rates;
  for (const Motion& motion : motions) rates.push_back(motion.coefficients[order]);
  rates.push_back(Vector3d::Zero());  // of the walls
  for (std::size_t k = 0; k < island.holds.size(); ++k) {
    island.touches[k].push = order == 2 ? holds_[island.holds[k]].push : 0;
  }
  double largest = 0;
  for (const Vector3d& rate : rates) largest = std::max(largest, rate.cwiseAbs().maxCoeff());
  if (!least_constraint(rates, island.touches)) return !let_pass_worst(island, rates);
  for (std::size_t k = 0; k < island.holds.size(); ++k) {
    if (parting_rate(rates, island.touches[k]) <= rate_rounding * largest) continue;
    drop_hold(island.holds[k]);
    return false;
  }
  for (std::size_t k = 0; k < island.holds.size(); ++k) {
    if (order == 2) holds_[island.holds[k]].push = island.touches[k].push;
  }
  for (std::size_t i = 0; i < island.free; ++i) motions[i].coefficients[order] = rates[i];
  return true;
}

/// Of bodies that cannot all be held the pair that is pressed together most passes through. Walls do not give way.
template <int Degree>
bool World<Degree>::let_pass_worst(const Island& island, const std::vector<Vector3d>& rates) {
  HoldSlot worst = no_hold;
  double least = never;
  for (std::size_t k = 0; k < island.holds.size(); ++k) {
    const double rate = parting_rate(rates, island.touches[k]);
    if (holds_[island.holds[k]].b == no_body || !(rate < least)) continue;
    least = rate;
    worst = island.holds[k];
  }
  if (worst == no_hold) return false;
  const Hold hold = holds_[worst];
  let_pass(hold.a, hold.b);
  drop_hold(worst);
  if (!hold.fresh) {  // else the event that made it is about to be reported
    ++counters_.held;
    report(Pending::Kind::held, hold.a, hold.b, contact_at(moving(hold.a), moving(hold.b), now_));
  }
  return true;
}

/// Convex bodies that are held are on either side of a plane through the touch and stay there, so they cannot meet
/// again before they are let go. A mesh may have something else in the way; where rounding makes it the held touch that
/// is found, that is left behind by some roundings.
template <int Degree>
double World<Degree>::next_contact_of_held(const Pair& pair) const {
  const auto a = moving(pair.a);
  const auto b = moving(pair.b);
  if (!is_mesh(a) && !is_mesh(b)) return never;
  const double t = first_contact(a, b, now_, horizon_, ContactMode::resolved);
  if (t != now_) return t;
  Vector3d out = Vector3d::Zero();
  for (const HoldSlot slot : bodies_[pair.a].holds) {
    if (holds_[slot].b == pair.b) out += holds_[slot].normal;
  }
  const double coordinates =
      a.motion.position(now_).cwiseAbs().maxCoeff() + b.motion.position(now_).cwiseAbs().maxCoeff();
  const double size = a.shape.bounding_radius + b.shape.bounding_radius;
  const Motion farther = shifted(b.motion, coordinate_slack * (size + coordinates) * out);
  return first_contact(a, MovingShape<Degree>{b.shape, farther}, now_, horizon_, ContactMode::resolved);
}

/// Held pairs part by sliding off, or by `slack`.
template <int Degree>
void World<Degree>::schedule_release(HoldSlot slot) {
  const Hold& hold = holds_[slot];
  if (hold.b == no_body) return;  // Walls have no edge to slide off.
  const auto a = moving(hold.a);
  const auto b = moving(hold.b);
  bool together = true;
  for (std::size_t i = 1; i <= Degree; ++i) {
    together = together && a.motion.coefficients[i] == b.motion.coefficients[i];
  }
  if (together && (Degree == 1 || a.motion.start == b.motion.start || a.motion.coefficients[Degree].isZero(0))) {
    return releases_.clear(slot);
  }
  const Motion nearer = shifted(b.motion, -slack_of(a, b, now_) * hold.normal);
  const double t = first_separation(a, MovingShape<Degree>{b.shape, nearer}, now_, horizon_);
  releases_.set(slot, t);
}

template <int Degree>
void World<Degree>::release(HoldSlot slot) {
  drop_hold(slot);
  settle();
}

template <int Degree>
bool World<Degree>::held(BodyId a, BodyId b) const {
  body(a), body(b);
  return find_hold(std::min(a, b), std::max(a, b)) != no_hold;
}

template <int Degree>
bool World<Degree>::held_at_wall(BodyId a, int wall) const {
  body(a);
  return find_hold(a, no_body, wall) != no_hold;
}

template <int Degree>
typename World<Degree>::Motion World<Degree>::free_motion(BodyId id) const {
  const Body& b = body(id);
  if (b.holds.empty()) return movers_[id].motion;
  Motion motion = movers_[id].motion.restarted(now_);
  if constexpr (Degree >= 2) motion.coefficients[2] = b.force;
  return motion;
}

template <int Degree>
void World<Degree>::count_edit() {
  idle_until_ = -never;
  if (!stepping_) return;
  if (now_ - edits_start_ > options_.zeno.interval) {
    edits_start_ = now_;
    edits_ = 0;
  }
  if (++edits_ <= std::max<std::uint64_t>(options_.most_edits, 64 * alive_)) return;
  throw std::runtime_error("World: callbacks have changed bodies " + std::to_string(edits_) + " times within " +
                           std::to_string(now_ - edits_start_) + " s, at " + std::to_string(now_) +
                           " s; WorldOptions.most_edits allows no more");
}

template class World<1>;
template class World<2>;

}  // namespace kds::collision
