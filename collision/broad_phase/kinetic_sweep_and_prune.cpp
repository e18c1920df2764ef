#include "collision/broad_phase/kinetic_sweep_and_prune.hpp"

#include "kds/audit.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace kds::collision {

template <int Degree>
KineticSweepAndPrune<Degree>::KineticSweepAndPrune(double now, ListedAxes listed)
    : asked_(listed),
      lists_{List(AxisListener{this, 0}), List(AxisListener{this, 1}), List(AxisListener{this, 2})},
      unlisted_(changes_),
      simulator_(now, lists_[0], lists_[1], lists_[2], unlisted_) {}

template <int Degree>
bool KineticSweepAndPrune<Degree>::overlap_where_listed(BodyId a, BodyId b) const {
  for (std::size_t d = 0; d < 3; ++d) {
    if (is_listed(d) && !overlap_on(lists_[d], a, b)) return false;
  }
  return true;
}

template <int Degree>
void KineticSweepAndPrune<Degree>::ends_swapped(std::size_t axis, std::uint32_t left, std::uint32_t right, double t) {
  const BodyId left_body = left / 2;
  const BodyId right_body = right / 2;
  // After the swap a minimum on the left means that the two intervals have met, a maximum that they have parted.
  const bool met = is_min(left);
  if (listed_ != all_axes && axis == sweep_axis_) {
    open_[lists_[axis].position(left)] += met ? 2 : -2;
    if (left_body == right_body) inverted_ += met ? std::size_t(-1) : 1;
  }
  if (left_body == right_body) return;
  const BodyId a = std::min(left_body, right_body);
  const BodyId b = std::max(left_body, right_body);
  if (updating_) {
    ++update_swaps_;
    if (listed_ == all_axes) changes_.push_back({a, b, false});
    return;
  }
  // It matters if they overlap on the other axes. (Intervals that are not inverted need no look at this one.)
  if ((listed_ == all_axes || inverted_ > 0 || axis != sweep_axis_) && overlap_on(lists_[axis], a, b) != met) return;
  for (std::size_t d = 0; d < 3; ++d) {
    if (d != axis && is_listed(d) && !overlap_on(lists_[d], a, b)) return;
  }
  if (listed_ != all_axes && !(met ? unlisted_.met(a, b, t) : unlisted_.parted(a, b))) return;
  changes_.push_back({a, b, met});
}

/// The bodies that overlap with one which has just come, sorted. Where there is no list its pairs are made known.
template <int Degree>
std::vector<BodyId> KineticSweepAndPrune<Degree>::partners_now(BodyId id, double now) {
  std::vector<BodyId> partners;
  partners_on_lists(id, partners);
  if (listed_ != all_axes) {
    std::erase_if(partners,
                  [&](BodyId other) { return !unlisted_.met(std::min(id, other), std::max(id, other), now); });
  }
  std::sort(partners.begin(), partners.end());
  return partners;
}

template <int Degree>
void KineticSweepAndPrune<Degree>::insert(std::span<const Entry> bodies, double now, PairListener& listener) {
  simulator_.set_clock(now);
  box_updates_ += bodies.size();
  if (size() == 0) {
    const unsigned listed = best_axes(bodies, now);
    unlisted_.choose(all_axes & ~listed, now);
    for (const Entry& body : bodies) unlisted_.set_box(body.id, *body.box, now);
    build_lists(bodies, listed, now);
    for (const auto& [a, b] : pairs_on_lists()) {
      if (listed_ == all_axes || unlisted_.met(a, b, now)) listener.pair_began(a, b, now);
    }
    return;
  }
  for (const Entry& body : bodies) {
    unlisted_.set_box(body.id, *body.box, now);
    for (std::size_t d = 0; d < 3; ++d) {
      if (!is_listed(d)) continue;
      lists_[d].insert(min_end(body.id), body.box->min.axis(static_cast<int>(d)), now);
      lists_[d].insert(max_end(body.id), body.box->max.axis(static_cast<int>(d)), now);
    }
    count_open();
    for (const BodyId other : partners_now(body.id, now)) {
      listener.pair_began(std::min(body.id, other), std::max(body.id, other), now);
    }
  }
  if (size() >= 2 * chosen_at_) choose_again(now);
}

template <int Degree>
void KineticSweepAndPrune<Degree>::remove(BodyId id, double now, PairListener& listener) {
  simulator_.set_clock(now);
  std::vector<BodyId> partners;
  if (listed_ == all_axes) {
    partners_on_lists(id, partners);
  } else {
    unlisted_.forget_pairs(id, partners);
  }
  for (std::size_t d = 0; d < 3; ++d) {
    if (!is_listed(d)) continue;
    lists_[d].remove(min_end(id), now);
    lists_[d].remove(max_end(id), now);
  }
  count_open();
  std::sort(partners.begin(), partners.end());
  for (const BodyId other : partners) listener.pair_ended(std::min(id, other), std::max(id, other), now);
}

template <int Degree>
void KineticSweepAndPrune<Degree>::update(BodyId id, const KineticBox<Degree>& box, double now,
                                          PairListener& listener) {
  simulator_.set_clock(now);
  ++box_updates_;
  if (listed_ == all_axes) {
    unlisted_.set_box(id, box, now);
    return update_listed_pairs(id, box, now, listener);
  }
  std::vector<BodyId> before;
  unlisted_.forget_pairs(id, before);
  std::sort(before.begin(), before.end());
  unlisted_.set_box(id, box, now);
  updating_ = true;
  for (std::size_t d = 0; d < 3; ++d) {
    if (!is_listed(d)) continue;
    lists_[d].update(min_end(id), box.min.axis(static_cast<int>(d)), now);
    lists_[d].update(max_end(id), box.max.axis(static_cast<int>(d)), now);
  }
  updating_ = false;
  const std::vector<BodyId> after = partners_now(id, now);
  auto old = before.begin();
  for (const BodyId other : after) {
    for (; old != before.end() && *old < other; ++old) listener.pair_ended(std::min(id, *old), std::max(id, *old), now);
    if (old != before.end() && *old == other) {
      ++old;
    } else {
      listener.pair_began(std::min(id, other), std::max(id, other), now);
    }
  }
  for (; old != before.end(); ++old) listener.pair_ended(std::min(id, *old), std::max(id, *old), now);
}

/// Where all axes have lists.
template <int Degree>
void KineticSweepAndPrune<Degree>::update_listed_pairs(BodyId id, const KineticBox<Degree>& box, double now,
                                                       PairListener& listener) {
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
    for (const PairChange& change : changes_) {
      auto it =
          std::find_if(seen.begin(), seen.end(), [&](const Seen& s) { return s.a == change.a && s.b == change.b; });
      if (it == seen.end()) it = seen.insert(seen.end(), Seen{change.a, change.b, {}});
      it->apart_changes[d] = !it->apart_changes[d];
    }
  }
  updating_ = false;
  changes_.clear();
  std::sort(seen.begin(), seen.end(),
            [](const Seen& x, const Seen& y) { return std::pair(x.a, x.b) < std::pair(y.a, y.b); });
  for (const Seen& pair : seen) {
    // Each swap of a minimum with a maximum of a pair toggles its overlap on that axis.
    bool before = true;
    for (std::size_t d = 0; d < 3; ++d)
      before = before && (overlap_on(lists_[d], pair.a, pair.b) != pair.apart_changes[d]);
    const bool after = overlap(pair.a, pair.b);
    if (before && !after) listener.pair_ended(pair.a, pair.b, now);
    if (!before && after) listener.pair_began(pair.a, pair.b, now);
  }
}

template <int Degree>
bool KineticSweepAndPrune<Degree>::advance(double limit, PairListener& listener) {
  while (simulator_.step(limit)) {
    if (changes_.empty()) continue;
    const PairChange change = changes_.front();
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
  horizon_ = horizon;
  for (auto& list : lists_) list.extend_horizon(now, horizon);
  unlisted_.extend_horizon(now, horizon);
  if (listed_ != all_axes) {
    for (const auto& [a, b] : pairs_on_lists()) unlisted_.look_farther(a, b, now);
  }
  choose_again(now);
}

template <int Degree>
void KineticSweepAndPrune<Degree>::audit(double now) const {
  for (const auto& list : lists_) list.audit(now);
  for (const auto& end : sweep_list().entries()) {
    for (std::size_t d = 0; d < 3; ++d) {
      if (is_listed(d) && (!lists_[d].contains(end.id) || !lists_[d].contains(end.id ^ 1))) {
        throw AuditFailure("KineticSweepAndPrune: body " + std::to_string(end.id / 2) + " lacks an end on some axis");
      }
    }
  }
  if (listed_ == all_axes) return;
  unlisted_.audit(now);
  std::int32_t open = 0;
  std::vector<BodyId> partners;
  for (std::size_t i = 0; i < open_.size(); ++i) {
    const std::uint32_t end = sweep_list().entries()[i].id;
    open += is_min(end) ? 1 : -1;
    if (open_[i] != open) throw AuditFailure("KineticSweepAndPrune: place " + std::to_string(i) + ": not so many open");
    if (!is_min(end)) continue;
    partners.clear();
    partners_on_lists(end / 2, partners);
    for (const BodyId other : partners) {
      if (other < end / 2) unlisted_.audit_pair(other, end / 2, now);
    }
  }
}

template <int Degree>
BroadPhaseCounters KineticSweepAndPrune<Degree>::counters() const {
  Counters swaps;
  for (const auto& list : lists_) swaps = swaps + list.counters();
  return {swaps.events + update_swaps_, swaps.certificates + unlisted_.counters().certificates, box_updates_};
}

template class KineticSweepAndPrune<1>;
template class KineticSweepAndPrune<2>;

}  // namespace kds::collision
