// The levels of a box grid: what is in their cells, and the search in them.
#include "collision/broad_phase/box_grid_ends.hpp"
#include "collision/broad_phase/typical_spacing.hpp"
#include "kds/arithmetic/power_of_two.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <vector>

namespace kds::collision {

double BoxGrid::cell_side(int exponent) const { return unit_ * power_of_two(exponent); }

double BoxGrid::room_for(double extent) const { return cell_side(level_for(extent)) / tuning_.roominess; }

/// Precondition: empty, or restart() is next.
void BoxGrid::choose_cells(double spacing) {
  unit_ = 1;
  finest_ = least;
  const double side = tuning_.cell_per_spacing * spacing;
  if (side > 0x1p-900 && side < 0x1p900) {  // otherwise the boxes inserted decide
    finest_ = static_cast<Exponent>(std::ilogb(side));
    unit_ = side / power_of_two(finest_);
  }
  room_per_extent_ = tuning_.roominess / unit_;
}

double BoxGrid::coarsest() const {
  return levels_.empty() ? 0 : cell_side(levels_.back().exponent) / tuning_.roominess;
}

std::vector<BoxGrid::Level>::iterator BoxGrid::find_level(Exponent exponent) {
  return std::lower_bound(levels_.begin(), levels_.end(), exponent,
                          [](const Level& level, Exponent e) { return level.exponent < e; });
}

/// Finds or makes the level; a new one has no guests.
BoxGrid::Level& BoxGrid::use_level(Exponent exponent) {
  const auto place = find_level(exponent);
  if (place != levels_.end() && place->exponent == exponent) return *place;
  families_ += 0x9E6C63D0676A9A99u;
  return *levels_.insert(place, Level{exponent, power_of_two(lattice_bits - exponent) / unit_, families_});
}

/// Rebuilds the levels when the wasted work exceeds the cost of rebuilding.
void BoxGrid::tidy() {
  if (unsettled_) settle();
  if (crowding_ > tuning_.patience * static_cast<std::int64_t>(size_)) refine();
}

/// Levels are added and removed with the sizes of boxes; one without natives is given up. Levels take in guests, and
/// cease to.
void BoxGrid::settle() {
  unsettled_ = false;
  bool changed = false;
  for (Level& level : levels_) {
    if (level.wasted <= static_cast<std::int64_t>(size_)) continue;
    level.hosts = !level.hosts;
    level.wasted = 0;
    changed = true;
  }
  std::erase_if(levels_, [](const Level& level) { return level.natives == 0 && !level.hosts; });
  if (changed) restart_guests();
}

/// For boxes that are new: as if all were going to change equally often.
void BoxGrid::choose_hosts() {
  std::size_t finer = 0;
  for (Level& level : levels_) {
    level.hosts = level.natives * size_ > tuning_.scanned_per_change * finer;
    level.wasted = 0;
    finer += level.natives;
  }
}

/// Puts all boxes into new cells of the levels that fit them now, with room for this many.
void BoxGrid::restart(std::size_t room) {
  levels_.clear();
  natives_.restart(room);
  for (Id id = 0; id < items_.size(); ++id) {
    Item& item = items_[id];
    if (item.level == absent) continue;
    item.level = level_for(item.bounds.extent());
    Level& level = use_level(item.level);
    if (item.entered) add_native(level, Ends(item.bounds, level.scale), id, item.kind);
  }
  choose_hosts();
  restart_guests();
}

/// More boxes, which may be elsewhere, may need other cells.
void BoxGrid::grow() {
  choose_cells_for_kinds();
  restart(2 * natives_.size());
}

/// Each kind has cells of its own. They suit the sparsest of the kinds that many boxes have: more boxes in a cell cost
/// less than more cells. Precondition: restart() is next.
void BoxGrid::choose_cells_for_kinds() {
  std::array<std::vector<Id>, kinds> of;
  for (Id id = 0; id < items_.size(); ++id) {
    if (contains(id)) of[items_[id].kind].push_back(id);
  }
  const auto few = [&](const std::vector<Id>& ids) { return ids.size() * tuning_.share_for_cells < size_; };
  const std::vector<Id>* sparsest = nullptr;
  for (const std::vector<Id>& ids : of) {
    if (!ids.empty() && !few(ids) && (!sparsest || ids.size() < sparsest->size())) sparsest = &ids;
  }
  if (!sparsest) return;
  choose_cells(typical_spacing(sparsest->size(), [&](std::size_t i) { return box((*sparsest)[i]); }));
}

/// Makes the smallest cells smaller if most boxes fit into them: for boxes that have gathered in one place.
void BoxGrid::refine() {
  crowding_ = 0;
  std::size_t fitting = 0;
  const double finer = 0.5 * least_cell() / tuning_.roominess;
  for (const Item& item : items_) fitting += item.level == finest_ && item.bounds.extent() < finer;
  if (2 * fitting < size_ || finest_ == least) return;
  --finest_;
  restart(natives_.room());
}

void BoxGrid::restart_guests() {
  std::size_t guests = 0;
  std::size_t finer = 0;
  for (Level& level : levels_) {
    for (Level::Populations& populations : level.of) populations.guests = {};
    if (level.hosts) guests += finer;
    finer += level.natives;
  }
  guests_.restart(guests + guests / 2 + levels_.size());
  if (guests == 0) return;
  for (Id id = 0; id < items_.size(); ++id) {
    if (!items_[id].entered) continue;
    for (Level& level : levels_) {
      if (!level.hosts || level.exponent <= items_[id].level) continue;
      add_guest(level, Ends(items_[id].bounds, level.scale), id, items_[id].kind);
    }
  }
}

/// Counts work that there has been because a level hosts, or does not; if negative, work that this has saved.
void BoxGrid::waste(Level& level, std::int64_t work) {
  level.wasted = std::max<std::int64_t>(level.wasted + work, 0);
  if (level.wasted > static_cast<std::int64_t>(size_)) unsettled_ = true;
}

/// A native is put or moves: either its guests are there, or all smaller boxes are compared.
void BoxGrid::count_scan(Level& level) {
  const auto work = static_cast<std::int64_t>(size_ / tuning_.scanned_per_change + 1);
  waste(level, level.hosts ? -work : work);
}

/// A smaller box changes its cell, after so many buckets that are walked, or would if it were a guest.
void BoxGrid::count_change(Level& level, std::size_t walked) {
  const auto work = static_cast<std::int64_t>(1 + walked / 4);
  waste(level, level.hosts ? work : -work);
}

std::size_t BoxGrid::count_smaller(const Level& level, Kind kind) const {
  std::size_t count = 0;
  for (const Level& finer : levels_) {
    if (finer.exponent >= level.exponent) break;
    count += finer.of[kind].natives.count;
  }
  return count;
}

void BoxGrid::count_in(Population& population, const Ends& ends) {
  if (population.count++ == 0) {
    population.span = 0;
    for (std::size_t d = 0; d < 3; ++d) population.low[d] = population.high[d] = ends.values[d];
  }
  population.span = std::max(population.span, ends.span());
  for (std::size_t d = 0; d < 3; ++d) {
    population.low[d] = std::min(population.low[d], ends.values[d]);
    population.high[d] = std::max(population.high[d], ends.values[d]);
  }
}

void BoxGrid::add(CellTable& table, std::uint64_t family, Population& population, const Ends& ends, Id id) {
  count_in(population, ends);
  table.add(ends.place(table, family), ends.in_cell(), id);
}

void BoxGrid::add_native(Level& level, const Ends& ends, Id id, Kind kind) {
  ++level.natives;
  add(natives_, level.family_of(kind), level.of[kind].natives, ends, id);
}

void BoxGrid::add_guest(Level& level, const Ends& ends, Id id, Kind kind) {
  add(guests_, level.family_of(kind), level.of[kind].guests, ends, id);
}

void BoxGrid::remove(CellTable& table, std::uint64_t family, Population& population, const Ends& ends, Id id) {
  --population.count;
  table.remove(ends.place(table, family), ends.in_cell(), id);
}

void BoxGrid::replace(CellTable& table, std::uint64_t family, Population& population, const Ends& from, const Ends& to,
                      Id id) {
  if (from.values == to.values) return;  // as most are of boxes that are guests of far larger cells
  if (from.same_cell(to)) {
    population.span = std::max(population.span, to.span());
    table.replace(to.place(table, family), from.in_cell(), to.in_cell(), id);
  } else {
    remove(table, family, population, from, id);
    add(table, family, population, to, id);
  }
}

/// Notes how many chained buckets a search of so many cells has visited.
inline void BoxGrid::count_crowd(std::size_t chained, std::size_t cells) {
  const std::int64_t allowed = tuning_.crowded_chain * static_cast<std::int64_t>(cells);
  crowding_ = std::max<std::int64_t>(crowding_ + static_cast<std::int64_t>(chained) - allowed, 0);
}

/// Appends to `found` the boxes that overlap on the lattice, and maybe some others. Precondition: the box is at most a
/// few cells large, or the population is in few; the population is not empty.
void BoxGrid::search(const CellTable& table, std::uint64_t family, const Population& population, const Ends& box,
                     CellTable::Found& found) {
  CellTable::Block block;
  block.family = family;
  for (std::size_t d = 0; d < 3; ++d) {
    const std::int64_t low = Ends::cell_of(std::max(box.values[d] - population.span, population.low[d]));
    const std::int64_t high = Ends::cell_of(std::min(-box.values[d + 3], population.high[d]));
    if (low > high) return;
    block.low[d] = low;
    block.lengths[d] = static_cast<std::size_t>(high - low + 1);
    assert(block.lengths[d] <= CellTable::Block::longest);
    const LatticeLimits limits(d);
    for (std::int64_t cell = low; cell <= high; ++cell) {
      block.limits[d][static_cast<std::size_t>(cell - low)] = limits.in(cell, box.values[d], -box.values[d + 3]);
    }
  }
  count_crowd(table.find(block, found), block.lengths[0] * block.lengths[1] * block.lengths[2]);
}

/// The way of a prism through the cells of a level, slab by slab of cells along its main axis.
struct BoxGrid::Way {
  /// Across, where x along the main axis is 0: the least and the greatest coordinate in a slab, with those of the boxes
  /// in its cells, and a unit for roundings.
  struct Across {
    std::size_t d;
    double rate, low, high;
  };

  Way(const BoxSlant& slant, const Level& of_level, const Population& of_natives, const Item& item)
      : level(of_level), natives(of_natives), box(item.bounds, level.scale), main(slant.main_axis()) {
    first = Ends::cell_of(std::max(box.values[main] - natives.span, natives.low[main]));
    last = Ends::cell_of(std::min(-box.values[main + 3], natives.high[main]));
    const auto end = static_cast<double>(units_per_cell + natives.span);
    for (std::size_t i = 0; i < 2; ++i) {
      const std::size_t d = (main + 1 + i) % 3;
      const BoxSlant::Line line = slant.line(d);
      across[i] = {d, line.rate, level.scale * (line.at - line.half) - 1 + std::min(-line.rate, line.rate * end),
                   level.scale * (line.at + line.half) + 1 + std::max(-line.rate, line.rate * end)};
      widest = std::max(widest, level.scale * line.half);
    }
    farthest = level.scale * slant.farthest();
  }

  std::int64_t slabs() const { return first > last ? 0 : last - first + 1; }
  /// Whether roundings are less than a unit, and no slab has more cells across than a block.
  bool fits() const { return farthest < 0x1p40 && widest < units_per_cell; }

  const Level& level;
  const Population& natives;
  Ends box;
  std::size_t main;
  std::int64_t first, last;  ///< cells along the main axis
  double widest = 0;
  double farthest;
  std::array<Across, 2> across;
};

/// Finds the boxes of finer levels that overlap these bounds: among the guests, or among all.
void BoxGrid::search_smaller(const Level& level, Kind kind, const BoxBounds& bounds, CellTable::Found& found) {
  const Population& guests = level.of[kind].guests;
  if (guests.count != 0) {
    search(guests_, level.family_of(kind), guests, Ends(bounds, level.scale), found);
  } else if (!level.hosts && count_smaller(level, kind) != 0) {
    const BoxOverlaps overlaps(bounds, 0, bounds, 0);
    for (Id id = 0; id < items_.size(); ++id) {
      const Item& item = items_[id];
      if (!item.entered || item.level >= level.exponent || item.kind != kind) continue;
      if (overlaps.with(item.bounds, 0) != 0) found.add(id);
    }
  }
}

/// The same for a box of the level. The guests of a large cell are many, and a prism meets few of them; it is followed
/// through the cells of the natives where that costs less.
void BoxGrid::search_smaller(const Level& level, Kind kind, const Item& item, CellTable::Found& found) {
  const std::size_t smaller = count_smaller(level, kind);
  if (smaller == 0) return;
  if (item.slant != no_slant) {
    boost::container::small_vector<Way, 4> ways;
    std::int64_t slabs = 0;
    bool fits = true;
    for (const Level& finer : levels_) {
      if (finer.exponent >= level.exponent) break;
      const Population& natives = finer.of[kind].natives;
      if (natives.count == 0) continue;
      ways.emplace_back(slants_[item.slant], finer, natives, item);
      slabs += ways.back().slabs();
      fits = fits && ways.back().fits();
    }
    if (fits && slabs * tuning_.guests_per_slab < static_cast<std::int64_t>(smaller)) {
      for (const Way& way : ways) follow(way, kind, found);
      return;
    }
  }
  search_smaller(level, kind, item.bounds, found);
}

void BoxGrid::follow(const Way& way, Kind kind, CellTable::Found& found) {
  const auto& box = way.box.values;
  const Population& natives = way.natives;
  CellTable::Slab slab;
  const CellTable::Step step = CellTable::step(way.main);
  slab.steps = {CellTable::step(way.across[0].d), CellTable::step(way.across[1].d)};
  const LatticeLimits along(way.main);
  const std::array<LatticeLimits, 2> across{LatticeLimits(way.across[0].d), LatticeLimits(way.across[1].d)};
  const std::uint64_t family = way.level.family_of(kind);
  std::size_t walked = 0, cells = 0;
  for (std::int64_t cell = way.first; cell <= way.last; ++cell) {
    const auto x = static_cast<double>(cell * units_per_cell);
    slab.row = family + static_cast<std::uint64_t>(cell) * step.row;
    slab.place = static_cast<std::size_t>(cell) * step.place;
    // False if the prism meets no cell of the slab.
    const auto look_across = [&](std::size_t i) __attribute__((always_inline)) {
      const auto& [d, rate, least, greatest] = way.across[i];
      const std::int64_t low = std::max<std::int64_t>(box[d], std::llrint(least + rate * x));
      const std::int64_t high = std::min<std::int64_t>(-box[d + 3], std::llrint(greatest + rate * x));
      const std::int64_t from = Ends::cell_of(std::max(low - natives.span, natives.low[d]));
      const std::int64_t to = Ends::cell_of(std::min(high, natives.high[d]));
      if (from > to) return false;
      slab.row += static_cast<std::uint64_t>(from) * slab.steps[i].row;
      slab.place += static_cast<std::size_t>(from) * slab.steps[i].place;
      slab.lengths[i] = static_cast<std::size_t>(to - from + 1);
      assert(slab.lengths[i] <= CellTable::Slab::widest);
      CellTable::Ends* limits = slab.limits[i].data();
      for (std::int64_t c = from; c <= to; ++c) *limits++ = across[i].in(c, low, high);
      return true;
    };
    if (!look_across(0) || !look_across(1)) continue;
    slab.limit = along.in(cell, box[way.main], -box[way.main + 3]);
    cells += slab.lengths[0] * slab.lengths[1];
    walked += natives_.find(slab, found);
  }
  count_crowd(walked, cells);
}

}  // namespace kds::collision
