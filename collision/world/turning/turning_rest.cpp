#include "collision/world/turning/turning_rest.hpp"

#include "collision/motions.hpp"
#include "collision/narrow_phase/turning/point_rates.hpp"
#include "collision/vectors.hpp"
#include "collision/world/resting/resting_contacts.hpp"
#include "collision/world/turning/body_frame.hpp"
#include "collision/world/turning/rest_rules.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace kds::collision {

using Eigen::Vector3d;
using namespace turning_rest;

template <class Motion>
typename TurningRest<Motion>::Slot TurningRest<Motion>::find(BodySlot a, BodySlot b, int) const {
  if (resting_ == 0 || !(carries(a) || carries(b))) return none;
  const auto it = pairs_.find({a, b});
  return it != pairs_.end() && it->second.rests ? 0 : none;
}

template <class Motion>
typename TurningRest<Motion>::Pair& TurningRest<Motion>::pair(Key key) {
  const auto it = pairs_.find(key);
  if (it != pairs_.end()) return it->second;
  Pair& pair = list(key);
  note_linked(key.first, key.second);
  return pair;
}

/// A pair that there has not been.
template <class Motion>
typename TurningRest<Motion>::Pair& TurningRest<Motion>::list(Key key) {
  for (const auto& [slot, other] : {key, Key(key.second, key.first)}) {
    auto& others = member(slot).others;
    others.insert(std::lower_bound(others.begin(), others.end(), other, before()), other);
  }
  return pairs_[key];
}

template <class Motion>
void TurningRest<Motion>::unlist(Key key) {
  for (const auto& [slot, other] : {key, Key(key.second, key.first)}) {
    auto& others = of_[slot].others;
    others.erase(std::lower_bound(others.begin(), others.end(), other, before()));
  }
  pairs_.erase(key);
}

template <class Motion>
void TurningRest<Motion>::erase(Key key) {
  const auto it = pairs_.find(key);
  if (it->second.rests) {
    --resting_;
    listener_->tell_resting(false,
                            {.a = key.first, .b = key.second, .normal = it->second.normal, .point = it->second.point});
  }
  unlist(key);
  touch(key.first), touch(key.second);
}

template <class Motion>
void TurningRest<Motion>::erase_all(BodySlot slot) {
  while (!of_[slot].others.empty()) erase(bodies_.in_order(slot, of_[slot].others.back()));
}

/// Wakes all bodies of the group of one that rests.
template <class Motion>
void TurningRest<Motion>::wake(BodySlot slot) {
  if (shared_.is_shared(slot)) shared_.concern(island(slot));
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

/// Wakes only these, each of which rests; all others go on resting.
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
  note_struck(a, b);
  if (resting_ == 0 || !(carries(a) || carries(b))) return false;
  // What touches a resting body gently may come to lie on it. Until that is known the body goes on resting.
  const double g = scale({a, b}).acceleration;
  const std::optional<Carrier> carrier = common_carrier(a, b);
  const bool gentle = std::min(bodies_[a].restitution, bodies_[b].restitution) < 1 && !bodies_.fixed(a) &&
                      !bodies_.fixed(b) && carrier && calm(a, g, *carrier) && calm(b, g, *carrier);
  if (gentle) return false;
  if (carries(a) != carries(b) && !bodies_.fixed(a) && !bodies_.fixed(b)) return true;
  if (carries(a)) wake(a);
  if (carries(b)) wake(b);
  solve();
  return false;
}

template <class Motion>
std::vector<detail::Blow> TurningRest<Motion>::note_blow(const detail::Blow& blow) {
  blows_.note(blow, same_place * scale({blow.a, blow.b}).size);
  note_linked(blow.a, blow.b);
  return blows_.of_last([this](BodySlot slot) { return !bodies_.fixed(slot) && !carries(slot); });
}

template <class Motion>
void TurningRest<Motion>::drop_all(BodySlot slot) {
  blows_.forget(slot);
  if (slot >= of_.size()) return;
  if (shared_.is_shared(slot)) shared_.concern(island(slot));
  if (carries(slot)) wake(slot);
  const std::vector<BodySlot> others = of_[slot].others;  // which leave it when they wake
  for (const BodySlot other : others) {
    if (carries(other) && pairs_[bodies_.in_order(slot, other)].rests) wake(other);
  }
  erase_all(slot);
  of_[slot].since = never, of_[slot].looked = -never;
  touch(slot);
  std::erase(woken_, slot);  // it has a motion of its own
}

template <class Motion>
bool TurningRest<Motion>::drop_filtered(BodySlot slot) {
  blows_.forget(slot);
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
    const auto [a, b] = bodies_.in_order(slot, other);
    if (holds(a, b)) found.push_back(other);
  }
  return found;
}

template <class Motion>
void TurningRest<Motion>::solve() {
  std::vector<BodySlot> woken = std::exchange(woken_, {});
  std::sort(woken.begin(), woken.end(), before());
  for (const BodySlot slot : woken) {
    Motion motion = bodies_.motion(slot).restarted(clock_.now);
    if constexpr (Motion::degree >= 2) motion.path.coefficients[2] = bodies_.free_acceleration(slot);
    listener_->take_up(slot, motion);
  }
}

/// How what a body lies on moves; it stands still if the body lies on nothing that is known.
template <class Motion>
Carrier TurningRest<Motion>::carrier(BodySlot slot) const {
  return slot < of_.size() && !of_[slot].others.empty() ? of_[slot].carrier : Carrier{};
}

/// Half of the acceleration that a body has if nothing touches it, seen from what it lies on.
template <class Motion>
Vector3d TurningRest<Motion>::half_weight(BodySlot slot) const {
  return bodies_.free_acceleration(slot) - carrier(slot).half_acceleration;
}

/// The acceleration by which flights are as fast as they are: that of the weight, or seen from what the body lies on,
/// whichever is greater.
template <class Motion>
double TurningRest<Motion>::acceleration(BodySlot slot) const {
  return 2 * std::max(norm(bodies_.free_acceleration(slot)), norm(half_weight(slot)));
}

template <class Motion>
typename TurningRest<Motion>::Scale TurningRest<Motion>::scale(Key key) const {
  Scale scale;
  for (const BodySlot slot : {key.first, key.second}) {
    if (bodies_.fixed(slot)) continue;
    scale.acceleration = std::max(scale.acceleration, acceleration(slot));
    scale.size = std::min(scale.size, bodies_[slot].bounding_radius);
    scale.driven = std::max(
        scale.driven, driven_by_corners(bodies_[slot].shape, bodies_.motion(slot), half_weight(slot), clock_.now));
  }
  return scale;
}

/// How far from each other bodies may be that hold each other, in units of length.
template <class Motion>
double TurningRest<Motion>::holding_distance(const Scale& scale) const {
  const double flight = scale.driven * flight_;
  return std::min(scale.acceleration * flight * flight, largest_holding_distance * scale.size);
}

/// Up to which speed of its fastest point a body is calm.
template <class Motion>
double TurningRest<Motion>::calm_speed(const Scale& scale) const {
  return std::sqrt(calm_energy * scale.acceleration * holding_distance(scale));
}

/// How that moves what two bodies that touch lie on: the fixed one of them, and what the others lie on that have
/// touched something already. Nothing if these move differently, or if a fixed body turns, but for a half-space that
/// slides below what is carried by something else; it stands still if there are none.
template <class Motion>
std::optional<Carrier> TurningRest<Motion>::common_carrier(BodySlot a, BodySlot b) const {
  std::optional<Carrier> found;
  for (const BodySlot slot : {a, b}) {
    const bool fixed = bodies_.fixed(slot);
    if (!fixed && (slot >= of_.size() || of_[slot].others.empty())) continue;
    const std::optional<Carrier> carrier = fixed ? carrier_of(bodies_.motion(slot)) : of_[slot].carrier;
    if (!carrier) return std::nullopt;
    if (found && !(*found == *carrier)) {
      if (slides_under(slot, *found)) continue;
      if (!slides_under(a, *carrier)) return std::nullopt;
    }
    found = carrier;
  }
  return found ? found : Carrier{};
}

template <class Motion>
bool TurningRest<Motion>::calm(BodySlot slot, double acceleration, const Carrier& carrier) const {
  const Motion& motion = bodies_.motion(slot);
  if (bodies_.fixed(slot)) return stays_below(slot, carrier);
  const Scale scale{acceleration, bodies_[slot].bounding_radius,
                    driven_by_corners(bodies_[slot].shape, motion, half_weight(slot), clock_.now)};
  const auto others = slot < of_.size() ? static_cast<double>(of_[slot].others.size()) : 0;
  const double driven = std::clamp(others / calm_neighbours, 1.0, most_driven);
  const Vector3d velocity = carrier.velocity_at(clock_.now);
  return all_slower(motion, velocity, bodies_[slot].shape, scale.size, driven * calm_speed(scale), clock_.now);
}

template <class Motion>
void TurningRest<Motion>::note(Key key, const collision::Contact& contact, const Carrier& carrier) {
  const double t = clock_.now;
  const BodyFrame a(bodies_.motion(key.first), t), b(bodies_.motion(key.second), t);
  auto& places = pair(key).places;
  const Scale scale = this->scale(key);
  const double far = holding_distance(scale);
  const auto slip = this->slip(key, carrier);
  const auto at = [&](const detail::TouchedPlace& place) { return point_of(place, a, b, bodies_.fixed(key.first)); };
  std::erase_if(places, [&](const detail::TouchedPlace& place) {
    const Vector3d x = slip ? at(place) : a.out(place.on_a);
    const bool lasts = t - place.time <= memory * flight_ && apart(place, a, b, slip.has_value()) <= far;
    return !lasts ||
           (norm(x - contact.point) <= same_place * scale.size && dot(place.normal, contact.normal) >= same_side);
  });
  if (places.size() >= most_places) {
    const auto way = [&](const detail::TouchedPlace& place) {
      return norm((slip ? at(place) : a.out(place.on_a)) - contact.point);
    };
    places.erase(
        std::min_element(places.begin(), places.end(), [&](const auto& x, const auto& y) { return way(x) < way(y); }));
  }
  places.push_back({a.back(contact.point), b.back(contact.point), contact.normal, t});
}

template <class Motion>
bool TurningRest<Motion>::comes_to_rest(BodySlot a, BodySlot b, const collision::Contact& contact,
                                        const MobilityOf& mobility) {
  if constexpr (Motion::degree < 2) return false;  // nothing presses bodies together
  const double g = scale({a, b}).acceleration;
  const double t = clock_.now;
  const std::optional<Carrier> carrier = common_carrier(a, b);
  if (!(carrier && g > 0 && std::min(bodies_[a].restitution, bodies_[b].restitution) < 1 && calm(a, g, *carrier) &&
        calm(b, g, *carrier))) {
    for (const BodySlot slot : {a, b}) {
      if (slot >= of_.size() || bodies_.fixed(slot) || carries(slot)) continue;
      erase_all(slot);
      of_[slot].since = never;
    }
    return false;
  }
  note({a, b}, contact, *carrier);
  bool long_enough = true, patient = true;
  for (const BodySlot slot : {a, b}) {
    if (bodies_.fixed(slot) || carries(slot)) continue;
    Member& body = member(slot);
    body.carrier = *carrier;
    body.since = std::min(body.since, t);
    long_enough = long_enough && t - std::max(body.since, body.looked) >= calm_flights * flight_;
    patient = patient && t - body.since >= part_flights * flight_;
  }
  if (!long_enough) return false;
  const auto look = [&](BodySlot slot) {
    if (!bodies_.fixed(slot)) of_[slot].looked = t;
  };
  Group linked = find_group(bodies_.fixed(a) ? b : a);
  note_what_slides_on(linked, mobility);
  if (linked.any_busy() && !patient) {
    look(a), look(b);
    return false;
  }
  const Group held = held_part(linked, false);
  ++walks_;
  for (const BodySlot slot : held.bodies) of_[slot].seen = walks_;
  const auto stops = [&](BodySlot slot) { return bodies_.fixed(slot) || of_[slot].seen == walks_; };
  if (stops(a) != stops(b)) {  // It is put off where the other would move into the one that stops.
    const Motion motion_a = stops(a) ? carried_by(*carrier, bodies_.motion(a), t) : bodies_.motion(a);
    const Motion motion_b = stops(b) ? carried_by(*carrier, bodies_.motion(b), t) : bodies_.motion(b);
    const PointRates<Motion::degree> rates(motion_a, motion_b, t);
    if (dot(contact.normal, rates.velocity(contact.point)) < 0) {
      look(a), look(b);
      return false;
    }
  }
  std::vector<BodySlot> too_weak;  // to carry the others
  bool any = false;
  for (const BodySlot slot : linked.bodies) {
    const bool holds = of_[slot].seen == walks_;
    any = any || (holds && !carries(slot));
    if (holds) continue;
    of_[slot].looked = t;
    touch(slot);
    if (carries(slot)) too_weak.push_back(slot);
  }
  wake_only(too_weak);
  solve();
  if (!any) look(a), look(b);
  if (any) stop(held, contact, {a, b});
  return holds(a, b);
}

/// Whether a body rests, or has been calm for long enough; `acceleration` is the greatest of its group.
template <class Motion>
bool TurningRest<Motion>::ready(BodySlot slot, double acceleration) const {
  return of_[slot].rests ||
         (clock_.now - of_[slot].since >= calm_flights * flight_ && calm(slot, acceleration, of_[slot].carrier));
}

template <class Motion>
void TurningRest<Motion>::stop(const Group& group, const collision::Contact& contact, Key met) {
  const double t = clock_.now;
  for (const Key& key : group.pairs) {
    Pair& pair = pairs_[key];
    if (pair.rests) continue;
    const detail::TouchedPlace& place = pair.places.back();
    const BodyFrame a(bodies_.motion(key.first), t);
    pair.normal = place.normal;
    pair.point = (key == met ? contact.point : a.out(place.on_a)) - a.origin();
    pair.rests = true;
    ++resting_;
    touch(key.first), touch(key.second);
    listener_->tell_resting(true, {.a = key.first, .b = key.second, .normal = pair.normal, .point = pair.point});
  }
  for (const BodySlot slot : group.bodies) {
    if (carries(slot)) continue;
    const std::vector<BodySlot> others = of_[slot].others;
    for (const BodySlot other : others) {  // which it has left meanwhile
      const Key key = bodies_.in_order(slot, other);
      if (!pairs_[key].rests) erase(key);
    }
    of_[slot].rests = true;
    of_[slot].ignored = {};
    of_[slot].since = never;
    listener_->take_up(slot, carried_by(of_[slot].carrier, bodies_.motion(slot), t));
  }
}

#define KDS_INSTANTIATE(motion) template class TurningRest<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
