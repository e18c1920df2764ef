// The boxes that overlap one that is not in the grid.
#include "collision/broad_phase/box_grid_ends.hpp"

#include <algorithm>
#include <array>

namespace kds::collision {

void BoxGrid::find_overlapping(const StaticBox& box, Ids& found) const {
  for (const Level& level : levels_) {
    const std::size_t before = found.size();
    Kind kind = 0;
    while (kind < kinds && search_in(level, kind, box, found)) ++kind;
    if (kind == kinds) continue;
    found.resize(before);
    // All boxes of this level, and with them those of coarser ones.
    for (Id id = 0; id < items_.size(); ++id) {
      const Item& item = items_[id];
      if (item.level >= level.exponent && item.bounds.box().overlaps(box)) found.push_back(id);
    }
    return;
  }
}

/// Searches the cells of a level for boxes of one kind; false, without a search, if they are more than there are boxes.
///
/// An overlapping box is found in the cell that contains its corner. It may be found through other cells too, of other
/// levels, or so far away that the marks of rows repeat; so it counts only in its own cell.
bool BoxGrid::search_in(const Level& level, Kind kind, const StaticBox& box, Ids& found) const {
  const Population& natives = level.of[kind].natives;
  if (natives.count == 0) return true;
  const Ends ends(BoxBounds(box), level.scale);
  std::array<std::int64_t, 3> low, high;  // cells
  double cells = 1;
  for (std::size_t d = 0; d < 3; ++d) {
    low[d] = Ends::cell_of(std::max(ends.values[d] - natives.span, natives.low[d]));
    high[d] = Ends::cell_of(std::min(-ends.values[d + 3], natives.high[d]));
    if (low[d] > high[d]) return true;
    cells *= static_cast<double>(high[d] - low[d] + 1);
  }
  constexpr auto longest = static_cast<std::int64_t>(CellTable::Block::longest);
  // (If the table has fewer buckets, cells of one row share them.)
  if (cells > static_cast<double>(items_.size()) || natives_.room() < CellTable::Block::longest) return false;
  CellTable::Block block;
  block.family = level.family_of(kind);
  CellTable::Found numbers;
  const auto take = [&] {
    numbers.clear();
    natives_.find(block, numbers);
    for (const Id id : numbers.numbers()) {
      const Item& item = items_[id];
      if (item.level != level.exponent || item.kind != kind || !item.bounds.box().overlaps(box)) continue;
      const Ends its(item.bounds, level.scale);
      bool here = true;
      for (std::size_t d = 0; d < 3; ++d) {
        const std::int64_t along = its.cell(d) - block.low[d];
        here = here && along >= 0 && along < static_cast<std::int64_t>(block.lengths[d]);
      }
      if (here) found.push_back(id);
    }
  };
  const auto choose = [&](std::size_t d, std::int64_t first) {
    block.low[d] = first;
    block.lengths[d] = static_cast<std::size_t>(std::min(high[d] - first + 1, longest));
    for (std::size_t i = 0; i < block.lengths[d]; ++i) {
      const std::int64_t cell = first + static_cast<std::int64_t>(i);
      block.limits[d][i] = LatticeLimits(d).in(cell, ends.values[d], -ends.values[d + 3]);
    }
  };
  for (std::int64_t z = low[2]; z <= high[2]; z += longest) {
    choose(2, z);
    for (std::int64_t y = low[1]; y <= high[1]; y += longest) {
      choose(1, y);
      for (std::int64_t x = low[0]; x <= high[0]; x += longest) {
        choose(0, x);
        take();
      }
    }
  }
  return true;
}

}  // namespace kds::collision
