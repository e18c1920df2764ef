// The levels of a box grid: what is in their cells, and the search in them.
#include "collision/broad_phase/box_grid_ends.hpp"
#include "collision/broad_phase/typical_spacing.hpp"
#include "kds/arithmetic/power_of_two.hpp"

#include <algorithm>
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

/// Finds or makes the level; a new one has no guests yet.
BoxGrid::Level& BoxGrid::use_level(Exponent exponent) {
  const auto place = find_level(exponent);
  if (place != levels_.end() && place->exponent == exponent) return *place;
  families_ += 0x9E6C63D0676A9A99u;
  return *levels_.insert(place, Level{exponent, power_of_two(lattice_bits - exponent) / unit_, families_});
}

/// Rebuilds the levels when the wasted work exceeds the cost of rebuilding.
void BoxGrid::tidy() {
  if (idle_) drop_idle_level();
  if (crowding_ > tuning_.patience * static_cast<std::int64_t>(size_)) refine();
}

/// Levels are added and removed with the sizes of boxes; one without natives is given up.
void BoxGrid::drop_idle_level() {
  idle_ = false;
  std::erase_if(levels_, [&](const Level& level) { return level.natives == 0 && level.idle > size_; });
  restart_guests();
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
  restart_guests();
}

/// More boxes, which may be elsewhere, may need other cells.
void BoxGrid::grow() {
  std::vector<Id> present;
  for (Id id = 0; id < items_.size(); ++id) {
    if (contains(id)) present.push_back(id);
  }
  choose_cells(typical_spacing(present.size(), [&](std::size_t i) { return box(present[i]); }));
  restart(2 * natives_.size());
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
    guests += finer;
    finer += level.natives;
  }
  guests_.restart(guests + guests / 2 + levels_.size());
  if (guests == 0) return;
  for (Id id = 0; id < items_.size(); ++id) {
    if (!items_[id].entered) continue;
    for (Level& level : levels_) {
      if (level.exponent <= items_[id].level) continue;
      add_guest(level, Ends(items_[id].bounds, level.scale), id, items_[id].kind);
    }
  }
}

void BoxGrid::count_guest(Level& level) {
  if (level.natives == 0 && ++level.idle > size_) idle_ = true;
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
  if (from.same_cell(to)) {
    population.span = std::max(population.span, to.span());
    table.replace(to.place(table, family), from.in_cell(), to.in_cell(), id);
  } else {
    remove(table, family, population, from, id);
    add(table, family, population, to, id);
  }
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
    for (std::size_t i = 0; i < block.lengths[d]; ++i) {
      const std::int64_t cell = low + static_cast<std::int64_t>(i);
      block.limits[d][i] = box.limits(d, cell) | row_mark(d, cell);
    }
  }
  const auto cells = static_cast<std::int64_t>(block.lengths[0] * block.lengths[1] * block.lengths[2]);
  const auto walked = static_cast<std::int64_t>(table.find(block, found));
  crowding_ = std::max<std::int64_t>(crowding_ + walked - tuning_.crowded_chain * cells, 0);
}

}  // namespace kds::collision
