// What the world tells of one instant: all of it in one order, whatever the broad phase.
#include "collision/world.hpp"

#include <algorithm>
#include <tuple>
#include <utility>
#include <vector>

namespace kds::collision {

/// As WorldListener says. Where a pair ended with a body that was removed, and began again with the next of its id, the
/// end comes first.
bool detail::Pending::operator<(const Pending& other) const {
  const auto key = [](const Pending& event) {
    const auto stage = [&] {
      switch (event.kind) {
        case Kind::held:
          return 0;
        case Kind::moved:
          return 1;
        case Kind::pair_ended:
        case Kind::pair_began:
          return 2;
        case Kind::separation:
          return 3;
        case Kind::overlap:
          return 4;
      }
      return 5;
    };
    return std::tuple(stage(), event.a, event.b, event.kind);
  };
  return key(*this) < key(other);
}

template <int Degree>
void World<Degree>::report_next() {
  const Pending event = *pending_.begin();
  pending_.erase(pending_.begin());
  PairEvent pair{event.a, event.b, event.contact};
  switch (event.kind) {
    case Pending::Kind::overlap:
      ++counters_.overlaps;
      return tell([&](Listener& listener) { listener.overlap(*this, pair); });
    case Pending::Kind::separation:
      ++counters_.separations;
      return tell([&](Listener& listener) { listener.separation(*this, pair); });
    case Pending::Kind::held:
      return tell([&](Listener& listener) { listener.held(*this, pair); });
    case Pending::Kind::moved:
      return tell([&](Listener& listener) { listener.moved(*this, event.a); });
    case Pending::Kind::pair_began:
      return tell([&](Listener& listener) { listener.pair_began(*this, event.a, event.b, event.contact.time); });
    case Pending::Kind::pair_ended:
      return tell([&](Listener& listener) { listener.pair_ended(*this, event.a, event.b, event.contact.time); });
  }
}

/// Bounding volumes that meet and part at one instant, or part and meet (bodies that are moved in turn, lists of ends
/// that are brought into order one after the other), have done neither.
template <int Degree>
void World<Degree>::report_pair(bool began, BodyId a, BodyId b) {
  using Kind = typename Pending::Kind;
  if (take_back(began ? Kind::pair_ended : Kind::pair_began, a, b)) return;
  report(began ? Kind::pair_began : Kind::pair_ended, a, b, {.time = now_});
}

/// Forgets a report that has been undone before it was made; false if there is none.
template <int Degree>
bool World<Degree>::take_back(typename Pending::Kind kind, BodyId a, BodyId b) {
  if (pending_.empty()) return false;
  const auto it = pending_.find({kind, a, b, {}});
  if (it == pending_.end() || it->removed) return false;
  pending_.erase(it);
  return true;
}

/// A body has been removed, and has no pairs any more: its separations are told as they were, and what would be told of
/// a body that is there is not.
template <int Degree>
void World<Degree>::keep_reports_of(BodyId removed) {
  using Kind = typename Pending::Kind;
  std::vector<Pending> reports;
  std::erase_if(pending_, [&](const Pending& event) {
    if (event.a != removed && event.b != removed) return false;
    reports.push_back(event);
    return true;
  });
  for (Pending event : reports) {
    if (event.kind == Kind::overlap || event.kind == Kind::moved) continue;
    event.removed = true;
    pending_.insert(event);
  }
}

template class World<1>;
template class World<2>;

}  // namespace kds::collision
