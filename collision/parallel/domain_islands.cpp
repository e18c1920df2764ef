// What a domain knows of islands: bodies that lean on each other, of which some may be owned elsewhere.
#include "collision/motions.hpp"
#include "collision/parallel/domain.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace kds::collision {

template <class Motion>
bool Domain<Motion>::leans(BodySlot slot) const {
  return engine_.parts().resting.leans(slot);
}

/// An island is known wholly. What owned bodies meet has to be right as far as bodies reach that lean on them.
template <class Motion>
void Domain<Motion>::begin_islands() {
  shared_copies_.clear();
  engine_.transfer().islands().begin_shared();
  note_islands();
  report_.begun_outside = report_.overshoot;
  find_islands(world_.now());
  islands_ = std::move(next_islands_);
  constexpr double least_room = 0.125;  // of the halo: less makes windows that are too short
  if (!(division_.room() - report_.begun_outside > least_room * division_.halo)) report_.divisible = false;
}

/// Takes note of what has happened to islands with bodies of several domains.
template <class Motion>
void Domain<Motion>::note_islands() {
  const double t = world_.now();
  SharedIslands& islands = engine_.transfer().islands().shared();
  for (const BodySlot slot : islands.take_shared()) {
    const Followed copy{slot, 0, t, engine_.bodies().motion(slot)};
    follow_outside(copy, t);
    shared_copies_.insert_or_assign(slot, copy);
  }
  for (const auto& island : islands.take_concerned()) mark(island, cause_at(t), t);
  note_touched();
}

/// Of bodies that turn: what an event has changed of others than those that have met.
template <class Motion>
void Domain<Motion>::note_touched() {
  if constexpr (turns<Motion>) {
    std::vector<BodySlot> touched = engine_.transfer().islands().take_touched();
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    for (const BodySlot slot : touched) {
      if (!engine_.bodies().fixed(slot)) changed(slot, world_.now());
    }
  }
}

/// If bodies of an island are owned by this domain and others: all mark what has happened to it, from which events of
/// all may follow. Each two have a mark of their own, and each domain has its marks in the order of the others, so they
/// are passed by pair after pair: (0, 1), (0, 2), (1, 2).
template <class Motion>
void Domain<Motion>::mark(std::span<const BodySlot> island, const DomainEvent::Cause& cause, double t) {
  bool mine = false;
  std::set<DomainIndex> others;
  for (const BodySlot slot : island) owner_of(slot) == index_ ? void(mine = true) : void(others.insert(owner_of(slot)));
  if (!mine || !logs_) return;
  const BodyId first = engine_.bodies().keys().key(island.front());
  for (const DomainIndex other : others) {
    put({Kind::mark, other, first, first, {.time = t}, 0, 0, cause});
  }
}

/// Finds the islands of followed bodies, as they are at t.
template <class Motion>
void Domain<Motion>::find_islands(double t) {
  next_islands_ = {};
  const auto& bodies = engine_.bodies();
  for (const Followed& body : followed_) {
    const BodySlot mover = detail::mover_of(bodies, body.slot);
    if (next_islands_.of.contains(body.slot) || !leans(mover)) continue;
    const std::vector<BodySlot> island = engine_.parts().resting.island(mover);
    std::vector<Eigen::Vector3d> places;
    for (const BodySlot slot : island) places.push_back(place_at(bodies.path(slot), t));
    auto& knowers = next_islands_.knowers.emplace_back();
    if (!division_.find_knowers(places, knowers)) report_.divisible = false;
    for (std::size_t i = 0; i < island.size(); ++i) {
      if (known_[island[i]].role == Role::copy) continue;
      const typename Islands::Place place{static_cast<DomainIndex>(division_.partition.cell_of(places[i])),
                                          next_islands_.knowers.size() - 1};
      next_islands_.of[island[i]] = place;
      for (const BodySlot sensor : bodies.attachments().sensors(island[i])) next_islands_.of[sensor] = place;
    }
  }
}

template <class Motion>
std::vector<BodySlot> Domain<Motion>::with_islands(std::span<const BodySlot> numbers) const {
  std::vector<BodySlot> all(numbers.begin(), numbers.end());
  const auto& bodies = engine_.bodies();
  std::set<BodySlot> seen;
  for (const BodySlot body : numbers) {
    const BodySlot at = slot_of(body);
    if (!leans(at) || seen.contains(at)) continue;
    for (const BodySlot slot : engine_.parts().resting.island(at)) {
      seen.insert(slot);
      all.push_back(number(slot));
      for (const BodySlot sensor : bodies.attachments().sensors(slot)) all.push_back(number(sensor));
    }
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

#define KDS_INSTANTIATE(motion) KDS_TEMPLATE_PART class Domain<motion>;
KDS_FOR_EACH_MOTION(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
