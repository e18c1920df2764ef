#include "collision/broad_phase/box_grid.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace kds::collision {
namespace {

/// The largest integer not above x, of at most 2^62.
std::int64_t floor_to_integer(double x) {
  const double bounded = std::clamp(x, -0x1p62, 0x1p62);
  const auto cut = static_cast<std::int64_t>(bounded);
  return cut - (bounded < static_cast<double>(cut));
}

/// 2^exponent, without a call where it is a normal number.
double power_of_two(int exponent) {
  return exponent > -1023 && exponent <= 1023 ? std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52)
                                              : std::ldexp(1.0, exponent);
}

}  // namespace

/// Cells are at least this much larger than a box. Larger ones are fewer to look into, and hold more.
constexpr double roominess = 1.4;

/// A block of cells of one level.
struct BoxGrid::Cells {
  Cells(const StaticBox& box, const Level& level) : tag(level.tag) {
    for (std::size_t d = 0; d < 3; ++d) {
      const auto i = static_cast<Eigen::Index>(d);
      low[d] = floor_to_integer(box.min[i] * level.scale);
      high[d] = floor_to_integer(box.max[i] * level.scale);
    }
  }

  bool holds(std::int64_t x, std::int64_t y, std::int64_t z) const {
    return low[0] <= x && x <= high[0] && low[1] <= y && y <= high[1] && low[2] <= z && z <= high[2];
  }
  friend bool operator==(const Cells& a, const Cells& b) { return a.low == b.low && a.high == b.high; }

  /// Calls visit(key, x, y, z). Far-away cells may have the same key, which does no harm.
  template <class Visit>
  void each(Visit&& visit) const {
    const auto bits = [](std::int64_t i) { return static_cast<CellTable::Key>(i) & 0xFFFFF; };
    for (std::int64_t z = low[2]; z <= high[2]; ++z) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        for (std::int64_t x = low[0]; x <= high[0]; ++x) visit(tag ^ (bits(z) << 40 | bits(y) << 20 | bits(x)), x, y, z);
      }
    }
  }

  std::array<std::int64_t, 3> low, high;
  std::uint64_t tag;
};

BoxGrid::Exponent BoxGrid::level_for(double extent) {
  if (!(extent > 0)) return -most;
  if (!(extent < 0x1p1023)) return most;
  int exponent = 0;
  std::frexp(roominess * extent, &exponent);  // the mantissa is below 1
  return static_cast<Exponent>(std::clamp(exponent, -most, most));
}

double BoxGrid::room_for(double extent) { return power_of_two(level_for(extent)) / roominess; }

double BoxGrid::coarsest() const { return levels_.empty() ? 0 : power_of_two(levels_.back().exponent) / roominess; }

std::vector<BoxGrid::Level>::iterator BoxGrid::find_level(Exponent exponent) {
  return std::lower_bound(levels_.begin(), levels_.end(), exponent,
                          [](const Level& level, Exponent e) { return level.exponent < e; });
}

std::vector<BoxGrid::Level>::iterator BoxGrid::add_level(std::vector<Level>::iterator place, Exponent exponent) {
  return levels_.insert(place, Level{exponent, power_of_two(-exponent), ++tags_ << 60});
}

BoxGrid::Level& BoxGrid::use_level(Exponent exponent) {
  auto place = find_level(exponent);
  if (place != levels_.end() && place->exponent == exponent) return *place;
  place = add_level(place, exponent);
  for (Id id = 0; id < items_.size(); ++id) {
    if (items_[id].level == absent || items_[id].level > exponent) continue;
    ++place->guests;
    Cells(box(id), *place).each([&](CellTable::Key cell, auto...) { guests_.add(cell, id); });
  }
  return *place;
}

/// Levels come and go with the sizes of boxes; one without natives is given up when as much has been spent on its guests
/// as it costs to build it anew.
void BoxGrid::drop_idle_level() {
  idle_ = false;
  std::erase_if(levels_, [&](const Level& level) { return level.natives == 0 && level.idle > size_; });
  guests_.clear();
  for (Id id = 0; id < items_.size(); ++id) {
    if (items_[id].level == absent) continue;
    for (const Level& level : levels_) {
      if (level.exponent <= items_[id].level) continue;
      Cells(box(id), level).each([&](CellTable::Key cell, auto...) { guests_.add(cell, id); });
    }
  }
}

template <class Look>
void BoxGrid::search_cell(const Level& level, bool own, CellTable::Key cell, const Look& look) const {
  if (level.natives > 0) natives_.visit(cell, look);
  if (own && level.guests > 0) guests_.visit(cell, look);
}

void BoxGrid::put(Id id, const StaticBox& box, Changes& changes) {
  if (id >= items_.size()) items_.resize(std::max<std::size_t>(id + 1, items_.size() + items_.size() / 2));
  Item& item = items_[id];
  const StaticBox from = this->box(id);
  const Exponent from_level = item.level;
  Exponent level = level_for(box.extent());
  // A box that has become a little smaller stays at its level.
  if (from_level != absent && level < from_level && level_for(1.125 * box.extent()) == from_level) level = from_level;
  use_level(level);
  size_ += from_level == absent;
  item.bounds = bounds(box);
  item.level = level;
  if (from_level == absent) return enter(id, changes);
  relocate(id, from, from_level, box, changes);
}

void BoxGrid::announce(Id id, const StaticBox& box) {
  Item& item = items_[id];
  item.bounds = bounds(box);
  item.level = level_for(box.extent());
  const auto place = find_level(item.level);
  if (place == levels_.end() || place->exponent != item.level) add_level(place, item.level);
  ++size_;
}

/// A number for a new search, which no box has been reported in.
void BoxGrid::begin_search(Id id) {
  if (++search_ == 0) {  // all numbers have been used
    for (Item& other : items_) other.reported = 0;
    search_ = 1;
  }
  items_[id].reported = search_;
}

void BoxGrid::enter(Id id, Changes& changes) {
  begin_search(id);
  const StaticBox box = this->box(id);
  const Bounds limits = BoxGrid::limits(box);
  const auto look = [&](Id other_id) {
    Item& other = items_[other_id];
    if (other.reported == search_ || !other.bounds.within(limits)) return;
    other.reported = search_;
    changes.began.push_back(other_id);
  };
  for (Level& level : levels_) {
    if (level.exponent < items_[id].level) continue;
    const Cells cells(box, level);
    if (level.exponent == items_[id].level) {
      level.idle = 0;
      ++level.natives;
      cells.each([&](CellTable::Key cell, auto...) {
        if (level.guests > 0) guests_.visit(cell, look);
        natives_.add(cell, id, look);
      });
    } else {
      if (level.natives == 0 && ++level.idle > size_) idle_ = true;
      ++level.guests;
      cells.each([&](CellTable::Key cell, auto...) {
        if (level.natives > 0) natives_.visit(cell, look);
        guests_.add(cell, id);
      });
    }
  }
  if (idle_) drop_idle_level();
}

void BoxGrid::remove(Id id, Changes& changes) {
  Item& item = items_[id];
  const StaticBox from = box(id);
  const Exponent from_level = item.level;
  --size_;
  item.level = absent;
  relocate(id, from, from_level, from, changes);
}

/// Moves a box, whose new state is in place, from one set of cells to another, and compares overlaps then and now. Its
/// new level may be `absent`.
void BoxGrid::relocate(Id id, const StaticBox& from, Exponent from_level, const StaticBox& to, Changes& changes) {
  const Exponent to_level = items_[id].level;
  begin_search(id);
  constexpr double none = -std::numeric_limits<double>::infinity();
  const Bounds nowhere{{none, none}, {none, none}, {none, none}};
  const Bounds limits_before = limits(from);
  const Bounds limits_after = to_level != absent ? limits(to) : nowhere;
  const Bounds limits_ever = limits_before.joined(limits_after);
  const auto look = [&](Id other_id) {
    Item& other = items_[other_id];
    if (!other.bounds.within(limits_ever)) return;
    const bool after = other.bounds.within(limits_after);
    if (other.bounds.within(limits_before) == after || other.reported == search_) return;
    other.reported = search_;
    (after ? changes.began : changes.ended).push_back(other_id);
  };
  const bool stays = from_level == to_level;
  for (Level& level : levels_) {
    const bool was = level.exponent >= from_level;
    const bool is = to_level != absent && level.exponent >= to_level;
    if (!was && !is) continue;
    const bool was_own = level.exponent == from_level;
    const bool is_own = level.exponent == to_level;
    if (!stays) {
      level.natives += is_own;
      level.natives -= was_own;
      level.guests += is && !is_own;
      level.guests -= was && !was_own;
    }
    if (is_own) level.idle = 0;
    if (level.natives == 0 && ++level.idle > size_) idle_ = true;
    // Cells that are both before and after, and in the same role, need only be searched.
    const bool same_role = was && is && was_own == is_own;
    const Cells before(was ? from : to, level);
    const Cells after(to, level);
    const bool own = was_own || is_own;
    if (is) {
      after.each([&](CellTable::Key cell, std::int64_t x, std::int64_t y, std::int64_t z) {
        search_cell(level, own, cell, look);
        if (!(same_role && before.holds(x, y, z))) (is_own ? natives_ : guests_).add(cell, id);
      });
    }
    if (was && !(same_role && before == after)) {
      before.each([&](CellTable::Key cell, std::int64_t x, std::int64_t y, std::int64_t z) {
        const bool shared = is && after.holds(x, y, z);
        if (!shared) search_cell(level, own, cell, look);
        if (!(same_role && shared)) (was_own ? natives_ : guests_).remove(cell, id);
      });
    }
  }
  if (idle_) drop_idle_level();
}

}  // namespace kds::collision
