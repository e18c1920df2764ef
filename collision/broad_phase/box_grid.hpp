// A hierarchical hash grid of boxes at rest: which of them overlap.
#pragma once

#include "collision/broad_phase/box_bounds.hpp"
#include "collision/broad_phase/box_slant.hpp"
#include "collision/broad_phase/cell_table.hpp"
#include "collision/broad_phase/swept_box.hpp"
#include "collision/broad_phase/tuning.hpp"
#include "kds/large_vector.hpp"
#include "kds/simd/two_doubles.hpp"

#include <boost/container/small_vector.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace kds::collision {

/// Stores boxes by number and reports, when one is inserted, removed or replaced, with which others its overlap has
/// changed.
///
/// A level of the grid has cubic cells, of sides that double from level to level; the smallest contain a few boxes on
/// average, since looking into empty cells costs more than comparing some boxes in vain. A box is a *native* of the
/// level whose cells are just larger, and may be a *guest* of coarser levels; in each it is in one cell, that of its
/// lower corner, so to move it rarely changes more than one entry. A search looks into the cells that may contain the
/// corner of an overlapping box. So two boxes of any sizes meet in cells of the larger one's level; space is unbounded,
/// and a small box is not compared with other small ones through the cells of a large one. Cells are found by hashing;
/// different cells with the same key only cost time, since every box found in a cell is compared.
///
/// Guests are sought only when a native is put or moves. A level whose natives do that rarely, that of a floor on which
/// many bodies move, has none: then a native is compared with all smaller boxes. Each level takes in guests, and ceases
/// to, once that would have saved as much work as it costs.
///
/// A cell stores the ends of its boxes on a lattice of a 32nd of its side. Rounding to it is monotone, so boxes that
/// overlap do so on the lattice; most that do not are excluded without reading the boxes themselves.
///
/// Sources: [Ericson05] section 7.2 for hierarchical grids, [Teschner03] for hashing cells. Differs: guests have
/// separate lists; ends on a lattice are stored in the cells.
///
/// Of a long box perhaps only a prism counts (box_slant.hpp), which few of the guests of its large cell meet. Then the
/// smaller boxes are sought along the prism, in the cells of the levels of which they are natives, where that costs
/// less.
///
/// Boxes may be of several *kinds*, each with cells of its own in every level, so that a box is compared only with
/// those of the kinds that its own meets.
///
/// Cost: O(1) a change at bounded density, for each level in use from the box's own and each kind that is met; of a box
/// whose level has no guests, O(n), if few boxes are so large or are changed so rarely that this costs less. Memory
/// O(n).
class BoxGrid {
 public:
  using Id = std::uint32_t;

  /// Kinds are below `kinds`.
  using Kind = std::uint8_t;
  static constexpr std::size_t kinds = 4;
  /// By kind: bit k is set if it meets kind k. Symmetric. At first there is only kind 0, which meets itself.
  using Meetings = std::array<std::uint8_t, kinds>;

  /// Changes with more, which are few, allocate memory.
  using Ids = boost::container::small_vector<Id, 16>;

  /// Boxes with which overlap began and ended.
  struct Changes {
    Ids began, ended;

    bool empty() const { return began.empty() && ended.empty(); }

    void clear() {
      began.clear();
      ended.clear();
    }

    /// Takes out what has both begun and ended: these are no changes. `began` and `ended` are sorted then.
    void leave_out_common();
  };

  explicit BoxGrid(const CellTuning& tuning = {}) : tuning_(tuning), room_per_extent_(tuning.roominess) {
    check(tuning);
  }

  bool contains(Id id) const { return id < items_.size() && items_[id].level != absent; }
  std::size_t size() const { return size_; }
  /// Precondition: contains(id).
  StaticBox box(Id id) const {
    if (!contains(id)) return {};
    return items_[id].bounds.box();
  }
  /// The box in the form that is compared. Precondition: contains(id).
  const BoxBounds& bounds(Id id) const { return items_[id].bounds; }
  /// The radius by which its edges are rounded, as it is compared (kept_rounding()). Precondition: contains(id).
  float rounding(Id id) const { return items_[id].rounding; }
  /// One past the greatest number that there has been.
  Id end() const { return static_cast<Id>(items_.size()); }

  /// Greatest extent of a box of the same level as one of this extent.
  double room_for(double extent) const;

  /// Makes room for boxes of numbers below `end`.
  void reserve(Id end) {
    items_.resize(std::max<std::size_t>(items_.size(), end));
    if (end > natives_.room()) restart(end);
  }
  /// The same, for boxes that come later.
  void expect(Id end) {
    items_.reserve(end);
    if (end > natives_.room()) restart(end);
  }
  /// Gives back the memory of cells if there are far fewer boxes than there were. O(n).
  void fit() {
    if (natives_.room() > 4 * size_) restart(2 * size_);
  }
  /// Chooses the smallest cells by the spacing of boxes. Precondition: empty. Later the grid chooses by itself.
  void choose_cells(double spacing);

  /// Side of the smallest cells that may be used.
  double least_cell() const { return cell_side(finest_); }

  /// Inserts a box, or replaces the one of that number, with edges rounded by a radius (box_bounds.hpp). Appends to
  /// `changes`. `alone`: what the box that it replaces overlaps is not sought, since that is nothing, or the caller
  /// knows it; then all that overlaps the new box is told as begun, and nothing as ended. `slant`: of the box only what
  /// is in that prism counts; null if all of it does.
  void put(Id id, const StaticBox& box, Changes& changes, double rounding = 0, bool alone = false,
           const BoxSlant* slant = nullptr);

  /// Chooses the kind of a box that is to be inserted; without it, the kind is 0.
  void set_kind(Id id, Kind kind) { items_[id].kind = kind; }
  Kind kind(Id id) const { return items_[id].kind; }
  /// Changes which kinds meet, and the kinds of boxes that are here: new_kind(id) is called for each. Reports nothing:
  /// overlaps of boxes that no longer meet are forgotten. O(n). Precondition: boxes of two kinds that have not met
  /// before do not overlap.
  template <class NewKind>
  void change_kinds(const Meetings& meetings, NewKind&& new_kind) {
    meetings_ = meetings;
    for (Id id = 0; id < items_.size(); ++id) {
      if (contains(id)) items_[id].kind = new_kind(id);
    }
    choose_cells_for_kinds();
    restart(natives_.room());
  }

  /// Fetches a box for a later put(). Precondition: id < end().
  void prefetch(Id id) const { __builtin_prefetch(&items_[id], 1); }

  /// Whether two boxes overlap, of whatever kinds. Precondition: both are here.
  bool overlap(Id a, Id b) const {
    return overlaps_with(items_[a]).with(items_[b].bounds, items_[b].rounding) != 0 &&
           !apart(items_[a].bounds, slant(a), b);
  }

  /// Whether only a part of the box counts. Precondition: contains(id).
  bool slanted(Id id) const { return items_[id].slant != no_slant; }
  /// Whether that may be so of any box.
  bool any_slanted() const { return !slants_.empty(); }

  /// For inserting many into an empty grid in an order that suits the cache: first all are announced, then each one
  /// enters. No other function may be called in between. Precondition: id below the end reserved; none has entered.
  void announce(Id id, const StaticBox& box, double rounding = 0) {
    if (size_ == 0) levels_.clear(), unsettled_ = false;  // those of boxes that have been removed
    Item& item = items_[id];
    item.bounds = BoxBounds(box);
    item.rounding = kept_rounding(rounding);
    item.level = level_for(item.bounds.extent());
    if (levels_.empty() || levels_.back().exponent != item.level) use_level(item.level);
    ++size_;
  }
  /// Appends to `changes` the overlaps with boxes that have entered before. Precondition: announced.
  void enter(Id id, Changes& changes);
  /// Instead of enter() for all that have been announced, if their overlaps are known. Fastest in the order of places,
  /// x fastest.
  void enter_all(std::span<const Id> ids);

  /// Precondition: contains(id). Appends to `changes`. `alone`: see put().
  void remove(Id id, Changes& changes, bool alone = false);

  /// Appends the boxes that overlap this one, without rounded edges, each once, in no particular order. Changes
  /// nothing. Precondition: all that have been announced have entered.
  ///
  /// Cost: on each level in use, the cells that may contain the corner of an overlapping box; O(n) in all if these are
  /// more than there are boxes.
  void find_overlapping(const StaticBox& box, Ids& found) const;

  /// Greatest extent of a box of the level next finer than that of a box of this extent; 0 if there is none.
  double room_below(double extent) const {
    const Exponent level = level_for(extent);
    return level == finest_ ? 0 : cell_side(level - 1) / tuning_.roominess;
  }

  /// Greatest extent of a box for which a level is in use.
  double coarsest() const;

 private:
  using Exponent = std::int16_t;
  static constexpr Exponent absent = std::numeric_limits<Exponent>::min();
  static constexpr std::uint32_t no_slant = std::numeric_limits<std::uint32_t>::max();
  static constexpr int least = -1000;  ///< exponent; the scale of such cells does not overflow
  static constexpr int most = 1023;    ///< exponent; all space is a few cells of this size

  /// The data of a box that a search reads: one cache line.
  struct alignas(64) Item {
    BoxBounds bounds;
    float rounding = 0;
    std::uint32_t reported = 0;      ///< the last search that has reported it
    std::uint32_t slant = no_slant;  ///< its place in slants_
    Exponent level = absent;
    bool entered = false;  ///< is in the cells; false while it is only announced
    Kind kind = 0;
  };

  /// The natives or the guests of a level that are of one kind, and bounds for searches of them.
  struct Population {
    std::size_t count = 0;
    std::int64_t span = 0;                      ///< of the largest since it was last empty, in units of the lattice
    std::array<std::int64_t, 3> low{}, high{};  ///< bounds on the lower corners since then, same units
  };

  struct Level {
    Exponent exponent;
    double scale;             ///< units of the lattice per unit of length
    std::uint64_t family;     ///< of its cells
    std::size_t natives = 0;  ///< of all kinds
    bool hosts = false;       ///< whether smaller boxes are its guests
    /// The work that there has been because it hosts, or does not, less that which there would have been otherwise; at
    /// least 0. The unit is that of changing the cell of a box.
    std::int64_t wasted = 0;
    struct Populations {
      Population natives{}, guests{};
    };
    std::array<Populations, kinds> of{};

    std::uint64_t family_of(Kind kind) const { return family + kind * 0xD6E8FEB86659FD93; }
  };

  static BoxOverlaps overlaps_with(const Item& item) {
    return {item.bounds, item.rounding, item.bounds, item.rounding};
  }

  struct Ends;
  struct Census;
  struct Way;

  double cell_side(int exponent) const;
  Exponent level_for(double extent) const {
    if (!(extent > 0)) return finest_;
    if (!(extent < 0x1p1023)) return most;
    const double room = room_per_extent_ * extent;
    int exponent = static_cast<int>(std::bit_cast<std::uint64_t>(room) >> 52) - 1022;  // of a mantissa below 1
    if (exponent == -1022) std::frexp(room, &exponent);                                // a subnormal number
    return static_cast<Exponent>(std::clamp<int>(exponent, finest_, most));
  }
  std::vector<Level>::iterator find_level(Exponent exponent);
  Level& use_level(Exponent exponent);
  static void count_in(Population& population, const Ends& ends);
  static void add(CellTable& table, std::uint64_t family, Population& population, const Ends& ends, Id id);
  static void remove(CellTable& table, std::uint64_t family, Population& population, const Ends& ends, Id id);
  static void replace(CellTable& table, std::uint64_t family, Population& population, const Ends& from, const Ends& to,
                      Id id);
  void add_native(Level& level, const Ends& ends, Id id, Kind kind);
  void add_guest(Level& level, const Ends& ends, Id id, Kind kind);
  void count_scan(Level& level);
  void count_change(Level& level, std::size_t walked);
  void waste(Level& level, std::int64_t work);
  void begin_search(Id id);
  bool report_once(Id id);
  bool meets(Kind kind, Id id) const { return meetings_[kind] >> items_[id].kind & 1; }
  const BoxSlant* slant(Id id) const { return slanted(id) ? &slants_[items_[id].slant] : nullptr; }
  /// Whether the slants of two boxes keep them apart; the first is given by its bounds and its slant.
  bool apart(const BoxBounds& bounds, const BoxSlant* slant, Id other) const {
    return (slant && slant->apart(items_[other].bounds)) ||
           (slanted(other) && slants_[items_[other].slant].apart(bounds));
  }
  template <bool slants>
  void compare(const Item& from, const Item& to, const CellTable::Found& found, Changes& changes);
  template <bool slants>
  void take_overlapping(Id id, const Item& item, const CellTable::Found& found, Ids& overlapping);
  void set_item(Id id, const Item& item, const BoxSlant* slant) {
    std::uint32_t place = no_slant;
    if (slant) {
      place = slanted(id) ? items_[id].slant : place_for_slant();
      slants_[place] = *slant;
    } else {
      drop_slant(id);
    }
    items_[id] = item;
    items_[id].slant = place;
  }
  std::uint32_t place_for_slant();
  void drop_slant(Id id);
  void leave(Id id, Changes& changes, bool alone);
  void move(Id id, const Item& to, Changes& changes, bool alone);
  void put_anew(Id id, const Item& to, const BoxSlant* slant, Changes& changes, bool alone);
  void settle();
  void choose_hosts();
  void restart_guests();
  void tidy();
  void grow();
  void choose_cells_for_kinds();
  void restart(std::size_t room);
  void refine();
  bool search_in(const Level& level, Kind kind, const StaticBox& box, Ids& found) const;
  void search_natives(const Level& level, Kind kind, const Ends& box, CellTable::Found& found) {
    const Population& natives = level.of[kind].natives;
    if (natives.count != 0) search(natives_, level.family_of(kind), natives, box, found);
  }
  std::size_t count_smaller(const Level& level, Kind kind) const;
  void search_smaller(const Level& level, Kind kind, const BoxBounds& bounds, CellTable::Found& found);
  void search(const CellTable& table, std::uint64_t family, const Population& population, const Ends& box,
              CellTable::Found& found);
  void count_crowd(std::size_t chained, std::size_t cells);
  void search_smaller(const Level& level, Kind kind, const Item& item, CellTable::Found& found);
  void follow(const Way& way, Kind kind, CellTable::Found& found);

  CellTuning tuning_;
  LargeVector<Item> items_;                 // by id
  LargeVector<BoxSlant> slants_;            // by Item::slant; empty as long as there has been none
  std::vector<std::uint32_t> free_slants_;  // places of no box
  std::vector<Level> levels_;               // finest first
  CellTable natives_;
  CellTable guests_;
  std::uint32_t search_ = 0;
  std::uint64_t families_ = 0;
  std::size_t size_ = 0;
  double unit_ = 1;            ///< side of a cell of exponent 0, in [1, 2)
  double room_per_extent_;     ///< roominess in such cells
  Exponent finest_ = least;    ///< no box is native of a finer level
  std::int64_t crowding_ = 0;  ///< buckets on chains that searches have visited, minus an allowance for each cell
  bool unsettled_ = false;     ///< some level has wasted much, or has no natives
  Meetings meetings_{1};
};

}  // namespace kds::collision
