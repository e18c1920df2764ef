// Boxes that are inserted, moved and removed.
#include "collision/broad_phase/box_grid.hpp"

#include "collision/broad_phase/box_grid_ends.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace kds::collision {

namespace {

/// Calls visit(kind) for each of a set.
template <class Visit>
inline void for_each_kind(std::uint8_t set, Visit&& visit) {
  for (unsigned left = set; left != 0; left &= left - 1) visit(static_cast<BoxGrid::Kind>(std::countr_zero(left)));
}

}  // namespace

void BoxGrid::put(Id id, const StaticBox& box, Changes& changes, double rounding, bool alone, const BoxSlant* slant) {
  if (id >= items_.size()) items_.resize(std::max<std::size_t>(id + 1, items_.size() + items_.size() / 2));
  const Exponent before = items_[id].level;
  const double extent = box.extent();
  Exponent level = level_for(extent);
  // A box that has become a little smaller stays at its level.
  if (before != absent && level < before && level_for(1.125 * extent) == before) level = before;
  const Item to{BoxBounds(box), kept_rounding(rounding), 0, no_slant, level, false, items_[id].kind};
  if (level == before && !slant && !slanted(id)) return move(id, to, changes, alone);
  if (before != absent) return put_anew(id, to, slant, changes, alone);
  ++size_;
  set_item(id, to, slant);
  enter(id, changes);
}

std::uint32_t BoxGrid::place_for_slant() {
  if (free_slants_.empty()) {
    slants_.emplace_back();
    return static_cast<std::uint32_t>(slants_.size() - 1);
  }
  const std::uint32_t place = free_slants_.back();
  free_slants_.pop_back();
  return place;
}

void BoxGrid::drop_slant(Id id) {
  if (!slanted(id)) return;
  free_slants_.push_back(items_[id].slant);
  items_[id].slant = no_slant;
}

/// Cells of two levels may share a bucket, so a box may be found twice, or find itself.
void BoxGrid::begin_search(Id id) {
  if (++search_ == 0) {  // the counter has wrapped round
    for (Item& other : items_) other.reported = 0;
    search_ = 1;
  }
  items_[id].reported = search_;
}

/// False if the box has been reported in this search already.
bool BoxGrid::report_once(Id id) { return std::exchange(items_[id].reported, search_) != search_; }

/// Appends what overlaps just one of two places of a box. Without slants nothing is called in the loop, so that what it
/// compares with stays in registers.
template <bool slants>
inline void BoxGrid::compare(const Item& from, const Item& to, const CellTable::Found& found, Changes& changes) {
  const BoxOverlaps overlaps(from.bounds, from.rounding, to.bounds, to.rounding);
  constexpr unsigned only_before = 1, only_after = 2;
  const unsigned met = meetings_[to.kind];
  for (const Id number : found.numbers()) {
    Item& other = items_[number];
    unsigned overlap = overlaps.with(other.bounds, other.rounding);
    if constexpr (slants) {
      if ((overlap & only_before) != 0 && apart(from.bounds, nullptr, number)) overlap &= ~only_before;
      if ((overlap & only_after) != 0 && apart(to.bounds, nullptr, number)) overlap &= ~only_after;
    }
    if (overlap != only_before && overlap != only_after) continue;
    if ((met >> other.kind & 1) == 0 || !report_once(number)) continue;
    (overlap == only_after ? changes.began : changes.ended).push_back(number);
  }
}

/// Appends what overlaps a box.
template <bool slants>
inline void BoxGrid::take_overlapping(Id id, const Item& item, const CellTable::Found& found, Ids& overlapping) {
  const BoxOverlaps overlaps = overlaps_with(item);
  const BoxSlant* const own = slants ? slant(id) : nullptr;
  for (const Id other : found.numbers()) {
    // Of what is found near a prism most is outside of it, and in the box around it.
    if constexpr (slants) {
      if (own && own->apart(items_[other].bounds)) continue;
      if (slanted(other) && slants_[items_[other].slant].apart(item.bounds)) continue;
    }
    if (overlaps.with(items_[other].bounds, items_[other].rounding) == 0 || !meets(item.kind, other)) continue;
    if (report_once(other)) overlapping.push_back(other);
  }
}

void BoxGrid::enter(Id id, Changes& changes) {
  if (natives_.size() == natives_.room()) grow();
  if (guests_.size() + levels_.size() > guests_.room()) restart_guests();
  items_[id].entered = true;
  const Item item = items_[id];
  use_level(item.level);
  CellTable::Found found;
  begin_search(id);
  for (Level& level : levels_) {
    if (level.exponent < item.level) continue;
    const Ends ends(item.bounds, level.scale);
    const bool native = level.exponent == item.level;
    for_each_kind(meetings_[item.kind], [&](Kind kind) {
      search_natives(level, kind, ends, found);
      if (native) search_smaller(level, kind, item, found);
    });
    if (native) {
      count_scan(level);
      add_native(level, ends, id, item.kind);
    } else {
      count_change(level, 0);
      if (level.hosts) add_guest(level, ends, id, item.kind);
    }
  }
  slants_.empty() ? take_overlapping<false>(id, item, found, changes.began)
                  : take_overlapping<true>(id, item, found, changes.began);
  tidy();
}

/// Extends the bounds by many boxes at once: the least and greatest ends are found first and rounded then; rounding is
/// monotone.
struct BoxGrid::Census {
  void add(const BoxBounds& box, const Ends& ends) {
    ++count;
    span = std::max(span, ends.span());
    low_xy = lesser(box.xy, low_xy);
    low_zx = lesser(box.zx, low_zx);
    high_xy = greater(box.xy, high_xy);
    high_zx = greater(box.zx, high_zx);
  }
  Population population(double scale) const {
    if (count == 0) return {};
    const auto rounded = [&](double x) { return Ends::on_lattice(x * scale); };
    return {count,
            span,
            {rounded(low_xy[0]), rounded(low_xy[1]), rounded(low_zx[0])},
            {rounded(high_xy[0]), rounded(high_xy[1]), rounded(high_zx[0])}};
  }

  static constexpr double beyond = std::numeric_limits<double>::infinity();
  std::size_t count = 0;
  std::int64_t span = 0;
  Two low_xy{beyond, beyond}, low_zx{beyond, beyond};
  Two high_xy{-beyond, -beyond}, high_zx{-beyond, -beyond};
};

/// The boxes and cells of later ones are prefetched meanwhile: they are scattered in memory.
void BoxGrid::enter_all(std::span<const Id> ids) {
  if (ids.size() > natives_.room()) natives_.restart(ids.size());
  struct Ready {
    std::size_t place;
    CellTable::Ends ends;
  };
  constexpr std::size_t ahead = 16;
  std::array<Ready, ahead> ready;
  std::vector<std::array<Census, kinds>> censuses(levels_.size());
  std::size_t level = 0;
  for (std::size_t i = 0; i < ids.size() + ahead; ++i) {
    Ready& slot = ready[i % ahead];
    if (i >= ahead) natives_.add(slot.place, slot.ends, ids[i - ahead]);
    if (i >= ids.size()) continue;
    __builtin_prefetch(&items_[ids[std::min(i + ahead, ids.size() - 1)]], 1);
    Item& item = items_[ids[i]];
    item.entered = true;
    if (levels_[level].exponent != item.level) {
      level = static_cast<std::size_t>(find_level(item.level) - levels_.begin());
    }
    const Ends ends(item.bounds, levels_[level].scale);
    censuses[level][item.kind].add(item.bounds, ends);
    slot = {ends.place(natives_, levels_[level].family_of(item.kind)), ends.in_cell()};
    natives_.fetch(slot.place);
  }
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    levels_[i].natives = 0;
    for (std::size_t kind = 0; kind < kinds; ++kind) {
      levels_[i].of[kind].natives = censuses[i][kind].population(levels_[i].scale);
      levels_[i].natives += censuses[i][kind].count;
    }
  }
  choose_hosts();
  restart_guests();
}

/// Takes a box out of all cells and appends what it overlapped to changes.ended.
void BoxGrid::leave(Id id, Changes& changes, bool alone) {
  items_[id].entered = false;
  const Item item = items_[id];
  CellTable::Found found;
  for (Level& level : levels_) {
    if (level.exponent < item.level) continue;
    const Ends ends(item.bounds, level.scale);
    const bool native = level.exponent == item.level;
    if (native) {
      if (--level.natives == 0) unsettled_ = true;
      remove(natives_, level.family_of(item.kind), level.of[item.kind].natives, ends, id);
    } else if (level.hosts) {
      remove(guests_, level.family_of(item.kind), level.of[item.kind].guests, ends, id);
    }
    if (alone) continue;
    for_each_kind(meetings_[item.kind], [&](Kind kind) {
      search_natives(level, kind, ends, found);
      if (native) search_smaller(level, kind, item, found);
    });
    if (native) count_scan(level);
  }
  if (alone) return;
  begin_search(id);
  slants_.empty() ? take_overlapping<false>(id, item, found, changes.ended)
                  : take_overlapping<true>(id, item, found, changes.ended);
}

void BoxGrid::remove(Id id, Changes& changes, bool alone) {
  leave(id, changes, alone);
  --size_;
  drop_slant(id);
  items_[id].level = absent;
}

/// Replaces a box by one of the same level: if they are near each other, one search finds all boxes that overlap
/// either.
void BoxGrid::move(Id id, const Item& to, Changes& changes, bool alone) {
  const Item from = items_[id];
  auto level = find_level(to.level);
  constexpr double near = 2 * units_per_cell;  // units of the lattice: then searches are small at all levels
  if (from.bounds.joined(to.bounds).extent() * level->scale > near) return put_anew(id, to, nullptr, changes, alone);
  items_[id] = to;
  items_[id].entered = true;
  CellTable::Found found;
  begin_search(id);
  const Kind own = to.kind;
  const std::uint8_t met = meetings_[own];
  const auto sought = [&](const Ends& before, const Ends& after) { return alone ? after : before.joined(after); };
  {
    const Ends before(from.bounds, level->scale);
    const Ends after(to.bounds, level->scale);
    const Ends searched = sought(before, after);
    const BoxBounds bounds = alone ? to.bounds : from.bounds.joined(to.bounds);
    for_each_kind(met, [&](Kind kind) {
      search_natives(*level, kind, searched, found);
      if (level != levels_.begin()) search_smaller(*level, kind, bounds, found);
    });
    count_scan(*level);
    replace(natives_, level->family_of(own), level->of[own].natives, before, after, id);
  }
  while (++level != levels_.end()) {
    const Ends before(from.bounds, level->scale);
    const Ends after(to.bounds, level->scale);
    const Ends searched = sought(before, after);
    for_each_kind(met, [&](Kind kind) { search_natives(*level, kind, searched, found); });
    const std::size_t walked = guests_.walked();
    if (level->hosts) replace(guests_, level->family_of(own), level->of[own].guests, before, after, id);
    count_change(*level, guests_.walked() - walked);
  }
  if (alone) {
    slants_.empty() ? take_overlapping<false>(id, to, found, changes.began)
                    : take_overlapping<true>(id, to, found, changes.began);
  } else {
    slants_.empty() ? compare<false>(from, to, found, changes) : compare<true>(from, to, found, changes);
  }
  tidy();
}

/// Takes a box out and inserts it again; boxes that overlap both before and after are not changes.
void BoxGrid::put_anew(Id id, const Item& to, const BoxSlant* slant, Changes& changes, bool alone) {
  Changes own;
  leave(id, own, alone);
  set_item(id, to, slant);
  enter(id, own);
  if (!alone) own.leave_out_common();
  changes.ended.insert(changes.ended.end(), own.ended.begin(), own.ended.end());
  changes.began.insert(changes.began.end(), own.began.begin(), own.began.end());
}

void BoxGrid::Changes::leave_out_common() {
  if (began.empty() || ended.empty()) return;
  std::sort(began.begin(), began.end());
  std::sort(ended.begin(), ended.end());
  Ids common;
  std::set_intersection(began.begin(), began.end(), ended.begin(), ended.end(), std::back_inserter(common));
  for (Ids* const ids : {&began, &ended}) {
    const auto in_both = [&](Id id) { return std::binary_search(common.begin(), common.end(), id); };
    ids->erase(std::remove_if(ids->begin(), ids->end(), in_both), ids->end());
  }
}

}  // namespace kds::collision
