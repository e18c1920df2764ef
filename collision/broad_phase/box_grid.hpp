// Boxes at rest, and which of them overlap: a hierarchical hash grid.
#pragma once

#include "collision/broad_phase/cell_table.hpp"
#include "collision/broad_phase/swept_box.hpp"

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace kds::collision {

/// Keeps boxes by number and tells, when one comes, goes or is replaced, with which others its overlap has changed.
///
/// A level of the grid has cubic cells of 2^k units. A box is a *native* of the level whose cells are just larger, where
/// it is in at most eight cells, and a *guest* of all coarser levels in use. So two boxes of any sizes meet in cells of
/// the larger one's level; space has no bounds, and a small box does not look at other small ones through the cells of
/// a large one. Cells are found by hashing; different cells that share a key cost time, and nothing else, since what
/// is found in a cell is only a hint.
///
/// Sources: [Ericson05] section 7.2 for hierarchical grids, [Teschner03] for hashing cells. Differs: boxes are in all
/// cells they overlap, so that a search looks at no others; guests have lists of their own.
/// Cost: O(1) a change at bounded density, for each level in use from the box's own; a first native of a level makes all
/// smaller boxes its guests, O(n). Memory O(n).
class BoxGrid {
 public:
  using Id = std::uint32_t;

  /// Boxes with which overlap began and ended.
  struct Changes {
    std::vector<Id> began, ended;

    void clear() {
      began.clear();
      ended.clear();
    }
  };

  bool contains(Id id) const { return id < items_.size() && items_[id].level != absent; }
  std::size_t size() const { return size_; }
  /// Precondition: contains(id).
  StaticBox box(Id id) const {
    if (!contains(id)) return {};
    const auto& [xy, zx, yz] = items_[id].bounds;
    return {{xy[0], xy[1], zx[0]}, {-zx[1], -yz[0], -yz[1]}};
  }
  /// One past the greatest number that there has been.
  Id end() const { return static_cast<Id>(items_.size()); }

  /// Greatest extent of a box of the same level as one of this extent.
  static double room_for(double extent);

  /// Makes room for boxes of numbers below `end`.
  void reserve(Id end) {
    items_.resize(std::max<std::size_t>(items_.size(), end));
    natives_.reserve(2 * std::size_t{end});
  }

  /// Puts a box in, or in place of the one of that number. Appends to `changes`.
  void put(Id id, const StaticBox& box, Changes& changes);

  /// To put many into an empty grid in whatever order suits the cache: first all are announced, then each one enters.
  /// Nothing else may be asked in between. Precondition: id below the end reserved; none has entered.
  void announce(Id id, const StaticBox& box);
  /// Appends to `changes` those that have entered before. Precondition: announced.
  void enter(Id id, Changes& changes);

  /// Precondition: contains(id). Appends to `changes`.
  void remove(Id id, Changes& changes);

  /// Greatest extent of a box for which a level is in use.
  double coarsest() const;

 private:
  using Exponent = std::int16_t;
  static constexpr Exponent absent = std::numeric_limits<Exponent>::min();
  static constexpr int most = 1023;  ///< exponents are within +-most: all space is a few cells of the coarsest

  /// Two doubles at a time: one SSE or NEON register.
  using Two = double __attribute__((vector_size(16)));

  /// A box as six numbers (min, -max), so that boxes overlap if none of one's exceeds the same of the other's
  /// (max, -min): three comparisons of two numbers.
  struct Bounds {
    Two xy, zx, yz;

    bool within(const Bounds& limits) const {
#ifdef __SSE2__
      const Two within = _mm_and_pd(_mm_and_pd(_mm_cmple_pd(xy, limits.xy), _mm_cmple_pd(zx, limits.zx)),
                                    _mm_cmple_pd(yz, limits.yz));
      return _mm_movemask_pd(within) == 3;
#else
      const auto within = (xy <= limits.xy) & (zx <= limits.zx) & (yz <= limits.yz);
      return (within[0] & within[1]) != 0;
#endif
    }
    Bounds joined(const Bounds& b) const {
      return {xy > b.xy ? xy : b.xy, zx > b.zx ? zx : b.zx, yz > b.yz ? yz : b.yz};
    }
  };
  static Bounds bounds(const StaticBox& box) {
    return {Two{box.min[0], box.min[1]}, Two{box.min[2], -box.max[0]}, Two{-box.max[1], -box.max[2]}};
  }
  static Bounds limits(const StaticBox& box) {
    return {Two{box.max[0], box.max[1]}, Two{box.max[2], -box.min[0]}, Two{-box.min[1], -box.min[2]}};
  }

  /// What a search reads of every box it finds: one cache line.
  struct alignas(64) Item {
    Bounds bounds;
    std::uint32_t reported = 0;  ///< the last search that has reported it
    Exponent level = absent;
  };

  struct Level {
    Exponent exponent;
    double scale;            ///< cells per unit
    std::uint64_t tag;       ///< of the keys of its cells
    std::size_t natives = 0;
    std::size_t guests = 0;
    std::size_t idle = 0;    ///< registrations of guests since the last native went
  };

  struct Cells;

  static Exponent level_for(double extent);
  std::vector<Level>::iterator find_level(Exponent exponent);
  std::vector<Level>::iterator add_level(std::vector<Level>::iterator place, Exponent exponent);
  Level& use_level(Exponent exponent);
  void begin_search(Id id);
  void relocate(Id id, const StaticBox& from, Exponent from_level, const StaticBox& to, Changes& changes);
  void drop_idle_level();
  template <class Look>
  void search_cell(const Level& level, bool own, CellTable::Key cell, const Look& look) const;

  std::vector<Item> items_;    // by id
  std::vector<Level> levels_;  // finest first
  CellTable natives_;
  CellTable guests_;
  std::uint32_t search_ = 0;
  std::uint64_t tags_ = 0;
  std::size_t size_ = 0;
  bool idle_ = false;  ///< some level has had too much idle work
};

}  // namespace kds::collision
