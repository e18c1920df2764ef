// Overlap in the directions that have no sorted list.
#pragma once

#include "certificates/order.hpp"
#include "collision/broad_phase/broad_phase.hpp"
#include "collision/broad_phase/kdop.hpp"
#include "collision/degrees.hpp"
#include "kds/events/dary_queue.hpp"
#include "kds/large_vector.hpp"
#include "kds/simd/four_floats.hpp"
#include "kds/statistics.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace kds::collision {

/// A pair of bodies, a < b, whose boxes begin or cease to overlap.
struct PairChange {
  BodySlot a, b;
  bool began;
};

/// Keeps, for the pairs of boxes that overlap on all axes with a list, the exact times at which they begin and cease to
/// overlap on the others: one certificate for each pair instead of the swaps of a list.
///
/// Most pairs need none. For each body the hull of its box from now to the horizon is stored, rounded outward; pairs
/// whose hulls are apart on one of these axes stay apart. The next filter is for straight paths, in doubles with error
/// bounds. For the remaining pairs first_all_broken() or first_any_holds() over the sides of the boxes gives the same
/// doubles at which lists of these axes would swap.
///
/// Directions are numbered: 0 to 2 are the axes, those of k-DOPs follow. A pair is apart while it is apart in one of
/// them.
///
/// The state is that at t+, so no pair begins and ends at the same time. Events of one time are in the order of (a, b).
///
/// Cost: a few operations for a pair that meets on the listed axes; where its hulls overlap, two to four failure times
/// and one event for each beginning and end.
template <int Degree>
class UnlistedAxes {
 public:
  /// The hull of a box from some time to the horizon, rounded outward to floats, which take half the memory.
  struct Hull {
    FourFloats ends{0, 0, 0, 0};  ///< low on two axes, then high

    static Hull everywhere() {
      constexpr float far = std::numeric_limits<float>::infinity();
      return {FourFloats{-far, -far, far, far}};
    }
    /// Without a branch.
    bool meets(const Hull& other) const {
      const FourFloats crossed = __builtin_shufflevector(other.ends, other.ends, 2, 3, 0, 1);  // its high ones first
      const auto begin = ends <= crossed;
      const auto end = crossed <= ends;
      return all_set(__builtin_shufflevector(begin, end, 0, 1, 6, 7));
    }
  };

  /// Changes found by process() are appended to `changes`. There are 3 directions, or up to the 13 of a 26-DOP.
  UnlistedAxes(std::vector<PairChange>& changes, std::size_t directions)
      : changes_(&changes), directions_(directions), queue_(PairRank{&pairs_}) {}
  UnlistedAxes(const UnlistedAxes&) = delete;
  UnlistedAxes& operator=(const UnlistedAxes&) = delete;

  /// From now on these directions have no list: bit d stands for direction d. Forgets all pairs.
  void choose(unsigned directions, double now);

  /// Gives a body its box, and its slabs in the directions beyond the axes. Precondition: none of its pairs is known.
  void set_box(BodySlot id, const KineticBox<Degree>& box, std::span<const KineticSlab<Degree>> slabs, double now);
  const KineticBox<Degree>& box(BodySlot id) const { return boxes_[id]; }
  /// An end of a body's interval in a direction.
  Motion<Degree> end(BodySlot id, std::size_t direction, bool upper) const {
    if (direction < 3) return (upper ? boxes_[id].max : boxes_[id].min).axis(static_cast<int>(direction));
    return upper ? slab(id, direction).max : slab(id, direction).min;
  }

  /// One more than the greatest id so far.
  std::size_t bodies() const { return boxes_.size(); }

  /// A box in the form that is compared with those of bodies. If all axes have a list it meets them all.
  Hull hull_of(const StaticBox& box) const;

  /// Whether the pair may overlap on these axes before the horizon: only the first filter.
  bool near(BodySlot a, BodySlot b) const { return hulls_meet(a, b) && (more_.empty() || near_on_more(a, b)); }

  const Hull& hull(BodySlot id) const { return hulls_[id]; }
  /// Whether their hulls meet in the first two directions, without a branch.
  bool hulls_meet(BodySlot a, BodySlot b) const { return hulls_[a].meets(hulls_[b]); }

  /// The boxes of a pair have met on all axes with a list; a < b. Returns whether they overlap on these axes too.
  bool met(BodySlot a, BodySlot b, double now) { return near(a, b) && add(a, b, now); }

  /// They have parted on an axis with a list. Returns whether they have overlapped on these axes until now. (Only pairs
  /// whose hulls meet are stored.)
  bool parted(BodySlot a, BodySlot b) { return near(a, b) && drop(a, b); }

  /// Tests a pair that overlaps on the listed axes again, since the horizon is later.
  void look_farther(BodySlot a, BodySlot b, double now);

  /// Removes all pairs of a body; the bodies that it has overlapped are appended to `partners`.
  void forget_pairs(BodySlot id, std::vector<BodySlot>& partners);

  /// Whether a pair overlaps on these axes. Precondition: it does on the others.
  bool overlap(BodySlot a, BodySlot b) const;

  double next_time() const { return queue_.empty() ? never : queue_.top().time; }
  void process();

  /// The owner then lets all pairs that overlap on the listed axes look_farther().
  void extend_horizon(double now, double horizon);

  /// Checks what is known; the owner calls audit_pair() for all pairs that overlap on the listed axes.
  void audit(double now) const;
  void audit_pair(BodySlot a, BodySlot b, double now) const;

  const Counters& counters() const { return counters_; }

 private:
  using PairSlot = std::uint32_t;
  static constexpr PairSlot no_pair = ~PairSlot{0};

  struct Pair {
    BodySlot a, b;
    bool overlap = false;
    bool alive = false;
  };
  struct PairRank {
    const LargeVector<Pair>* pairs;
    std::uint64_t operator()(std::uint32_t slot) const {
      return std::uint64_t{(*pairs)[slot].a} << 32 | (*pairs)[slot].b;
    }
  };
  class Sides;
  static constexpr std::size_t most_directions = 13;  ///< of a 26-DOP, the largest

  using Apart = certificates::Order<Degree>;

  /// For k-DOPs: the slab of a body in any direction, including the axes.
  const KineticSlab<Degree>& slab(BodySlot id, std::size_t direction) const {
    return slabs_[id * directions_ + direction];
  }
  void set_hulls(BodySlot id, double now);
  bool near_on_more(BodySlot a, BodySlot b) const;
  bool add(BodySlot a, BodySlot b, double now);
  bool drop(BodySlot a, BodySlot b);
  PairSlot find(BodySlot a, BodySlot b) const;
  void remove(PairSlot slot);
  double next_change(const Pair& pair, double now) const;

  std::vector<PairChange>* changes_;
  std::size_t directions_;
  std::array<int, 2> axes_{0, 0};  // axes without a list: the first count_ of them
  std::size_t count_ = 0;
  std::vector<std::size_t> more_;  // all other directions without a list
  double horizon_ = never;
  LargeVector<KineticBox<Degree>> boxes_;        // by body
  LargeVector<Hull> hulls_;                      // by body
  std::vector<KineticSlab<Degree>> slabs_;       // by body and direction, if there are more than the axes
  std::vector<float> more_hulls_;                // by body and direction of more_: from, to
  LargeVector<std::vector<PairSlot>> pairs_of_;  // by body
  LargeVector<Pair> pairs_;                      // those that overlap, or will before the horizon
  std::vector<PairSlot> free_;
  DaryQueue<PairRank> queue_;
  Counters counters_;
};

#define KDS_DECLARE(degree) extern template class UnlistedAxes<degree>;
KDS_FOR_ALL_DEGREES(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
