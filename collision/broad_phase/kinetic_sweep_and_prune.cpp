#include "collision/broad_phase/kinetic_sweep_and_prune.hpp"

#include "collision/degrees.hpp"
#include "kds/audit.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace kds::collision {

template <int Degree>
KineticSweepAndPrune<Degree>::KineticSweepAndPrune(double now, const SweepTuning& tuning, Kdops<Degree> kdops)
    : kdops_(std::move(kdops)),
      tuning_(tuning),
      all_axes_((1u << (3 + kdops_.directions.size())) - 1),
      listed_(all_axes_),
      unlisted_(changes_, 3 + kdops_.directions.size()),
      simulator_(now, lists_, unlisted_) {
  check(tuning);
  std::vector<std::size_t> directions;
  for (std::size_t d = 0; d < 3 + kdops_.directions.size(); ++d) {
    lists_.all.emplace_back(AxisListener{this, d});
    directions.push_back(d);
  }
  lists_.use(directions);
}

template <int Degree>
void KineticSweepAndPrune<Degree>::set_volume(BodySlot id, const KineticBox<Degree>& box, double now) {
  if (kdops_.directions.empty()) return unlisted_.set_box(id, box, {}, now);
  std::vector<KineticSlab<Degree>> slabs(kdops_.directions.size());
  for (std::size_t i = 0; i < slabs.size(); ++i) slabs[i] = kdops_.slab(id, i, now);
  for (const auto& slab : slabs) require_finite(slab, id);
  unlisted_.set_box(id, box, slabs, now);
}

template <int Degree>
bool KineticSweepAndPrune<Degree>::overlap_where_listed(BodySlot a, BodySlot b) const {
  for (const std::size_t d : lists_.used) {
    if (!overlap_on(lists_.all[d], a, b)) return false;
  }
  return true;
}

/// A minimum and a maximum have swapped: updates the pair, if the bodies overlap on the other axes.
template <int Degree>
void KineticSweepAndPrune<Degree>::intervals_changed(std::size_t axis, std::uint32_t left, std::uint32_t right,
                                                     double t) {
  looked_ = true;
  const BodySlot left_body = left / 2;
  const BodySlot right_body = right / 2;
  // After the swap a minimum on the left means that the two intervals have met, a maximum that they have parted.
  const bool met = is_min(left);
  if (left_body == right_body) {
    if (!all_listed() && axis == sweep_axis_) inverted_ += met ? std::size_t(-1) : 1;
    return;
  }
  const BodySlot a = std::min(left_body, right_body);
  const BodySlot b = std::max(left_body, right_body);
  if (updating_) {
    ++update_swaps_;
    if (all_listed()) changes_.push_back({a, b, false});
    return;
  }
  // The swap counts if they overlap on the other axes. (For intervals that are not inverted this axis need not be
  // checked.)
  if ((all_listed() || inverted_ > 0 || axis != sweep_axis_) && overlap_on(lists_.all[axis], a, b) != met) return;
  for (const std::size_t d : lists_.used) {
    if (d != axis && !overlap_on(lists_.all[d], a, b)) return;
  }
  if (!all_listed() && !(met ? unlisted_.met(a, b, t) : unlisted_.parted(a, b))) return;
  changes_.push_back({a, b, met});
}

/// The bodies that overlap a new one, sorted. Its pairs are added to the axes without a list.
template <int Degree>
std::vector<BodySlot> KineticSweepAndPrune<Degree>::partners_now(BodySlot id, double now) {
  std::vector<BodySlot> partners;
  partners_on_lists(id, partners);
  if (!all_listed()) {
    std::erase_if(partners,
                  [&](BodySlot other) { return !unlisted_.met(std::min(id, other), std::max(id, other), now); });
  }
  std::sort(partners.begin(), partners.end());
  return partners;
}

template <int Degree>
void KineticSweepAndPrune<Degree>::insert(std::span<const Entry> bodies, double now, PairListener& listener) {
  simulator_.set_clock(now);
  box_updates_ += bodies.size();
  if (size() == 0) {
    unlisted_.choose(0, now);  // idle until the listed axes have been chosen
    for (const Entry& body : bodies) set_volume(body.slot, *body.box, now);
    const unsigned listed = best_axes(bodies, now);
    unlisted_.choose(all_axes_ & ~listed, now);
    build_lists(bodies, listed, now);
    for (const auto& [a, b] : pairs_on_lists()) {
      if (all_listed() || unlisted_.met(a, b, now)) listener.pair_began(a, b, now);
    }
    return;
  }
  for (const Entry& body : bodies) {
    set_volume(body.slot, *body.box, now);
    for (const std::size_t d : lists_.used) {
      lists_.all[d].insert(min_end(body.slot), unlisted_.end(body.slot, d, false), now);
      lists_.all[d].insert(max_end(body.slot), unlisted_.end(body.slot, d, true), now);
    }
    count_open();
    for (const BodySlot other : partners_now(body.slot, now)) {
      listener.pair_began(std::min(body.slot, other), std::max(body.slot, other), now);
    }
  }
  if (size() >= 2 * chosen_at_) choose_again(now);
}

template <int Degree>
void KineticSweepAndPrune<Degree>::remove(BodySlot id, double now, PairListener& listener) {
  simulator_.set_clock(now);
  std::vector<BodySlot> partners;
  if (all_listed()) {
    partners_on_lists(id, partners);
  } else {
    unlisted_.forget_pairs(id, partners);
  }
  for (const std::size_t d : lists_.used) {
    lists_.all[d].remove(min_end(id), now);
    lists_.all[d].remove(max_end(id), now);
  }
  count_open();
  std::sort(partners.begin(), partners.end());
  for (const BodySlot other : partners) listener.pair_ended(std::min(id, other), std::max(id, other), now);
}

template <int Degree>
void KineticSweepAndPrune<Degree>::update(BodySlot id, const KineticBox<Degree>& box, double now,
                                          PairListener& listener) {
  simulator_.set_clock(now);
  ++box_updates_;
  if (all_listed()) {
    set_volume(id, box, now);
    return update_listed_pairs(id, now, listener);
  }
  std::vector<BodySlot> before;
  unlisted_.forget_pairs(id, before);
  std::sort(before.begin(), before.end());
  set_volume(id, box, now);
  updating_ = true;
  for (const std::size_t d : lists_.used) {
    update_end(d, id, false, now);
    update_end(d, id, true, now);
  }
  updating_ = false;
  const std::vector<BodySlot> after = partners_now(id, now);
  auto old = before.begin();
  for (const BodySlot other : after) {
    for (; old != before.end() && *old < other; ++old) listener.pair_ended(std::min(id, *old), std::max(id, *old), now);
    if (old != before.end() && *old == other) {
      ++old;
    } else {
      listener.pair_began(std::min(id, other), std::max(id, other), now);
    }
  }
  for (; old != before.end(); ++old) listener.pair_ended(std::min(id, *old), std::max(id, *old), now);
}

/// The case that all directions have lists.
template <int Degree>
void KineticSweepAndPrune<Degree>::update_listed_pairs(BodySlot id, double now, PairListener& listener) {
  changes_.clear();
  updating_ = true;
  // The state before each partner's first change is read off at the end: a pair has changed if it was met by an odd
  // number of swaps on some axis, so partners are collected, each with the old answer at its first swap.
  struct Seen {
    BodySlot a, b;
    unsigned apart_changes;  // bit d for direction d
  };
  std::vector<Seen> seen;
  for (const std::size_t d : lists_.used) {
    changes_.clear();
    update_end(d, id, false, now);
    update_end(d, id, true, now);
    for (const PairChange& change : changes_) {
      auto it =
          std::find_if(seen.begin(), seen.end(), [&](const Seen& s) { return s.a == change.a && s.b == change.b; });
      if (it == seen.end()) it = seen.insert(seen.end(), Seen{change.a, change.b, 0});
      it->apart_changes ^= 1u << d;
    }
  }
  updating_ = false;
  changes_.clear();
  std::sort(seen.begin(), seen.end(),
            [](const Seen& x, const Seen& y) { return std::pair(x.a, x.b) < std::pair(y.a, y.b); });
  for (const Seen& pair : seen) {
    // Each swap of a minimum with a maximum of a pair toggles its overlap in that direction.
    bool before = true;
    for (const std::size_t d : lists_.used) {
      before = before && overlap_on(lists_.all[d], pair.a, pair.b) != ((pair.apart_changes >> d & 1) != 0);
    }
    const bool after = overlap(pair.a, pair.b);
    if (before && !after) listener.pair_ended(pair.a, pair.b, now);
    if (!before && after) listener.pair_began(pair.a, pair.b, now);
  }
}

template <int Degree>
bool KineticSweepAndPrune<Degree>::advance(double limit, PairListener& listener) {
  for (;;) {
    // Lists are processed first, up to the next event of axes without lists, which new pairs may bring nearer.
    const double until = std::min({limit, unlisted_.next_time(), std::numeric_limits<double>::max()});
    looked_ = false;
    while (!looked_) {
      List& list = lists_.all[lists_.first()];
      if (!(list.next_time() <= until)) break;
      simulator_.set_clock(list.next_time());
      list.process();
    }
    if (!looked_ && !simulator_.step(limit)) return false;
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
}

template <int Degree>
void KineticSweepAndPrune<Degree>::extend_horizon(double now, double horizon) {
  horizon_ = horizon;
  lists_.extend_horizon(now, horizon);
  unlisted_.extend_horizon(now, horizon);
  if (!all_listed()) {
    for (const auto& [a, b] : pairs_on_lists()) unlisted_.look_farther(a, b, now);
  }
  choose_again(now);
}

template <int Degree>
void KineticSweepAndPrune<Degree>::audit(double now) const {
  lists_.audit(now);
  for (const auto& end : sweep_list().entries()) {
    for (const std::size_t d : lists_.used) {
      if (!lists_.all[d].contains(end.id) || !lists_.all[d].contains(end.id ^ 1)) {
        throw AuditFailure("KineticSweepAndPrune: body " + std::to_string(end.id / 2) + " lacks an end on some axis");
      }
    }
  }
  if (all_listed()) return;
  unlisted_.audit(now);
  std::int32_t open = 0;
  std::vector<BodySlot> partners;
  for (std::size_t i = 0; i < open_.size(); ++i) {
    const std::uint32_t end = sweep_list().entries()[i].id;
    open += is_min(end) ? 1 : -1;
    if (open_[i] != open) throw AuditFailure("KineticSweepAndPrune: place " + std::to_string(i) + ": not so many open");
    if (!is_min(end)) continue;
    partners.clear();
    partners_on_lists(end / 2, partners);
    for (const BodySlot other : partners) {
      if (other < end / 2) unlisted_.audit_pair(other, end / 2, now);
    }
  }
}

template <int Degree>
BroadPhaseCounters KineticSweepAndPrune<Degree>::counters() const {
  const Counters swaps = lists_.counters();
  return {swaps.events + update_swaps_, swaps.certificates + unlisted_.counters().certificates, box_updates_};
}

#define KDS_INSTANTIATE(degree) template class KineticSweepAndPrune<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
