#include "collision/kinetic_sweep_and_prune.hpp"

#include "kds/audit.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace kds::collision {

template <int Degree>
KineticSweepAndPrune<Degree>::KineticSweepAndPrune(double now)
    : lists_{List(AxisListener{this, 0}), List(AxisListener{this, 1}), List(AxisListener{this, 2})},
      simulator_(now, lists_[0], lists_[1], lists_[2]) {}

template <int Degree>
bool KineticSweepAndPrune<Degree>::overlap(BodyId a, BodyId b) const {
  return overlap_on(lists_[0], a, b) && overlap_on(lists_[1], a, b) && overlap_on(lists_[2], a, b);
}

template <int Degree>
void KineticSweepAndPrune<Degree>::ends_swapped(std::size_t axis, std::uint32_t left, std::uint32_t right) {
  const BodyId left_body = left / 2;
  const BodyId right_body = right / 2;
  if (left_body == right_body) return;
  const BodyId a = std::min(left_body, right_body);
  const BodyId b = std::max(left_body, right_body);
  if (updating_) {
    changes_.push_back({a, b, false});
    return;
  }
  // The two intervals met or parted on this axis; it matters if they overlap on the others. After the swap a minimum
  // on the left means that they have met.
  const bool met = (left & 1) == 0;
  if (overlap_on(lists_[(axis + 1) % 3], a, b) && overlap_on(lists_[(axis + 2) % 3], a, b) &&
      overlap_on(lists_[axis], a, b) == met) {
    changes_.push_back({a, b, met});
  }
}

template <int Degree>
void KineticSweepAndPrune<Degree>::insert(std::span<const Entry> bodies, double now, PairListener& listener) {
  simulator_.set_clock(now);
  box_updates_ += bodies.size();
  if (lists_[0].size() == 0) {
    std::vector<typename List::Entry> ends;
    ends.reserve(2 * bodies.size());
    for (int d = 0; d < 3; ++d) {
      ends.clear();
      for (const Entry& body : bodies) {
        ends.push_back({body.box->min.axis(d), min_end(body.id)});
        ends.push_back({body.box->max.axis(d), max_end(body.id)});
      }
      lists_[static_cast<std::size_t>(d)].assign(ends, now);
    }
    report_overlaps_by_sweep(now, listener);
    return;
  }
  for (const Entry& body : bodies) {
    for (int d = 0; d < 3; ++d) {
      auto& list = lists_[static_cast<std::size_t>(d)];
      list.insert(min_end(body.id), body.box->min.axis(d), now);
      list.insert(max_end(body.id), body.box->max.axis(d), now);
    }
    std::vector<BodyId> partners;
    for (const auto& end : lists_[0].entries()) {
      const BodyId other = end.id / 2;
      if ((end.id & 1) == 0 && other != body.id && overlap(body.id, other)) partners.push_back(other);
    }
    std::sort(partners.begin(), partners.end());
    for (const BodyId other : partners) {
      listener.pair_began(std::min(body.id, other), std::max(body.id, other), now);
    }
  }
}

template <int Degree>
void KineticSweepAndPrune<Degree>::report_overlaps_by_sweep(double now, PairListener& listener) const {
  std::vector<BodyId> open;
  std::vector<std::pair<BodyId, BodyId>> pairs;
  for (const auto& end : lists_[0].entries()) {
    const BodyId id = end.id / 2;
    if ((end.id & 1) == 0) {
      for (const BodyId other : open) {
        if (overlap(id, other)) pairs.emplace_back(std::min(id, other), std::max(id, other));
      }
      open.push_back(id);
    } else if (const auto it = std::find(open.begin(), open.end(), id); it != open.end()) {
      *it = open.back();
      open.pop_back();
    }
  }
  std::sort(pairs.begin(), pairs.end());
  for (const auto& [a, b] : pairs) listener.pair_began(a, b, now);
}

template <int Degree>
void KineticSweepAndPrune<Degree>::remove(BodyId id, double now, PairListener& listener) {
  simulator_.set_clock(now);
  std::vector<BodyId> partners;
  for (const auto& end : lists_[0].entries()) {
    const BodyId other = end.id / 2;
    if ((end.id & 1) == 0 && other != id && overlap(id, other)) partners.push_back(other);
  }
  for (auto& list : lists_) {
    list.remove(min_end(id), now);
    list.remove(max_end(id), now);
  }
  std::sort(partners.begin(), partners.end());
  for (const BodyId other : partners) listener.pair_ended(std::min(id, other), std::max(id, other), now);
}

template <int Degree>
void KineticSweepAndPrune<Degree>::update(BodyId id, const KineticBox<Degree>& box, double now,
                                          PairListener& listener) {
  simulator_.set_clock(now);
  ++box_updates_;
  changes_.clear();
  updating_ = true;
  // The state before each partner's first change is read off at the end: a pair has changed if it was met by an odd
  // number of swaps on some axis, so partners are collected with the old answer taken when first seen.
  struct Seen {
    BodyId a, b;
    std::array<bool, 3> apart_changes;
  };
  std::vector<Seen> seen;
  for (std::size_t d = 0; d < 3; ++d) {
    auto& list = lists_[d];
    changes_.clear();
    list.update(min_end(id), box.min.axis(static_cast<int>(d)), now);
    list.update(max_end(id), box.max.axis(static_cast<int>(d)), now);
    for (const Change& change : changes_) {
      auto it = std::find_if(seen.begin(), seen.end(), [&](const Seen& s) { return s.a == change.a && s.b == change.b; });
      if (it == seen.end()) it = seen.insert(seen.end(), Seen{change.a, change.b, {}});
      it->apart_changes[d] = !it->apart_changes[d];
      ++update_swaps_;
    }
  }
  updating_ = false;
  changes_.clear();
  std::sort(seen.begin(), seen.end(), [](const Seen& x, const Seen& y) { return std::pair(x.a, x.b) < std::pair(y.a, y.b); });
  for (const Seen& pair : seen) {
    // Each swap of a minimum with a maximum of a pair toggles its overlap on that axis.
    bool before = true;
    for (std::size_t d = 0; d < 3; ++d) before = before && (overlap_on(lists_[d], pair.a, pair.b) != pair.apart_changes[d]);
    const bool after = overlap(pair.a, pair.b);
    if (before && !after) listener.pair_ended(pair.a, pair.b, now);
    if (!before && after) listener.pair_began(pair.a, pair.b, now);
  }
}

template <int Degree>
bool KineticSweepAndPrune<Degree>::advance(double limit, PairListener& listener) {
  while (simulator_.step(limit)) {
    if (changes_.empty()) continue;
    const Change change = changes_.front();
    changes_.clear();
    if (change.began) {
      listener.pair_began(change.a, change.b, simulator_.now());
    } else {
      listener.pair_ended(change.a, change.b, simulator_.now());
    }
    return true;
  }
  return false;
}

template <int Degree>
void KineticSweepAndPrune<Degree>::extend_horizon(double now, double horizon) {
  for (auto& list : lists_) list.extend_horizon(now, horizon);
}

template <int Degree>
void KineticSweepAndPrune<Degree>::audit(double now) const {
  for (const auto& list : lists_) list.audit(now);
  for (const auto& end : lists_[0].entries()) {
    const BodyId id = end.id / 2;
    for (const auto& list : lists_) {
      if (!list.contains(min_end(id)) || !list.contains(max_end(id))) {
        throw AuditFailure("KineticSweepAndPrune: body " + std::to_string(id) + " lacks an end on some axis");
      }
    }
  }
}

template <int Degree>
BroadPhaseCounters KineticSweepAndPrune<Degree>::counters() const {
  const Counters work = simulator_.counters();
  return {work.events + update_swaps_, work.certificates, box_updates_};
}

template class KineticSweepAndPrune<1>;
template class KineticSweepAndPrune<2>;

}  // namespace kds::collision
