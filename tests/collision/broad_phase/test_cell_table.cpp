// The hash table of a box grid's cells, against maps.
#include "collision/broad_phase/cell_table.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

namespace kds::collision::test_cell_table {
namespace {

using kds::tests::Random;

/// The same as find(block).
void find_slab_by_slab(const CellTable& table, const CellTable::Block& block, std::size_t main,
                       CellTable::Found& found) {
  const std::array<std::size_t, 2> across{(main + 1) % 3, (main + 2) % 3};
  for (std::size_t i = 0; i < block.lengths[main]; ++i) {
    CellTable::Slab slab;
    slab.place = 0;
    slab.row = block.family;
    const auto go = [&](std::size_t axis, std::int64_t cell) {
      slab.place += static_cast<std::size_t>(cell) * CellTable::step(axis).place;
      slab.row += static_cast<std::uint64_t>(cell) * CellTable::step(axis).row;
    };
    go(main, block.low[main] + static_cast<std::int64_t>(i));
    slab.limit = block.limits[main][i];
    for (std::size_t k = 0; k < 2; ++k) {
      go(across[k], block.low[across[k]]);
      slab.steps[k] = CellTable::step(across[k]);
      slab.lengths[k] = block.lengths[across[k]];
      slab.limits[k] = block.limits[across[k]];
    }
    table.find(slab, found);
  }
}

TEST_CASE("A cell table holds what was added and not removed", "[cell_table]") {
  Random random(11);
  CellTable table;
  table.restart(40);
  std::map<std::size_t, std::map<std::uint32_t, CellTable::Ends>> expected;  // by place
  constexpr CellTable::Ends limits = 0x4040404040404040;
  // One byte of eight, in turn, exceeds the limits, or none.
  const auto random_ends = [&] {
    const auto exceeding = std::min<std::size_t>(random.below(12), 8);
    CellTable::Ends ends = 0x40F03F0040400140;
    if (exceeding == 8) return ends;
    return (ends & ~(CellTable::Ends{0xFF} << 8 * exceeding)) | CellTable::Ends{0x41} << 8 * exceeding;
  };
  const auto exceeds = [](CellTable::Ends ends) {
    for (int i = 0; i < 8; ++i) {
      if (static_cast<std::int8_t>(ends >> 8 * i & 0xFF) > 0x40) return true;
    }
    return false;
  };
  CellTable::Found found;
  bool right = true;
  for (int round = 0; round < 20'000; ++round) {
    // A few rows, so that cells grow long.
    const std::int64_t x = random.integer(-3, 3);
    const std::size_t row = table.row(5, random.integer(-1, 1), random.integer(0, 1));
    const std::size_t place = table.place(row, x);
    const auto number = static_cast<std::uint32_t>(random.below(30));
    auto& cell = expected[place];
    if (const auto it = cell.find(number); it != cell.end() && random.one_in(2)) {
      const CellTable::Ends before = std::exchange(it->second, random_ends());
      right = right && table.replace(place, before, it->second, number);
      right = right && !table.remove(place, before ^ 0x8080, number);
    } else if (it != cell.end() || random.below(5) >= (round < 10'000 ? 3u : 2u)) {
      right = right && table.remove(place, it != cell.end() ? it->second : 0, number) == (it != cell.end());
      if (it != cell.end()) cell.erase(it);
    } else {
      cell[number] = random_ends();
      table.add(place, cell[number], number);
    }
    std::multiset<std::uint32_t> there, seen;
    // Bytes of all three axes, or the limits as a whole.
    CellTable::Block block{5, {x, -1, 0}, {3, 3, 2}, {}};
    for (std::size_t i = 0; i < 3; ++i)
      block.limits[0][i] = limits & 0xFFFFu, block.limits[1][i] = limits & 0x0000FFFFFFFF0000u;
    for (std::size_t i = 0; i < 2; ++i) block.limits[2][i] = limits & 0xFFFF000000000000u;
    for (int z = 0; z <= 1; ++z) {
      for (int y = -1; y <= 1; ++y) {
        for (int i = 0; i < 3; ++i) {
          for (const auto& [n, ends] : expected[table.place(table.row(5, y, z), x + i)]) {
            if (!exceeds(ends)) there.insert(n);
          }
        }
      }
    }
    found.clear();
    table.find(block, found);
    seen.insert(found.numbers().begin(), found.numbers().end());
    right = right && there == seen;
    found.clear();
    find_slab_by_slab(table, block, random.below(3), found);
    right = right && there == std::multiset<std::uint32_t>(found.numbers().begin(), found.numbers().end());
  }
  CHECK(right);
  std::size_t held = 0;
  for (const auto& [place, cell] : expected) held += cell.size();
  CHECK(table.size() == held);
  table.restart(100);
  found.clear();
  for (int i = 0; i < 128; ++i) table.find({0, {i, 0, 0}, {1, 1, 1}, {{{limits}, {0}, {0}}}}, found);
  CHECK(found.numbers().empty());
}

}  // namespace
}  // namespace kds::collision::test_cell_table
