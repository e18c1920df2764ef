// The pairs of bodies that may meet, and when they do.
#pragma once

#include "collision/broad_phase/broad_phase.hpp"
#include "collision/motions.hpp"
#include "collision/narrow_phase/contact.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/profile.hpp"
#include "collision/world/bodies.hpp"
#include "collision/world/clock.hpp"
#include "collision/world/pairs/box_times.hpp"
#include "collision/world/pairs/instant_edits.hpp"
#include "collision/world/pairs/list_arena.hpp"
#include "collision/world/reports.hpp"
#include "collision/world/resting/resting_contacts.hpp"
#include "collision/world/volumes.hpp"
#include "collision/world_counters.hpp"
#include "collision/world_options.hpp"
#include "kds/events/calendar_queue.hpp"
#include "kds/large_vector.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace kds::collision {

template <class Motion>
class Tumbling;

namespace detail {

using PairSlot = std::uint32_t;

/// Two bodies that may meet, in their order (BodyKeys). It exists while the broad phase lists it, and while
/// the two overlap: so its state is a function of the history of the two bodies, whatever the broad phase.
struct Pair {
  BodySlot a = 0, b = 0;
  std::uint32_t place_in_a = 0, place_in_b = 0;  ///< in the lists of the two bodies
  bool alive = false;
  bool listed = false;  ///< by the broad phase, or by Unbounded
  bool dirty = false;   ///< its contact time has to be computed anew
  bool fresh = false;   ///< one of the bodies has entered or jumped at this instant
  /// In contact, in mode `none`; in the modes that resolve contacts, let pass. Its next event is that they separate.
  bool overlapping = false;
  bool boxes_overlap = false;
  bool estimated = false;  ///< its contact time is a lower bound
  PairMemory memory;
  double passes_at = -never;  ///< at this time it counts as overlapping, whatever else happens then
};

/// The order of pairs: by the keys of their bodies.
struct PairRank {
  static constexpr bool lasts = true;  ///< a pair that has an event is alive, and so are its bodies

  const LargeVector<Pair>* pairs;
  const BodyKeys* keys;
  PairKey operator()(std::uint32_t slot) const { return {keys->key((*pairs)[slot].a), keys->key((*pairs)[slot].b)}; }
};

}  // namespace detail

/// The pairs that a broad phase lists, and those that overlap: the state of each, and the time of its next contact or
/// separation. With WorldOptions.report_pairs and a broad phase that is not exact, also the times at which its boxes
/// meet and part.
///
/// [Coming06] Figure 2: the result of a dynamic test is kept until the motion of one of the bodies changes. Then the
/// pair is dirty, until test(). Most tests give only a lower bound, which costs less; only the earliest time is
/// certified.
///
/// Cost: O(1) a pair that begins, ends or becomes dirty; one dynamic test a dirty pair; O(log n) an event.
template <class Motion>
class Pairs final : public PairListener {
 public:
  static constexpr Stage stage = Stage::reported;

  using Slot = detail::PairSlot;
  using Pair = detail::Pair;
  using Resting = RestingPart<Motion>;

  Pairs(const Bodies<Motion>& bodies, const Volumes<Motion>& volumes, Resting& resting, Reports& reports,
        const WorldOptions& options, Clock& clock, WorldCounters& counters, Profile* profile);
  Pairs(const Pairs&) = delete;
  Pairs& operator=(const Pairs&) = delete;

  /// Whether contacts of two bodies are resolved, or they pass through each other.
  ContactMode mode(BodySlot a, BodySlot b) const {
    const bool sensor = bodies_.any_sensor() && (bodies_[a].sensor || bodies_[b].sensor);
    return sensor || options_.response == Response::none ? ContactMode::transparent : ContactMode::resolved;
  }
  /// Whether the broad phase reports exactly the boxes that overlap. To be set before the first pair.
  void expect_exact(bool exact) { follows_boxes_ = options_.report_pairs && !exact, exact_ = exact; }

  /// Makes room for the pairs of so many bodies in all, somewhat more than one a body, at once.
  void reserve(std::size_t bodies);

  // Reports of the broad phase. It runs ahead to t, and the clock with it.
  void pairs_to_come(std::size_t pairs) override;
  bool filters() const override { return bodies_.filters(); }
  bool may_collide(BodySlot a, BodySlot b) const override { return bodies_.may_collide(a, b); }
  std::uint64_t filter_of(BodySlot slot) const override { return bodies_.filter(slot).masks(); }
  bool filters_meet(std::uint64_t a, std::uint64_t b) const override {
    return CollisionFilter::of_masks(a).meets(CollisionFilter::of_masks(b));
  }
  bool visit_pairs(BodySlot body, SlotVisitor visit) const override;
  void pair_began(BodySlot a, BodySlot b, double t) override;
  void pair_ended(BodySlot a, BodySlot b, double t) override;
  /// A new broad phase has been made, and these are all the pairs that it lists, in order.
  void list_anew(std::span<const std::pair<BodySlot, BodySlot>> listed);

  /// The change of bodies during which pairs begin. A body that enters may overlap others from the start; so may one
  /// that jumps, but if they pass through each other that is a contact.
  enum class Begin { moving, jumping, entering };
  void set_begin(Begin begin) { begin_ = begin; }
  /// A body has another filter than before, and the broad phase, which has ended its pairs, is about to begin them
  /// anew. Those that may not collide any more end; of those that could not collide before the bodies may overlap from
  /// the start.
  void filter_changed(BodySlot id, const CollisionFilter& before);
  /// The same of a pair that the caller has begun or ceased to ignore.
  void ignoring_changed(BodySlot a, BodySlot b);

  /// A body has another motion, or has jumped. prefetch_pairs() may be called before.
  void motion_changed(BodySlot id, bool jumped);
  void prefetch_pairs(BodySlot id) const;
  /// Calls far(slot) for bodies that may soon have a contact, and near(slot) when that comes sooner.
  template <class Near, class Far>
  void look_ahead(const Near& near, const Far& far) const;
  /// Hints for these, and for boxes that will soon be renewed: the second is given later.
  void prefetch(BodySlot id) const override;
  void prefetch_list(BodySlot id) const;
  /// A body goes on along its path and turns otherwise. Pairs with those for which waits(other) are left out.
  template <class Waits>
  void turned(BodySlot id, const Waits& waits) {
    for (const Link& link : links(id)) {
      if (!waits(link.other)) mark_turned(link.slot);
    }
  }
  /// Calls visit(a, b, slot) for each pair that is to be tested, and for those that become so meanwhile.
  template <class Visit>
  void every_untested(const Visit& visit) const {
    for (std::size_t i = 0; i < dirty_.size(); ++i) {
      const auto [a, b] = std::pair(pairs_[dirty_[i]].a, pairs_[dirty_[i]].b);
      if (pairs_[dirty_[i]].alive) visit(a, b, dirty_[i]);
    }
  }
  /// A time until which the balls around the two bodies of a pair are apart; now, or earlier, where that does not tell
  /// of contacts, as of those that may overlap. They are larger than they need be by this part of their radii.
  double balls_apart_until(Slot slot, double larger) const;
  /// A time up to which the body surely meets no other, whatever pieces the motions of bodies that precess are made of;
  /// now, or earlier, where that is not known. The balls around bodies are larger than they need be by this part of
  /// their radii. After that either the body is left alone, or has turned().
  double alone_until(BodySlot id, double larger, const Tumbling<Motion>& tumbling) requires(turns<Motion>);
  /// A body has another box, and its motion is unchanged.
  void box_changed(BodySlot id);
  /// The next contact of the two has to be found anew.
  void changed(BodySlot a, BodySlot b);
  /// Lets a pair pass until it has separated, and at this time whatever else happens, even if its boxes do not overlap
  /// just now.
  void let_pass(BodySlot a, BodySlot b) { go_on_overlapping(a, b, clock_.now); }
  /// Two bodies overlap from now on, and are or were let pass at `passes_at` (of pairs that are not, -never).
  void go_on_overlapping(BodySlot a, BodySlot b, double passes_at);
  /// Calls visit(a, b, passes_at) for each pair that overlaps.
  template <class Visit>
  void every_overlap(const Visit& visit) const {
    for (const Pair& pair : pairs_) {
      if (pair.alive && pair.overlapping) visit(pair.a, pair.b, pair.passes_at);
    }
  }
  /// Forgets all pairs.
  void clear();
  /// Gives back memory that fewer pairs do not need: forgets all, and takes them up again as they were. Precondition:
  /// no body is about to enter or to jump. O(pairs and slots).
  void fit();
  /// Calls visit(slot) for each body that passes through this one and overlaps it.
  void visit_overlapped(BodySlot id, SlotVisitor visit) const;
  /// A body is removed; the broad phase has ended its pairs. Those that overlap separate, with a report in mode `none`.
  void remove(BodySlot id);

  /// Tests dirty pairs: `most` of them, or all if there are no more.
  void test(std::size_t most = ~std::size_t{0});
  bool tested() const { return dirty_.empty(); }

  /// A time up to which there is no contact and no separation.
  double next_time() const { return contacts_.empty() ? never : contacts_.top().time; }
  /// If that is only a bound, replaces it by the exact time, which may be later; true if it was one.
  bool certify();
  /// Takes a contact or separation that is due. The next event of the pair has to be found anew.
  struct Event {
    BodySlot a, b;
    bool separates;
    FoundTouch found;  ///< for a contact, if known
  };
  /// Precondition: certify() has returned false.
  Event take_next();

  /// When boxes next meet or part; process_boxes() reports it.
  BoxTimes<detail::PairRank>& box_times() { return boxes_; }
  const BoxTimes<detail::PairRank>& box_times() const { return boxes_; }
  void process_boxes() { process_boxes(boxes_.top().slot, boxes_.top().time); }

  void extend_horizon();

  bool overlapping(BodySlot a, BodySlot b) const;
  bool listed(BodySlot a, BodySlot b) const;
  /// Where and how two bodies touch at t.
  Contact contact(BodySlot a, BodySlot b, double t, const FoundTouch& found = {}) const;

  /// Throws AuditFailure unless pairs that the broad phase does not list are pairs that overlap, and pairs that overlap
  /// penetrate or are about to separate at this instant.
  void audit(double t) const;

  /// The whole state as plain data, in the order of (a, b).
  struct Image {
    struct One {
      Pair pair;
      double contact = never;  ///< when it is due in the queues
      double boxes = never;
    };
    std::vector<One> pairs;
    InstantEdits::Image edits;

    template <class Archive>
    void archive(Archive& archive);
    /// Throws std::runtime_error, naming what is wrong.
    void check(const typename Bodies<Motion>::Image& bodies, double now, const WorldOptions& options) const;
  };
  Image image() const;
  void become(const Image& image);

 private:
  static constexpr Slot none = ~Slot{0};
  /// Room for pairs that a body gets with its first pair; if there are few bodies, for all.
  static constexpr std::uint32_t first_pairs = 2;
  static constexpr std::uint32_t few_pairs = 8;

  /// A pair as one of its bodies sees it.
  struct Link {
    BodySlot other;
    Slot slot;
  };

  std::span<const Link> links(BodySlot id) const {
    return id < of_.size() ? links_.items(of_[id]) : std::span<const Link>();
  }
  bool unbounded(const Pair& pair) const { return bodies_.unbounded(pair.a) || bodies_.unbounded(pair.b); }
  void make_room_for(std::size_t pairs);
  Slot find(BodySlot a, BodySlot b) const;
  Slot add(BodySlot a, BodySlot b);
  void link(Slot slot, std::uint32_t first_room = first_pairs);
  bool newly_allowed(BodySlot a, BodySlot b) const {
    return edits_.has_let_collide(a, bodies_.filter(a), b, bodies_.filter(b), clock_.now);
  }
  void end_filtered(BodySlot id);
  void unlist(Slot slot);
  void end(Slot slot);
  void release(Slot slot);
  void mark_dirty(Slot slot);
  void mark_turned(Slot slot);
  double apart_in_all_pieces(Slot slot) const { return slot < apart_.size() ? apart_[slot] : -never; }
  void report_boxes(bool meet, BodySlot a, BodySlot b) {
    reports_.add_volumes(meet, bodies_.id_of(a), bodies_.id_of(b), clock_.now);
  }

  // pair_tests.cpp
  double horizon(const Pair& pair) const;
  void test_resting(std::size_t first);
  void finish_test(Slot slot);
  void estimate_dirty(std::size_t from);
  void estimate_balls(std::size_t first, std::size_t last);
  void test(Slot slot);
  void set_contact(Slot slot, double time);
  void remember(Slot slot, const FoundTouch& found);
  void test_boxes(Slot slot);
  void process_boxes(Slot slot, double t);

  const Bodies<Motion>& bodies_;
  const Volumes<Motion>& volumes_;
  Resting& resting_;
  Reports& reports_;
  const WorldOptions& options_;
  Clock& clock_;
  WorldCounters& counters_;
  Profile* profile_;

  LargeVector<Pair> pairs_;
  std::vector<Slot> free_;
  ListArena<Link> links_;
  LargeVector<typename ListArena<Link>::List> of_;  ///< the pairs of each body, up to the last that has had one
  std::vector<Slot> dirty_;
  LargeVector<double> estimates_;  ///< by place in dirty_: see estimate_balls()
  LargeVector<FoundTouch> found_;  ///< by pair, if known; not valid once a motion has changed
  /// By pair, up to the last of which that has been found: a time until which the two are apart, whatever pieces of
  /// bodies that precess begin. It saves tests; all events are the same without it.
  std::vector<double> apart_;
  CalendarQueue<detail::PairRank> contacts_;  ///< slots are pairs
  BoxTimes<detail::PairRank> boxes_;          ///< slots are pairs; used where follows_boxes_
  std::size_t unlisted_ = 0;                  ///< pairs that the broad phase does not list
  bool follows_boxes_ = false;                ///< whether it has to find by itself when boxes meet and part
  bool exact_ = false;
  Begin begin_ = Begin::moving;
  InstantEdits edits_;
};

// Functions for a change of motion or a contact are in the header: each is a few instructions for a pair, in the
// innermost loops of World.

template <class Motion>
inline void Pairs<Motion>::mark_dirty(Slot slot) {
  if constexpr (turns<Motion>) {
    if (slot < apart_.size()) apart_[slot] = -never;
  }
  mark_turned(slot);
}

/// A pair is to be tested, and what is known of it for all pieces still holds.
template <class Motion>
inline void Pairs<Motion>::mark_turned(Slot slot) {
  if (pairs_[slot].dirty) return;
  pairs_[slot].dirty = true;
  dirty_.push_back(slot);
}

template <class Motion>
template <class Near, class Far>
inline void Pairs<Motion>::look_ahead(const Near& near, const Far& far) const {
  const auto with_both = [this](const auto& visit) {
    return [this, &visit](Slot slot) {
      visit(pairs_[slot].a);
      visit(pairs_[slot].b);
    };
  };
  contacts_.look_ahead(with_both(near), with_both(far), [this](Slot slot) { __builtin_prefetch(&pairs_[slot], 1); });
}

template <class Motion>
inline void Pairs<Motion>::prefetch(BodySlot id) const {
  bodies_.prefetch(id);
  if (id < of_.size()) __builtin_prefetch(&of_[id]);
}

template <class Motion>
inline void Pairs<Motion>::prefetch_list(BodySlot id) const {
  if (const auto list = links(id); !list.empty()) __builtin_prefetch(list.data());
}

template <class Motion>
inline void Pairs<Motion>::prefetch_pairs(BodySlot id) const {
  for (const Link& link : links(id)) {
    __builtin_prefetch(&pairs_[link.slot], 1);
    __builtin_prefetch(&bodies_.mover(link.other));
  }
}

template <class Motion>
inline void Pairs<Motion>::motion_changed(BodySlot id, bool jumped) {
  for (const Link& link : links(id)) mark_dirty(link.slot);
  if (!jumped) return;
  edits_.add_jump(id, clock_.now);
  for (const Link& link : links(id)) {
    const bool resolved = mode(id, link.other) == ContactMode::resolved;
    if (!resolved && !newly_allowed(id, link.other)) continue;
    Pair& pair = pairs_[link.slot];
    pair.fresh = true;
    if (!resolved || !pair.overlapping) continue;
    // It overlapped before the jump: if that has not been reported yet, it counts only if it still does.
    reports_.take_back(Reports::Kind::overlap, bodies_.id_of(pair.a), bodies_.id_of(pair.b));
  }
}

template <class Motion>
inline typename Pairs<Motion>::Event Pairs<Motion>::take_next() {
  const Slot slot = contacts_.top().slot;
  Pair& pair = pairs_[slot];
  const Event event{pair.a, pair.b, pair.overlapping, slot < found_.size() ? found_[slot] : FoundTouch{}};
  contacts_.clear(slot);
  if (pair.overlapping) {
    pair.overlapping = false;
  } else if (mode(pair.a, pair.b) == ContactMode::transparent) {
    pair.overlapping = true;
  }
  mark_dirty(slot);
  return event;
}

#define KDS_DECLARE(motion) extern template class Pairs<motion>;
KDS_FOR_ALL_MOTIONS(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
