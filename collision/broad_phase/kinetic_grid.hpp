// Kinetic grid: a broad phase whose proof is local.
#pragma once

#include "collision/broad_phase/box_grid.hpp"
#include "collision/broad_phase/box_of.hpp"
#include "collision/broad_phase/broad_phase.hpp"
#include "collision/broad_phase/coarse_number.hpp"
#include "collision/broad_phase/tuning.hpp"
#include "collision/degrees.hpp"
#include "kds/events/calendar_queue.hpp"
#include "kds/large_vector.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace kds::collision {

/// Every body has a *fat box* at rest that contains its kinetic box for a while, with edges rounded by the same radius
/// (box_bounds.hpp); the only certificate of a body is that it is still inside, and pairs are those whose fat boxes
/// overlap (box_grid.hpp). When that ends, a body gets a new fat box: the box that it sweeps until it has moved by a
/// length, its *travel*. So a body has costs for its neighbours only, and not, as in sorted lists, for all whose
/// coordinates it passes; a body at rest costs nothing.
///
/// The travel adapts, body by body: it grows while few pairs begin and shrinks while many do, which balances the cost
/// of renewals against that of pairs, at every density, size and speed. A body whose motion changes again and again
/// before it has left its fat box gets one with a margin on all sides, the largest one ahead, so that it stays inside
/// after most changes. The travel changes the cost, never the contacts.
///
/// Bodies that ignore each other, and are found near each other in vain, get cells of their own (a kind of BoxGrid), in
/// which only those search that may collide with them. The travel of a new body is that which earlier bodies of its
/// filter had when they were removed.
///
/// The time at which a fat box ends is not a root: a time is chosen, and the box is then the swept AABB until that
/// time, rounded outward. So scheduled times need not be exact.
/// The kinetic boxes themselves are not stored: when a fat box is renewed, the owner of the bodies is asked.
///
/// Cost: O(1) a renewal or motion change, for bodies of bounded density, and a queue operation; nothing in between.
/// Memory: 32 bytes a body, and that of the fat boxes and of the queue.
template <int Degree>
class KineticGrid final : public BroadPhase<Degree> {
 public:
  using Entry = typename BroadPhase<Degree>::Entry;

  /// `threads`: how many share the work when many bodies are added at once; 0 is as many as the machine has.
  explicit KineticGrid(BoxOf<Degree> box_of, std::size_t threads = 1, const GridTuning& tuning = {})
      : box_of_(std::move(box_of)), tuning_(tuning), fat_boxes_(tuning.cells), threads_(threads) {
    check(tuning);
  }

  bool exact() const override { return false; }
  std::string_view name() const override { return "grid"; }
  void reserve(BodySlot end) override;
  void fit() override {
    expiry_.fit();
    fat_boxes_.fit();
  }
  void expect(std::size_t bodies, BodySlot end, std::span<const Entry> some, double now) override;
  void insert(std::span<const Entry> bodies, double now, PairListener& listener) override;
  void remove(BodySlot id, double now, PairListener& listener) override;
  void update(BodySlot id, const KineticBox<Degree>& box, double now, PairListener& listener) override;
  void prefetch(BodySlot id) const override {
    if (id >= fat_boxes_.end()) return;
    __builtin_prefetch(&bodies_[id], 1);
    fat_boxes_.prefetch(id);
    expiry_.prefetch(id);
  }
  bool advance(double limit, PairListener& listener) override;
  double next_time() const override { return expiry_.empty() ? never : expiry_.top().time; }
  void extend_horizon(double now, double horizon) override;
  /// Searches the cells that the box meets, level by level (BoxGrid::find_overlapping).
  void visit_overlapping(const StaticBox& box, double now, SlotVisitor visit) const override;
  /// The same for the swept AABB, and each body whose fat box expires before `until` is tested; all bodies if that is
  /// beyond the horizon.
  void visit_swept(const KineticBox<Degree>& box, double from, double until, SlotVisitor visit) const override;
  void audit(double now) const override;
  BroadPhaseCounters counters() const override { return counters_; }

  std::size_t size() const { return fat_boxes_.size(); }

  /// Whether two bodies are a pair. Precondition: both are here.
  bool paired(BodySlot a, BodySlot b) const { return fat_boxes_.overlap(a, b); }

  /// Calls visit(id) for each body.
  template <class Visit>
  void visit(Visit&& visit) const {
    for (BodySlot id = 0; id < fat_boxes_.end(); ++id) {
      if (fat_boxes_.contains(id)) visit(id);
    }
  }

 private:
  /// A box with this travel on both sides still has a finite extent.
  static constexpr double greatest_travel = 0x1p1020;

  /// Two in a cache line. What decides costs only is coarse, or counted up to a most.
  struct alignas(32) Body {
    Body() {}  // the implicit one would set all to zero first

    /// Resets it to the state of a new body.
    void begin(double its_travel) {
      travel = its_travel;
      expiry = never;
      speed = way = life = 0;
      partners = tests = 0;
      begun = in_vain = jostled = 0;
      changed = false;
    }

    /// Its fat box, which was made at `now`, is valid until then.
    void begin_life(double until, double now) {
      expiry = until;
      life = until == never ? 0 : until - now;
    }
    /// For how long it has had its fat box; 0 if that is valid for ever.
    double age(double now) const { return expiry == never ? 0 : life - (expiry - now); }
    double way_until(double now) const { return way + speed * age(now); }

    void add_partner() { count_one(partners); }
    void drop_partner() { partners = static_cast<std::uint16_t>(partners - (partners < many_partners ? 1 : 0)); }

    double expiry = never;       ///< until when its fat box is valid
    CoarseNumber life;           ///< s, for which its fat box is valid; 0 if that is for ever
    CoarseNumber travel;         ///< how far it may move in its fat box
    CoarseNumber speed;          ///< when its fat box was made
    CoarseNumber way;            ///< how far it had moved by then since it was added, about
    std::uint16_t partners = 0;  ///< bodies with which it forms pairs; once there are many_partners that is not counted
    std::uint16_t tests = 0;     ///< of its pairs for changes of its motion since its last renewal
    std::uint8_t begun = 0;      ///< pairs since its last renewal
    std::uint8_t in_vain = 0;    ///< pairs found since then whose bodies may not collide
    std::int8_t jostled = 0;     ///< boxes in which its motion changed minus those in which it did not, bounded
    std::uint8_t filter : 7 = 0;  ///< index in filters_
    bool changed : 1 = false;     ///< whether its motion has changed since its last renewal

    static constexpr std::uint16_t many_partners = std::numeric_limits<std::uint16_t>::max();
  };
  static_assert(sizeof(Body) == 32);
  /// Bodies with the same filter, and what is known of them.
  struct Filter {
    std::uint64_t number = 0;
    bool used = false;
    BoxGrid::Kind kind = 0;
    std::uint32_t bodies = 0;
    double travel = 0;        ///< of a new body; 0 if none has been removed
    std::uint64_t boxes = 0;  ///< made for them
    /// Found near these, with the same filter, where that excludes itself.
    std::uint64_t in_vain = 0;
  };
  struct FatBox {
    StaticBox box;
    double expiry;
    std::uint32_t certificates = 0;  ///< tries
  };

  template <class Sweep, class MayBegin>
  FatBox fat_box(Body& body, const KineticBox<Degree>& kinetic, const Sweep& sweep, const StaticBox& present,
                 double now, double coarsest, MayBegin&& may_begin) const;
  FatBox fat_box(BodySlot id, const KineticBox<Degree>& kinetic, const BoxSweep<Degree>& sweep,
                 const StaticBox& present, double now);
  std::uint32_t fit(Body& body, const KineticBox<Degree>& kinetic, StaticBox& box, double now, double coarsest) const;
  void prepare(std::size_t bodies, std::span<const Entry> some, double now);
  void insert_first(std::span<const Entry> bodies, double now, PairListener& listener);
  void make_boxes(std::span<const Entry> bodies, std::span<StaticBox> boxes, std::size_t threads, double now);
  void cut_to_levels(std::span<const Entry> bodies, std::span<StaticBox> boxes, double now);
  void report_pair(BodySlot a, BodySlot b, double now, PairListener& listener);
  template <class Sweep>
  static double lifetime(double travel, const KineticBox<Degree>& kinetic, const Sweep& sweep);
  std::optional<BoxSlant> slant(const Body& body, const KineticBox<Degree>& kinetic, const StaticBox& present) const;
  double kept_until(BodySlot id, const KineticBox<Degree>& kinetic, const BoxSweep<Degree>& sweep,
                    const StaticBox& present, double now);
  void adapt_travel(BodySlot id, double now);
  static bool ended_pairs(BodySlot id, BoxGrid::Ids& ended, const PairListener& listener);
  bool renew(BodySlot id, const KineticBox<Degree>& kinetic, const BoxSweep<Degree>& sweep, const StaticBox& present,
             double now, PairListener& listener);
  void set_expiry(BodySlot id, double expiry, double now);
  void prefetch_coming(const PairListener& listener) const;
  double travel_factor(std::uint32_t begun) const;
  bool much_in_vain(const Filter& filter) const {
    constexpr std::uint64_t little = 256;
    return filter.in_vain > little + tuning_.in_vain_per_box * filter.boxes;
  }
  void join_filter(BodySlot id, const PairListener& listener);
  void leave_filter(BodySlot id, double now);
  void separate(const PairListener& listener);
  void report(BodySlot id, BoxGrid::Changes& changes, double now, PairListener& listener);

  BoxOf<Degree> box_of_;
  GridTuning tuning_;
  LargeVector<Body> bodies_;  // by id
  BoxGrid fat_boxes_;
  CalendarQueue<> expiry_;  // slots are bodies; no time is later than the horizon
  std::size_t threads_;
  double horizon_ = never;
  double first_travel_ = 0;  ///< of a new body
  /// How often a coarser level was wanted among the last fat boxes, and how many these are: of as many as there are
  /// bodies. Wishes of all time would add up, and begin a level for a few that fly far, in whose cells all others
  /// crowd.
  std::uint64_t wishes_ = 0;
  std::uint64_t boxes_since_ = 0;
  /// The first is of all bodies whose filters are not told apart; it has kind 0.
  std::array<Filter, 8> filters_{};
  bool expected_ = false;  ///< cells have been chosen for the bodies to come
  bool in_vain_ = false;   ///< some filter should have a kind of its own
  BroadPhaseCounters counters_;
};

#define KDS_DECLARE(degree) extern template class KineticGrid<degree>;
KDS_FOR_ALL_DEGREES(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
