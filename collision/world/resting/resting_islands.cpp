// Bodies that lean on each other: found, and moved as their resting contacts let them.
#include "collision/motions.hpp"
#include "collision/vectors.hpp"
#include "collision/world/resting/resting_contacts.hpp"
#include "kds/certificate.hpp"
#include "kds/roots/failure_time.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kds::collision {
using Eigen::Vector3d;

template <class Motion>
void RestingContacts<Motion>::note(BodySlot id) {
  if (!bodies_.entered(id)) return;
  bool as_given = true;
  if constexpr (Motion::degree == 2)
    as_given = bodies_.fixed(id) || bodies_.motion(id).coefficients[2] == bodies_.free_acceleration(id);
  if constexpr (Motion::degree >= 3) as_given = id >= of_.size() || !of_[id].carried;
  if (!carries(id) && as_given) return;
  if (std::exchange(member(id).disturbed, true)) return;
  disturbed_.push_back(id);
}

template <class Motion>
void RestingContacts<Motion>::solve_all() {
  while (!disturbed_.empty()) {
    const BodySlot id = disturbed_.back();
    disturbed_.pop_back();
    if (!std::exchange(member(id).disturbed, false) || !bodies_.entered(id)) continue;
    if (bodies_.fixed(id)) {
      solve_fixed(id);
    } else {
      for (bool dissolved = false; !solve_island(id, dissolved);) {
      }
    }
    if (bodies_.numbered()) solved_.push_back(id);
  }
}

/// A fixed body rests at walls only: they take away the speed and the acceleration that lead out of the domain. What it
/// carries is solved for anew.
template <class Motion>
void RestingContacts<Motion>::solve_fixed(BodySlot id) {
  const Motion before = bodies_.motion(id).restarted(clock_.now);
  Motion motion = before;
  const std::vector<Slot> contacts = in_order(id);  // some may be dropped
  const auto is_wall = [&](Slot slot) { return contacts_[slot].wall >= 0; };
  const bool at_wall = std::any_of(contacts.begin(), contacts.end(), is_wall);
  const bool given_anew = at_wall || (Motion::degree >= 3 && of_[id].carried);  // or a wall has let it go
  for (std::size_t i = 2; i <= Motion::degree && given_anew; ++i)
    motion.coefficients[i] = bodies_.free_term(id, i, clock_.now);
  of_[id].carried = false;
  for (const Slot slot : contacts) {
    Contact& contact = contacts_[slot];
    if (contact.wall < 0) {
      disturb(contact.a == id ? contact.b : contact.a);
      continue;
    }
    const Eigen::Index axis = contact.wall / 2;
    if (contact.fresh) motion.coefficients[1][axis] = 0;
    bool parts = motion.coefficients[1][axis] != 0;  // inward, or outward: then it meets the wall anew
    if constexpr (Motion::degree == 2) {
      double& force = motion.coefficients[2][axis];
      parts = parts || force * contact.normal[axis] < 0;
      if (!parts) force = 0;
    }
    if constexpr (Motion::degree >= 3) parts = parts || !press(motion, contact);
    contact.fresh = false;
    if (parts) {
      drop(slot);
    } else if (Motion::degree >= 3) {
      of_[id].carried = true;
      schedule_release(slot);
    }
  }
  if (given_anew && !(motion == before)) listener_->take_up(id, motion);
}

/// False if a contact had to be dropped: the caller then calls it again, with one contact fewer.
template <class Motion>
bool RestingContacts<Motion>::solve_island(BodySlot id, bool& dissolved) {
  Island island = find_island(id);
  if (in_cluster(island)) return step_cluster(island, dissolved);
  if (drop_broken(island)) return false;
  std::vector<Motion> motions;
  for (const BodySlot each : island.bodies) motions.push_back(bodies_.motion(each).restarted(clock_.now));
  const std::vector<Motion> before = motions;
  stay(island, motions);
  if (!constrain(island, 1, motions)) return false;
  const auto take_up_all = [&] {
    for (std::size_t i = 0; i < island.free; ++i) {
      if (!(motions[i] == before[i])) listener_->take_up(island.bodies[i], motions[i]);
    }
  };
  if constexpr (Motion::degree >= 2) {
    const std::vector<Motion> stopped = motions;
    for (std::size_t i = 0; i < island.free; ++i) {
      for (std::size_t order = 2; order <= Motion::degree; ++order) {
        motions[i].coefficients[order] = bodies_.free_term(island.bodies[i], order, clock_.now);
      }
      if constexpr (Motion::degree >= 3) of_[island.bodies[i]].carried = !island.contacts.empty();
    }
    if (!constrain(island, 2, motions) || (Motion::degree >= 3 && !constrain_curves(island, motions))) {
      // Bodies that are pulled apart at once have still lost their speed of approach.
      motions = stopped;
      take_up_all();
      return false;
    }
  }
  if constexpr (Motion::degree >= 2) watch(island, motions);
  take_up_all();
  for (const Slot slot : island.contacts) {
    contacts_[slot].fresh = false;
    schedule_release(slot);
  }
  return true;
}

/// The bodies that lean on each other, directly or not, but not through fixed ones; in their order, so that the
/// arithmetic does not depend on how they were found.
template <class Motion>
typename RestingContacts<Motion>::Island RestingContacts<Motion>::find_island(BodySlot id) {
  ++islands_;
  member(id);  // All that touches others is known.
  Island island;
  std::vector<BodySlot> anchored;
  const auto visit = [&](BodySlot next) {
    if (std::exchange(of_[next].island, islands_) == islands_) return;
    (bodies_.fixed(next) ? anchored : island.bodies).push_back(next);
  };
  visit(id);
  for (std::size_t i = 0; i < island.bodies.size(); ++i) {
    const BodySlot at = island.bodies[i];
    for (const Slot slot : of_[at].contacts) {
      const Contact& contact = contacts_[slot];
      const BodySlot other = contact.a == at ? contact.b : contact.a;
      const bool met_first = contact.a == at || bodies_.fixed(other);
      if (met_first) island.contacts.push_back(slot);
      if (other != no_body) visit(other);
    }
  }
  const auto before = [this](BodySlot x, BodySlot y) { return bodies_.before(x, y); };
  std::sort(island.bodies.begin(), island.bodies.end(), before);
  island.free = island.bodies.size();
  std::sort(anchored.begin(), anchored.end(), before);
  island.bodies.insert(island.bodies.end(), anchored.begin(), anchored.end());
  for (std::size_t i = 0; i < island.bodies.size(); ++i) {
    of_[island.bodies[i]].place = static_cast<std::uint32_t>(i);
  }
  const detail::RestingRank rank{&contacts_, &bodies_.keys()};
  std::sort(island.contacts.begin(), island.contacts.end(), [&](Slot x, Slot y) {
    const Contact& of_x = contacts_[x];
    const Contact& of_y = contacts_[y];
    if (of_x.a != of_y.a || of_x.b != of_y.b) return rank(x) < rank(y);
    if (of_x.wall != of_y.wall) return of_x.wall < of_y.wall;
    return std::lexicographical_compare(of_x.normal.begin(), of_x.normal.end(), of_y.normal.begin(), of_y.normal.end());
  });
  for (const Slot slot : island.contacts) {
    const Contact& contact = contacts_[slot];
    const bool at_wall = contact.b == no_body;
    const double a = bodies_[contact.a].inverse_mass;
    const double b = at_wall ? 0 : bodies_[contact.b].inverse_mass;
    // The walls come after the bodies.
    const auto place_b = at_wall ? static_cast<std::uint32_t>(island.bodies.size()) : of_[contact.b].place;
    island.touches.push_back({of_[contact.a].place, place_b, contact.normal, a, b});
  }
  if (bodies_.numbered()) note_concerned(island);
  return island;
}

/// Ends the contacts whose bodies have been given speed along the normal; those that approach meet anew, and may
/// bounce. If they would be back within a span, at once or after a bounce, they form a cluster instead.
template <class Motion>
bool RestingContacts<Motion>::drop_broken(const Island& island) {
  bool any = false;
  for (const Slot slot : island.contacts) {
    const Contact& contact = contacts_[slot];
    if (contact.fresh) continue;
    const Vector3d a = bodies_.path(contact.a).velocity(clock_.now);
    const Vector3d b = contact.b == no_body ? Vector3d(Vector3d::Zero()) : bodies_.path(contact.b).velocity(clock_.now);
    double largest = std::max({a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff(), contact.solved});
    if constexpr (Motion::degree >= 3) {
      largest += velocity_terms(bodies_.path(contact.a), clock_.now);
      if (contact.b != no_body) largest += velocity_terms(bodies_.path(contact.b), clock_.now);
    }
    const double rate = dot(contact.normal, b - a);
    if (std::abs(rate) <= rate_rounding * largest || std::abs(rate) <= gaps_.rate_error(contact) * largest) continue;
    any = true;
    if (soon_back(contact, std::abs(rate)) && (rate > 0 || turns(island))) {
      gather(island.bodies.front());
      return true;
    }
    drop(slot);
  }
  return any;
}

/// Takes away the rates along the normals of contacts with fixed bodies that remain after drop_broken(): they are
/// errors, and those that part are not taken away by constrain().
template <class Motion>
void RestingContacts<Motion>::stay(const Island& island, std::vector<Motion>& motions) const {
  for (std::size_t k = 0; k < island.contacts.size(); ++k) {
    const Contact& contact = contacts_[island.contacts[k]];
    const Touch& touch = island.touches[k];
    if (contact.fresh || !gaps_.concave(contact) || bodies_.fixed(contact.a) == bodies_.fixed(contact.b)) continue;
    Vector3d& of_a = motions[touch.a].coefficients[1];
    Vector3d& of_b = motions[touch.b].coefficients[1];
    const double rate = dot(contact.normal, of_b - of_a);
    const double largest = std::max({of_a.cwiseAbs().maxCoeff(), of_b.cwiseAbs().maxCoeff(), contact.solved});
    if (std::abs(rate) <= rate_rounding * largest) continue;
    if (bodies_.fixed(contact.a)) {
      of_b -= rate * contact.normal;
    } else {
      of_a += rate * contact.normal;
    }
  }
}

/// Velocities (order 1) or accelerations (2) by least constraint. False if a contact had to be dropped: one that parts,
/// or one whose bodies nothing can keep apart.
template <class Motion>
bool RestingContacts<Motion>::constrain(Island& island, std::size_t order, std::vector<Motion>& motions) {
  std::vector<Vector3d> rates;
  for (const Motion& motion : motions) rates.push_back(motion.coefficients[order]);
  rates.push_back(Vector3d::Zero());  // of the walls
  for (std::size_t k = 0; k < island.contacts.size(); ++k) {
    island.touches[k].push = order == 2 ? contacts_[island.contacts[k]].push : 0;
  }
  double largest = 0;
  for (const Vector3d& rate : rates) largest = std::max(largest, rate.cwiseAbs().maxCoeff());
  if (!least_constraint(rates, island.touches)) {
    const BodySlot id = island.bodies.front();
    const bool accelerated =
        std::any_of(island.bodies.begin(), island.bodies.begin() + static_cast<std::ptrdiff_t>(island.free),
                    [this](BodySlot each) { return longest_span(each) < never; });
    if (squeezed(island) || !accelerated) return !let_pass_worst(island, rates);
    gather(id);
    return false;
  }
  for (std::size_t k = 0; k < island.contacts.size(); ++k) {
    const double rate = parting_rate(rates, island.touches[k]);
    if (rate <= rate_rounding * largest) continue;
    if (order == 1 && soon_back(contacts_[island.contacts[k]], rate)) {
      gather(island.bodies.front());
    } else {
      drop(island.contacts[k]);
    }
    return false;
  }
  for (std::size_t k = 0; k < island.contacts.size(); ++k) {
    Contact& contact = contacts_[island.contacts[k]];
    if (order == 1) contact.solved = largest;
    if (order == 2) contact.push = island.touches[k].push;
  }
  for (std::size_t i = 0; i < island.free; ++i) motions[i].coefficients[order] = rates[i];
  return true;
}

/// Degree 3 and above: the terms of higher order, one after the other, and when each contact ceases to be pressed.
///
/// The push of a contact is a polynomial in time, whose constant term constrain() has found. While the push is positive
/// the two bodies stay together whatever their higher terms are, so the terms of each order are made equal along the
/// normal. Where the push vanishes up to some order, the next order is constrained as velocities are (no contact
/// approaches). The contact lasts until the polynomial turns negative. False if a contact had to be dropped.
template <class Motion>
bool RestingContacts<Motion>::constrain_curves(Island& island, std::vector<Motion>& motions) {
  if constexpr (Motion::degree >= 3) {
    const std::size_t count = island.contacts.size();
    std::vector<kds::Motion<Motion::degree - 2>> pushes(count);
    std::vector<char> pressed(count);
    double accelerations = 0;
    for (const Motion& motion : motions) {
      accelerations = std::max(accelerations, motion.coefficients[2].cwiseAbs().maxCoeff());
    }
    for (std::size_t k = 0; k < count; ++k) {
      const double push = contacts_[island.contacts[k]].push;
      pressed[k] = push > rate_rounding * accelerations;
      pushes[k].start = clock_.now;
      pushes[k].position.c[0] = pressed[k] ? 2 * push : 0;
    }
    for (std::size_t order = 3; order <= Motion::degree; ++order) {
      std::vector<Vector3d> rates;
      for (const Motion& motion : motions) rates.push_back(motion.coefficients[order]);
      rates.push_back(Vector3d::Zero());  // of the walls
      double largest = 0;
      for (const Vector3d& rate : rates) largest = std::max(largest, rate.cwiseAbs().maxCoeff());
      if (largest == 0) continue;
      std::vector<Touch> touches = island.touches;
      for (Touch& touch : touches) touch.push = 0;
      std::vector<std::size_t> backward(count, 0);  // where a contact that is pressed is kept from parting
      for (std::size_t k = 0; k < count; ++k) {
        if (!pressed[k]) continue;
        backward[k] = touches.size();
        touches.push_back(touches[k]);
        touches.back().normal = -touches[k].normal;
      }
      if (!least_constraint(rates, touches) && let_pass_worst(island, rates)) return false;
      for (std::size_t k = 0; k < count; ++k) {
        if (pressed[k] || parting_rate(rates, touches[k]) <= rate_rounding * largest) continue;
        part(island.contacts[k]);
        return false;
      }
      for (std::size_t k = 0; k < count; ++k) {
        const double push = touches[k].push - (backward[k] > 0 ? touches[backward[k]].push : 0.0);
        const bool real = std::abs(push) > rate_rounding * largest;
        const auto factor = static_cast<double>(order * (order - 1));
        pushes[k].position.c[order - 2] = real ? factor * push : 0;
        pressed[k] = pressed[k] || real;
      }
      for (std::size_t i = 0; i < island.free; ++i) motions[i].coefficients[order] = rates[i];
      // What is left of a term along a wall is a rounding, which would lead out of the domain at once.
      for (std::size_t k = 0; k < count; ++k) {
        const Contact& contact = contacts_[island.contacts[k]];
        if (contact.b != no_body || touches[k].a >= island.free) continue;
        double& term = motions[touches[k].a].coefficients[order][contact.wall / 2];
        if (std::abs(term) <= rate_rounding * largest) term = 0;
      }
    }
    for (std::size_t k = 0; k < count; ++k) {
      contacts_[island.contacts[k]].ends =
          failure_time(PolynomialCertificate<Motion::degree - 2>{pushes[k]}, clock_.now, never);
    }
  }
  return true;
}

/// A fixed body at a wall, of degree 3 and above: removes the terms that press it outward, and notes when they cease
/// to. False if they draw it inward at once.
template <class Motion>
bool RestingContacts<Motion>::press(Motion& motion, Contact& contact) const {
  if constexpr (Motion::degree >= 3) {
    const Eigen::Index axis = contact.wall / 2;
    kds::Motion<Motion::degree - 2> push;
    push.start = clock_.now;
    for (std::size_t order = 2; order <= Motion::degree; ++order) {
      const auto factor = static_cast<double>(order * (order - 1));
      push.position.c[order - 2] = factor * motion.coefficients[order][axis] * contact.normal[axis];
    }
    const PolynomialCertificate<Motion::degree - 2> pressed{push};
    contact.ends = failure_time(pressed, push.start, never);
    if (contact.ends == push.start) return false;
    for (std::size_t order = 2; order <= Motion::degree; ++order) motion.coefficients[order][axis] = 0;
  }
  return true;
}

/// Ends a contact of bodies that nothing presses together from now on: they part, if only by terms of a higher order.
/// They are let pass, so that an overlap by rounding is not taken for a new contact.
template <class Motion>
void RestingContacts<Motion>::part(Slot slot) {
  const Contact contact = contacts_[slot];
  if (contact.b != no_body) listener_->let_pass(contact.a, contact.b);
  drop(slot);
}

/// If the bodies cannot all be kept apart, the pair that is pressed together most is let pass. Walls do not give way.
template <class Motion>
bool RestingContacts<Motion>::let_pass_worst(const Island& island, const std::vector<Vector3d>& rates) {
  Slot worst = none;
  double least = never;
  for (std::size_t k = 0; k < island.contacts.size(); ++k) {
    const double rate = parting_rate(rates, island.touches[k]);
    if (contacts_[island.contacts[k]].b == no_body || !(rate < least)) continue;
    least = rate;
    worst = island.contacts[k];
  }
  if (worst == none) return false;
  const Contact contact = contacts_[worst];
  listener_->let_pass(contact.a, contact.b);
  listener_->tell_passes(contact);
  drop(worst);
  // If it is fresh, the event that has made it is about to be reported.
  if (!contact.fresh) listener_->tell_rebound_suppressed(contact.a, contact.b);
  return true;
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class RestingContacts<motion>;
KDS_FOR_EACH_PATH(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
