// What rests of bodies: how other worlds go on from it.
#include "collision/motions.hpp"
#include "collision/world/resting/resting_contacts.hpp"

#include <algorithm>
#include <cstddef>
#include <unordered_set>
#include <utility>
#include <vector>

namespace kds::collision {

/// What is left of a cluster when its contacts have ended has spans of its own.
template <class Motion>
bool RestingContacts<Motion>::divisible() const {
  if (!solved()) return false;
  const auto has_span = [this](BodySlot id) { return id < spans_.slots() && spans_.contains(id); };
  std::vector<char> seen(of_.size());
  for (BodySlot id = 0; id < of_.size(); ++id) {
    const double ends = of_[id].span_ends;
    if (ends == -never || ends == never || seen[id] || has_span(id)) continue;
    const std::vector<BodySlot> bodies = island(id);
    for (const BodySlot each : bodies) seen[each] = 1;
    if (std::none_of(bodies.begin(), bodies.end(), has_span)) return false;
  }
  return true;
}

template <class Motion>
RestingProgress RestingContacts<Motion>::progress(BodySlot id) const {
  if (id >= of_.size()) return {};
  const Member& member = of_[id];
  Progress::State state{.span_ends = member.span_ends, .calm_since = member.calm_since};
  if (id < spans_.slots()) state.looked_at = spans_.time(id);
  const auto number = [this](BodySlot slot) { return slot == no_body ? no_body : bodies_.number(slot); };
  for (const Slot slot : in_order(id)) {
    Contact contact = contacts_[slot];
    if (bodies_.fixed(id) && contact.b != no_body) continue;  // It goes with the other body.
    contact.a = number(contact.a), contact.b = number(contact.b);
    contact.seen = 0, contact.place = 0, contact.listed = 0;
    state.contacts.push_back(contact);
    state.releases.push_back(release(slot));
  }
  return {std::move(state), member.met};
}

template <class Motion>
void RestingContacts<Motion>::go_on_from(BodySlot id, const Progress& progress,
                                         const std::function<BodySlot(BodySlot)>& slot_of) {
  if (progress.is_none()) return;
  member(id).met = progress.met();
  if (!progress.state()) return;
  const Progress::State& state = *progress.state();
  of_[id].span_ends = state.span_ends;
  of_[id].calm_since = state.calm_since;
  of_[id].carried = !state.contacts.empty();
  if (state.looked_at < never) set_span(id, state.looked_at);
  for (std::size_t i = 0; i < state.contacts.size(); ++i) {
    Contact contact = state.contacts[i];
    for (BodySlot* const body : {&contact.a, &contact.b}) {
      if (*body == no_body) continue;
      const BodySlot slot = *body == bodies_.number(id) ? id : slot_of(*body);
      if (slot == no_body) ContactsOfBoth::refuse(bodies_.number(id));
      *body = slot;
    }
    const BodySlot other = contact.a == id ? contact.b : contact.a;
    const bool leans = other != no_body && !bodies_.fixed(other);
    if (const Slot slot = leans ? listed_by_other(contact, id) : none; slot != none) {
      list(slot, id);
      of_both_.brought_by_second();
      continue;
    }
    const Slot slot = give_slot(contact);
    list(slot, id);
    leans ? of_both_.brought_by_first() : list(slot, other);
    if (state.releases[i] < (Motion::degree <= 2 ? never : contact.ends)) {
      releases_.set(slot, state.releases[i]);
    } else {
      schedule_release(slot);  // as at a new horizon: the other world may have looked less far ahead
    }
  }
}

/// A contact of a body and one that is not fixed, which has listed it while the body has not; `none` if there is none.
template <class Motion>
typename RestingContacts<Motion>::Slot RestingContacts<Motion>::listed_by_other(const Contact& contact,
                                                                                BodySlot id) const {
  const BodySlot other = contact.a == id ? contact.b : contact.a;
  if (!rests(other)) return none;
  const auto& mine = of_[id].contacts;
  for (const Slot slot : of_[other].contacts) {
    const Contact& listed = contacts_[slot];
    if (listed.a != contact.a || listed.b != contact.b || listed.normal != contact.normal) continue;
    if (std::find(mine.begin(), mine.end(), slot) == mine.end()) return slot;
  }
  return none;
}

template <class Motion>
void RestingContacts<Motion>::let_go(BodySlot id) {
  if (id >= of_.size()) return;
  for (const Slot slot : std::vector<Slot>(of_[id].contacts)) {
    contacts_[slot].alive = false;
    releases_.clear(slot);
    free_.push_back(slot);
    unlist(slot);
  }
  if (id < spans_.slots()) spans_.clear(id);
  of_[id] = {};
}

template <class Motion>
bool RestingContacts<Motion>::leans(BodySlot id) const {
  if (!rests(id) || bodies_.fixed(id)) return false;
  return std::any_of(of_[id].contacts.begin(), of_[id].contacts.end(), [this](Slot slot) {
    const Contact& contact = contacts_[slot];
    return contact.b != no_body && !bodies_.fixed(contact.a) && !bodies_.fixed(contact.b);
  });
}

template <class Motion>
std::vector<BodySlot> RestingContacts<Motion>::island(BodySlot id) const {
  std::vector<BodySlot> bodies{id};
  std::unordered_set<BodySlot> found{id};
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const BodySlot at = bodies[i];
    if (!rests(at) || bodies_.fixed(at)) continue;
    for (const Slot slot : of_[at].contacts) {
      const Contact& contact = contacts_[slot];
      const BodySlot other = contact.a == at ? contact.b : contact.a;
      if (other != no_body && !bodies_.fixed(other) && found.insert(other).second) bodies.push_back(other);
    }
  }
  std::sort(bodies.begin(), bodies.end(), [this](BodySlot x, BodySlot y) { return bodies_.before(x, y); });
  return bodies;
}

template <class Motion>
void RestingContacts<Motion>::begin_shared() {
  shared_.begin();
  for (const Contact& contact : contacts_) {
    if (contact.alive) note_shared(contact.a, contact.b);
  }
}

/// Two bodies lean on each other, or one strikes what the other leans on: that is one island, or might have been.
template <class Motion>
void RestingContacts<Motion>::note_shared(BodySlot a, BodySlot b) {
  if (!shared_.any_copies() || b == no_body || bodies_.fixed(a) || bodies_.fixed(b)) return;
  shared_.link(a, b, [this](BodySlot id) { return island(id); });
}

/// What two bodies do that meet depends on all that they lean on.
template <class Motion>
void RestingContacts<Motion>::note_struck(const Contact& contact) {
  if (contact.b != no_body && (leans(contact.a) || leans(contact.b))) note_shared(contact.a, contact.b);
  for (const BodySlot id : {contact.a, contact.b}) {
    if (id != no_body && shared_.is_shared(id) && leans(id)) shared_.concern(island(id));
  }
}

template <class Motion>
void RestingContacts<Motion>::note_concerned(const Island& island) {
  if (island.free < 2) return;
  const auto end = island.bodies.begin() + static_cast<std::ptrdiff_t>(island.free);
  for (auto id = island.bodies.begin(); id != end; ++id) listener_->tell_touched(*id);
  if (shared_.is_shared(island.bodies.front())) shared_.concern({island.bodies.begin(), end});
}

template <class Motion>
void RestingContacts<Motion>::set_aside() {
  kept_.take(bodies_, *this, of_.size());
  contacts_.clear(), free_.clear(), of_.clear(), disturbed_.clear();
  releases_.resize(0);
  spans_.resize(0);
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class RestingContacts<motion>;
KDS_FOR_EACH_PATH(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
