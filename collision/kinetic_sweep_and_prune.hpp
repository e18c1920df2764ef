// Kinetic sweep and prune: the broad phase this library is about.
#pragma once

#include "collision/broad_phase.hpp"
#include "kds/simulator.hpp"
#include "structures/sorted_list.hpp"

#include <array>
#include <vector>

namespace kds::collision {

/// Three kinetic sorted lists of interval ends, one for each axis; a swap of a minimum with a maximum begins or ends
/// an overlap, and whether the other two axes overlap is read from list positions: no table of pairs is kept.
///
/// Paper: [Paper] sections 4.1-4.3. Cost: O(log n) or less a swap (the queue's), O(log n) a motion change, O(n) an
/// insertion or removal, no cost between events.
///
/// Ends that are equal for good (boxes that touch and move together) do not overlap.
template <int Degree>
class KineticSweepAndPrune final : public BroadPhase<Degree> {
 public:
  using Entry = typename BroadPhase<Degree>::Entry;

  KineticSweepAndPrune(double now);
  KineticSweepAndPrune(const KineticSweepAndPrune&) = delete;
  KineticSweepAndPrune& operator=(const KineticSweepAndPrune&) = delete;

  bool exact() const override { return true; }
  std::string_view name() const override { return "kinetic-sap"; }
  void insert(std::span<const Entry> bodies, double now, PairListener& listener) override;
  void remove(BodyId id, double now, PairListener& listener) override;
  void update(BodyId id, const KineticBox<Degree>& box, double now, PairListener& listener) override;
  bool advance(double limit, PairListener& listener) override;
  double next_time() const override { return simulator_.next_time(); }
  void extend_horizon(double now, double horizon) override;
  void audit(double now) const override;
  BroadPhaseCounters counters() const override;

 private:
  /// Learns of the swaps on one axis.
  struct AxisListener {
    KineticSweepAndPrune* owner;
    std::size_t axis;

    void swapped(std::uint32_t left, std::uint32_t right, double) {
      // An end's id is twice its body's, plus one for a maximum: two ends of a kind never matter.
      if (((left ^ right) & 1) != 0) owner->ends_swapped(axis, left, right);
    }
    // Maxima before minima: intervals that touch for good are apart.
    static std::uint32_t rank(std::uint32_t id) { return ~id & 1; }
  };
  using List = structures::SortedList<Degree, AxisListener>;

  static std::uint32_t min_end(BodyId id) { return 2 * id; }
  static std::uint32_t max_end(BodyId id) { return 2 * id + 1; }

  bool overlap(BodyId a, BodyId b) const;
  bool overlap_on(const List& list, BodyId a, BodyId b) const {
    return list.position(min_end(a)) < list.position(max_end(b)) &&
           list.position(min_end(b)) < list.position(max_end(a));
  }
  void ends_swapped(std::size_t axis, std::uint32_t left, std::uint32_t right);
  void report_overlaps_by_sweep(double now, PairListener& listener) const;

  std::array<List, 3> lists_;
  Simulator<List, List, List> simulator_;
  std::uint64_t box_updates_ = 0;
  std::uint64_t update_swaps_ = 0;

  /// A change seen while lists move. During a motion change they are only collected, as the axes change in turn.
  struct Change {
    BodyId a, b;
    bool began;
  };
  std::vector<Change> changes_;
  bool updating_ = false;
};

extern template class KineticSweepAndPrune<1>;
extern template class KineticSweepAndPrune<2>;

}  // namespace kds::collision
