#include "collision/world/turning/turning_rest.hpp"

#include "certificates/turning/turned_orientation.hpp"
#include "collision/motions.hpp"
#include "collision/vectors.hpp"
#include "collision/world/resting_contacts.hpp"
#include "collision/world/turning/rest_rules.hpp"
#include "kds/audit.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace kds::collision {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using namespace turning_rest;

namespace {

/// Where a body is at a time.
class Frame {
 public:
  template <class Motion>
  Frame(const Motion& motion, double t)
      : origin_(motion.path.position(t)),
        turn_(certificates::turned_orientation(motion.orientation, motion.spin(), t)),
        length_(dot(turn_.vec(), turn_.vec()) + turn_.w() * turn_.w()) {}

  const Vector3d& origin() const { return origin_; }
  Vector3d out(const Vector3d& x) const { return origin_ + turned(x, turn_.w()); }
  Vector3d back(const Vector3d& x) const { return turned(x - origin_, -turn_.w()); }

 private:
  /// q x q^-1 = x + 2 v x (v x x + w x) / |q|^2, for q = (w, v).
  Vector3d turned(const Vector3d& x, double w) const {
    const Vector3d v = turn_.vec();
    const Vector3d turn = cross(v, x) + w * x;
    return x + (2 / length_) * cross(v, turn);
  }

  Vector3d origin_;
  Quaterniond turn_;
  double length_;
};

template <class Motion>
double surface_speed(const Motion& motion, double radius, double t) {
  return norm(motion.path.velocity(t)) + norm(motion.angular_velocity) * radius;
}

template <class Motion>
bool stands(const Motion& motion) {
  const auto& path = motion.path.coefficients;
  return motion.angular_velocity.isZero(0) &&
         std::all_of(path.begin() + 1, path.end(), [](const Vector3d& x) { return x.isZero(0); });
}

template <class Motion>
Motion stopped(const Motion& motion, double t) {
  Motion result = motion.restarted(t);
  auto& path = result.path.coefficients;
  std::fill(path.begin() + 1, path.end(), Vector3d::Zero());
  result.angular_velocity = Vector3d::Zero();
  return result;
}

/// Where a ball is pressed that touches at x: with rolling friction up to that far from there, to where its weight acts.
Vector3d pressed_at(const Vector3d& x, const Vector3d& centre, const Vector3d& weight, const Vector3d& normal,
                    double rolling) {
  const double along = dot(normal, weight);
  if (rolling == 0 || along == 0) return x;
  const Vector3d below = centre + (dot(normal, x - centre) / along) * weight;
  const double way = norm(below - x);
  return way <= rolling ? below : Vector3d(x + (rolling / way) * (below - x));
}

}  // namespace

template <class Motion>
typename TurningRest<Motion>::Slot TurningRest<Motion>::find(BodySlot a, BodySlot b, int) const {
  if (resting_ == 0 || !(carries(a) || carries(b))) return none;
  const auto it = pairs_.find({a, b});
  return it != pairs_.end() && it->second.rests ? 0 : none;
}

template <class Motion>
typename TurningRest<Motion>::Pair& TurningRest<Motion>::pair(Key key) {
  const auto [it, is_new] = pairs_.try_emplace(key);
  if (is_new) {
    const auto list = [this](BodySlot slot, BodySlot other) {
      auto& others = member(slot).others;
      others.insert(std::lower_bound(others.begin(), others.end(), other), other);
    };
    list(key.first, key.second), list(key.second, key.first);
  }
  return it->second;
}

template <class Motion>
void TurningRest<Motion>::erase(Key key) {
  const auto it = pairs_.find(key);
  if (it->second.rests) {
    --resting_;
    listener_.tell_resting(false,
                           {.a = key.first, .b = key.second, .normal = it->second.normal, .point = it->second.point});
  }
  pairs_.erase(it);
  const auto unlist = [this](BodySlot slot, BodySlot other) {
    auto& others = of_[slot].others;
    others.erase(std::lower_bound(others.begin(), others.end(), other));
  };
  unlist(key.first, key.second), unlist(key.second, key.first);
}

template <class Motion>
void TurningRest<Motion>::erase_all(BodySlot slot) {
  while (!of_[slot].others.empty()) erase(std::minmax(slot, of_[slot].others.back()));
}

/// All bodies of the group of one that rests.
template <class Motion>
void TurningRest<Motion>::wake(BodySlot slot) {
  std::vector<BodySlot> group{slot};
  of_[slot].rests = false;
  for (std::size_t i = 0; i < group.size(); ++i) {
    woken_.push_back(group[i]);
    for (const BodySlot other : of_[group[i]].others) {
      if (std::exchange(of_[other].rests, false)) group.push_back(other);
    }
    erase_all(group[i]);
    of_[group[i]].since = never;
  }
}

/// Only these, each of which rests: what is left rests on.
template <class Motion>
void TurningRest<Motion>::wake_only(std::span<const BodySlot> slots) {
  for (const BodySlot slot : slots) {
    of_[slot].rests = false;
    of_[slot].since = never;
    woken_.push_back(slot);
    erase_all(slot);
  }
}

template <class Motion>
bool TurningRest<Motion>::meet(BodySlot a, BodySlot b) {
  if (resting_ == 0 || !(carries(a) || carries(b))) return false;
  // What touches it gently is to lie on it, perhaps: until that is known it stays as it is.
  const bool gentle = std::min(bodies_[a].restitution, bodies_[b].restitution) < 1 &&
                      (carries(a) || !bodies_.fixed(a)) && (carries(b) || !bodies_.fixed(b)) &&
                      calm(a, scale({a, b}).acceleration) && calm(b, scale({a, b}).acceleration);
  if (gentle) return false;
  if (carries(a) != carries(b) && !bodies_.fixed(a) && !bodies_.fixed(b)) return true;
  if (carries(a)) wake(a);
  if (carries(b)) wake(b);
  solve();
  return false;
}

template <class Motion>
void TurningRest<Motion>::strike(BodySlot a, const Vector3d& turn_a, BodySlot b, const Vector3d& turn_b,
                                 const Vector3d& impulse, const MobilityOf& mobility) {
  const BodySlot struck = carries(a) ? a : b;
  const auto moved = [&](BodySlot slot) {
    const Scale scale{acceleration(slot), bodies_[slot].bounding_radius};
    return StruckBody{.mobility = mobility(slot), .size = scale.size, .still_speed = calm_speed(scale)};
  };
  StruckBody alone = moved(struck);
  alone.velocity = {(struck == b ? 1 : -1) * alone.mobility.inverse_mass * impulse,
                    alone.mobility.turned_by(struck == b ? turn_b : turn_a)};
  if (alone.still()) return;
  const Group group = find_group(struck, true);
  std::vector<StruckBody> bodies{alone};
  for (std::size_t i = 1; i < group.bodies.size(); ++i) bodies.push_back(moved(group.bodies[i]));
  if (takes_impact(bodies, group.footholds)) return;
  std::vector<char> moves(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) moves[i] = i == 0 || !bodies[i].still();
  const Group left = held_part(without(group, std::move(moves)), true);
  ++walks_;
  for (const BodySlot slot : left.bodies) of_[slot].seen = walks_;
  std::vector<BodySlot> woken;
  for (const BodySlot slot : group.bodies) {
    if (of_[slot].seen != walks_) woken.push_back(slot);
  }
  wake_only(woken);
  solve();
}

template <class Motion>
bool TurningRest<Motion>::Group::any_busy() const {
  return std::any_of(busy.begin(), busy.end(), [](char is) { return is != 0; });
}

template <class Motion>
typename TurningRest<Motion>::Group TurningRest<Motion>::without(const Group& group, std::vector<char> out) {
  std::vector<std::size_t> touches(group.bodies.size());
  const auto stays = [&](const Foothold& at) {
    return (at.a == Foothold::fixed || !out[at.a]) && (at.b == Foothold::fixed || !out[at.b]);
  };
  bool more = true;
  while (more) {
    std::fill(touches.begin(), touches.end(), 0);
    for (const Foothold& at : group.footholds) {
      if (!stays(at)) continue;
      if (at.a != Foothold::fixed) ++touches[at.a];
      if (at.b != Foothold::fixed) ++touches[at.b];
    }
    more = false;
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (!out[i] && touches[i] == 0) out[i] = 1, more = true;
    }
  }
  Group left;
  std::vector<std::uint32_t> place(group.bodies.size(), Foothold::fixed);
  for (std::size_t i = 0; i < group.bodies.size(); ++i) {
    if (out[i]) continue;
    place[i] = static_cast<std::uint32_t>(left.bodies.size());
    left.bodies.push_back(group.bodies[i]), left.loads.push_back(group.loads[i]), left.busy.push_back(group.busy[i]);
    left.leans.push_back(group.leans[i]);
  }
  for (std::size_t k = 0; k < group.footholds.size(); ++k) {
    Foothold at = group.footholds[k];
    if (!stays(at)) continue;
    if (at.a != Foothold::fixed) at.a = place[at.a];
    if (at.b != Foothold::fixed) at.b = place[at.b];
    left.footholds.push_back(at), left.pairs.push_back(group.pairs[k]);
  }
  return left;
}

/// Bodies that are farthest from balance are left out until what is left is in balance: first those that do not rest yet.
/// Of what rests those are left out that cannot carry one that is left out. One that leans on a busy body, or on one
/// that is left out and does so, says nothing of what else it touches.
template <class Motion>
typename TurningRest<Motion>::Group TurningRest<Motion>::held_part(Group group, bool removed) const {
  const auto leave = [&](std::vector<char> out) {
    for (bool more = true; more;) {
      more = false;
      for (const Foothold& at : group.footholds) {
        if (at.a == Foothold::fixed || at.b == Foothold::fixed) continue;
        for (const auto& [gone, other] : {std::pair(at.a, at.b), std::pair(at.b, at.a)}) {
          const bool goes = out[gone] && !of_[group.bodies[gone]].rests && (group.busy[gone] || group.leans[gone]);
          if (goes && !std::exchange(group.leans[other], char{1})) more = true;
        }
      }
    }
    group = without(group, std::move(out));
  };
  leave(group.busy);
  std::vector<double> left;
  char weak = 0;  // whether something that rests has been left out
  while (!group.bodies.empty() && !balanced(group.loads, group.footholds, &left)) {
    const auto rests = [&](std::size_t i) { return of_[group.bodies[i]].rests; };
    bool all_rest = true;
    for (std::size_t i = 0; i < left.size(); ++i) all_rest = all_rest && rests(i);
    if (all_rest && !removed && weak == 0) return group;  // it has been in balance before
    double most = 0;
    for (std::size_t i = 0; i < left.size(); ++i) {
      if (all_rest || !rests(i)) most = std::max(most, left[i]);
    }
    std::vector<char> out(left.size());
    for (std::size_t i = 0; i < left.size(); ++i) out[i] = (all_rest || !rests(i)) && left[i] >= unheld_part * most;
    for (const Foothold& at : group.footholds) {
      if (at.a == Foothold::fixed || at.b == Foothold::fixed) continue;
      for (const auto& [gone, other] : {std::pair(at.a, at.b), std::pair(at.b, at.a)}) {
        const bool tells = out[gone] && !rests(gone) && !group.leans[gone];
        if (tells && rests(other) && left[other] > weak_part) out[other] = weak = 1;
      }
    }
    leave(std::move(out));
  }
  return group;
}

template <class Motion>
void TurningRest<Motion>::drop_all(BodySlot slot) {
  if (slot >= of_.size()) return;
  if (carries(slot)) wake(slot);
  const std::vector<BodySlot> others = of_[slot].others;  // which leave it when they wake
  for (const BodySlot other : others) {
    if (carries(other) && pairs_[std::minmax(slot, other)].rests) wake(other);
  }
  erase_all(slot);
  of_[slot].since = never, of_[slot].looked = -never;
  std::erase(woken_, slot);  // it has a motion of its own
}

template <class Motion>
bool TurningRest<Motion>::drop_filtered(BodySlot slot) {
  if (slot >= of_.size()) return false;
  const auto& others = of_[slot].others;
  const auto over = [&](BodySlot other) { return !bodies_.may_collide(slot, other); };
  if (std::none_of(others.begin(), others.end(), over)) return false;
  drop_all(slot);
  return true;
}

template <class Motion>
std::vector<BodySlot> TurningRest<Motion>::partners(BodySlot slot) const {
  std::vector<BodySlot> found;
  if (slot >= of_.size()) return found;
  for (const BodySlot other : of_[slot].others) {
    if (holds(std::min(slot, other), std::max(slot, other))) found.push_back(other);
  }
  return found;
}

template <class Motion>
void TurningRest<Motion>::solve() {
  std::vector<BodySlot> woken = std::exchange(woken_, {});
  std::sort(woken.begin(), woken.end());
  for (const BodySlot slot : woken) {
    Motion motion = bodies_.motion(slot).restarted(clock_.now);
    if constexpr (Motion::degree >= 2) motion.path.coefficients[2] = bodies_.free_acceleration(slot);
    listener_.take_up(slot, motion);
  }
}

/// The magnitude of the acceleration that a body has if nothing touches it.
template <class Motion>
double TurningRest<Motion>::acceleration(BodySlot slot) const {
  return 2 * norm(bodies_.free_acceleration(slot));
}

template <class Motion>
typename TurningRest<Motion>::Scale TurningRest<Motion>::scale(Key key) const {
  Scale scale;
  for (const BodySlot slot : {key.first, key.second}) {
    if (bodies_.fixed(slot)) continue;
    scale.acceleration = std::max(scale.acceleration, acceleration(slot));
    scale.size = std::min(scale.size, bodies_[slot].bounding_radius);
  }
  return scale;
}

/// How far from each other bodies may be that hold each other, in units of length.
template <class Motion>
double TurningRest<Motion>::reach(const Scale& scale) const {
  return std::min(scale.acceleration * flight_ * flight_, largest_reach * scale.size);
}

/// Up to which speed of its fastest point a body is calm.
template <class Motion>
double TurningRest<Motion>::calm_speed(const Scale& scale) const {
  return std::sqrt(calm_energy * scale.acceleration * reach(scale));
}

template <class Motion>
bool TurningRest<Motion>::calm(BodySlot slot, double acceleration) const {
  const Motion& motion = bodies_.motion(slot);
  if (bodies_.fixed(slot)) return stands(motion);
  const Scale scale{acceleration, bodies_[slot].bounding_radius};
  return surface_speed(motion, scale.size, clock_.now) <= calm_speed(scale);
}

/// Whether two bodies that touch without friction slide on each other, or turn about the normal: as wholes, for the
/// corners of a body that rocks slide to and fro.
template <class Motion>
bool TurningRest<Motion>::slides(Key key, const Vector3d& normal) const {
  const Motion& a = bodies_.motion(key.first);
  const Motion& b = bodies_.motion(key.second);
  const Scale scale = this->scale(key);
  const Vector3d way = a.path.velocity(clock_.now) - b.path.velocity(clock_.now);
  const double turn = dot(a.angular_velocity - b.angular_velocity, normal);
  const double slip = norm(way - dot(way, normal) * normal) + std::abs(turn) * scale.size;
  return slip > smooth_slip * calm_speed(scale);
}

template <class Motion>
void TurningRest<Motion>::note(Key key, const collision::Contact& contact) {
  const double t = clock_.now;
  const Frame a(bodies_.motion(key.first), t), b(bodies_.motion(key.second), t);
  auto& places = pair(key).places;
  const Scale scale = this->scale(key);
  const double far = reach(scale);
  std::erase_if(places, [&](const detail::TouchedPlace& place) {
    const Vector3d x = a.out(place.on_a);
    const bool lasts = t - place.time <= memory * flight_ && norm(b.out(place.on_b) - x) <= far;
    return !lasts ||
           (norm(x - contact.point) <= same_place * scale.size && dot(place.normal, contact.normal) >= same_side);
  });
  if (places.size() >= most_places) places.erase(places.begin());
  places.push_back({a.back(contact.point), b.back(contact.point), contact.normal, t});
}

template <class Motion>
bool TurningRest<Motion>::comes_to_rest(BodySlot a, BodySlot b, const collision::Contact& contact) {
  if constexpr (Motion::degree < 2) return false;  // nothing presses bodies together
  const double g = scale({a, b}).acceleration;
  const double t = clock_.now;
  if (!(g > 0 && std::min(bodies_[a].restitution, bodies_[b].restitution) < 1 && calm(a, g) && calm(b, g))) {
    for (const BodySlot slot : {a, b}) {
      if (slot >= of_.size() || bodies_.fixed(slot) || carries(slot)) continue;
      erase_all(slot);
      of_[slot].since = never;
    }
    return false;
  }
  note({a, b}, contact);
  bool long_enough = true, patient = true;
  for (const BodySlot slot : {a, b}) {
    if (bodies_.fixed(slot) || carries(slot)) continue;
    Member& body = member(slot);
    body.since = std::min(body.since, t);
    long_enough = long_enough && t - std::max(body.since, body.looked) >= calm_flights * flight_;
    patient = patient && t - body.since >= part_flights * flight_;
  }
  if (!long_enough) return false;
  const auto look = [&](BodySlot slot) {
    if (!bodies_.fixed(slot)) of_[slot].looked = t;
  };
  const Group linked = find_group(bodies_.fixed(a) ? b : a);
  if (linked.any_busy() && !patient) {
    look(a), look(b);
    return false;
  }
  const Group held = held_part(linked, false);
  ++walks_;
  for (const BodySlot slot : held.bodies) of_[slot].seen = walks_;
  std::vector<BodySlot> too_weak;  // to carry the others
  bool any = false;
  for (const BodySlot slot : linked.bodies) {
    const bool holds = of_[slot].seen == walks_;
    any = any || (holds && !carries(slot));
    if (holds) continue;
    of_[slot].looked = t;
    if (carries(slot)) too_weak.push_back(slot);
  }
  wake_only(too_weak);
  solve();
  if (!any) look(a), look(b);
  if (any) stop(held, contact, {a, b});
  return holds(a, b);
}

/// The bodies that are linked with one by places where they touch, and the forces that these can give.
template <class Motion>
typename TurningRest<Motion>::Group TurningRest<Motion>::find_group(BodySlot first, bool resting) {
  const double t = clock_.now;
  Group group;
  ++walks_;
  const auto visit = [&](BodySlot slot) {
    if (std::exchange(of_[slot].seen, walks_) == walks_) return;
    of_[slot].place = static_cast<std::uint32_t>(group.bodies.size());
    group.bodies.push_back(slot);
  };
  const auto place_of = [&](BodySlot slot) { return bodies_.fixed(slot) ? Foothold::fixed : of_[slot].place; };
  std::vector<std::uint32_t> busy;
  visit(first);
  for (std::size_t i = 0; i < group.bodies.size(); ++i) {
    const BodySlot slot = group.bodies[i];
    Load load{.mass = bodies_[slot].mass,
              .size = bodies_[slot].bounding_radius,
              .acceleration = 2 * bodies_.free_acceleration(slot)};
    group.loads.push_back(load);
    for (const BodySlot other : of_[slot].others) {
      const Key key = std::minmax(slot, other);
      if (!bodies_.fixed(other) && of_[other].seen == walks_ && of_[other].place < i) continue;
      if (resting && !pairs_[key].rests) continue;
      const Frame a(bodies_.motion(key.first), t), b(bodies_.motion(key.second), t);
      const double far = reach(scale(key));
      const double friction = std::min(bodies_[key.first].friction, bodies_[key.second].friction);
      const bool smooth =
          std::min(bodies_[key.first].tangential_restitution, bodies_[key.second].tangential_restitution) == -1;
      const double rolling = std::min(bodies_[key.first].rolling_friction, bodies_[key.second].rolling_friction);
      const bool rests = pairs_[key].rests;
      bool links = false;
      for (const detail::TouchedPlace& place : pairs_[key].places) {
        const Vector3d on_a = a.out(place.on_a), on_b = b.out(place.on_b);
        if (!rests && (t - place.time > memory * flight_ || norm(on_b - on_a) > far)) continue;
        if (!std::exchange(links, true) && !bodies_.fixed(other)) visit(other);
        if (!rests && (((friction == 0 || smooth) && slides(key, place.normal)) ||
                       (bodies_.fixed(other) && !stands(bodies_.motion(other))))) {
          busy.push_back(of_[slot].place);
          if (!bodies_.fixed(other)) busy.push_back(of_[other].place);
        }
        Vector3d x = 0.5 * (on_a + on_b);
        for (const auto& [slot_of, frame] : {std::pair<BodySlot, const Frame&>{key.first, a}, {key.second, b}}) {
          if (bodies_.fixed(slot_of) || !(bodies_.mover(slot_of).radius > 0)) continue;
          x = pressed_at(x, frame.origin(), bodies_.free_acceleration(slot_of), place.normal, rolling);
          break;
        }
        group.footholds.push_back({.a = place_of(key.first),
                                   .b = place_of(key.second),
                                   .arm_a = x - a.origin(),
                                   .arm_b = x - b.origin(),
                                   .normal = place.normal,
                                   .friction = smooth ? 0 : friction});
        group.pairs.push_back(key);
      }
    }
  }
  double g = 0;
  for (const BodySlot slot : group.bodies) g = std::max(g, acceleration(slot));
  for (const BodySlot slot : group.bodies) group.busy.push_back(!ready(slot, g));
  for (const std::uint32_t place : busy) group.busy[place] = 1;
  group.leans.resize(group.bodies.size());
  return group;
}

/// Whether a body rests, or has been calm for long enough; `acceleration` is the greatest of its group.
template <class Motion>
bool TurningRest<Motion>::ready(BodySlot slot, double acceleration) const {
  return of_[slot].rests || (clock_.now - of_[slot].since >= calm_flights * flight_ && calm(slot, acceleration));
}

template <class Motion>
void TurningRest<Motion>::stop(const Group& group, const collision::Contact& contact, Key met) {
  const double t = clock_.now;
  for (const Key& key : group.pairs) {
    Pair& pair = pairs_[key];
    if (pair.rests) continue;
    const detail::TouchedPlace& place = pair.places.back();
    const Frame a(bodies_.motion(key.first), t);
    pair.normal = place.normal;
    pair.point = (key == met ? contact.point : a.out(place.on_a)) - a.origin();
    pair.rests = true;
    ++resting_;
    listener_.tell_resting(true, {.a = key.first, .b = key.second, .normal = pair.normal, .point = pair.point});
  }
  for (const BodySlot slot : group.bodies) {
    if (carries(slot)) continue;
    const std::vector<BodySlot> others = of_[slot].others;
    for (const BodySlot other : others) {  // which it has left meanwhile
      const Key key = std::minmax(slot, other);
      if (!pairs_[key].rests) erase(key);
    }
    of_[slot].rests = true;
    of_[slot].since = never;
    listener_.take_up(slot, stopped(bodies_.motion(slot), t));
  }
}

template <class Motion>
void TurningRest<Motion>::audit(double, bool) const {
  const auto need = [&](bool right, BodySlot slot, const char* what) {
    if (!right) throw AuditFailure("World: body " + std::to_string(bodies_.id_of(slot)) + ": " + what);
  };
  std::size_t resting = 0;
  for (const auto& [key, pair] : pairs_) {
    for (const BodySlot slot : {key.first, key.second}) {
      need(bodies_.entered(slot), slot, "it rests on another, and is not there");
      need(!pair.rests || stands(bodies_.motion(slot)), slot, "it rests, and moves");
      need(!pair.rests || of_[slot].rests || bodies_.fixed(slot), slot, "it rests on another, and is awake");
    }
    resting += pair.rests;
  }
  for (BodySlot slot = 0; slot < of_.size(); ++slot) {
    if (!of_[slot].rests) continue;
    const auto& others = of_[slot].others;
    need(bodies_.entered(slot) && !bodies_.fixed(slot), slot, "it rests, and is not there");
    need(!others.empty(), slot, "it rests on nothing");
  }
  if (resting != resting_) throw AuditFailure("World: pairs that rest are miscounted");
}

#define KDS_INSTANTIATE(motion) template class TurningRest<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
