#include "collision/broad_phase/box_grid.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <iterator>
#include <utility>

namespace kds::collision {
namespace {

/// Units of the lattice in a cell, as a power of two. Finer ones leave fewer boxes that overlap on the lattice alone;
/// but ends of a few cells have to fit a byte.
constexpr int lattice_bits = 5;
constexpr std::int64_t units_per_cell = 1 << lattice_bits;

/// 2^exponent, without a call where it is a normal number.
double power_of_two(int exponent) {
  return exponent > -1023 && exponent <= 1023 ? std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52)
                                              : std::ldexp(1.0, exponent);
}

/// Byte i of CellTable::Ends. What is out of range is as much out of range on both sides of a comparison.
CellTable::Ends byte(std::size_t i, std::int64_t value) {
  const std::int64_t bounded = std::clamp(value, -CellTable::limit, CellTable::limit);
  return static_cast<CellTable::Ends>(static_cast<std::uint8_t>(bounded)) << 8 * i;
}

/// Bytes 6 and 7: the row, modulo 16 and 8, and its complement; here what a coordinate has in them. The one or the other
/// exceeds that of another row, so the rows of a search, of which there are fewer, are not mistaken for each other.
CellTable::Ends row_mark(std::size_t d, std::int64_t cell) {
  if (d == 0) return 0;
  const CellTable::Ends bits = d == 1 ? 0x0F : 0x70;
  const auto mark = static_cast<CellTable::Ends>(d == 1 ? cell : cell << 4) & bits;
  return mark << 48 | (mark ^ (d == 1 ? bits : 0xF0)) << 56;
}

}  // namespace

/// Cells are at least this much larger than a box. Larger ones are fewer to look into, and hold more.
constexpr double roominess = 1.4;

/// A box on the lattice of a level: (min, -max), like Bounds.
struct BoxGrid::Ends {
  Ends() = default;
  Ends(const Bounds& box, double scale)
      : values{on_lattice(box.xy[0] * scale), on_lattice(box.xy[1] * scale), on_lattice(box.zx[0] * scale),
               on_lattice(box.zx[1] * scale), on_lattice(box.yz[0] * scale), on_lattice(box.yz[1] * scale)} {}

  /// Monotone, and as far below zero as above.
  static std::int64_t on_lattice(double x) { return std::llrint(std::clamp(x, -0x1p61, 0x1p61)); }
  static std::int64_t cell_of(std::int64_t x) { return x >> lattice_bits; }

  /// The cell a box is in.
  std::int64_t cell(std::size_t d) const { return cell_of(values[d]); }
  bool same_cell(const Ends& other) const {
    return (((values[0] ^ other.values[0]) | (values[1] ^ other.values[1]) | (values[2] ^ other.values[2])) >>
            lattice_bits) == 0;
  }
  std::size_t place(const CellTable& table, const Level& level) const {
    return table.place(table.row(level.family, cell(1), cell(2)), cell(0));
  }

  std::int64_t span() const {
    return std::max({-values[3] - values[0], -values[4] - values[1], -values[5] - values[2]});
  }
  Ends joined(const Ends& other) const {
    Ends result;
    for (std::size_t i = 0; i < 6; ++i) result.values[i] = std::min(values[i], other.values[i]);
    return result;
  }

  /// Counted from the box's own cell.
  CellTable::Ends in_cell() const {
    CellTable::Ends ends = 0;
    for (std::size_t d = 0; d < 3; ++d) {
      const std::int64_t corner = cell(d) << lattice_bits;
      ends |= byte(d, values[d] - corner) | byte(d + 3, values[d + 3] + corner) | row_mark(d, cell(d));
    }
    return ends;
  }

  /// What boxes in cells of this coordinate may not exceed if they overlap.
  CellTable::Ends limits(std::size_t d, std::int64_t cell) const {
    const std::int64_t corner = cell << lattice_bits;
    return byte(d, -values[d + 3] - corner) | byte(d + 3, corner - values[d]);
  }

  std::array<std::int64_t, 6> values;
};

BoxGrid::Exponent BoxGrid::level_for(double extent) {
  if (!(extent > 0)) return least;
  if (!(extent < 0x1p1023)) return most;
  int exponent = 0;
  std::frexp(roominess * extent, &exponent);  // the mantissa is below 1
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

/// Levels come and go with the sizes of boxes; one without natives is given up when as much has been spent on its guests
/// as it costs to build it anew.
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

void BoxGrid::add(CellTable& table, const Level& level, Population& population, const Ends& ends, Id id) {
  if (population.count++ == 0) {
    population.span = 0;
    for (std::size_t d = 0; d < 3; ++d) population.low[d] = population.high[d] = ends.cell(d);
  }
  population.span = std::max(population.span, ends.span());
  for (std::size_t d = 0; d < 3; ++d) {
    population.low[d] = std::min(population.low[d], ends.cell(d));
    population.high[d] = std::max(population.high[d], ends.cell(d));
  }
  table.add(ends.place(table, level), ends.in_cell(), id);
}

void BoxGrid::remove(CellTable& table, const Level& level, Population& population, const Ends& ends, Id id) {
  --population.count;
  table.remove(ends.place(table, level), id);
}

void BoxGrid::replace(CellTable& table, const Level& level, Population& population, const Ends& from, const Ends& to,
                      Id id) {
  if (from.same_cell(to)) {
    population.span = std::max(population.span, to.span());
    table.replace(to.place(table, level), to.in_cell(), id);
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

void BoxGrid::put(Id id, const StaticBox& box, Changes& changes) {
  if (id >= items_.size()) items_.resize(std::max<std::size_t>(id + 1, items_.size() + items_.size() / 2));
  const Exponent before = items_[id].level;
  const double extent = box.extent();
  Exponent level = level_for(extent);
  // A box that has become a little smaller stays at its level.
  if (before != absent && level < before && level_for(1.125 * extent) == before) level = before;
  if (level == before) return move(id, bounds(box), changes);
  use_level(level);
  if (before != absent) return put_anew(id, bounds(box), level, changes);
  ++size_;
  items_[id].bounds = bounds(box);
  items_[id].level = level;
  enter(id, changes);
}

void BoxGrid::announce(Id id, const StaticBox& box) {
  if (size_ == 0) levels_.clear();  // of boxes that have gone
  Item& item = items_[id];
  item.bounds = bounds(box);
  item.level = level_for(box.extent());
  const auto place = find_level(item.level);
  if (place == levels_.end() || place->exponent != item.level) add_level(place, item.level);
  ++size_;
}

/// Cells of two levels may share a bucket, so a box may be found twice, or find itself.
void BoxGrid::begin_search(Id id) {
  found_.clear();
  if (++search_ == 0) {  // all numbers have been used
    for (Item& other : items_) other.reported = 0;
    search_ = 1;
  }
  items_[id].reported = search_;
}

/// False if it has been reported in this search.
bool BoxGrid::report_once(Id id) { return std::exchange(items_[id].reported, search_) != search_; }

void BoxGrid::enter(Id id, Changes& changes) {
  if (natives_.size() == natives_.room()) restart_natives(2 * natives_.size());
  if (guests_.size() + levels_.size() > guests_.room()) restart_guests();
  items_[id].entered = true;
  const Item item = items_[id];
  const Bounds limits = item.bounds.limits();
  begin_search(id);
  for (Level& level : levels_) {
    if (level.exponent < item.level) continue;
    const Ends ends(item.bounds, level.scale);
    search(natives_, level, level.natives, ends);
    if (level.exponent == item.level) {
      level.idle = 0;
      search(guests_, level, level.guests, ends);
      add(natives_, level, level.natives, ends, id);
    } else {
      count_guest(level);
      add(guests_, level, level.guests, ends, id);
    }
  }
  for (const Id other : found_.numbers()) {
    if (items_[other].bounds.within(limits) && report_once(other)) changes.began.push_back(other);
  }
  if (idle_) drop_idle_level();
}

/// Takes a box out of all cells and appends what it overlapped to changes.ended.
void BoxGrid::leave(Id id, Changes& changes) {
  items_[id].entered = false;
  const Item item = items_[id];
  const Bounds limits = item.bounds.limits();
  begin_search(id);
  for (Level& level : levels_) {
    if (level.exponent < item.level) continue;
    const Ends ends(item.bounds, level.scale);
    if (level.exponent == item.level) {
      remove(natives_, level, level.natives, ends, id);
      search(guests_, level, level.guests, ends);
    } else {
      remove(guests_, level, level.guests, ends, id);
    }
    search(natives_, level, level.natives, ends);
  }
  for (const Id other : found_.numbers()) {
    if (items_[other].bounds.within(limits) && report_once(other)) changes.ended.push_back(other);
  }
}

void BoxGrid::remove(Id id, Changes& changes) {
  leave(id, changes);
  --size_;
  items_[id].level = absent;
}

/// Replaces a box by one of its level: if they are near each other, one search finds what overlaps either.
void BoxGrid::move(Id id, const Bounds& to, Changes& changes) {
  const Item item = items_[id];
  auto level = find_level(item.level);
  constexpr double near = 2 * units_per_cell;  // in units of the lattice; searches are then small at all levels
  if (item.bounds.joined(to).extent() * level->scale > near) return put_anew(id, to, item.level, changes);
  const Ends own_before(item.bounds, level->scale);
  const Ends own_after(to, level->scale);
  const Ends own_either = own_before.joined(own_after);
  items_[id].bounds = to;
  begin_search(id);
  level->idle = 0;
  search(natives_, *level, level->natives, own_either);
  search(guests_, *level, level->guests, own_either);
  replace(natives_, *level, level->natives, own_before, own_after, id);
  while (++level != levels_.end()) {
    const Ends before(item.bounds, level->scale);
    const Ends after(to, level->scale);
    search(natives_, *level, level->natives, before.joined(after));
    count_guest(*level);
    replace(guests_, *level, level->guests, before, after, id);
  }
  const Bounds limits_before = item.bounds.limits();
  const Bounds limits_after = to.limits();
  for (const Id other : found_.numbers()) {
    const Bounds& bounds = items_[other].bounds;
    const bool after = bounds.within(limits_after);
    if (bounds.within(limits_before) == after || !report_once(other)) continue;
    (after ? changes.began : changes.ended).push_back(other);
  }
  if (idle_) drop_idle_level();
}

/// Takes a box out and puts it in anew; what overlaps both before and after has not changed.
void BoxGrid::put_anew(Id id, const Bounds& to, Exponent level, Changes& changes) {
  const auto ended = static_cast<std::ptrdiff_t>(changes.ended.size());
  const auto began = static_cast<std::ptrdiff_t>(changes.began.size());
  leave(id, changes);
  items_[id].bounds = to;
  items_[id].level = level;
  enter(id, changes);
  std::sort(changes.ended.begin() + ended, changes.ended.end());
  std::sort(changes.began.begin() + began, changes.began.end());
  std::vector<Id> both;
  std::set_intersection(changes.ended.begin() + ended, changes.ended.end(), changes.began.begin() + began,
                        changes.began.end(), std::back_inserter(both));
  const auto is_both = [&](Id other) { return std::binary_search(both.begin(), both.end(), other); };
  changes.ended.erase(std::remove_if(changes.ended.begin() + ended, changes.ended.end(), is_both), changes.ended.end());
  changes.began.erase(std::remove_if(changes.began.begin() + began, changes.began.end(), is_both), changes.began.end());
}

}  // namespace kds::collision
