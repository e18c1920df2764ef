// Kinetic sweep and prune: the broad phase of [Coming06], exact.
#pragma once

#include "collision/broad_phase/broad_phase.hpp"
#include "collision/broad_phase/kdop.hpp"
#include "collision/broad_phase/tuning.hpp"
#include "collision/broad_phase/unlisted_axes.hpp"
#include "collision/degrees.hpp"
#include "kds/simulator.hpp"
#include "structures/sorted_list.hpp"

#include <cstddef>
#include <utility>
#include <vector>

namespace kds::collision {

/// Kinetic sorted lists of interval ends, one for each listed axis; a swap of a minimum with a maximum begins or ends
/// an overlap there, and positions in the other lists show whether the bodies overlap there: no table of pairs is kept.
/// The axes without a list have a certificate for each pair that overlaps on the listed ones and comes near on the
/// others (UnlistedAxes).
///
/// Paper: [Coming06] sections 4.1-4.3. Differs: by default one list. On each listed axis a body passes the coordinates
/// of all others, near or far, so most of the cost is swaps, and one list has a third of them; of the pairs that meet
/// on one axis few come near on the others. The axis is the one with the fewest expected pairs and swaps, estimated
/// from sizes and speeds; it is chosen again when the horizon is moved or the number of bodies has doubled. A few
/// boxes, not k-DOPs, get three lists, which costs microseconds then (SweepTuning). Times of pairs are the same, bit
/// for bit, whichever axes are listed. Changes at one time are in this order: lists, in the order of axes, then pairs
/// by (a, b) on the other axes; so a pair may begin on one axis and end on another at the same time, but only on listed
/// axes.
///
/// Cost: O(log n) or less a swap (the queue's), no cost between events; a motion change the swaps of its jump and a
/// look at the pairs that overlap on the first listed axis; insertion and removal O(n) moves of memory besides that.
///
/// Intervals whose ends stay equal (boxes that touch and move together) do not overlap.
///
/// Bounding volumes may be k-DOPs (Kdops): intervals in further directions, with lists or without like those on the
/// axes; bodies overlap if they do so in all directions. The list may then be in any direction. Papers: [Klosowski98],
/// [Coming08].
template <int Degree>
class KineticSweepAndPrune final : public BroadPhase<Degree> {
 public:
  using Entry = typename BroadPhase<Degree>::Entry;

  explicit KineticSweepAndPrune(double now, const SweepTuning& tuning = {}, Kdops<Degree> kdops = {});
  KineticSweepAndPrune(const KineticSweepAndPrune&) = delete;
  KineticSweepAndPrune& operator=(const KineticSweepAndPrune&) = delete;

  bool exact() const override { return true; }
  std::string_view name() const override { return "kinetic-sap"; }
  void insert(std::span<const Entry> bodies, double now, PairListener& listener) override;
  void remove(BodySlot id, double now, PairListener& listener) override;
  void update(BodySlot id, const KineticBox<Degree>& box, double now, PairListener& listener) override;
  bool advance(double limit, PairListener& listener) override;
  double next_time() const override { return simulator_.next_time(); }
  void extend_horizon(double now, double horizon) override;
  /// O(log n) comparisons find the stretch of the first list that the box covers; then each body with an end in it is
  /// tested, and, going left from it, as many ends as it takes to find all intervals that are open there (all ends if
  /// all directions have lists). O(n) while an event is due now.
  void visit_overlapping(const StaticBox& box, double now, SlotVisitor visit) const override;
  /// O(n): lists have the order of ends now, not that of later times.
  void visit_swept(const KineticBox<Degree>& box, double from, double until, SlotVisitor visit) const override;
  void audit(double now) const override;
  BroadPhaseCounters counters() const override;

  /// Which directions have a list at present: bit d for axis d, from bit 3 on those of the k-DOPs.
  unsigned listed_axes() const { return listed_; }

 private:
  /// The listener of the swaps in one direction.
  struct AxisListener {
    KineticSweepAndPrune* owner;
    std::size_t axis;  ///< or other direction

    void swapped(std::uint32_t left, std::uint32_t right, double t) { owner->ends_swapped(axis, left, right, t); }
    // Maxima before minima: intervals that stay in touch are apart.
    static std::uint32_t rank(std::uint32_t id) { return ~id & 1; }
  };
  using List = structures::SortedList<Degree, AxisListener>;

  /// The lists, as one structure. Events at one time are in the order of the lists.
  class Lists {
   public:
    std::vector<List> all;          ///< by direction; empty where there is none
    std::vector<std::size_t> used;  ///< the directions that have one

    void use(std::vector<std::size_t> directions) { used = std::move(directions); }
    /// The list whose event is next; any, if there is no event.
    std::size_t first() const {
      std::size_t first = used.front();
      for (std::size_t i = 1; i < used.size(); ++i) {
        if (all[used[i]].next_time() < all[first].next_time()) first = used[i];
      }
      return first;
    }
    double next_time() const { return all[first()].next_time(); }
    /// Precondition: there is an event.
    void process() { all[first()].process(); }
    void extend_horizon(double now, double horizon) {
      for (List& list : all) list.extend_horizon(now, horizon);
    }
    void audit(double now) const {
      for (const List& list : all) list.audit(now);
    }
    Counters counters() const {
      Counters sum;
      for (const List& list : all) sum = sum + list.counters();
      return sum;
    }
  };

  static std::uint32_t min_end(BodySlot id) { return 2 * id; }
  static std::uint32_t max_end(BodySlot id) { return 2 * id + 1; }
  static bool is_min(std::uint32_t end) { return (end & 1) == 0; }

  bool is_listed(std::size_t axis) const { return (listed_ >> axis & 1) != 0; }
  const List& sweep_list() const { return lists_.all[sweep_axis_]; }
  bool all_listed() const { return listed_ == all_axes_; }
  std::size_t size() const { return sweep_list().size() / 2; }

  bool overlap(BodySlot a, BodySlot b) const {
    return overlap_where_listed(a, b) && (all_listed() || unlisted_.overlap(a, b));
  }
  bool overlap_where_listed(BodySlot a, BodySlot b) const;
  bool overlap_on(const List& list, BodySlot a, BodySlot b) const {
    const unsigned a_begins = list.position(min_end(a)) < list.position(max_end(b));
    const unsigned b_begins = list.position(min_end(b)) < list.position(max_end(a));
    return (a_begins & b_begins) != 0;  // without a branch
  }
  void ends_swapped(std::size_t axis, std::uint32_t left, std::uint32_t right, double t);
  void intervals_changed(std::size_t axis, std::uint32_t left, std::uint32_t right, double t);

  // kinetic_sweep_and_prune_axes.cpp: which axes have lists, and which bodies overlap on them
  unsigned best_axes(std::span<const Entry> bodies, double now) const;
  void build_lists(std::span<const Entry> bodies, unsigned listed, double now);
  void choose_again(double now);
  void count_open();
  using BodyPair = std::pair<BodySlot, BodySlot>;
  std::vector<BodyPair> pairs_on_lists() const;
  void partners_on_lists(BodySlot id, std::vector<BodySlot>& partners) const;
  std::size_t ends_below(double x, double now) const;

  std::vector<BodySlot> partners_now(BodySlot id, double now);
  void update_listed_pairs(BodySlot id, double now, PairListener& listener);

  void set_volume(BodySlot id, const KineticBox<Degree>& box, double now);
  /// Moves an end in a direction to where set_volume() has put it.
  void update_end(std::size_t d, BodySlot id, bool upper, double now) {
    lists_.all[d].update(upper ? max_end(id) : min_end(id), unlisted_.end(id, d, upper), now);
  }

  Kdops<Degree> kdops_;
  SweepTuning tuning_;
  unsigned all_axes_;  ///< and directions
  unsigned listed_;
  std::size_t sweep_axis_ = 0;  // the first that has a list
  std::size_t chosen_at_ = 0;   // bodies when the axes were chosen
  double horizon_ = never;

  /// The changes that lists and pairs report. During a motion change swaps are only collected, since the axes change
  /// one after the other.
  std::vector<PairChange> changes_;
  bool updating_ = false;
  bool looked_ = false;  ///< a pair was tested since advance() has last read the next event of axes without a list

  // Of the sweep list, kept only where some axis has no list: how many intervals are open just after each place, and
  // how many have their maximum before their minimum.
  std::vector<std::int32_t> open_;
  std::size_t inverted_ = 0;

  Lists lists_;
  UnlistedAxes<Degree> unlisted_;
  Simulator<Lists, UnlistedAxes<Degree>> simulator_;
  std::uint64_t box_updates_ = 0;
  std::uint64_t update_swaps_ = 0;
};

// ---------------------------------------------------------------------------------------------------------------

/// An end's id is twice its body's, plus one for a maximum: swaps of two minima or two maxima never count. Most other
/// swaps are of bodies that are far apart in some other direction. Processors cannot predict which case it is, so both
/// conditions are computed before the only branch, which is hardly ever taken.
template <int Degree>
inline void KineticSweepAndPrune<Degree>::ends_swapped(std::size_t axis, std::uint32_t left, std::uint32_t right,
                                                       double t) {
  const std::uint32_t kinds_differ = (left ^ right) & 1;
  unsigned near;
  if (all_listed()) {
    near = overlap_on(lists_.all[axis + 1 < lists_.all.size() ? axis + 1 : 0], left / 2, right / 2);
  } else {
    near = unlisted_.hulls_meet(left / 2, right / 2);
    // A minimum on the left has met the other's maximum: one more is open between them, where one less was.
    const auto more = static_cast<std::int32_t>(kinds_differ * (2 - 4 * (left & 1)));
    if (axis == sweep_axis_) open_[sweep_list().position(left)] += more;
  }
  const unsigned one_body = (left ^ right) == 1;
  if ((kinds_differ & (near | one_body | unsigned{updating_})) != 0) intervals_changed(axis, left, right, t);
}

#define KDS_DECLARE(degree) extern template class KineticSweepAndPrune<degree>;
KDS_FOR_ALL_DEGREES(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
