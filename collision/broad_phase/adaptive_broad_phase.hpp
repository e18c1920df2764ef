// The default broad phase: it chooses between two by the number of bodies, and may change during a run.
#pragma once

#include "collision/broad_phase/box_of.hpp"
#include "collision/broad_phase/few_boxes.hpp"
#include "collision/broad_phase/kinetic_grid.hpp"
#include "collision/broad_phase/tuning.hpp"
#include "collision/degrees.hpp"

#include <memory>
#include <string_view>
#include <utility>

namespace kds::collision {

/// A few boxes are compared each with all others; from 65 bodies on it is the kinetic grid, until there are no more
/// than 32. When it changes it reports the pairs that one has and the other has not, so no contact is lost.
///
/// These two are enough: of random scenes of 4 to 64 balls of all sizes, speeds, densities and rates hardly any was
/// cheaper in the grid, with sorted lists or by all pairs; with more balls the grid is the cheapest in nearly all
/// scenes that were measured (docs/speed.md).
template <int Degree>
class AdaptiveBroadPhase final : public BroadPhase<Degree> {
 public:
  using Entry = typename BroadPhase<Degree>::Entry;

  /// `threads`: see KineticGrid.
  explicit AdaptiveBroadPhase(BoxOf<Degree> box_of, std::size_t threads = 1, const AdaptiveTuning& tuning = {})
      : box_of_(std::move(box_of)), tuning_(tuning), few_(tuning.few), threads_(threads) {
    check(tuning);
  }

  bool exact() const override { return false; }
  std::string_view name() const override { return chosen().name(); }
  void reserve(BodySlot end) override;
  void fit() override {
    if (grid_) grid_->fit();
  }
  void expect(std::size_t bodies, BodySlot end, std::span<const Entry> some, double now) override;
  void insert(std::span<const Entry> bodies, double now, PairListener& listener) override;
  void remove(BodySlot id, double now, PairListener& listener) override;
  void update(BodySlot id, const KineticBox<Degree>& box, double now, PairListener& listener) override;
  void prefetch(BodySlot id) const override {
    if (grid_) grid_->prefetch(id);
  }
  bool advance(double limit, PairListener& listener) override {
    return grid_ ? grid_->advance(limit, listener) : few_.advance(limit, listener);
  }
  double next_time() const override { return grid_ ? grid_->next_time() : few_.next_time(); }
  void extend_horizon(double now, double horizon) override;
  void visit_overlapping(const StaticBox& box, double now, SlotVisitor visit) const override {
    chosen().visit_overlapping(box, now, visit);
  }
  void visit_swept(const KineticBox<Degree>& box, double from, double until, SlotVisitor visit) const override {
    chosen().visit_swept(box, from, until, visit);
  }
  void audit(double now) const override { chosen().audit(now); }
  BroadPhaseCounters counters() const override;

 private:
  const BroadPhase<Degree>& chosen() const { return grid_ ? static_cast<const BroadPhase<Degree>&>(*grid_) : few_; }
  std::unique_ptr<KineticGrid<Degree>> new_grid() const;
  void make_grid(double now);
  void change_to_grid(double now, PairListener& listener);
  void change_to_few(double now, PairListener& listener);
  template <class From, class To>
  static void report_changes(std::span<const Entry> bodies, const From& from, const To& to, double now,
                             PairListener& listener);

  BoxOf<Degree> box_of_;
  AdaptiveTuning tuning_;
  FewBoxes<Degree> few_;                       ///< has all bodies while there is no grid
  std::unique_ptr<KineticGrid<Degree>> grid_;  ///< otherwise has them
  /// One that has room for the bodies to come, until it is needed.
  std::unique_ptr<KineticGrid<Degree>> spare_;
  std::size_t threads_;
  BodySlot room_ = 0;  ///< slots for which reserve() has asked
  double horizon_ = never;
  BroadPhaseCounters done_;  ///< work of grids that have been given up
};

#define KDS_DECLARE(degree) extern template class AdaptiveBroadPhase<degree>;
KDS_FOR_ALL_DEGREES(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
