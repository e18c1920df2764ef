// A few boxes, each compared with all others: a broad phase without a structure.
#pragma once

#include "collision/broad_phase/broad_phase.hpp"
#include "collision/broad_phase/swept_box.hpp"
#include "collision/broad_phase/tuning.hpp"
#include "collision/degrees.hpp"
#include "kds/simd/two_doubles.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace kds::collision {

/// For some dozen bodies: pairs are those whose boxes, swept over one *span* of time for all, overlap; when it is over,
/// all get new ones. Comparing a box with all others costs less than searching the few that it might overlap, and there
/// is nothing to set up.
///
/// The span ends at the horizon, if that is near. Otherwise its length balances the cost of new boxes and that of
/// pairs: the next span is longer if pairs, with their tests, cost less than new boxes for all, and shorter if they
/// cost more. Its length changes the cost, never the contacts.
/// Cost: O(n) a motion change and O(n^2) a span, both with a small constant: two boxes are compared at a time, without
/// a branch. No queue, and no allocation once the bodies are there.
template <int Degree>
class FewBoxes final : public BroadPhase<Degree> {
 public:
  using Entry = typename BroadPhase<Degree>::Entry;

  /// The most bodies: the partners of a body are the bits of one number.
  static constexpr std::size_t most = most_few_boxes;

  explicit FewBoxes(const FewBoxesTuning& tuning = {}) : tuning_(tuning) { check(tuning); }

  bool exact() const override { return false; }
  std::string_view name() const override { return "few-boxes"; }
  /// Throws std::length_error, and changes nothing, if there would be more than `most`.
  void insert(std::span<const Entry> bodies, double now, PairListener& listener) override;
  void remove(BodySlot id, double now, PairListener& listener) override;
  void update(BodySlot id, const KineticBox<Degree>& box, double now, PairListener& listener) override;
  bool advance(double limit, PairListener& listener) override;
  double next_time() const override { return !bodies_.empty() && until_ < horizon_ ? until_ : never; }
  void extend_horizon(double, double horizon) override { horizon_ = horizon; }
  /// O(n): the swept boxes are compared, two at a time.
  void visit_overlapping(const StaticBox& box, double now, SlotVisitor visit) const override;
  /// The same within the span; beyond it, O(n) new boxes.
  void visit_swept(const KineticBox<Degree>& box, double from, double until, SlotVisitor visit) const override;
  void audit(double now) const override;
  BroadPhaseCounters counters() const override { return counters_; }

  std::size_t size() const { return bodies_.size(); }

  /// Whether two bodies are a pair. Precondition: both are here.
  bool paired(BodySlot a, BodySlot b) const { return (partners_[place_of(a)] >> place_of(b) & 1) != 0; }

  /// Calls visit(id, box) for each body.
  template <class Visit>
  void visit(Visit&& visit) const {
    for (const Body& body : bodies_) visit(body.id, body.box);
  }

  /// Forgets all bodies, and reports nothing.
  void clear() { bodies_.clear(); }

 private:
  using Row = std::uint64_t;  ///< of places, the lowest bit first

  struct Body {
    BodySlot id;
    KineticBox<Degree> box;
  };

  std::size_t place_of(BodySlot id) const;
  std::uint64_t cost_of_span() const;
  void begin_span(double now, double latest);
  double first_span(double now) const;
  StaticBox swept(const KineticBox<Degree>& box, double now) const;
  void put(std::size_t place, const StaticBox& box);
  StaticBox box(std::size_t place) const;
  Row overlaps(const StaticBox& box, std::size_t count) const;
  void meet(std::size_t place, const PairListener& listener);
  void change(std::size_t place, Row row, std::size_t count, double now, PairListener& listener);
  bool renew(double now, PairListener& listener);

  FewBoxesTuning tuning_;
  std::vector<Body> bodies_;
  std::array<Row, most> partners_{};                        ///< the partners of each body
  std::array<Row, most> others_{};                          ///< the bodies with which each may collide
  std::array<std::array<Two, most / 2>, 3> min_{}, max_{};  ///< ends of swept boxes, by axis and place
  double until_ = -never;                                   ///< until when these are valid
  double horizon_ = never;
  double span_ = 0;          ///< s; 0 for none yet
  std::uint64_t spent_ = 0;  ///< pairs that began or had to be tested, in this span
  BroadPhaseCounters counters_;
};

#define KDS_DECLARE(degree) extern template class FewBoxes<degree>;
KDS_FOR_ALL_DEGREES(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
