// Clusters: bodies in sustained contact on curved surfaces, advanced together, span by span.
#include "collision/motions.hpp"
#include "collision/world/resting/cluster_span.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace kds::collision {

using Eigen::Vector3d;
using namespace cluster;

template <class Motion>
bool RestingContacts<Motion>::in_cluster(const Island& island) const {
  return std::any_of(island.bodies.begin(), island.bodies.end(), [this](BodySlot id) { return clustered(id); });
}

/// Whether the normal of any contact turns while bodies slide. A ball that slides alone over a mesh does so only where
/// it leaves a face.
template <class Motion>
bool RestingContacts<Motion>::turns(const Island& island) const {
  if (island.contacts.size() == 1 && alone_on_face(contacts_[island.contacts.front()])) return false;
  return std::any_of(island.contacts.begin(), island.contacts.end(),
                     [this](Slot slot) { return gaps_.turns(contacts_[slot]); });
}

template <class Motion>
Vector3d RestingContacts<Motion>::acceleration(BodySlot id) const {
  if constexpr (Motion::degree >= 2) {
    return 2 * bodies_.free_term(id, 2, clock_.now);
  } else {
    return Vector3d::Zero();
  }
}

template <class Motion>
Vector3d RestingContacts<Motion>::velocity(BodySlot id) const {
  return bodies_.path(id).velocity(clock_.now);
}

/// The longest span of a body's cluster, as far as it depends on the body's weight.
template <class Motion>
double RestingContacts<Motion>::longest_span(BodySlot id) const {
  const double a = norm(acceleration(id));
  return a > 0 ? part_of_fall * std::sqrt(bodies_[id].bounding_radius / a) : never;
}

/// Whether two bodies that part at this rate meet again within a span: so short a flight counts as contact.
template <class Motion>
bool RestingContacts<Motion>::soon_back(const Contact& contact, double rate) const {
  if (contact.b == no_body || !(contact.fresh || contact.push > 0)) return false;
  for (const BodySlot id : {contact.a, contact.b}) {
    if (bodies_.fixed(id)) continue;
    const double span = longest_span(id);
    if (span < never && 2 * rate <= span * norm(acceleration(id))) return true;
  }
  return false;
}

/// Makes a cluster of all bodies that lean on a body, with a span that ends at the given time.
template <class Motion>
void RestingContacts<Motion>::gather(BodySlot id, double ends) {
  if (bodies_.fixed(id)) return;
  const Island island = find_island(id);
  bool woken = false;
  for (std::size_t i = 0; i < island.free; ++i) {
    Member& member = of_[island.bodies[i]];
    woken = woken || member.span_ends == never;
    if (clustered(island.bodies[i]) && member.span_ends != never) continue;
    member.span_ends = ends;
    member.calm_since = never;
  }
  for (const Slot slot : island.contacts) {
    Contact& contact = contacts_[slot];
    releases_.clear(slot);
    contact.since = clock_.now;
    if (contact.b != no_body && !gaps_.turns(contact)) continue;
    contact.room = (gaps_.bends(contact) ? room_of_curves : room_of_planes) * gaps_.size(contact);
  }
  // A span that has begun is proven for bodies that move on parabolas.
  const bool on_parabolas = std::all_of(
      island.bodies.begin(), island.bodies.begin() + static_cast<std::ptrdiff_t>(island.free), [this](BodySlot each) {
        const auto& terms = bodies_.path(each).coefficients;
        return std::all_of(terms.begin() + std::min<std::ptrdiff_t>(3, std::ssize(terms)), terms.end(),
                           [](const Vector3d& term) { return term.isZero(0); });
      });
  if (ends > clock_.now && !woken && on_parabolas) {
    set_span(island.bodies.front(), ends);
  } else {
    disturb(id);
  }
}

/// Bodies keep their motions; solve_island() does the rest.
template <class Motion>
void RestingContacts<Motion>::dissolve(const Island& island) {
  for (std::size_t i = 0; i < island.free; ++i) {
    const BodySlot id = island.bodies[i];
    leave(id);
    Motion motion = bodies_.motion(id).restarted(clock_.now);
    for (std::size_t k = 2; k <= Motion::degree; ++k) motion.coefficients[k] = bodies_.free_term(id, k, clock_.now);
    if (!(motion == bodies_.motion(id))) listener_->take_up(id, motion);
  }
  for (const Slot slot : island.contacts) contacts_[slot].fresh = true;
}

/// Whether no contact of a cluster turns or parts any more, so that it needs no more spans.
template <class Motion>
bool RestingContacts<Motion>::slides_on(const Island& island) const {
  const auto at_wall = [this](Slot slot) { return contacts_[slot].b == no_body; };
  const bool at_walls = std::all_of(island.contacts.begin(), island.contacts.end(), at_wall);
  if (!at_walls && (island.contacts.size() != 1 || turns(island))) return false;
  return std::none_of(island.contacts.begin(), island.contacts.end(), [this](Slot slot) {
    const Contact& contact = contacts_[slot];
    double largest = norm(velocity(contact.a));
    if (contact.b != no_body) largest = std::max(largest, norm(velocity(contact.b)));
    return gaps_.parting(contact) > rate_rounding * largest;
  });
}

/// Whether a contact with a mesh has moved to the place of an earlier one in the list: the bodies have left the facet
/// that it was on.
template <class Motion>
bool RestingContacts<Motion>::repeats(const Island& island, std::size_t k) const {
  const Contact& contact = contacts_[island.contacts[k]];
  if (!gaps_.concave(contact)) return false;
  for (std::size_t i = k; i-- > 0;) {
    const Contact& other = contacts_[island.contacts[i]];
    if (other.a != contact.a || other.b != contact.b) return false;
    if (other.alive && dot(other.normal, contact.normal) > detail::same_normal) return true;
  }
  return false;
}

/// Recomputes the contacts of a cluster. False if some have ended and were dropped: then the cluster has changed.
template <class Motion>
bool RestingContacts<Motion>::renew(const Island& island) {
  bool all = true;
  for (std::size_t k = 0; k < island.contacts.size(); ++k) {
    if (gaps_.renew(contacts_[island.contacts[k]]) && !repeats(island, k)) continue;
    drop(island.contacts[k]);
    all = false;
  }
  return all;
}

/// The span of a cluster begins. False if it is to be called again. `dissolved`: whether a cluster of its bodies has
/// been dissolved at this instant already; then it is not dissolved again.
template <class Motion>
bool RestingContacts<Motion>::step_cluster(Island& island, bool& dissolved) {
  if (!renew(island)) return false;
  if (!dissolved && slides_on(island)) {
    bool far = false;
    for (const Slot slot : island.contacts) {
      if (contacts_[slot].gap > 4 * room_of_many * gaps_.size(contacts_[slot])) drop(slot), far = true;
    }
    if (!far) dissolve(island), dissolved = true;
    return false;
  }
  for (std::size_t i = 0; i < island.free; ++i) {
    Member& member = of_[island.bodies[i]];
    if (member.span_ends == never) member.calm_since = never;
  }
  Span span(*this, island);
  if (span.length == never) {  // Nothing accelerates them.
    dissolve(island);
    return false;
  }
  if (!span.solve_velocities(turns(island)) && squeezed(island) && let_pass_worst(island, span.velocities))
    return false;
  if (!span.solve_accelerations() && squeezed(island) && let_pass_worst(island, span.halves)) return false;
  const bool sleeps = comes_to_rest(island, span.velocities) <= clock_.now;
  double length = span.usable();
  if (length < shortest_span * span.length) {
    length = span.length;
    span.move_as_one();
  }
  take_up(island, span, sleeps ? never : length);
  return true;
}

/// Gives the bodies the motions of a span, until it ends. A span without end is rest.
template <class Motion>
void RestingContacts<Motion>::take_up(const Island& island, Span& span, double length) {
  const bool sleeps = length == never;
  for (std::size_t i = 0; i < island.free; ++i) {
    const BodySlot id = island.bodies[i];
    of_[id].span_ends = clock_.now + length;
    of_[id].disturbed = false;
    const Vector3d still = Vector3d::Zero();
    move(id, sleeps ? still : span.velocities[i], sleeps ? still : span.halves[i], sleeps ? no_body : span.carrier);
    if (id < spans_.slots()) spans_.clear(id);
  }
  if (sleeps) return;
  span.prove();
  set_span(island.bodies.front(), clock_.now + length);
}

/// Bodies that fill all the room between fixed ones may be driven to and fro by rounding errors.
template <class Motion>
void RestingContacts<Motion>::halt(BodySlot id) {
  if (!clustered(id) || bodies_.fixed(id)) return;
  Island island = find_island(id);
  while (!renew(island)) island = find_island(id);
  Span span(*this, island);
  if (span.length == never) return;
  span.move_as_one();
  if (!span.keeps_apart() && let_pass_worst(island, span.velocities)) return;
  take_up(island, span, span.length);
}

/// `carrier`: a fixed body by whose terms of higher order it moves too, or no_body.
template <class Motion>
void RestingContacts<Motion>::move(BodySlot id, const Vector3d& velocity, const Vector3d& half_acceleration,
                                   BodySlot carrier) {
  Motion motion = bodies_.motion(id).restarted(clock_.now);
  motion.coefficients[1] = velocity;
  for (std::size_t i = 2; i <= Motion::degree; ++i) motion.coefficients[i] = Vector3d::Zero();
  if constexpr (Motion::degree >= 2) motion.coefficients[2] = half_acceleration;
  if (Motion::degree >= 3 && carrier != no_body) {
    const Motion of_carrier = bodies_.path(carrier).restarted(clock_.now);
    for (std::size_t i = 3; i <= Motion::degree; ++i) motion.coefficients[i] = of_carrier.coefficients[i];
  }
  if (!(motion == bodies_.motion(id))) listener_->take_up(id, motion);
}

/// Contacts that are not proven are tested like pairs that do not rest.
template <class Motion>
void RestingContacts<Motion>::set_proven(Contact& contact, bool proven) {
  if (contact.b == no_body) return;
  const bool tested = !std::exchange(contact.proven, proven);
  if (tested || !proven) listener_->changed(contact.a, contact.b);
}

template <class Motion>
void RestingContacts<Motion>::set_span(BodySlot first, double ends) {
  if (spans_.slots() <= first) spans_.resize(2 * (first + std::size_t{1}));
  spans_.set(first, ends);
}

/// Whether fixed bodies may close in on others, so that there may be no way for these to stay apart.
template <class Motion>
bool RestingContacts<Motion>::squeezed(const Island& island) const {
  const bool at_wall = std::any_of(island.contacts.begin(), island.contacts.end(),
                                   [this](Slot slot) { return contacts_[slot].b == no_body; });
  const auto terms = [this](BodySlot id, std::size_t i) {
    return Vector3d(bodies_.motion(id).restarted(clock_.now).coefficients[i]);
  };
  for (std::size_t k = island.free; k < island.bodies.size(); ++k) {
    for (std::size_t i = 1; i <= Motion::degree; ++i) {
      const Vector3d other = at_wall ? Vector3d(Vector3d::Zero()) : terms(island.bodies[island.free], i);
      if (terms(island.bodies[k], i) != other) return true;
    }
  }
  return false;
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class RestingContacts<motion>;
KDS_FOR_EACH_PATH(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
