// No pruning: the baseline that tests every pair once and keeps the result.
#pragma once

#include "collision/broad_phase/broad_phase.hpp"

#include <algorithm>
#include <vector>

namespace kds::collision {

/// Cached dynamic collision detection ([Coming06] section 5): every pair is active from the time both bodies are there
/// until one is removed.
/// Cost: O(n) pairs to test for each motion change; memory O(n^2), in the world, for the pairs.
template <int Degree>
class AllPairs final : public BroadPhase<Degree> {
 public:
  using Entry = typename BroadPhase<Degree>::Entry;

  bool exact() const override { return false; }
  std::string_view name() const override { return "all-pairs"; }

  void insert(std::span<const Entry> bodies, double now, PairListener& listener) override {
    const std::size_t before = bodies_.size();
    for (const Entry& body : bodies) bodies_.push_back(body.slot);
    for (std::size_t i = 0; i < bodies_.size(); ++i) {  // in the order of the bodies in memory
      for (std::size_t j = std::max(i + 1, before); j < bodies_.size(); ++j) {
        listener.pair_began(std::min(bodies_[i], bodies_[j]), std::max(bodies_[i], bodies_[j]), now);
      }
    }
  }

  void remove(BodySlot id, double now, PairListener& listener) override {
    bodies_.erase(std::find(bodies_.begin(), bodies_.end(), id));
    for (const BodySlot other : bodies_) listener.pair_ended(std::min(id, other), std::max(id, other), now);
  }

  void update(BodySlot, const KineticBox<Degree>&, double, PairListener&) override { ++box_updates_; }
  bool advance(double, PairListener&) override { return false; }
  double next_time() const override { return never; }
  void extend_horizon(double, double) override {}
  /// It has no boxes, and visits all bodies. O(n).
  void visit_overlapping(const StaticBox&, double, SlotVisitor visit) const override {
    for (const BodySlot id : bodies_) visit(id);
  }
  void visit_swept(const KineticBox<Degree>&, double, double, SlotVisitor visit) const override {
    for (const BodySlot id : bodies_) visit(id);
  }
  void audit(double) const override {}
  BroadPhaseCounters counters() const override { return {0, 0, box_updates_}; }

 private:
  std::vector<BodySlot> bodies_;
  std::uint64_t box_updates_ = 0;
};

}  // namespace kds::collision
