// The levels of a box grid: what is in their cells, and the search in them.
#include "collision/broad_phase/box_grid_ends.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace kds::collision {
namespace {

/// 2^exponent, without a call where it is a normal number.
double power_of_two(int exponent) {
  return exponent > -1023 && exponent <= 1023 ? std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52)
                                              : std::ldexp(1.0, exponent);
}

}  // namespace

/// Cells are at least this much larger than a box. Larger ones are fewer to look into, and hold more.
constexpr double roominess = 1.4;

BoxGrid::Exponent BoxGrid::level_for(double extent) {
  if (!(extent > 0)) return least;
  if (!(extent < 0x1p1023)) return most;
  const double room = roominess * extent;
  int exponent = static_cast<int>(std::bit_cast<std::uint64_t>(room) >> 52) - 1022;  // of a mantissa below 1
  if (exponent == -1022) std::frexp(room, &exponent);                                // not a normal number
  return static_cast<Exponent>(std::clamp(exponent, least, most));
}

double BoxGrid::room_for(double extent) { return power_of_two(level_for(extent)) / roominess; }

double BoxGrid::coarsest() const { return levels_.empty() ? 0 : power_of_two(levels_.back().exponent) / roominess; }

std::vector<BoxGrid::Level>::iterator BoxGrid::find_level(Exponent exponent) {
  return std::lower_bound(levels_.begin(), levels_.end(), exponent,
                          [](const Level& level, Exponent e) { return level.exponent < e; });
}

std::vector<BoxGrid::Level>::iterator BoxGrid::add_level(std::vector<Level>::iterator place, Exponent exponent) {
  families_ += 0x9E6C63D0676A9A99u;
  return levels_.insert(place, Level{exponent, power_of_two(lattice_bits - exponent), families_});
}

BoxGrid::Level& BoxGrid::use_level(Exponent exponent) {
  auto place = find_level(exponent);
  if (place != levels_.end() && place->exponent == exponent) return *place;
  place = add_level(place, exponent);
  restart_guests();
  return *place;
}

/// Levels come and go with the sizes of boxes; one without natives is given up when as much has been spent on its
/// guests as it costs to build it anew.
void BoxGrid::drop_idle_level() {
  idle_ = false;
  std::erase_if(levels_, [&](const Level& level) { return level.natives.count == 0 && level.idle > size_; });
  restart_guests();
}

void BoxGrid::restart_natives(std::size_t room) {
  natives_.restart(room);
  for (Level& level : levels_) level.natives = {};
  for (Id id = 0; id < items_.size(); ++id) {
    if (!items_[id].entered) continue;
    Level& level = *find_level(items_[id].level);
    add(natives_, level, level.natives, Ends(items_[id].bounds, level.scale), id);
  }
}

void BoxGrid::restart_guests() {
  std::size_t guests = 0;
  std::size_t finer = 0;
  for (Level& level : levels_) {
    level.guests = {};
    guests += finer;
    finer += level.natives.count;
  }
  guests_.restart(guests + guests / 2 + levels_.size());
  if (guests == 0) return;
  for (Id id = 0; id < items_.size(); ++id) {
    if (!items_[id].entered) continue;
    for (Level& level : levels_) {
      if (level.exponent <= items_[id].level) continue;
      add(guests_, level, level.guests, Ends(items_[id].bounds, level.scale), id);
    }
  }
}

void BoxGrid::count_guest(Level& level) {
  if (level.natives.count == 0 && ++level.idle > size_) idle_ = true;
}

void BoxGrid::count_in(Population& population, const Ends& ends) {
  if (population.count++ == 0) {
    population.span = 0;
    for (std::size_t d = 0; d < 3; ++d) population.low[d] = population.high[d] = ends.cell(d);
  }
  population.span = std::max(population.span, ends.span());
  for (std::size_t d = 0; d < 3; ++d) {
    population.low[d] = std::min(population.low[d], ends.cell(d));
    population.high[d] = std::max(population.high[d], ends.cell(d));
  }
}

void BoxGrid::add(CellTable& table, const Level& level, Population& population, const Ends& ends, Id id) {
  count_in(population, ends);
  table.add(ends.place(table, level), ends.in_cell(), id);
}

void BoxGrid::remove(CellTable& table, const Level& level, Population& population, const Ends& ends, Id id) {
  --population.count;
  table.remove(ends.place(table, level), ends.in_cell(), id);
}

void BoxGrid::replace(CellTable& table, const Level& level, Population& population, const Ends& from, const Ends& to,
                      Id id) {
  if (from.same_cell(to)) {
    population.span = std::max(population.span, to.span());
    table.replace(to.place(table, level), from.in_cell(), to.in_cell(), id);
  } else {
    remove(table, level, population, from, id);
    add(table, level, population, to, id);
  }
}

/// Appends to found_ the boxes that overlap on the lattice, and maybe some others. Precondition: the box is at most a
/// few cells large, or the population is in few.
void BoxGrid::search(const CellTable& table, const Level& level, const Population& population, const Ends& box) {
  if (population.count == 0) return;
  CellTable::Block block;
  block.family = level.family;
  for (std::size_t d = 0; d < 3; ++d) {
    const std::int64_t low = std::max(Ends::cell_of(box.values[d] - population.span), population.low[d]);
    const std::int64_t high = std::min(Ends::cell_of(-box.values[d + 3]), population.high[d]);
    if (low > high) return;
    block.low[d] = low;
    block.lengths[d] = static_cast<std::size_t>(high - low + 1);
    assert(block.lengths[d] <= CellTable::Block::longest);
    for (std::size_t i = 0; i < block.lengths[d]; ++i) {
      const std::int64_t cell = low + static_cast<std::int64_t>(i);
      block.limits[d][i] = box.limits(d, cell) | row_mark(d, cell);
    }
  }
  table.find(block, found_);
}

}  // namespace kds::collision
