// A sorted list made of a rule, with any queue and any solver, that tells of its swaps as SortedList does: what the
// tuned list is compared with, and what other queues and solvers are tried on.
#pragma once

#include "certificates/order.hpp"
#include "kds/framework/kinetic.hpp"
#include "structures/sorted_list.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace kds::tests {

/// Ties and the swaps of a jump are as in SortedList. Slot: the id of the left element of a pair.
template <int Degree, structures::SwapListener Listener>
struct RankedListRule {
  using Element = Motion<Degree>;
  using Order = certificates::Order<Degree>;
  static constexpr const char* name = "RankedListRule";
  Listener listener;
  std::vector<Id> order{};             ///< ids in order
  std::vector<std::uint32_t> place{};  ///< of an id in the order

  std::optional<Order> certificate(Slot left, const MovingSet<Element>& x) const {
    if (place[left] + std::size_t{1} == order.size()) return std::nullopt;
    return Order{x[left], x[order[place[left] + std::size_t{1}]]};
  }
  std::array<Id, 2> members(Slot left) const { return {left, order[place[left] + std::size_t{1}]}; }

  Effect repair(Slot left, Repair<Element>& repair) {
    const std::size_t i = place[left];
    swap_at(i, repair.now());
    certify(i, i + 1, repair);
    return Effect::external;
  }
  void insert(Id id, Repair<Element>& repair) {
    const auto at =
        std::partition_point(order.begin(), order.end(), [&](Id other) { return in_order(other, id, repair); });
    const auto i = static_cast<std::size_t>(at - order.begin());
    order.insert(at, id);
    renumber(i, repair);
    certify(i, i, repair);
  }
  void remove(Id id, Repair<Element>& repair) {
    const std::size_t i = place[id];
    repair.retire(id);
    order.erase(order.begin() + static_cast<std::ptrdiff_t>(i));
    renumber(i, repair);
    if (i > 0) repair.certify(order[i - 1]);
  }
  void change(Id id, Repair<Element>& repair) {
    const std::size_t before = place[id];
    std::size_t i = before;
    while (i > 0 && !in_order(order[i - 1], id, repair)) swap_at(--i, repair.now());
    while (i + 1 < order.size() && !in_order(id, order[i + 1], repair)) swap_at(i++, repair.now());
    certify(std::min(i, before), std::max(i, before), repair);
  }
  template <class Archive>
  void archive(Archive& archive) {
    archive(order, place);
  }

  bool in_order(Id a, Id b, const Repair<Element>& repair) const {
    const int s = repair.sign(Order{repair[a], repair[b]});
    return s != 0 ? s > 0 : std::pair(listener.rank(a), a) < std::pair(listener.rank(b), b);
  }
  void swap_at(std::size_t i, double now) {
    std::swap(order[i], order[i + 1]);
    for (const std::size_t k : {i, i + 1}) place[order[k]] = static_cast<std::uint32_t>(k);
    listener.swapped(order[i], order[i + 1], now);
  }
  /// The pairs of which the elements at these places are part.
  void certify(std::size_t first, std::size_t last, Repair<Element>& repair) {
    for (std::size_t k = first > 0 ? first - 1 : 0; k <= last; ++k) repair.certify(order[k]);
  }
  void renumber(std::size_t first, const Repair<Element>& repair) {
    place.resize(repair.elements().end_id());
    for (std::size_t k = first; k < order.size(); ++k) place[order[k]] = static_cast<std::uint32_t>(k);
  }
};

/// The rule with elements of its own, to be used like a SortedList.
template <int Degree, structures::SwapListener Listener, EventQueue Queue = DefaultEventQueue,
          FailureTimeSolver Solver = CertifiedSolver>
class RuleList {
 public:
  using Id = std::uint32_t;
  using Entry = typename structures::SortedList<Degree, Listener>::Entry;

  explicit RuleList(Listener listener = {}) : list_(set_, std::numeric_limits<double>::lowest(), {listener}) {}

  std::size_t size() const { return list_.rule().order.size(); }
  std::uint32_t position(Id id) const { return list_.rule().place[id]; }
  std::vector<Entry> entries() const {
    std::vector<Entry> entries;
    for (const Id id : list_.rule().order) entries.push_back({set_[id], id});
    return entries;
  }

  void assign(std::span<const Entry> entries, double now) {
    for (const Entry& entry : entries) insert(entry.id, entry.motion, now);
  }
  void insert(Id id, const Motion<Degree>& motion, double now) { set_.insert(id, motion, now); }
  void remove(Id id, double now) { set_.remove(id, now); }
  void update(Id id, const Motion<Degree>& motion, double now) { set_.update(id, motion, now); }

  double next_time() const { return list_.next_time(); }
  void process() { list_.process(); }
  void extend_horizon(double now, double horizon) { list_.extend_horizon(now, horizon); }
  void audit(double now) const { list_.audit(now); }
  Counters counters() const { return list_.counters(); }

  template <class Archive>
  void archive(Archive& archive) {
    archive(set_, list_);
  }

 private:
  MovingSet<Motion<Degree>> set_;
  Kinetic<RankedListRule<Degree, Listener>, NoListener, Queue, Solver> list_;
};

}  // namespace kds::tests
