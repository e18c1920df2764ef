// Groups of bodies that rest, or may come to rest: which there are, what holds them, and which of them an impact moves.
#include "collision/motions.hpp"
#include "collision/narrow_phase/half_space_of.hpp"
#include "collision/vectors.hpp"
#include "collision/world/resting/resting_contacts.hpp"
#include "collision/world/turning/body_frame.hpp"
#include "collision/world/turning/rest_rules.hpp"
#include "collision/world/turning/turning_rest.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace kds::collision {

using Eigen::Vector3d;
using namespace turning_rest;

namespace {

/// The point at which a ball that touches at x is pressed: with rolling friction the point nearest to where its weight
/// acts, up to that length from x.
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
bool TurningRest<Motion>::strike(BodySlot a, const Vector3d& turn_a, BodySlot b, const Vector3d& turn_b,
                                 const Vector3d& impulse, const MobilityOf& mobility) {
  const BodySlot struck = carries(a) ? a : b;
  const auto moved = [&](BodySlot slot) {
    const Scale scale{acceleration(slot), bodies_[slot].bounding_radius};
    return StruckBody{.mobility = mobility(slot), .size = scale.size, .still_speed = calm_speed(scale)};
  };
  Ignored& ignored = of_[struck].ignored;
  if (clock_.now - ignored.since > ignored_flights * flight_) ignored = {.since = clock_.now};
  StruckBody alone = moved(struck);
  ignored.velocity += (struck == b ? 1 : -1) * alone.mobility.inverse_mass * impulse;
  ignored.angular_velocity += alone.mobility.turned_by(struck == b ? turn_b : turn_a);
  alone.velocity = {ignored.velocity, ignored.angular_velocity};
  if (alone.still()) return false;
  const Group group = find_group(struck, true);
  std::vector<StruckBody> bodies{alone};
  for (std::size_t i = 1; i < group.bodies.size(); ++i) bodies.push_back(moved(group.bodies[i]));
  // Since the last small impulse the weights have pressed the bodies on each other, so friction can hold more small
  // impulses.
  const double meanwhile = std::min(clock_.now - of_[struck].ignored.since, calm_flights * flight_);
  for (std::size_t i = 0; i < bodies.size(); ++i)
    bodies[i].velocity.velocity += meanwhile * group.loads[i].acceleration;
  if (takes_impact(bodies, group.footholds)) {
    of_[struck].ignored = {clock_.now, bodies[0].velocity.velocity, bodies[0].velocity.angular_velocity};
    return false;
  }
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
  return !woken.empty();
}

/// Whether two bodies that touch without friction slide on each other, or turn about the normal. The velocities of the
/// whole bodies count, since the corners of a body that rocks slide to and fro; and on what slides below it, `away`,
/// how it moves besides.
template <class Motion>
bool TurningRest<Motion>::slides(Key key, const Vector3d& normal, const std::optional<Vector3d>& away) const {
  const Motion& a = bodies_.motion(key.first);
  const Motion& b = bodies_.motion(key.second);
  const Scale scale = this->scale(key);
  Vector3d way = a.path.velocity(clock_.now) - b.path.velocity(clock_.now);
  if (away) way += *away;
  const double turn = dot(a.angular_velocity - b.angular_velocity, normal);
  const double slip = norm(way - dot(way, normal) * normal) + std::abs(turn) * scale.size;
  return slip > smooth_slip * calm_speed(scale);
}

/// Of bodies that slide without friction those are busy that would slide on, too, if the weights of all pressed them on
/// what they touch.
template <class Motion>
void TurningRest<Motion>::note_what_slides_on(Group& group, const MobilityOf& mobility) const {
  if (group.sliding.empty()) return;
  std::vector<StruckBody> bodies;
  for (std::size_t i = 0; i < group.bodies.size(); ++i) {
    const BodySlot slot = group.bodies[i];
    const Motion& motion = bodies_.motion(slot);
    const Scale scale{acceleration(slot), bodies_[slot].bounding_radius};
    const Vector3d velocity = motion.path.velocity(clock_.now) - carrier(slot).velocity_at(clock_.now);
    bodies.push_back({.mobility = mobility(slot),
                      .velocity = {velocity + calm_flights * flight_ * group.loads[i].acceleration,  //
                                   motion.angular_velocity},
                      .size = scale.size,
                      .still_speed = smooth_slip * calm_speed(scale)});
  }
  takes_impact(bodies, group.footholds);
  for (const std::uint32_t place : group.sliding) group.busy[place] = group.busy[place] || !bodies[place].still();
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

/// Bodies that are farthest from balance are left out until what is left is in balance: first those that do not rest
/// yet. Of what rests those are left out that cannot carry one that is left out. A body that leans on a busy one,
/// directly or through others that are left out, may be out of balance for that reason alone. So when it is left out,
/// the resting bodies that it touches stay.
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

/// The velocity with which a fixed body slides below what is carried, if it is a half-space that does so.
template <class Motion>
std::optional<Vector3d> TurningRest<Motion>::slides_under(BodySlot slot, const Carrier& carrier) const {
  if (!bodies_.fixed(slot) || !bodies_.unbounded(slot)) return std::nullopt;
  const Motion& motion = bodies_.motion(slot);
  return turning_rest::slides_under(carrier, half_space_of(*bodies_[slot].shape, motion), motion);
}

/// Whether a fixed body can bear for good what is carried, moving with the carrier or sliding below.
template <class Motion>
bool TurningRest<Motion>::stays_below(BodySlot slot, const Carrier& carrier) const {
  return moves_with(bodies_.motion(slot), carrier) || slides_under(slot, carrier);
}

/// The velocity of the second of two bodies, seen from the first, where one is carried and the other slides below it.
template <class Motion>
std::optional<Vector3d> TurningRest<Motion>::slip(Key key, const Carrier& carrier) const {
  if (bodies_.fixed(key.second)) return slides_under(key.second, carrier);
  auto found = slides_under(key.first, carrier);
  if (found) *found = -*found;
  return found;
}

/// The group of a body: all bodies that are linked with it by places where they touch, and the forces that are possible
/// at these places.
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
    Load load{.mass = bodies_[slot].mass, .size = bodies_[slot].bounding_radius, .acceleration = 2 * half_weight(slot)};
    group.loads.push_back(load);
    for (const BodySlot other : of_[slot].others) {
      const Key key = bodies_.in_order(slot, other);
      if (!bodies_.fixed(other) && of_[other].seen == walks_ && of_[other].place < i) continue;
      if (resting && !pairs_[key].rests) continue;
      const BodyFrame a(bodies_.motion(key.first), t), b(bodies_.motion(key.second), t);
      const double far = holding_distance(scale(key));
      const double friction = std::min(bodies_[key.first].friction, bodies_[key.second].friction);
      const bool smooth =
          std::min(bodies_[key.first].tangential_restitution, bodies_[key.second].tangential_restitution) == -1;
      const double rolling = std::min(bodies_[key.first].rolling_friction, bodies_[key.second].rolling_friction);
      const bool rests = pairs_[key].rests;
      const auto slip = this->slip(key, of_[slot].carrier);
      bool links = false;
      for (const detail::TouchedPlace& place : pairs_[key].places) {
        const Vector3d on_a = a.out(place.on_a), on_b = b.out(place.on_b);
        if (!rests && (t - place.time > memory * flight_ || apart(place, a, b, slip.has_value()) > far)) continue;
        if (!std::exchange(links, true) && !bodies_.fixed(other)) visit(other);
        const auto list = [&](std::vector<std::uint32_t>& places) {
          places.push_back(of_[slot].place);
          if (!bodies_.fixed(other)) places.push_back(of_[other].place);
        };
        if (!rests && bodies_.fixed(other) && !stays_below(other, of_[slot].carrier)) list(busy);
        if (!rests && (friction == 0 || smooth) && slides(key, place.normal, slip)) list(group.sliding);
        Vector3d x = slip ? point_of(place, a, b, bodies_.fixed(key.first)) : Vector3d(0.5 * (on_a + on_b));
        for (const auto& [slot_of, frame] : {std::pair<BodySlot, const BodyFrame&>{key.first, a}, {key.second, b}}) {
          if (slip || bodies_.fixed(slot_of) || !(bodies_.mover(slot_of).radius > 0)) continue;
          x = pressed_at(x, frame.origin(), half_weight(slot_of), place.normal, rolling);
          break;
        }
        group.footholds.push_back({.a = place_of(key.first),
                                   .b = place_of(key.second),
                                   .arm_a = x - a.origin(),
                                   .arm_b = x - b.origin(),
                                   .normal = place.normal,
                                   .friction = smooth ? 0 : friction,
                                   .pull = slip ? Vector3d(-*slip / norm(*slip)) : Vector3d(Vector3d::Zero())});
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

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class TurningRest<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
