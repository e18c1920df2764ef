// What rests of bodies that turn: how other worlds go on from it.
#include "collision/motions.hpp"
#include "collision/world/resting/resting_contacts.hpp"
#include "collision/world/turning/turning_rest.hpp"

#include <algorithm>
#include <cstddef>
#include <unordered_set>
#include <utility>
#include <vector>

namespace kds::collision {

/// A pair of which one body is fixed goes with the other.
template <class Motion>
TurningRestProgress TurningRest<Motion>::progress(BodySlot slot) const {
  if (slot >= of_.size() || bodies_.fixed(slot)) return {};
  const Member& member = of_[slot];
  Progress::State state{.since = member.since, .rests = member.rests};
  if (member.looked > member.since) state.looked = member.looked;
  if (member.rests) state.ignored = member.ignored;
  if (!member.others.empty()) state.carrier = member.carrier;
  for (const BodySlot other : member.others) {
    state.links.push_back({bodies_.number(other), pairs_.at(bodies_.in_order(slot, other))});
  }
  return Progress(std::move(state));
}

template <class Motion>
void TurningRest<Motion>::go_on_from(BodySlot slot, const Progress& progress,
                                     const std::function<BodySlot(BodySlot)>& slot_of) {
  if (progress.is_none()) return;
  const Progress::State& state = *progress.state();
  Member& body = member(slot);
  body.since = state.since, body.looked = state.looked, body.rests = state.rests;
  body.ignored = state.ignored, body.carrier = state.carrier;
  for (const Progress::Link& link : state.links) {
    const BodySlot other = slot_of(link.other);
    if (other == no_body) ContactsOfBoth::refuse(bodies_.number(slot));
    const Key key = bodies_.in_order(slot, other);
    if (pairs_.contains(key)) {  // The other, which is not fixed, has gone on before.
      of_both_.brought_by_second();
      continue;
    }
    if (!bodies_.fixed(other)) of_both_.brought_by_first();
    list(key) = link.pair;
    resting_ += link.pair.rests;
  }
}

template <class Motion>
void TurningRest<Motion>::let_go(BodySlot slot) {
  blows_.forget(slot);
  if (slot >= of_.size()) return;
  while (!of_[slot].others.empty()) {
    const Key key = bodies_.in_order(slot, of_[slot].others.back());
    resting_ -= pairs_[key].rests;
    unlist(key);
  }
  of_[slot] = {};
}

template <class Motion>
void TurningRest<Motion>::set_aside() {
  kept_.take(bodies_, *this, of_.size());
  pairs_.clear(), of_.clear();
  blows_.become({});
  resting_ = 0;
}

/// Bodies that are not fixed.
template <class Motion>
template <class Take>
void TurningRest<Motion>::each_partner(BodySlot slot, const Take& take) const {
  const auto free = [&](BodySlot other) {
    if (!bodies_.fixed(other)) take(other);
  };
  if (slot < of_.size()) std::for_each(of_[slot].others.begin(), of_[slot].others.end(), free);
  blows_.each_partner(slot, clock_.now, free);
}

template <class Motion>
bool TurningRest<Motion>::leans(BodySlot slot) const {
  if (bodies_.fixed(slot)) return false;
  bool any = false;
  each_partner(slot, [&](BodySlot) { any = true; });
  return any;
}

template <class Motion>
std::vector<BodySlot> TurningRest<Motion>::island(BodySlot slot) const {
  std::vector<BodySlot> bodies{slot};
  std::unordered_set<BodySlot> found{slot};
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    each_partner(bodies[i], [&](BodySlot other) {
      if (found.insert(other).second) bodies.push_back(other);
    });
  }
  std::sort(bodies.begin(), bodies.end(), before());
  return bodies;
}

template <class Motion>
void TurningRest<Motion>::begin_shared() {
  shared_.begin();
  touched_.clear();
  for (const auto& [key, pair] : pairs_) note_linked(key.first, key.second);
  shared_.take_concerned();  // Nothing has happened to them.
}

/// Two bodies are of one island from now on.
template <class Motion>
void TurningRest<Motion>::note_linked(BodySlot a, BodySlot b) {
  if (!shared_.any_copies() || bodies_.fixed(a) || bodies_.fixed(b)) return;
  shared_.link(a, b, [this](BodySlot slot) { return island(slot); });
  if (shared_.is_shared(a)) shared_.concern(island(a));
}

/// What two bodies do that meet depends on the islands of both.
template <class Motion>
void TurningRest<Motion>::note_struck(BodySlot a, BodySlot b) {
  if (!shared_.any_copies()) return;
  const bool both = !bodies_.fixed(a) && !bodies_.fixed(b);
  if (both && (leans(a) || leans(b))) shared_.link(a, b, [this](BodySlot slot) { return island(slot); });
  for (const BodySlot slot : {a, b}) {
    if (shared_.is_shared(slot) && leans(slot)) shared_.concern(island(slot));
  }
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class TurningRest<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
