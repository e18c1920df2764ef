// Overlap in the directions that have no sorted list.
#pragma once

#include "certificates/order.hpp"
#include "collision/broad_phase/broad_phase.hpp"
#include "collision/broad_phase/kdop.hpp"
#include "collision/degrees.hpp"
#include "kds/events/dary_queue.hpp"
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
/// overlap on the others: one certificate a pair in place of the swaps of a list.
///
/// Most pairs need none. Of each body there is the hull of its box from now to the horizon, rounded outward; pairs
/// whose hulls are apart on one of these axes stay apart. The next filter takes two straight paths in doubles, with
/// bounds on the errors. What is left gets first_all_broken() or first_any_holds() over the sides of its boxes: the
/// same doubles at which lists of these axes would swap.
///
/// Directions are numbered: 0 to 2 are the axes, those of k-DOPs follow. A pair is apart while it is so in one of them.
///
/// State is that of t+, so no pair is ever reported for no time at all. Events of one time come by (a, b).
///
/// Cost: a few operations for a pair that meets on the listed axes; where its hulls overlap, two to four failure times
/// and one event for each beginning and end.
template <int Degree>
class UnlistedAxes {
 public:
  /// What a box covers from some time to the horizon, rounded outward to floats, which are half as much to fetch.
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

  /// The greatest id so far, and one.
  std::size_t bodies() const { return boxes_.size(); }

  /// A box as one to compare with those of bodies. It meets them all where all axes have a list.
  Hull hull_of(const StaticBox& box) const;

  /// Whether the pair may overlap here before the horizon: the first filter alone.
  bool near(BodySlot a, BodySlot b) const { return hulls_meet(a, b) && (more_.empty() || near_on_more(a, b)); }

  const Hull& hull(BodySlot id) const { return hulls_[id]; }
  /// Near on the first two directions, without a branch.
  bool hulls_meet(BodySlot a, BodySlot b) const { return hulls_[a].meets(hulls_[b]); }

  /// The boxes of a pair have met on all axes with a list; a < b. Returns whether they overlap on these axes too.
  bool met(BodySlot a, BodySlot b, double now) { return near(a, b) && add(a, b, now); }

  /// They have parted on an axis with a list. Returns whether they have overlapped on these until now. (Pairs that are
  /// known are near.)
  bool parted(BodySlot a, BodySlot b) { return near(a, b) && drop(a, b); }

  /// Looks again at a pair that overlaps on the listed axes, as the horizon is later.
  void look_farther(BodySlot a, BodySlot b, double now);

  /// Forgets all pairs of a body; those it has overlapped with are appended to `partners`.
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
    const std::vector<Pair>* pairs;
    std::uint64_t operator()(std::uint32_t slot) const {
      return std::uint64_t{(*pairs)[slot].a} << 32 | (*pairs)[slot].b;
    }
  };
  class Sides;
  static constexpr std::size_t most_directions = 13;  ///< of a 26-DOP, the most there is

  using Apart = certificates::Order<Degree>;

  /// Of k-DOPs: the slab of a body in any direction, the axes too.
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
  std::vector<KineticBox<Degree>> boxes_;        // by body
  std::vector<Hull> hulls_;                      // by body
  std::vector<KineticSlab<Degree>> slabs_;       // by body and direction, if there are more than the axes
  std::vector<float> more_hulls_;                // by body and direction of more_: from, to
  std::vector<std::vector<PairSlot>> pairs_of_;  // by body
  std::vector<Pair> pairs_;                      // those that overlap, or will before the horizon
  std::vector<PairSlot> free_;
  DaryQueue<PairRank> queue_;
  Counters counters_;
};

#define KDS_DECLARE(degree) extern template class UnlistedAxes<degree>;
KDS_FOR_ALL_DEGREES(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
