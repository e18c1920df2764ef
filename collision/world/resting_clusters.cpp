// Clusters: bodies in sustained contact on curved surfaces, advanced together, span by span.
#include "collision/degrees.hpp"
#include "collision/vectors.hpp"
#include "collision/world/cluster_rules.hpp"
#include "collision/world/resting_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace kds::collision {
namespace {

using Eigen::Vector3d;
using namespace cluster;

/// Normals and accelerations depend on each other: so often they are found in turn.
constexpr std::size_t most_passes = 4;

/// By sweeps, which is quick where the pushes are known from a little while ago; what they do not solve (a wedge that
/// is squeezed, what is light between the heavy) by active sets. Where that is impossible, since bodies fill all the
/// room that there is, no gap is made to grow: `at_least` are the bounds for that.
bool solve(std::vector<Vector3d>& rates, std::vector<Touch>& touches, std::span<const double> at_least,
           double tolerance) {
  const std::vector<Vector3d> before = rates;
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

}  // namespace

/// A span of a cluster that begins now: what its bodies do in it. Places among rates are those of the island, and the
/// walls come last.
template <int Degree>
class RestingContacts<Degree>::Span {
 public:
  Span(RestingContacts& all, Island& island) : all_(all), island_(island), touches_(island.touches) {
    const double now = all.clock_.now;
    for (const BodySlot id : island.bodies) {
      velocities.push_back(all.velocity(id));
      halves.push_back(0.5 * all.bodies_.motion(id).acceleration(now));
    }
    velocities.push_back(Vector3d::Zero());
    halves.push_back(Vector3d::Zero());
    length = longest();
  }

  /// False if not all contacts could be kept from closing.
  bool solve_velocities(bool turns) {
    tolerance_ = never;
    for (std::size_t k = 0; k < touches_.size(); ++k) {
      Contact& contact = this->contact(k);
      const bool bends = all_.gaps_.bends(contact);
      const bool loose = turns || contact.b == no_body;
      const bool many = touches_.size() > most_active;
      const double room = many ? room_of_many : bends ? room_of_curves : loose ? room_of_planes : 0;
      contact.room = room * all_.gaps_.size(contact);
      tolerance_ = std::min(tolerance_, tolerated * contact.room);
      normals_.push_back(contact.normal);
      if (bends) bends_.push_back(k);
      touches_[k].normal = contact.normal;
      touches_[k].least = least_rate(contact, contact.gap, length);
      touches_[k].push = 0;
      at_least_.push_back(std::min(touches_[k].least, 0.0));
    }
    return solve(velocities, touches_, at_least_, tolerance_ / length);
  }

  /// Half the accelerations, and the pushes of contacts. On a curved surface the normal is that between those at both
  /// ends of the span, so that what begins in touch and along the surface ends so, and no speed is lost.
  bool solve_accelerations() {
    std::vector<Vector3d> free = halves;
    for (std::size_t i = 0; i < island_.free; ++i) free[i] = 0.5 * all_.acceleration(island_.bodies[i]);
    bool solved = true;
    for (std::size_t pass = 0; pass < most_passes; ++pass) {
      const bool follow = turn_normals();
      if (pass > 0 && follow) break;
      halves = free;
      for (std::size_t k = 0; k < touches_.size(); ++k) {
        const Contact& contact = this->contact(k);
        const double rate = parting_rate(velocities, touches_[k]);
        touches_[k].least = least_acceleration(closing(contact, contact.gap), rate, length);
        touches_[k].push = contact.push;
        at_least_[k] = std::min(touches_[k].least, -rate / length);
      }
      solved = solve(halves, touches_, at_least_, tolerance_ / (length * length));
      for (std::size_t k = 0; k < touches_.size(); ++k) contact(k).push = touches_[k].push;
    }
    return solved;
  }

  /// How long it may last: what has been left too near ends it before it is too late. Contacts know from then on how
  /// far they will be, and which of them are proven.
  double usable() {
    for (double result = length;;) {
      pay(result);
      const double lasts = provable(result);
      if (lasts == result) return result;
      result = lasts;
    }
  }

  /// Of what cannot be solved all bodies get one velocity and one acceleration, which no contact forbids: those of the
  /// fixed bodies that they lean on, or the means by mass if there are none.
  void move_as_one() {
    const auto wall = island_.bodies.size();
    const bool at_wall = std::any_of(island_.contacts.begin(), island_.contacts.end(),
                                     [this](Slot slot) { return all_.contacts_[slot].b == no_body; });
    Vector3d rate = Vector3d::Zero();
    Vector3d half = Vector3d::Zero();
    if (island_.free < wall) {
      rate = velocities[island_.free], half = halves[island_.free];
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
    for (const Slot slot : island_.contacts) all_.contacts_[slot].push = 0;
  }

  void prove() {
    for (std::size_t k = 0; k < touches_.size(); ++k) all_.set_proven(contact(k), proven_[k] != 0);
  }

  double length;  ///< s; `never` if nothing accelerates the bodies
  std::vector<Vector3d> velocities;
  std::vector<Vector3d> halves;

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
      if (along > 0) span = std::min(span, part_of_slide * all_.gaps_.size(contact) / along);
    }
    return span;
  }

  /// What lifts contacts to their room, and what is rounded, is paid by the speeds: the bodies end the span with no more
  /// energy than they have before it, if it lasts for a time. Fixed bodies that move do work, which nobody pays.
  void pay(double time) {
    const auto moves = [](const Vector3d& vector) { return !vector.isZero(0); };
    const auto fixed = static_cast<std::ptrdiff_t>(island_.free);
    if (std::any_of(velocities.begin() + fixed, velocities.end(), moves)) return;
    if (std::any_of(halves.begin() + fixed, halves.end(), moves)) return;
    double gained = 0;
    double by_speeds = 0;  // its derivative by a factor of all velocities
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

  /// For how much of a time no bodies come into each other.
  double provable(double time) {
    proven_.clear();
    for (std::size_t k = 0; k < touches_.size(); ++k) {
      Contact& contact = this->contact(k);
      const double rate = parting_rate(velocities, touches_[k]);
      const double half = parting_rate(halves, touches_[k]);
      contact.fresh = false;
      contact.aim = all_.gaps_.along_normal(contact) - closing(contact, contact.gap);
      proven_.push_back(all_.gaps_.proven(contact, rate, half, time));
      if (proven_.back()) continue;
      const auto apart_at = [&](double at) {
        return all_.gaps_.after(contact, displacement(touches_[k], at)).width >= 0;
      };
      const auto lasts = [&](double until) {  // What would meet at once lasts not at all.
        if (!all_.gaps_.bends(contact)) return all_.gaps_.proven(contact, rate, half, until);
        return apart_at(until) && apart_at(shortest_span * until);
      };
      while (time > 0 && !lasts(time)) time /= 2;
    }
    return time;
  }

  /// Of b, seen from a.
  Vector3d displacement(const Touch& touch, double time) const {
    return (velocities[touch.b] - velocities[touch.a]) * time + (halves[touch.b] - halves[touch.a]) * (time * time);
  }

  /// False if the paths would end nearer to each other than the normals that they were found with tell.
  bool turn_normals() {
    bool follow = true;
    for (const std::size_t k : bends_) {
      Contact& contact = this->contact(k);
      Touch& touch = touches_[k];
      const Vector3d way = displacement(touch, length);
      const SurfaceGap end = all_.gaps_.after(contact, way);
      const double expected = contact.gap + dot(touch.normal, way);
      follow = follow && end.width >= expected - tolerated * contact.room;
      contact.normal = normals_[k] + end.normal;
      contact.normal /= norm(contact.normal);
      touch.normal = contact.normal;
    }
    return follow;
  }

  RestingContacts& all_;
  Island& island_;
  std::vector<Touch>& touches_;
  std::vector<Vector3d> normals_;   ///< of contacts when it begins
  std::vector<std::size_t> bends_;  ///< contacts whose normals turn
  std::vector<double> at_least_;
  std::vector<char> proven_;
  double tolerance_ = never;  ///< of gaps when it ends, in units of length
};

template <int Degree>
bool RestingContacts<Degree>::in_cluster(const Island& island) const {
  return std::any_of(island.bodies.begin(), island.bodies.end(), [this](BodySlot id) { return clustered(id); });
}

/// Whether the normal of any contact does while bodies slide.
template <int Degree>
bool RestingContacts<Degree>::turns(const Island& island) const {
  return std::any_of(island.contacts.begin(), island.contacts.end(),
                     [this](Slot slot) { return gaps_.turns(contacts_[slot]); });
}

template <int Degree>
Vector3d RestingContacts<Degree>::acceleration(BodySlot id) const {
  if constexpr (Degree >= 2) {
    return 2 * bodies_.free_term(id, 2, clock_.now);
  } else {
    return Vector3d::Zero();
  }
}

template <int Degree>
Vector3d RestingContacts<Degree>::velocity(BodySlot id) const {
  return bodies_.motion(id).velocity(clock_.now);
}

/// Of a cluster to which a body belongs, as far as its weight alone matters.
template <int Degree>
double RestingContacts<Degree>::longest_span(BodySlot id) const {
  const double a = norm(acceleration(id));
  return a > 0 ? part_of_fall * std::sqrt(bodies_[id].bounding_radius / a) : never;
}

/// Whether what parts at a rate is back within a span: a flight that short is none.
template <int Degree>
bool RestingContacts<Degree>::soon_back(const Contact& contact, double rate) const {
  if (contact.b == no_body || !(contact.fresh || contact.push > 0)) return false;
  for (const BodySlot id : {contact.a, contact.b}) {
    if (bodies_.fixed(id)) continue;
    const double span = longest_span(id);
    if (span < never && 2 * rate <= span * norm(acceleration(id))) return true;
  }
  return false;
}

/// Makes a cluster of all that leans on a body, with a span that ends then.
template <int Degree>
void RestingContacts<Degree>::gather(BodySlot id, double ends) {
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
  if (ends > clock_.now && !woken) {
    set_span(island.bodies.front(), ends);
  } else {
    disturb(id);
  }
}

/// Bodies go on as they are, and settle_island() sees to the rest.
template <int Degree>
void RestingContacts<Degree>::dissolve(const Island& island) {
  for (std::size_t i = 0; i < island.free; ++i) {
    const BodySlot id = island.bodies[i];
    leave(id);
    Motion motion = bodies_.motion(id).restarted(clock_.now);
    for (std::size_t k = 2; k <= Degree; ++k) motion.coefficients[k] = bodies_.free_term(id, k, clock_.now);
    if (!(motion == bodies_.motion(id))) listener_.take_up(id, motion);
  }
  for (const Slot slot : island.contacts) contacts_[slot].fresh = true;
}

/// Whether no contact of a cluster turns any more, nor parts, so that it needs no more spans.
template <int Degree>
bool RestingContacts<Degree>::slides_on(const Island& island) const {
  const auto at_wall = [this](Slot slot) { return contacts_[slot].b == no_body; };
  const bool at_walls = std::all_of(island.contacts.begin(), island.contacts.end(), at_wall);
  if (!at_walls && island.contacts.size() != 1) return false;
  return std::none_of(island.contacts.begin(), island.contacts.end(), [this](Slot slot) {
    const Contact& contact = contacts_[slot];
    double largest = norm(velocity(contact.a));
    if (contact.b != no_body) largest = std::max(largest, norm(velocity(contact.b)));
    return gaps_.turns(contact) || gaps_.parting(contact) > rate_rounding * largest;
  });
}

/// Whether a contact with a mesh has come to where one before it is: the bodies have left the facet that it was on.
template <int Degree>
bool RestingContacts<Degree>::repeats(const Island& island, std::size_t k) const {
  const Contact& contact = contacts_[island.contacts[k]];
  if (!gaps_.has_mesh(contact)) return false;
  for (std::size_t i = k; i-- > 0;) {
    const Contact& other = contacts_[island.contacts[i]];
    if (other.a != contact.a || other.b != contact.b) return false;
    if (other.alive && dot(other.normal, contact.normal) > detail::same_normal) return true;
  }
  return false;
}

/// The span of a cluster begins. False if it is to be called again.
template <int Degree>
bool RestingContacts<Degree>::step_cluster(Island& island) {
  const double now = clock_.now;
  bool over = false;
  for (std::size_t k = 0; k < island.contacts.size(); ++k) {
    if (gaps_.renew(contacts_[island.contacts[k]]) && !repeats(island, k)) continue;
    drop(island.contacts[k]);
    over = true;
  }
  if (over) return false;
  if (slides_on(island)) {
    bool far = false;
    for (const Slot slot : island.contacts) {
      if (contacts_[slot].gap > 4 * room_of_many * gaps_.size(contacts_[slot])) drop(slot), far = true;
    }
    if (!far) dissolve(island);
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
  if (!span.solve_velocities(turns(island)) && squeezed(island) && let_pass_worst(island, span.velocities)) return false;
  if (!span.solve_accelerations() && squeezed(island) && let_pass_worst(island, span.halves)) return false;
  const bool sleeps = comes_to_rest(island, span.velocities) <= now;
  double length = span.usable();
  if (length < shortest_span * span.length) {
    length = span.length;
    span.move_as_one();
  }
  take_up(island, span, sleeps ? never : length);
  return true;
}

/// What a span says, until it ends. One without end is rest.
template <int Degree>
void RestingContacts<Degree>::take_up(const Island& island, Span& span, double length) {
  const bool sleeps = length == never;
  for (std::size_t i = 0; i < island.free; ++i) {
    const BodySlot id = island.bodies[i];
    of_[id].span_ends = clock_.now + length;
    of_[id].disturbed = false;
    const Vector3d still = Vector3d::Zero();
    move(id, sleeps ? still : span.velocities[i], sleeps ? still : span.halves[i]);
    if (id < spans_.slots()) spans_.clear(id);
  }
  if (sleeps) return;
  span.prove();
  set_span(island.bodies.front(), clock_.now + length);
}

/// Bodies that fill all the room that there is may be driven to and fro by roundings alone.
template <int Degree>
void RestingContacts<Degree>::halt(BodySlot id) {
  if (!clustered(id) || bodies_.fixed(id)) return;
  Island island = find_island(id);
  Span span(*this, island);
  if (span.length == never) return;
  span.move_as_one();
  take_up(island, span, span.length);
}

template <int Degree>
void RestingContacts<Degree>::move(BodySlot id, const Vector3d& velocity, const Vector3d& half_acceleration) {
  Motion motion = bodies_.motion(id).restarted(clock_.now);
  motion.coefficients[1] = velocity;
  for (std::size_t i = 2; i <= Degree; ++i) motion.coefficients[i] = Vector3d::Zero();
  if constexpr (Degree >= 2) motion.coefficients[2] = half_acceleration;
  if (!(motion == bodies_.motion(id))) listener_.take_up(id, motion);
}

/// What is not proven is tested as pairs that do not rest are.
template <int Degree>
void RestingContacts<Degree>::set_proven(Contact& contact, bool proven) {
  if (contact.b == no_body) return;
  const bool tested = !std::exchange(contact.proven, proven);
  if (tested || !proven) listener_.changed(contact.a, contact.b);
}

template <int Degree>
void RestingContacts<Degree>::set_span(BodySlot first, double ends) {
  if (spans_.slots() <= first) spans_.resize(2 * (first + std::size_t{1}));
  spans_.set(first, ends);
}

/// Whether fixed bodies may close in on others, so that there may be no way for these to stay apart.
template <int Degree>
bool RestingContacts<Degree>::squeezed(const Island& island) const {
  const bool at_wall = std::any_of(island.contacts.begin(), island.contacts.end(),
                                   [this](Slot slot) { return contacts_[slot].b == no_body; });
  const auto terms = [this](BodySlot id, std::size_t i) {
    return Vector3d(bodies_.motion(id).restarted(clock_.now).coefficients[i]);
  };
  for (std::size_t k = island.free; k < island.bodies.size(); ++k) {
    for (std::size_t i = 1; i <= Degree; ++i) {
      const Vector3d other = at_wall ? Vector3d(Vector3d::Zero()) : terms(island.bodies[island.free], i);
      if (terms(island.bodies[k], i) != other) return true;
    }
  }
  return false;
}

/// When bodies that go on like this come to rest, `never` if they do not: something at rest carries them, no contact is
/// perfectly elastic, all have met others that are free (what slides alone on a plane slides on), and have been slow
/// for long enough.
template <int Degree>
double RestingContacts<Degree>::comes_to_rest(const Island& island, const std::vector<Vector3d>& velocities) {
  const bool carried = std::any_of(island.contacts.begin(), island.contacts.end(), [this](Slot slot) {
    const Contact& contact = contacts_[slot];
    return contact.push > 0 && (contact.b == no_body || bodies_.fixed(contact.a) || bodies_.fixed(contact.b));
  });
  const bool moves = std::any_of(velocities.begin() + static_cast<std::ptrdiff_t>(island.free), velocities.end(),
                                 [](const Vector3d& velocity) { return !velocity.isZero(0); });
  double energy = 0;
  double least_energy = 0;
  for (std::size_t i = 0; i < island.free; ++i) {
    const auto& body = bodies_[island.bodies[i]];
    energy += body.mass * squared_norm(velocities[i]);
    least_energy += body.mass * norm(acceleration(island.bodies[i])) * body.bounding_radius;
  }
  const bool calm_in_all = carried && !moves && energy <= calm_speed * calm_speed * least_energy;
  double rests = calm_in_all ? clock_.now : never;
  for (std::size_t i = 0; i < island.free; ++i) {
    const BodySlot id = island.bodies[i];
    const double a = norm(acceleration(id));
    const double size = bodies_[id].bounding_radius;
    const double fastest = fastest_calm * calm_speed;
    double& since = of_[id].calm_since;
    const bool calm = calm_in_all && of_[id].met && bodies_[id].restitution < 1 &&
                      squared_norm(velocities[i]) <= fastest * fastest * a * size;
    since = calm ? std::min(since, clock_.now) : never;
    rests = std::max(rests, since < never && a > 0 ? since + calm_time * std::sqrt(size / a) : never);
  }
  return rests;
}

#define KDS_INSTANTIATE(degree) template class RestingContacts<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
