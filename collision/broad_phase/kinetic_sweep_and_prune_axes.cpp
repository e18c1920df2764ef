// Which directions have lists, and which bodies overlap on them.
#include "collision/broad_phase/kinetic_sweep_and_prune.hpp"
#include "collision/degrees.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>

namespace kds::collision {

/// The expected cost of a list: the pairs that overlap on its axis, about (lengths of all intervals) / (length of the
/// whole), and their changes, (speeds) x (time ahead) / (length of the whole). Without a horizon, the time ahead is the
/// time in which bodies move by their own sizes. A list is given up for another axis only if the cost is this much
/// lower.
template <int Degree>
unsigned KineticSweepAndPrune<Degree>::best_axes(std::span<const Entry> bodies, double now) const {
  const std::size_t directions = lists_.all.size();
  if (tuning_.listed == ListedAxes::all) return all_axes_;
  if (tuning_.listed == ListedAxes::automatic && bodies.size() < tuning_.few_bodies && directions == 3)
    return all_axes_;
  std::vector<double> lengths(directions), speeds(directions), low(directions, never), high(directions, -never);
  const auto add = [&](std::size_t d, double min, double max, double speed) {
    low[d] = std::min(low[d], min);
    high[d] = std::max(high[d], max);
    lengths[d] += max - min;
    speeds[d] += std::abs(speed);
  };
  for (const Entry& body : bodies) {
    const Eigen::Vector3d min = body.box->min.position(now);
    const Eigen::Vector3d max = body.box->max.position(now);
    const Eigen::Vector3d speed = body.box->min.velocity(now);
    for (int d = 0; d < 3; ++d) add(static_cast<std::size_t>(d), min[d], max[d], speed[d]);
    for (std::size_t d = 3; d < directions; ++d) {
      const Motion<Degree> end = unlisted_.end(body.slot, d, false);
      add(d, end(now), unlisted_.end(body.slot, d, true)(now), derivative(end.position)(now - end.start));
    }
  }
  const double speed = speeds[0] + speeds[1] + speeds[2];
  const double crossing = speed > 0 ? (lengths[0] + lengths[1] + lengths[2]) / speed : 0;
  const auto promises = [&](std::size_t d) {
    const double whole = std::max(high[d] - low[d], 0x1p-1000);
    const double cost = (lengths[d] + speeds[d] * std::min(crossing, horizon_ - now)) / whole;
    return cost * (!all_listed() && is_listed(d) ? tuning_.change_below : 1.0);
  };
  std::size_t best = 0;
  for (std::size_t d = 1; d < directions; ++d) {
    if (promises(d) < promises(best)) best = d;
  }
  return 1u << best;
}

template <int Degree>
void KineticSweepAndPrune<Degree>::build_lists(std::span<const Entry> bodies, unsigned listed, double now) {
  listed_ = listed;
  sweep_axis_ = static_cast<std::size_t>(std::countr_zero(listed));
  chosen_at_ = bodies.size();
  std::vector<typename List::Entry> ends;
  ends.reserve(2 * bodies.size());
  std::vector<std::size_t> used;
  for (std::size_t d = 0; d < lists_.all.size(); ++d) {
    ends.clear();
    if (is_listed(d)) {
      used.push_back(d);
      for (const Entry& body : bodies) {
        ends.push_back({unlisted_.end(body.slot, d, false), min_end(body.slot)});
        ends.push_back({unlisted_.end(body.slot, d, true), max_end(body.slot)});
      }
    }
    lists_.all[d].assign(ends, now);
  }
  lists_.use(used);
  count_open();
}

/// Changes the lists during a run, if that pays. Overlaps stay the same, so nothing is reported. Precondition: no event
/// is due.
template <int Degree>
void KineticSweepAndPrune<Degree>::choose_again(double now) {
  if (tuning_.listed == ListedAxes::all || next_time() <= now) return;
  std::vector<Entry> bodies;
  for (const auto& end : sweep_list().entries()) {
    if (is_min(end.id)) bodies.push_back({end.id / 2, &unlisted_.box(end.id / 2)});
  }
  chosen_at_ = bodies.size();
  const unsigned listed = best_axes(bodies, now);
  if (listed == listed_) return;
  unlisted_.choose(all_axes_ & ~listed, now);
  build_lists(bodies, listed, now);
  if (all_listed()) return;
  for (const auto& [a, b] : pairs_on_lists()) unlisted_.met(a, b, now);
}

template <int Degree>
void KineticSweepAndPrune<Degree>::count_open() {
  if (all_listed()) return;
  const auto ends = sweep_list().entries();
  open_.resize(ends.size());
  inverted_ = 0;
  std::int32_t open = 0;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const bool opens = is_min(ends[i].id);
    open += opens ? 1 : -1;
    open_[i] = open;
    inverted_ += opens && sweep_list().position(ends[i].id ^ 1) < i;
  }
}

/// The pairs a < b that overlap where there are lists and are near each other where there are none. Sorted.
template <int Degree>
auto KineticSweepAndPrune<Degree>::pairs_on_lists() const -> std::vector<BodyPair> {
  std::vector<BodyPair> pairs;
  const auto add = [&](BodySlot a, BodySlot b) {
    if (!all_listed() && !unlisted_.near(a, b)) return;
    if (overlap_where_listed(a, b)) pairs.emplace_back(std::min(a, b), std::max(a, b));
  };
  if (inverted_ > 0) {
    std::vector<BodySlot> open;
    for (const auto& end : sweep_list().entries()) {
      if (!is_min(end.id)) continue;
      open.clear();
      partners_on_lists(end.id / 2, open);
      for (const BodySlot other : open) {
        if (other < end.id / 2) add(other, end.id / 2);
      }
    }
  } else {
    using Hull = typename UnlistedAxes<Degree>::Hull;
    struct Open {
      Hull hull;
      BodySlot id;
    };
    std::vector<Open> open;
    std::vector<std::uint32_t> place(unlisted_.bodies());
    for (const auto& end : sweep_list().entries()) {
      const BodySlot id = end.id / 2;
      if (is_min(end.id)) {
        const Hull hull = all_listed() ? Hull::everywhere() : unlisted_.hull(id);
        for (const Open& other : open) {
          if (other.hull.meets(hull)) add(other.id, id);
        }
        place[id] = static_cast<std::uint32_t>(open.size());
        open.push_back({hull, id});
      } else if (place[id] < open.size() && open[place[id]].id == id) {  // otherwise it has not begun: it is inverted
        place[open.back().id] = place[id];
        open[place[id]] = open.back();
        open.pop_back();
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// Appends the bodies that overlap with this one where there are lists. They have an end between its ends, or are open
/// where it begins; the latter are found going left, until as many have been seen as are open.
template <int Degree>
void KineticSweepAndPrune<Degree>::partners_on_lists(BodySlot id, std::vector<BodySlot>& partners) const {
  const List& list = sweep_list();
  const auto ends = list.entries();
  const auto [first, last] = std::minmax({list.position(min_end(id)), list.position(max_end(id))});
  const auto add = [&](BodySlot other) {
    if (overlap_where_listed(id, other)) partners.push_back(other);
  };
  for (std::size_t i = first + 1; i < last; ++i) {
    const std::uint32_t end = ends[i].id;
    const std::uint32_t other_end = list.position(end ^ 1);
    if (is_min(end) || other_end < first || other_end > last) add(end / 2);
  }
  std::int32_t open = first > 0 && inverted_ == 0 && !all_listed() ? open_[first - 1] : 0;
  const bool all = inverted_ > 0 || all_listed();  // then their number is not known
  for (std::size_t i = first; i-- > 0 && (all || open > 0);) {
    const std::uint32_t end = ends[i].id;
    if (!is_min(end)) continue;
    const std::uint32_t other_end = list.position(end ^ 1);
    open -= other_end > first;
    if (other_end > last) add(end / 2);
  }
}

#define KDS_INSTANTIATE(degree) KDS_TEMPLATE_PART class KineticSweepAndPrune<degree>;
KDS_FOR_EACH_DEGREE(KDS_INSTANTIATE)
#undef KDS_INSTANTIATE

}  // namespace kds::collision
