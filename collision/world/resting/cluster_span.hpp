// A span of a cluster: the motions of its bodies. Included only by resting_clusters.cpp.
#pragma once

#include "collision/vectors.hpp"
#include "collision/world/resting/cluster_rules.hpp"
#include "collision/world/resting/resting_contacts.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace kds::collision {
namespace cluster {

/// Normals and accelerations depend on each other: this many times they are computed in turn.
inline constexpr std::size_t most_passes = 4;

/// Solves by sweeps, which are quick if the pushes of a short time before are known, and where these do not converge (a
/// wedge that is squeezed, light bodies between heavy ones) by active sets. If there is no solution, since bodies fill
/// all the room between fixed ones, it tries again with the bounds `at_least`, which let no gap grow.
inline bool solve(std::vector<Eigen::Vector3d>& rates, std::vector<Touch>& touches, std::span<const double> at_least,
                  double tolerance) {
  const std::vector<Eigen::Vector3d> before = rates;
  const bool few = touches.size() <= most_active;
  const std::vector<Touch> guesses = few ? touches : std::vector<Touch>();
  if (tolerance > 0 && nearly_least_constraint(rates, touches, tolerance, most_sweeps)) return true;
  rates = before;
  if (few) {
    touches = guesses;
    if (least_constraint(rates, touches)) return true;
    rates = before;
    touches = guesses;
  }
  for (std::size_t k = 0; k < touches.size(); ++k) touches[k].least = std::min(touches[k].least, at_least[k]);
  return few ? least_constraint(rates, touches) : nearly_least_constraint(rates, touches, tolerance, most_sweeps);
}

}  // namespace cluster

/// A span of a cluster that begins now. Places among rates are those of the island, and the walls come last.
template <class Motion>
class RestingContacts<Motion>::Span {
  using Vector3d = Eigen::Vector3d;

 public:
  Span(RestingContacts& all, Island& island) : all_(all), island_(island), touches_(island.touches) {
    const double now = all.clock_.now;
    for (const BodySlot id : island.bodies) {
      velocities.push_back(all.velocity(id));
      halves.push_back(0.5 * all.bodies_.path(id).acceleration(now));
    }
    velocities.push_back(Vector3d::Zero());
    halves.push_back(Vector3d::Zero());
    length = longest();
  }

  /// False if some contacts could not be kept from closing.
  bool solve_velocities(bool turns) {
    tolerance_ = never;
    for (std::size_t k = 0; k < touches_.size(); ++k) {
      Contact& contact = this->contact(k);
      const bool bends = all_.gaps_.bends(contact);
      const bool loose = turns || contact.b == no_body;
      const bool many = touches_.size() > cluster::most_active;
      const double room = many    ? cluster::room_of_many
                          : bends ? cluster::room_of_curves
                          : loose ? cluster::room_of_planes
                                  : 0;
      contact.room = room * all_.gaps_.size(contact);
      tolerance_ = std::min(tolerance_, cluster::tolerated * contact.room);
      normals_.push_back(contact.normal);
      if (bends) bends_.push_back(k);
      touches_[k].normal = contact.normal;
      touches_[k].least = cluster::least_rate(contact, contact.gap, length);
      touches_[k].push = 0;
      at_least_.push_back(std::min(touches_[k].least, 0.0));
    }
    return cluster::solve(velocities, touches_, at_least_, tolerance_ / length);
  }

  /// Half the accelerations, and the pushes of contacts. On a curved surface the normal is that between those at both
  /// ends of the span, so that bodies that begin in touch and moving along the surface end so, and no speed is lost.
  bool solve_accelerations() {
    std::vector<Vector3d> free = halves;
    for (std::size_t i = 0; i < island_.free; ++i) free[i] = 0.5 * all_.acceleration(island_.bodies[i]);
    bool solved = true;
    for (std::size_t pass = 0; pass < cluster::most_passes; ++pass) {
      const bool follow = turn_normals();
      if (pass > 0 && follow) break;
      halves = free;
      for (std::size_t k = 0; k < touches_.size(); ++k) {
        const Contact& contact = this->contact(k);
        const double bending = all_.gaps_.beyond_parabola(contact, touches_[k].normal, length);
        const double rate = parting_rate(velocities, touches_[k]) + bending / length;
        touches_[k].least = cluster::least_acceleration(cluster::closing(contact, contact.gap), rate, length);
        touches_[k].push = contact.push;
        at_least_[k] = std::min(touches_[k].least, -rate / length);
      }
      solved = cluster::solve(halves, touches_, at_least_, tolerance_ / (length * length));
      for (std::size_t k = 0; k < touches_.size(); ++k) contact(k).push = touches_[k].push;
    }
    return solved;
  }

  /// How long the span may last: until the first gap that was left too small would close. Also sets the gap of each
  /// contact at the end, and whether it is proven.
  double usable() {
    for (double result = length;;) {
      pay(result);
      const double lasts = provable(result);
      if (lasts == result) return result;
      result = lasts;
    }
  }

  /// If there is no solution all bodies get one motion, which no contact forbids: that of the fixed bodies that they
  /// lean on, or the means of velocity and acceleration by mass if there are none. Where fixed bodies move in different
  /// ways it is that of the first which keeps them clear of the others, and contacts with those are not proven.
  void move_as_one() {
    const auto wall = island_.bodies.size();
    const bool at_wall = std::any_of(island_.contacts.begin(), island_.contacts.end(),
                                     [this](Slot slot) { return all_.contacts_[slot].b == no_body; });
    Vector3d rate = Vector3d::Zero();
    Vector3d half = Vector3d::Zero();
    if (island_.free < wall) {
      const std::size_t first = clear_carrier();
      carrier = island_.bodies[first];
      rate = velocities[first], half = halves[first];
    } else if (!at_wall) {
      double mass = 0;
      for (const BodySlot id : island_.bodies) {
        const double of = all_.bodies_[id].mass;
        rate += of * all_.velocity(id);
        half += of * 0.5 * all_.acceleration(id);
        mass += of;
      }
      rate /= mass, half /= mass;
    }
    for (std::size_t i = 0; i < island_.free; ++i) velocities[i] = rate, halves[i] = half;
    proven_.assign(touches_.size(), 1);
    for (std::size_t k = 0; k < touches_.size(); ++k) {
      Contact& contact = this->contact(k);
      contact.push = 0;
      contact.aim = contact.gap;
      proven_[k] = contact.b == no_body || (moves_alike(touches_[k].a) && moves_alike(touches_[k].b));
    }
  }
  /// Whether all contacts are proven.
  bool keeps_apart() const {
    return std::all_of(proven_.begin(), proven_.end(), [](char proven) { return proven != 0; });
  }

  void prove() {
    for (std::size_t k = 0; k < touches_.size(); ++k) all_.set_proven(contact(k), proven_[k] != 0);
  }

  double length;  ///< s; `never` if nothing accelerates the bodies
  std::vector<Vector3d> velocities;
  std::vector<Vector3d> halves;
  BodySlot carrier = no_body;  ///< of move_as_one(): the fixed body with which all move

 private:
  Contact& contact(std::size_t k) { return all_.contacts_[island_.contacts[k]]; }

  double longest() const {
    double span = never;
    for (std::size_t i = 0; i < island_.free; ++i) span = std::min(span, all_.longest_span(island_.bodies[i]));
    for (std::size_t k = 0; k < touches_.size(); ++k) {
      const Contact& contact = all_.contacts_[island_.contacts[k]];
      if (contact.b == no_body) continue;
      const Vector3d relative = velocities[touches_[k].b] - velocities[touches_[k].a];
      const double along = norm(relative - dot(contact.normal, relative) * contact.normal);
      if (along > 0) span = std::min(span, cluster::part_of_slide * all_.gaps_.size(contact) / along);
    }
    return span;
  }

  /// Takes the energy that lifts contacts to their room, and that rounding adds, from the speeds: if the span lasts for
  /// `time`, the bodies end it with no more energy than they have before it. The work of moving fixed bodies is not
  /// taken off.
  void pay(double time) {
    const auto moves = [](const Vector3d& vector) { return !vector.isZero(0); };
    const auto fixed = static_cast<std::ptrdiff_t>(island_.free);
    if (std::any_of(velocities.begin() + fixed, velocities.end(), moves)) return;
    if (std::any_of(halves.begin() + fixed, halves.end(), moves)) return;
    double gained = 0;
    double by_speeds = 0;  // its derivative with respect to a common factor of all velocities
    for (std::size_t i = 0; i < island_.free; ++i) {
      const BodySlot id = island_.bodies[i];
      const Vector3d weight = all_.acceleration(id);
      const Vector3d end = velocities[i] + 2 * time * halves[i];
      const Vector3d way = time * (velocities[i] + time * halves[i]);
      const double mass = all_.bodies_[id].mass;
      gained += mass * (0.5 * (squared_norm(end) - squared_norm(all_.velocity(id))) - dot(weight, way));
      by_speeds += mass * (dot(end, velocities[i]) - time * dot(weight, velocities[i]));
    }
    if (!(gained > 0 && by_speeds > gained)) return;
    for (std::size_t i = 0; i < island_.free; ++i) velocities[i] *= 1 - gained / by_speeds;
  }

  /// For how long, at most `time`, no bodies penetrate.
  double provable(double time) {
    proven_.clear();
    for (std::size_t k = 0; k < touches_.size(); ++k) {
      Contact& contact = this->contact(k);
      const double rate = parting_rate(velocities, touches_[k]);
      const double half = parting_rate(halves, touches_[k]);
      contact.fresh = false;
      contact.aim = all_.gaps_.along_normal(contact) - cluster::closing(contact, contact.gap);
      proven_.push_back(all_.gaps_.proven(contact, rate, half, time));
      if (proven_.back()) continue;
      const auto apart_at = [&](double at) {
        return all_.gaps_.after(contact, displacement(touches_[k], at)).width >= 0;
      };
      const auto lasts = [&](double until) {  // If the two would meet at once it does not last at all.
        if (!all_.gaps_.bends(contact)) return all_.gaps_.proven(contact, rate, half, until);
        return apart_at(until) && apart_at(cluster::shortest_span * until);
      };
      while (time > 0 && !lasts(time)) time /= 2;
    }
    return time;
  }

  /// How far b moves relative to a in a time.
  Vector3d displacement(const Touch& touch, double time) const {
    Vector3d way = (velocities[touch.b] - velocities[touch.a]) * time;
    way += (halves[touch.b] - halves[touch.a]) * (time * time);
    if constexpr (Motion::degree >= 3) way += higher_terms(touch.b, time) - higher_terms(touch.a, time);
    return way;
  }

  /// How far the terms above the second degree move a fixed body; no others have any.
  Vector3d higher_terms(std::uint32_t place, double time) const {
    Vector3d way = Vector3d::Zero();
    if (place < island_.free || place >= island_.bodies.size()) return way;
    const auto motion = all_.bodies_.path(island_.bodies[place]).restarted(all_.clock_.now);
    for (std::size_t i = Motion::degree; i >= 3; --i) way = (way + motion.coefficients[i]) * time;
    return way * (time * time);
  }

  /// The place of the first fixed body whose motion leads into no other fixed body or wall that is touched; if there is
  /// none, of the one whose motion does so most slowly.
  std::size_t clear_carrier() const {
    std::size_t best = island_.free;
    double greatest = -never;
    for (std::size_t i = island_.free; i < island_.bodies.size(); ++i) {
      double least = 0;
      for (const Touch& touch : touches_) {
        const auto velocity = [&](std::uint32_t place) { return velocities[place < island_.free ? i : place]; };
        least = std::min(least, dot(touch.normal, velocity(touch.b) - velocity(touch.a)));
      }
      if (least > greatest) greatest = least, best = i;
    }
    return best;
  }

  /// Whether a body moves as the carrier does, up to rounding, or is one that it carries.
  bool moves_alike(std::uint32_t place) const {
    if (place < island_.free || carrier == no_body) return true;
    const double now = all_.clock_.now;
    const auto of_carrier = all_.bodies_.path(carrier).restarted(now);
    const auto of_body = all_.bodies_.path(island_.bodies[place]).restarted(now);
    for (std::size_t i = 1; i <= Motion::degree; ++i) {
      const Vector3d &x = of_carrier.coefficients[i], &y = of_body.coefficients[i];
      if (!(norm(x - y) <= rate_rounding * norm(x))) return false;
    }
    return true;
  }

  /// False if the paths would end nearer to each other than follows from the normals with which they were computed.
  bool turn_normals() {
    bool follow = true;
    for (const std::size_t k : bends_) {
      Contact& contact = this->contact(k);
      Touch& touch = touches_[k];
      const Vector3d way = displacement(touch, length);
      const SurfaceGap end = all_.gaps_.after(contact, way);
      const double expected = contact.gap + dot(touch.normal, way);
      follow = follow && end.width >= expected - cluster::tolerated * contact.room;
      contact.normal = normals_[k] + end.normal;
      contact.normal /= norm(contact.normal);
      touch.normal = contact.normal;
    }
    return follow;
  }

  RestingContacts& all_;
  Island& island_;
  std::vector<Touch>& touches_;
  std::vector<Vector3d> normals_;   ///< of contacts at the beginning of the span
  std::vector<std::size_t> bends_;  ///< contacts whose normals turn
  std::vector<double> at_least_;
  std::vector<char> proven_;
  double tolerance_ = never;  ///< of gaps at the end of the span, in units of length
};

}  // namespace kds::collision
