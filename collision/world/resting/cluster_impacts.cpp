// Impacts on clusters: a body that is struck passes the impact on, at once, to all bodies that lean on it.
#include "collision/motions.hpp"
#include "collision/vectors.hpp"
#include "collision/world/resting/cluster_rules.hpp"
#include "collision/world/resting/resting_contacts.hpp"

#include <algorithm>
#include <deque>
#include <utility>
#include <vector>

namespace kds::collision {
namespace {

using Eigen::Vector3d;
using namespace cluster;

/// Over-relaxation: more than the missing push is added, since neighbours take some of it away again. Measured: the
/// fewest visits for heaps of balls; 1 takes a third more.
constexpr double over_relaxation = 1.2;
/// How exactly the contact that is struck is solved, compared with those elsewhere.
constexpr double struck_precision = 0x1p-8;

}  // namespace

/// The bodies and contacts that an impact affects, one after the other, beginning where it happens: solved by sweeps
/// [Cryer71] over those whose bodies have changed.
template <class Motion>
class RestingContacts<Motion>::Neighbourhood {
 public:
  /// Begins with a contact, which may be a resting one. `least`: the rate at which it is to part. `span`: s, for bodies
  /// in no cluster.
  Neighbourhood(RestingContacts& all, const Contact& struck, Slot slot, double least, double span)
      : all_(all), span_(span) {
    ++all_.islands_;
    add_body(no_body);
    if (slot != none) {
      Contact& contact = all_.contacts_[slot];
      contact.seen = all_.islands_;
      contact.place = 0;
      if (all_.gaps_.concave(contact)) {  // They touch, or overlap by some roundings.
        contact.gap = std::min(all_.gaps_.along_normal(contact), 0.0);
        contact.since = all_.clock_.now;
        contact.aim = contact.gap - closing(contact, contact.gap);
      }
    }
    add_touch(struck, slot, least);
  }

  /// Solves for velocities; those before the impact were allowed by all other contacts.
  bool solve_velocities(double restitution) {
    const bool solved = solve(velocities, Order::velocities);
    if (restitution == 0) return solved;
    for (std::size_t i = 0; i < velocities.size(); ++i) velocities[i] += restitution * (velocities[i] - before_[i]);
    touches_[0].least = 0;
    for (Touch& touch : touches_) touch.push = 0;
    wait_for_all();
    return solve(velocities, Order::velocities) && solved;
  }

  /// Solves for half the accelerations of all bodies that are affected and in clusters.
  bool solve_accelerations() {
    const std::size_t reached = touches_.size();
    for (std::size_t i = 0; i < reached; ++i) prepare(i);
    for (std::size_t i = 0; i < reached; ++i) {
      if (!turned_[i]) continue;
      look_at(touches_[i].a, Order::accelerations);
      look_at(touches_[i].b, Order::accelerations);
    }
    wait_for_all();
    const bool solved = solve(halves, Order::accelerations);
    for (std::size_t i = 0; i < touches_.size(); ++i) {
      if (slots_[i] == none) continue;
      Contact& contact = all_.contacts_[slots_[i]];
      contact.push = touches_[i].push;
      const double rate = parting_rate(velocities, touches_[i]);
      all_.set_proven(contact, all_.gaps_.proven(contact, rate, parting_rate(halves, touches_[i]), spans_[i]));
    }
    return solved;
  }

  std::vector<BodySlot> bodies;  ///< the first stands for the walls
  std::vector<Vector3d> velocities;
  std::vector<Vector3d> halves;

 private:
  enum class Order { velocities, accelerations };

  std::uint32_t add_body(BodySlot id) {
    if (id == no_body && !bodies.empty()) return 0;
    if (id != no_body) {
      Member& member = all_.member(id);
      if (std::exchange(member.island, all_.islands_) == all_.islands_) return member.place;
      member.place = static_cast<std::uint32_t>(bodies.size());
    }
    bodies.push_back(id);
    before_.push_back(id == no_body ? Vector3d(Vector3d::Zero()) : all_.velocity(id));
    velocities.push_back(before_.back());
    halves.push_back(Vector3d::Zero());
    if (id != no_body) halves.back() = 0.5 * all_.bodies_.path(id).acceleration(all_.clock_.now);
    known_.push_back(0);
    of_body_.emplace_back();
    return static_cast<std::uint32_t>(bodies.size() - 1);
  }

  void add_touch(const Contact& contact, Slot slot, double least) {
    const auto inverse_mass = [&](BodySlot id) { return id == no_body ? 0.0 : all_.bodies_[id].inverse_mass; };
    const auto place = static_cast<std::uint32_t>(touches_.size());
    touches_.push_back({add_body(contact.a), add_body(contact.b), contact.normal, inverse_mass(contact.a),
                        inverse_mass(contact.b), 0, least});
    slots_.push_back(slot);
    spans_.push_back(span_of(contact));
    tolerances_.push_back(contact.room > 0 ? absorbed * contact.room : rounding * all_.gaps_.size(contact));
    waiting_.push_back(place);
    waits_.push_back(1);
    turned_.push_back(0);
  }

  /// The rest of the span of its cluster; with two clusters, until the later one ends.
  double span_of(const Contact& contact) const {
    double ends = all_.clock_.now + span_;
    for (const BodySlot id : {contact.a, contact.b}) {
      if (id == no_body || all_.bodies_.fixed(id) || !all_.clustered(id)) continue;
      if (all_.of_[id].span_ends != never) ends = std::max(ends, all_.of_[id].span_ends);
    }
    return ends - all_.clock_.now;
  }

  /// For accelerations: the push that a contact has, and its least relative acceleration.
  void prepare(std::size_t i) {
    Touch& touch = touches_[i];
    if (slots_[i] == none) {  // The two part.
      touch.push = 0;
      touch.least = -never;
      return;
    }
    Contact& contact = all_.contacts_[slots_[i]];
    touch.push = contact.push;
    turned_[i] = goes_elsewhere(touch, contact, spans_[i]) && all_.gaps_.bends(contact);
    if (turned_[i]) turn(touch, contact, spans_[i]);
    touch.normal = contact.normal;
    const double falls = all_.gaps_.along_normal(contact) - contact.aim;
    const double bending = all_.gaps_.beyond_parabola(contact, touch.normal, spans_[i]);
    touch.least = least_acceleration(falls, parting_rate(velocities, touch) + bending / spans_[i], spans_[i]);
  }

  /// Whether the distance that a contact slides in the span has changed by enough to matter.
  bool goes_elsewhere(const Touch& touch, const Contact& contact, double span) const {
    const Vector3d change = (velocities[touch.b] - before_[touch.b]) - (velocities[touch.a] - before_[touch.a]);
    return norm(change) * span > contact.room;
  }

  /// The normal becomes the one half-way between now and the end of the span, and the push of the contact is turned to
  /// it.
  void turn(Touch& touch, Contact& contact, double span) {
    Contact here = contact;
    const double gap = all_.gaps_.nearest(here);
    const Vector3d displacement =
        (velocities[touch.b] - velocities[touch.a]) * span + (halves[touch.b] - halves[touch.a]) * (span * span);
    Vector3d normal = here.normal + all_.gaps_.after(contact, displacement).normal;
    normal /= norm(normal);
    touch.normal = contact.normal;
    give_push(halves, touch, -contact.push);
    touch.normal = normal;
    give_push(halves, touch, contact.push);
    contact.normal = normal;
    contact.aim = all_.gaps_.along_normal(contact) - closing(contact, gap);
  }

  /// A body has changed: all its contacts are queued for a visit.
  void look_at(std::uint32_t place, Order order) {
    if (!known_[place]) list_touches(place, order);
    const auto [first, last] = of_body_[place];
    for (std::uint32_t i = first; i < last; ++i) {
      if (!std::exchange(waits_[listed_[i]], 1)) waiting_.push_back(listed_[i]);
    }
  }

  void list_touches(std::uint32_t place, Order order) {
    known_[place] = 1;
    const BodySlot id = bodies[place];
    const auto first = static_cast<std::uint32_t>(listed_.size());
    if (id != no_body && !all_.bodies_.fixed(id)) {
      if (slots_[0] == none && (place == touches_[0].a || place == touches_[0].b)) listed_.push_back(0);
      for (const Slot slot : all_.of_[id].contacts) {
        Contact& contact = all_.contacts_[slot];
        if (std::exchange(contact.seen, all_.islands_) != all_.islands_) {
          contact.place = static_cast<std::uint32_t>(touches_.size());
          Contact here = contact;
          const double gap = all_.gaps_.nearest(here);
          if (all_.gaps_.concave(contact)) contact.gap = gap, contact.since = all_.clock_.now;
          add_touch(here, slot, least_rate(here, gap, span_of(here)));
          if (order == Order::accelerations) prepare(contact.place);
        }
        listed_.push_back(contact.place);
      }
    }
    of_body_[place] = {first, static_cast<std::uint32_t>(listed_.size())};
  }

  void wait_for_all() {
    waiting_.clear();
    for (std::uint32_t i = 0; i < touches_.size(); ++i) waiting_.push_back(i);
    std::fill(waits_.begin(), waits_.end(), 1);
  }

  /// False if there are too many visits.
  bool solve(std::vector<Vector3d>& rates, Order order) {
    for (std::size_t visits = 0; !waiting_.empty(); ++visits) {
      if (visits > most_sweeps * (touches_.size() + 10)) return false;
      const std::uint32_t i = waiting_.front();
      waiting_.pop_front();
      waits_[i] = 0;
      Touch& touch = touches_[i];
      const double amount = std::max(over_relaxation * (touch.least - parting_rate(rates, touch)), -touch.push);
      const double time = order == Order::velocities ? spans_[i] : spans_[i] * spans_[i];
      if (std::abs(amount) * time <= (i == 0 ? struck_precision : 1) * tolerances_[i]) continue;
      give_push(rates, touch, amount);
      for (const std::uint32_t side : {touches_[i].a, touches_[i].b}) look_at(side, order);
    }
    if (order == Order::accelerations) return true;
    Touch& struck = touches_.front();  // The contact that is struck parts exactly as it should.
    const double lacks = struck.least - parting_rate(rates, struck);
    if (lacks > 0) give_push(rates, struck, lacks);
    return true;
  }

  RestingContacts& all_;
  double span_;
  std::vector<Vector3d> before_;
  std::vector<char> known_;                                       ///< by body: whether its touches are listed
  std::vector<std::pair<std::uint32_t, std::uint32_t>> of_body_;  ///< where in listed_
  std::vector<std::uint32_t> listed_;
  std::vector<Touch> touches_;
  std::vector<Slot> slots_;
  std::vector<double> spans_;       ///< s
  std::vector<double> tolerances_;  ///< of the gap when the span ends, in units of length
  std::vector<char> turned_;
  std::vector<char> waits_;
  std::deque<std::uint32_t> waiting_;
};

/// A body that strikes another joins that body's cluster, unless it is in one itself; bodies that rested wake. Returns
/// the time at which their span ends, which is now if a new one is to begin.
template <class Motion>
double RestingContacts<Motion>::wake(const Contact& contact, bool joins) {
  const double now = clock_.now;
  const auto free = [this](BodySlot id) { return id != no_body && !bodies_.fixed(id); };
  double ends = never;
  for (const BodySlot id : {contact.a, contact.b}) {
    if (id != no_body && clustered(id)) ends = std::min(ends, of_[id].span_ends);
  }
  for (const BodySlot id : {contact.a, contact.b}) {
    if (!free(id)) continue;
    if (clustered(id) ? of_[id].span_ends == never : rests(id)) gather(id, ends == never ? now : ends);
    if (clustered(id)) ends = std::min(ends, of_[id].span_ends);
  }
  if (ends == never) ends = now;  // Their clusters have just been dissolved.
  for (const BodySlot id : {contact.a, contact.b}) {
    if (!joins || !free(id) || clustered(id)) continue;
    member(id).span_ends = ends;
    member(id).calm_since = never;
  }
  return ends;
}

/// A contact in a cluster begins to last, with the room that neighbouring contacts have, which depends on how many
/// there are.
template <class Motion>
typename RestingContacts<Motion>::Slot RestingContacts<Motion>::add_to_cluster(const Contact& contact) {
  Contact lasting = contact;
  lasting.since = clock_.now;
  double part = gaps_.bends(contact) ? room_of_curves : room_of_planes;
  for (const BodySlot id : {contact.a, contact.b}) {
    if (id == no_body || bodies_.fixed(id)) continue;
    for (const Slot other : of_[id].contacts) {
      part = std::max(part, contacts_[other].room / gaps_.size(contacts_[other]));
    }
  }
  lasting.room = part * gaps_.size(contact);
  add(lasting);
  const Slot slot = find_like(contact);
  contacts_[slot].fresh = false;
  return slot;
}

/// The law of impacts [Moreau88]: of all velocities that no contact forbids, those nearest to the velocities before,
/// measured by mass; restitution adds its part of the same change. Only bodies that the impact affects are solved for.
template <class Motion>
void RestingContacts<Motion>::impact(const Contact& contact, double restitution) {
  const double now = clock_.now;
  if (bodies_.numbered()) note_struck(contact);
  double bounce = never;  // s; shorter flights are left out
  double weight = 0;
  for (const BodySlot id : {contact.a, contact.b}) {
    if (id == no_body || bodies_.fixed(id)) continue;
    bounce = std::min(bounce, longest_span(id));
    weight = std::max(weight, norm(acceleration(id)));
  }
  const double approach = -gaps_.parting(contact);
  if (bounce == never) bounce = approach > 0 ? part_of_slide * gaps_.size(contact) / approach : 1;
  const bool joins = 2 * restitution * approach <= bounce * weight;
  if (joins) restitution = 0;
  double span = wake(contact, joins) - now;
  Slot slot = find_like(contact);
  if (joins && slot == none) slot = add_to_cluster(contact);
  const bool anew = !(span > shortest_span * bounce);  // The span begins anew.
  if (anew) {
    span = bounce;
    for (const BodySlot id : {contact.a, contact.b}) {
      if (id == no_body || bodies_.fixed(id) || !clustered(id)) continue;
      for (const Slot each : find_island(id).contacts) {
        if (!gaps_.renew(contacts_[each])) drop(each);
      }
    }
    if (slot != none && !contacts_[slot].alive) slot = none;
  }
  // Bodies that stay together part by so little that they do not meet again by rounding.
  const double least = joins ? lift * (slot != none ? contacts_[slot].room : 0.0) / span : 0.0;
  Neighbourhood near(*this, contact, joins ? slot : none, least, span);
  const bool solved = near.solve_velocities(restitution) && (anew || near.solve_accelerations());
  for (std::size_t i = 1; i < near.bodies.size(); ++i) {
    const BodySlot id = near.bodies[i];
    if (bodies_.fixed(id)) continue;
    if (bodies_.numbered()) listener_->tell_touched(id);
    const Motion before = bodies_.motion(id).restarted(now);
    Motion motion = before;
    motion.coefficients[1] = near.velocities[i];
    if constexpr (Motion::degree >= 2) motion.coefficients[2] = near.halves[i];
    // A body that has just joined a cluster moves on a parabola as all of it do: the span is proven for that.
    for (std::size_t k = 3; k <= Motion::degree && clustered(id); ++k) motion.coefficients[k] = Vector3d::Zero();
    if (!(motion == before)) listener_->take_up(id, motion);
  }
  if (!solved && slot == none) add_to_cluster(contact);  // Bodies that are squeezed do not bounce.
  if (!anew && solved) return;
  for (const BodySlot id : {contact.a, contact.b}) {
    if (id == no_body || bodies_.fixed(id)) continue;
    if (!solved) gather(id);
    if (clustered(id)) disturb(id);
  }
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class RestingContacts<motion>;
KDS_FOR_EACH_PATH(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
