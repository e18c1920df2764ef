// Boxes of bodies for broad phases that ask for them, in tests without a world.
#pragma once

#include "collision/broad_phase/box_of.hpp"
#include "collision/broad_phase/broad_phase.hpp"

#include <map>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace kds::collision::tests {

/// A broad phase and the boxes that it has been given, which it is told when it asks. Only of those that are in it:
/// about any other at() throws.
template <int Degree>
class KeptBoxes final : public BroadPhase<Degree> {
 public:
  using Entry = typename BroadPhase<Degree>::Entry;

  /// `make(box_of)`: makes the broad phase.
  template <class Make>
  explicit KeptBoxes(const Make& make) : tested_(make([this](BodySlot id) { return boxes_.at(id); })) {}
  KeptBoxes(const KeptBoxes&) = delete;
  KeptBoxes& operator=(const KeptBoxes&) = delete;

  bool exact() const override { return tested_->exact(); }
  std::string_view name() const override { return tested_->name(); }
  void expect(std::size_t bodies, BodySlot end, std::span<const Entry> some, double now) override {
    tested_->expect(bodies, end, some, now);
  }
  void insert(std::span<const Entry> bodies, double now, PairListener& listener) override {
    for (const Entry& entry : bodies) boxes_[entry.slot] = *entry.box;
    tested_->insert(bodies, now, listener);
  }
  void remove(BodySlot id, double now, PairListener& listener) override {
    tested_->remove(id, now, listener);
    boxes_.erase(id);
  }
  void update(BodySlot id, const KineticBox<Degree>& box, double now, PairListener& listener) override {
    boxes_.at(id) = box;
    tested_->update(id, box, now, listener);
  }
  bool advance(double limit, PairListener& listener) override { return tested_->advance(limit, listener); }
  double next_time() const override { return tested_->next_time(); }
  void extend_horizon(double now, double horizon) override { tested_->extend_horizon(now, horizon); }
  void visit_overlapping(const StaticBox& box, double now, SlotVisitor visit) const override {
    tested_->visit_overlapping(box, now, visit);
  }
  void visit_swept(const KineticBox<Degree>& box, double from, double until, SlotVisitor visit) const override {
    tested_->visit_swept(box, from, until, visit);
  }
  void audit(double now) const override { tested_->audit(now); }
  BroadPhaseCounters counters() const override { return tested_->counters(); }

 private:
  std::map<BodySlot, KineticBox<Degree>> boxes_;
  std::unique_ptr<BroadPhase<Degree>> tested_;
};

/// A broad phase of this type that has its boxes with it; `options` are those after the first of its constructor.
template <template <int> class Tested, int Degree, class... Options>
std::unique_ptr<BroadPhase<Degree>> with_boxes(const Options&... options) {
  return std::make_unique<KeptBoxes<Degree>>(
      [&](BoxOf<Degree> box_of) { return std::make_unique<Tested<Degree>>(std::move(box_of), options...); });
}

/// The boxes of bodies whose slots are places in a vector, as they are when they are asked for.
template <int Degree>
BoxOf<Degree> boxes_of(const std::vector<KineticBox<Degree>>& boxes) {
  return [&boxes](BodySlot id) { return boxes.at(id); };
}

}  // namespace kds::collision::tests
