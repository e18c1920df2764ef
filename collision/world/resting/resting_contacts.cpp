// Resting contacts: which there are, when their bodies may meet elsewhere, and when they end.
#include "collision/world/resting/resting_contacts.hpp"
#include "collision/motions.hpp"
#include "collision/narrow_phase/piecewise_contact.hpp"
#include "collision/vectors.hpp"
#include "collision/world/resting/sliding_time.hpp"

#include <algorithm>
#include <cmath>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

/// How far a resting pair may part before its contact ends, relative to the smaller bounding radius: balls that slide
/// over each other follow a plane of contact until they have parted by this, and meet again on the next. Less makes
/// that more exact, and costs more pieces.
constexpr double slack = 0x1p-20;
/// The same relative to the coordinates, which are rounded whenever a motion is restarted.
constexpr double coordinate_slack = 0x1p-40;

/// How far a mesh in a cluster may sink by rounding beyond its present contacts before that counts as a new contact;
/// relative to the smaller bounding radius.
constexpr double approach_slack = 0x1p-37;

template <int Degree>
certificates::PointMotion<Degree> shifted(certificates::PointMotion<Degree> motion, const Vector3d& by) {
  motion.coefficients[0] += by;
  return motion;
}

template <int Degree>
double slack_of(const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b, double t) {
  const double size = std::min(a.shape.bounding_radius, b.shape.bounding_radius);
  const double coordinates = a.motion.position(t).cwiseAbs().maxCoeff() + b.motion.position(t).cwiseAbs().maxCoeff();
  return std::max(slack * size, coordinate_slack * coordinates);
}

}  // namespace

/// The contacts of a body, or of another that has fewer: a floor has many. Precondition: a has a member.
template <class Motion>
const std::vector<detail::RestingSlot>& RestingContacts<Motion>::fewer(BodySlot a, BodySlot b) const {
  static const std::vector<Slot> without_member;
  if (b == no_body) return of_[a].contacts;
  const std::vector<Slot>& of_b = b < of_.size() ? of_[b].contacts : without_member;
  return of_b.size() < of_[a].contacts.size() ? of_b : of_[a].contacts;
}

template <class Motion>
typename RestingContacts<Motion>::Slot RestingContacts<Motion>::find_among(BodySlot a, BodySlot b, int wall) const {
  for (const Slot slot : fewer(a, b)) {
    const Contact& contact = contacts_[slot];
    if (contact.a == a && contact.b == b && contact.wall == wall) return slot;
  }
  return none;
}

/// The contact of the same bodies and with nearly the same normal; convex bodies have one contact at most.
template <class Motion>
typename RestingContacts<Motion>::Slot RestingContacts<Motion>::find_like(const Contact& contact) const {
  if (!gaps_.concave(contact)) return find(contact.a, contact.b, contact.wall);
  if (!rests(contact.a)) return none;
  for (const Slot slot : fewer(contact.a, contact.b)) {
    const Contact& other = contacts_[slot];
    if (other.a == contact.a && other.b == contact.b && dot(other.normal, contact.normal) > detail::same_normal)
      return slot;
  }
  return none;
}

template <class Motion>
void RestingContacts<Motion>::add(const Contact& contact) {
  member(contact.a);
  for (const Slot slot : fewer(contact.a, contact.b)) {
    Contact& other = contacts_[slot];
    if (other.a != contact.a || other.b != contact.b || !(dot(other.normal, contact.normal) > detail::same_normal))
      continue;
    other.normal = contact.normal;
    other.fresh = true;
    return;
  }
  const Slot slot = give_slot(contact);
  for (const BodySlot id : {contact.a, contact.b}) list(slot, id);
  note_shared(contact.a, contact.b);
  contacts_[slot].alive = true;
  contacts_[slot].fresh = true;
  contacts_[slot].began = clock_.now;
  contacts_[slot].depth = std::max(gaps_.overlap(contact), 0.0);
  listener_->tell_resting(true, contacts_[slot]);
}

/// The contacts of a body in the order in which they began, which does not depend on their slots.
template <class Motion>
std::vector<detail::RestingSlot> RestingContacts<Motion>::in_order(BodySlot id) const {
  std::vector<Slot> slots = of_[id].contacts;
  if (!bodies_.fixed(id)) return slots;
  const detail::RestingRank rank{&contacts_, &bodies_.keys()};
  std::sort(slots.begin(), slots.end(), [&](Slot slot_x, Slot slot_y) {
    const Contact& x = contacts_[slot_x];
    const Contact& y = contacts_[slot_y];
    if (x.began != y.began) return x.began < y.began;
    if (x.a != y.a || x.b != y.b) return rank(slot_x) < rank(slot_y);
    if (x.wall != y.wall) return x.wall < y.wall;
    return std::lexicographical_compare(x.normal.begin(), x.normal.end(), y.normal.begin(), y.normal.end());
  });
  return slots;
}

/// A slot with the contact, which its bodies are to list.
template <class Motion>
typename RestingContacts<Motion>::Slot RestingContacts<Motion>::give_slot(const Contact& contact) {
  Slot slot;
  if (free_.empty()) {
    slot = static_cast<Slot>(contacts_.size());
    contacts_.emplace_back();
    if (releases_.slots() < contacts_.size()) releases_.resize(2 * contacts_.size());
  } else {
    slot = free_.back();
    free_.pop_back();
  }
  contacts_[slot] = contact;
  return slot;
}

template <class Motion>
void RestingContacts<Motion>::list(Slot slot, BodySlot id) {
  if (id == no_body) return;
  auto& contacts = member(id).contacts;
  if (bodies_.fixed(id)) contacts_[slot].listed = static_cast<std::uint32_t>(contacts.size());
  contacts.push_back(slot);
}

/// Takes a contact off the lists of its bodies.
template <class Motion>
void RestingContacts<Motion>::unlist(Slot slot) {
  const Contact& contact = contacts_[slot];
  for (const BodySlot id : {contact.a, contact.b}) {
    if (id == no_body) continue;
    auto& list = of_[id].contacts;
    if (bodies_.fixed(id)) {
      list[contact.listed] = list.back();
      contacts_[list.back()].listed = contact.listed;
      list.pop_back();
    } else {
      list.erase(std::find(list.begin(), list.end(), slot));
    }
  }
}

template <class Motion>
void RestingContacts<Motion>::drop(Slot slot) {
  Contact& contact = contacts_[slot];
  contact.alive = false;
  listener_->tell_resting(false, contact);
  releases_.clear(slot);
  free_.push_back(slot);
  unlist(slot);
  for (const BodySlot id : {contact.a, contact.b}) {
    if (id != no_body && (contact.b == no_body || !bodies_.fixed(id))) disturb(id);
  }
  if (contact.b != no_body) listener_->changed(contact.a, contact.b);
}

template <class Motion>
void RestingContacts<Motion>::drop_all(BodySlot id) {
  if (!rests(id)) return;
  const std::vector<Slot> slots = in_order(id);
  std::for_each(slots.rbegin(), slots.rend(), [this](Slot slot) { drop(slot); });
}

template <class Motion>
bool RestingContacts<Motion>::drop_filtered(BodySlot id) {
  if (!rests(id)) return false;
  std::vector<Slot> over;
  for (const Slot slot : in_order(id)) {
    const Contact& contact = contacts_[slot];
    if (contact.b != no_body && !bodies_.may_collide(contact.a, contact.b)) over.push_back(slot);
  }
  for (const Slot slot : over) drop(slot);
  return !over.empty();
}

template <class Motion>
std::vector<BodySlot> RestingContacts<Motion>::partners(BodySlot id) const {
  std::vector<BodySlot> found;
  if (!rests(id)) return found;
  for (const Slot slot : in_order(id)) {
    const Contact& contact = contacts_[slot];
    if (contact.b != no_body && holds(contact.a, contact.b)) found.push_back(contact.a == id ? contact.b : contact.a);
  }
  return found;
}

/// Convex bodies that rest on each other stay on either side of a plane through the point of contact, so they cannot
/// meet again before the contact ends. A mesh may meet the other body elsewhere. Where rounding makes the search find
/// the resting contact itself, the body is moved away from it by some roundings, as long as the two motions stay as
/// they are: so the answer does not depend on how often it is asked for.
template <class Motion>
ContactEstimate RestingContacts<Motion>::next_contact(BodySlot id_a, BodySlot id_b, double from) {
  const auto a = bodies_.moving(id_a);
  const auto b = bodies_.moving(id_b);
  const double horizon = clock_.horizon;
  const bool plane = bodies_.unbounded(id_a) || bodies_.unbounded(id_b);
  if (plane || (!concave(a.shape.shape) && !concave(b.shape.shape))) {
    if (keeps_apart(find(id_a, id_b))) return {never, true};
    return {first_contact(a, b, from, horizon, ContactMode::resolved), true};
  }
  // A mesh is searched no farther than motions are likely to last.
  const double size = std::min(a.shape.bounding_radius, b.shape.bounding_radius);
  const double some = from + sliding_time(a.motion, b.motion, from, most_slide * size);
  const double until = some > from ? std::min(some, horizon) : horizon;
  const auto first = [&](const Vector3d& apart) {
    const Motion farther = shifted(b.motion, apart);
    return first_contact(a, MovingShape<Motion>{b.shape, farther}, from, until, ContactMode::resolved);
  };
  const auto found = [&](double t) {
    return t <= until || until == horizon ? ContactEstimate{t, true} : ContactEstimate{until, false};
  };
  const Vector3d away = moved_away(id_a, id_b);
  const double t = first(away);
  if (!away.isZero(0) || t != from) return found(t);
  contacts_[find(id_a, id_b)].left_behind = std::max(a.motion.start, b.motion.start);
  return found(first(moved_away(id_a, id_b)));
}

/// By how much the second of two bodies that rest on each other, one of them concave, is moved away from the contacts
/// that last where their next one is sought.
template <class Motion>
Vector3d RestingContacts<Motion>::moved_away(BodySlot id_a, BodySlot id_b) const {
  const auto &a = bodies_.path(id_a), &b = bodies_.path(id_b);
  const double began = std::max(a.start, b.start);
  Vector3d out = Vector3d::Zero();
  bool left_behind = false;
  for (const Slot slot : fewer(id_a, id_b)) {
    if (contacts_[slot].a != id_a || contacts_[slot].b != id_b) continue;
    out += contacts_[slot].normal;
    left_behind = left_behind || contacts_[slot].left_behind == began;
  }
  const double size_a = bodies_[id_a].bounding_radius, size_b = bodies_[id_b].bounding_radius;
  // In a cluster the approach that the solver's sweeps leave is no contact.
  if (clustered(id_a) || clustered(id_b)) return approach_slack * std::min(size_a, size_b) * out;
  if (!left_behind) return Vector3d::Zero();
  const double coordinates = a.position(began).cwiseAbs().maxCoeff() + b.position(began).cwiseAbs().maxCoeff();
  return coordinate_slack * (size_a + size_b + coordinates) * out;
}

/// Where the next contact was sought with bodies moved away from those that last, they may not approach at any place
/// where they touch as they are: then it is the one that was found.
template <class Motion>
collision::Contact RestingContacts<Motion>::contact_at(BodySlot id_a, BodySlot id_b, double t,
                                                       const FoundTouch& found) const {
  const auto a = bodies_.moving(id_a);
  const auto b = bodies_.moving(id_b);
  const collision::Contact contact = collision::contact_at(a, b, t, found);
  if (bodies_.unbounded(id_a) || bodies_.unbounded(id_b)) return contact;
  if (!concave(a.shape.shape) && !concave(b.shape.shape)) return contact;
  const Vector3d away = moved_away(id_a, id_b);
  if (away.isZero(0) || approaching(contact, a, b)) return contact;
  const Motion farther = shifted(b.motion, away);
  const MovingShape<Motion> moved{b.shape, farther};
  const collision::Contact other = collision::contact_at(a, moved, t);
  return approaching(other, a, moved) ? other : contact;
}

/// A resting contact ends when the bodies have slid off each other, or have parted by `slack`.
template <class Motion>
void RestingContacts<Motion>::schedule_release(Slot slot) {
  Contact& contact = contacts_[slot];
  contact.unfinished = false;
  if (clustered(contact.a) || (contact.b != no_body && clustered(contact.b))) return;  // The cluster's spans end it.
  if (contact.b == no_body) {  // Walls have no edge to slide off.
    if constexpr (Motion::degree >= 3) releases_.set(slot, contact.ends);
    return;
  }
  const double now = clock_.now;
  const auto a = bodies_.moving(contact.a);
  const auto b = bodies_.moving(contact.b);
  bool together = true;
  for (std::size_t i = 1; i <= Motion::degree; ++i) {
    together = together && a.motion.coefficients[i] == b.motion.coefficients[i];
  }
  bool steady = true;  // the same polynomial about any start
  for (std::size_t i = 2; i <= Motion::degree; ++i) steady = steady && a.motion.coefficients[i].isZero(0);
  if (together && (steady || a.motion.start == b.motion.start)) {
    return Motion::degree >= 3 ? releases_.set(slot, contact.ends) : releases_.clear(slot);
  }
  // A mesh is followed from triangle to triangle, so no farther than motions are likely to last. When that is looked at
  // must make no difference.
  double until = clock_.horizon;
  double at = now;
  if (gaps_.concave(contact)) {
    at = std::max(a.motion.start, b.motion.start);
    const double some = now + sliding_time(a.motion, b.motion, now, most_slide * gaps_.size(contact));
    if (some > now) until = std::min(until, some);
  }
  const Motion nearer = shifted(b.motion, -slack_of(a, b, at) * contact.normal);
  const double t = first_separation(a, MovingShape<Motion>{b.shape, nearer}, now, until);
  contact.unfinished = !(t <= until) && until < clock_.horizon;
  const double ends = contact.unfinished ? until : t;
  releases_.set(slot, Motion::degree >= 3 ? std::min(ends, contact.ends) : ends);
}

/// The next contact to end. If several of the same two bodies end at one time, the order of their normals decides.
template <class Motion>
typename RestingContacts<Motion>::Slot RestingContacts<Motion>::first_release() const {
  Slot first = releases_.top().slot;
  const Contact& top = contacts_[first];
  for (const Slot slot : fewer(top.a, top.b)) {
    const Contact& contact = contacts_[slot];
    if (contact.a != top.a || contact.b != top.b || releases_.time(slot) != releases_.top().time) continue;
    const auto& normal = contact.normal;
    const auto& least = contacts_[first].normal;
    if (std::lexicographical_compare(normal.begin(), normal.end(), least.begin(), least.end())) first = slot;
  }
  return first;
}

/// Whether a round body that touches no other slides over a face of a fixed mesh, and will meet nothing else of it
/// soon: in a groove it would bounce from side to side.
template <class Motion>
bool RestingContacts<Motion>::alone_on_face(const Contact& contact) const {
  if (contact.b == no_body || bodies_.fixed(contact.a) == bodies_.fixed(contact.b)) return false;
  const bool first = bodies_.fixed(contact.b);
  const BodySlot slider = first ? contact.a : contact.b, mesh = first ? contact.b : contact.a;
  if (of_[slider].contacts.size() != 1 || !gaps_.on_face(contact)) return false;
  const double now = clock_.now;
  Motion slides = bodies_.motion(slider).restarted(now);
  const Motion ground = bodies_.motion(mesh).restarted(now);
  for (std::size_t i = 1; i <= Motion::degree; ++i) {
    const Eigen::Vector3d free = i == 1 ? slides.coefficients[1] : bodies_.free_term(slider, i, now);
    const Eigen::Vector3d apart = free - ground.coefficients[i];
    slides.coefficients[i] = free - dot(contact.normal, apart) * contact.normal;
  }
  slides.coefficients[0] += (first ? -1 : 1) * approach_slack * gaps_.size(contact) * contact.normal;
  constexpr double soon = 16;  // of the longest spans that a cluster would take
  // Beyond the horizon, too: that must make no difference.
  const double until = now + soon * longest_span(slider);
  const auto a = bodies_.moving(contact.a), b = bodies_.moving(contact.b);
  const double t = first ? first_contact(MovingShape<Motion>{a.shape, slides}, b, now, until, ContactMode::resolved)
                         : first_contact(a, MovingShape<Motion>{b.shape, slides}, now, until, ContactMode::resolved);
  return !(t <= until);
}

template <class Motion>
void RestingContacts<Motion>::process() {
  const bool is_span = releases_.empty() || (!spans_.empty() && spans_.top().time < releases_.top().time);
  if (!is_span) {
    const Slot slot = releases_.top().slot;
    const Contact& contact = contacts_[slot];
    if (contact.unfinished && releases_.top().time < contact.ends) return schedule_release(slot);
  }
  last_event_ = {last_event_.count + 1, next_time()};
  if (is_span) {
    const BodySlot id = spans_.top().slot;
    last_event_.is_span = true;
    last_event_.rank.a = bodies_.keys().key(id);
    spans_.clear(id);
    if (bodies_.numbered()) solved_.push_back(id);  // Also where nothing is left to be solved for.
    disturb(id);
    return solve();
  }
  const Slot slot = first_release();
  last_event_.rank = detail::RestingRank{&contacts_, &bodies_.keys()}(slot);
  if (Motion::degree >= 3 && contacts_[slot].ends <= releases_.top().time) {
    part(slot);
  } else if (Motion::degree >= 2 && contacts_[slot].push > 0 && gaps_.turns(contacts_[slot]) &&
             !alone_on_face(contacts_[slot])) {
    gather(bodies_.fixed(contacts_[slot].a) ? contacts_[slot].b : contacts_[slot].a);
  } else {
    drop(slot);
  }
  solve();
}

template <class Motion>
void RestingContacts<Motion>::extend_horizon() {
  for (Slot slot = 0; slot < contacts_.size(); ++slot) {
    const bool known = releases_.contains(slot) && (Motion::degree <= 2 || releases_.time(slot) < contacts_[slot].ends);
    if (contacts_[slot].alive && !known) schedule_release(slot);
  }
}

#define KDS_INSTANTIATE(motion) template class RestingContacts<motion>;
KDS_FOR_EACH_PATH(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
