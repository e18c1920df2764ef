// What rests of single bodies: how other worlds go on from it.
#include "collision/motions.hpp"
#include "collision/world/resting/resting_contacts.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::collision {

template <class Motion>
bool RestingContacts<Motion>::divisible() const {
  if (!solved()) return false;
  const auto leans = [this](const Contact& contact) {
    return contact.alive && contact.b != no_body && !bodies_.fixed(contact.a) && !bodies_.fixed(contact.b);
  };
  if (std::any_of(contacts_.begin(), contacts_.end(), leans)) return false;
  for (BodySlot id = 0; id < of_.size(); ++id) {
    // A cluster of several bodies has one span; what is left of it when their contacts have ended has spans of its own.
    const double ends = of_[id].span_ends;
    const bool waits_for_others = ends != -never && ends != never && !(id < spans_.slots() && spans_.contains(id));
    if (waits_for_others) return false;
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
    state.releases.push_back(releases_.time(slot));
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
      if (slot == no_body || (slot != id && !bodies_.fixed(slot))) {
        throw std::runtime_error("World: body " + std::to_string(bodies_.number(id)) +
                                 " rests on one that is not there, or is not fixed");
      }
      *body = slot;
    }
    const Slot slot = give_slot(contact);
    if (state.releases[i] < never) {
      releases_.set(slot, state.releases[i]);
    } else {
      schedule_release(slot);  // as at a new horizon
    }
  }
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
void RestingContacts<Motion>::set_aside() {
  kept_.clear();
  for (BodySlot id = 0; id < of_.size(); ++id) {
    if (bodies_.alive(id)) keep(id, progress(id));
  }
  contacts_.clear(), free_.clear(), of_.clear(), disturbed_.clear();
  releases_.resize(0);
  spans_.resize(0);
}

template <class Motion>
void RestingContacts<Motion>::go_on() {
  const auto slot_of = [this](BodySlot slot) { return bodies_.alive(slot) ? slot : no_body; };
  for (BodySlot id = 0; id < kept_.size(); ++id) {
    if (bodies_.alive(id)) go_on_from(id, kept_[id], slot_of);
  }
  kept_.clear();
}

template <class Motion>
const RestingProgress& RestingContacts<Motion>::kept(BodySlot id) const {
  static const Progress nothing;
  return id < kept_.size() ? kept_[id] : nothing;
}

template <class Motion>
void RestingContacts<Motion>::keep(BodySlot id, const Progress& progress) {
  if (id >= kept_.size()) {
    if (progress.is_none()) return;
    kept_.resize(id + std::size_t{1});
  }
  kept_[id] = progress;
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class RestingContacts<motion>;
KDS_FOR_EACH_PATH(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
