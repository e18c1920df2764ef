// Sweep and prune over arrays with swept AABBs: the frame-based baseline.
#pragma once

#include "collision/broad_phase/broad_phase.hpp"
#include "collision/broad_phase/swept_box.hpp"
#include "collision/degrees.hpp"
#include "collision/profile.hpp"

#include <array>
#include <cstdint>
#include <unordered_set>
#include <vector>

namespace kds::collision {

/// At each frame every body gets its swept AABB until the next, the arrays of interval ends are sorted again by
/// insertion sort, and exchanges of a minimum with a maximum add or drop pairs.
///
/// Paper: [Cohen95] for sweep and prune, [Coming06] section 5 for its use with swept volumes. Pairs are those whose
/// swept boxes overlap: a superset of those whose kinetic boxes do. A motion change in mid-frame sweeps the body anew.
/// Cost: O(n + swaps) a frame.
template <int Degree>
class SweptSweepAndPrune final : public BroadPhase<Degree> {
 public:
  using Entry = typename BroadPhase<Degree>::Entry;

  /// Frames at start + k / rate. `profile` may be null. Precondition: rate > 0, in Hz, and 1 / rate is finite.
  SweptSweepAndPrune(double start, double rate, Profile* profile);

  bool exact() const override { return false; }
  std::string_view name() const override { return "sap"; }
  void insert(std::span<const Entry> bodies, double now, PairListener& listener) override;
  void remove(BodySlot id, double now, PairListener& listener) override;
  void update(BodySlot id, const KineticBox<Degree>& box, double now, PairListener& listener) override;
  bool advance(double limit, PairListener& listener) override;
  double next_time() const override { return frame_end_; }
  void extend_horizon(double, double) override {}
  /// O(n): a sorted array shows which intervals begin or end near a place, not which are open there.
  void visit_overlapping(const StaticBox& box, double now, SlotVisitor visit) const override;
  /// O(n), with new swept boxes beyond the frame.
  void visit_swept(const KineticBox<Degree>& box, double from, double until, SlotVisitor visit) const override;
  void audit(double now) const override;
  BroadPhaseCounters counters() const override { return counters_; }

 private:
  /// One interval end: twice the body's id, plus one for a maximum.
  struct End {
    double value;
    std::uint32_t id;
  };
  /// The listener of changes, their time, and whether there were any.
  struct Reports {
    PairListener& listener;
    double now;
    bool any = false;
  };
  /// Maxima before minima at one value, so that boxes that merely touch are apart. Swept boxes are rounded outward.
  static bool before(const End& a, const End& b) {
    return a.value < b.value || (a.value == b.value && (a.id & 1) > (b.id & 1));
  }
  static std::uint64_t key(BodySlot a, BodySlot b) { return std::uint64_t{a} << 32 | b; }

  double value(std::uint32_t id, std::size_t axis) const {
    const StaticBox& box = swept_[id / 2];
    const auto d = static_cast<Eigen::Index>(axis);
    return (id & 1) != 0 ? box.max[d] : box.min[d];
  }
  bool overlap(BodySlot a, BodySlot b) const;
  void sweep(BodySlot id, double from);
  void sort_axis(std::size_t axis, Reports& reports);
  void move_end(std::size_t axis, std::uint32_t id, Reports& reports);
  void exchange(std::size_t axis, std::size_t left, Reports& reports);
  void frame(double now, Reports& reports);
  void add_pair(BodySlot a, BodySlot b, Reports& reports);
  void drop_pair(BodySlot a, BodySlot b, Reports& reports);

  double start_;
  double rate_;
  Profile* profile_;
  std::uint64_t frames_ = 0;
  double frame_end_;
  std::vector<KineticBox<Degree>> boxes_;  // by body
  std::vector<StaticBox> swept_;           // by body
  std::vector<BodySlot> bodies_;
  std::array<std::vector<End>, 3> ends_;
  std::array<std::vector<std::uint32_t>, 3> places_;  // of ends, by end id; up to date between frames
  std::unordered_set<std::uint64_t> pairs_;
  BroadPhaseCounters counters_;
};

#define KDS_DECLARE(degree) extern template class SweptSweepAndPrune<degree>;
KDS_FOR_ALL_DEGREES(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
