// Bodies that lean on each other: found, and moved as what holds them lets them.
#include "collision/vectors.hpp"
#include "collision/world.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

}  // namespace

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
      settle_fixed(id);
    } else {
      while (!settle_island(id)) {
      }
    }
  }
}

/// Nothing but walls holds a fixed body: they take the speed and the acceleration that lead out of the domain.
template <int Degree>
void World<Degree>::settle_fixed(BodyId id) {
  const Motion before = movers_[id].motion.restarted(now_);
  Motion motion = before;
  const std::vector<HoldSlot> holds = bodies_[id].holds;  // some may be dropped
  const bool at_wall = std::any_of(holds.begin(), holds.end(), [&](HoldSlot slot) { return holds_[slot].wall >= 0; });
  if constexpr (Degree >= 2) {
    if (at_wall) motion.coefficients[2] = bodies_[id].force;
  }
  for (const HoldSlot slot : holds) {
    Hold& hold = holds_[slot];
    if (hold.wall < 0) {
      disturb(hold.a == id ? hold.b : hold.a);
      continue;
    }
    const Eigen::Index axis = hold.wall / 2;
    if (hold.fresh) motion.coefficients[1][axis] = 0;
    bool parts = motion.coefficients[1][axis] != 0;  // inward, or outward: then it meets the wall anew
    if constexpr (Degree >= 2) {
      double& force = motion.coefficients[2][axis];
      parts = parts || force * hold.normal[axis] < 0;
      if (!parts) force = 0;
    }
    hold.fresh = false;
    if (parts) drop_hold(slot);
  }
  if (at_wall && !(motion == before)) take_up(id, motion);
}

template <int Degree>
void World<Degree>::take_up(BodyId id, const Motion& motion) {
  ++counters_.motion_updates;
  set_motion(id, motion, false);
  report(Pending::Kind::moved, id, no_body, {.time = now_});
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
  const auto take_up_all = [&] {
    for (std::size_t i = 0; i < island.free; ++i) {
      if (!(motions[i] == before[i])) take_up(island.bodies[i], motions[i]);
    }
  };
  if constexpr (Degree >= 2) {
    const std::vector<Motion> stopped = motions;
    for (std::size_t i = 0; i < island.free; ++i) motions[i].coefficients[2] = bodies_[island.bodies[i]].force;
    if (!constrain(island, 2, motions)) {  // What is pulled away at once has been stopped all the same.
      motions = stopped;
      take_up_all();
      return false;
    }
  }
  take_up_all();
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
    if (std::abs(dot(hold.normal, b - a)) <= rate_rounding * largest) continue;
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

template class World<1>;
template class World<2>;

}  // namespace kds::collision
