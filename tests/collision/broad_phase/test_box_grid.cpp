// The hierarchical hash grid against brute force.
#include "collision/broad_phase/box_grid.hpp"
#include "collision/broad_phase/cell_table.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace kds::collision {
namespace {

using kds::tests::Random;

TEST_CASE("A cell table holds what was added and not removed", "[box_grid]") {
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

StaticBox random_box(Random& random, double size, double side, double far) {
  Eigen::Array3d centre;
  Eigen::Array3d half;
  for (int d = 0; d < 3; ++d) {
    centre[d] = far + random.between(-side, side);
    half[d] = size * random.between(0.1, 0.5);
  }
  return {centre - half, centre + half};
}

std::pair<BoxGrid::Id, BoxGrid::Id> ordered(BoxGrid::Id a, BoxGrid::Id b) { return {std::min(a, b), std::max(a, b)}; }

/// Sizes over many levels, or all of one; boxes that touch, since coordinates are rounded to a lattice in every other
/// round.
void compare_with_brute_force(std::uint64_t seed, int sizes, double far) {
  INFO("seed " << seed << ", sizes over 2^" << sizes << ", around " << far);
  Random random(seed);
  BoxGrid grid;
  std::map<BoxGrid::Id, StaticBox> boxes;
  std::set<std::pair<BoxGrid::Id, BoxGrid::Id>> pairs;
  BoxGrid::Changes changes;
  std::size_t seen = 0;
  for (int round = 0; round < 800; ++round) {
    const auto id = static_cast<BoxGrid::Id>(random.below(60));
    changes.clear();
    if (boxes.contains(id) && random.one_in(4)) {
      grid.remove(id, changes);
      boxes.erase(id);
      REQUIRE(changes.began.empty());
    } else {
      StaticBox box = random_box(
          random, std::ldexp(1.0, -static_cast<int>(random.below(static_cast<std::size_t>(sizes) + 1))), 2, far);
      if (round % 2 == 0) {
        box.min = (box.min * 8).round() / 8;
        box.max = (box.max * 8).round() / 8;
      }
      grid.put(id, box, changes);
      boxes[id] = box;
    }
    for (const auto other : changes.ended) REQUIRE(pairs.erase(ordered(id, other)) == 1);
    for (const auto other : changes.began) REQUIRE(pairs.insert(ordered(id, other)).second);
    REQUIRE(grid.size() == boxes.size());
    std::set<std::pair<BoxGrid::Id, BoxGrid::Id>> expected;
    for (auto a = boxes.begin(); a != boxes.end(); ++a) {
      for (auto b = std::next(a); b != boxes.end(); ++b) {
        if (a->second.overlaps(b->second)) expected.emplace(a->first, b->first);
      }
    }
    REQUIRE(pairs == expected);
    seen += pairs.size();
  }
  CHECK(seen > 300);
}

TEST_CASE("A box grid tells of just the overlaps that change", "[box_grid]") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    compare_with_brute_force(seed, 0, 0);
    compare_with_brute_force(seed, 12, 0);
    compare_with_brute_force(seed, 3, 1e6);
    compare_with_brute_force(seed, 3, -1e15);  // where boxes are a few spacings of the doubles
  }
}

TEST_CASE("Boxes of no extent, and ones that fill all space, have their place in a box grid", "[box_grid]") {
  constexpr double most = std::numeric_limits<double>::max();
  const StaticBox all{Eigen::Array3d::Constant(-most), Eigen::Array3d::Constant(most)};
  const StaticBox point{Eigen::Array3d::Constant(3), Eigen::Array3d::Constant(3)};
  const StaticBox far{Eigen::Array3d::Constant(1e300), Eigen::Array3d::Constant(2e300)};
  BoxGrid grid;
  BoxGrid::Changes changes;
  grid.put(0, point, changes);
  grid.put(1, all, changes);
  CHECK(changes.began == std::vector<BoxGrid::Id>{0});
  changes.clear();
  grid.put(2, far, changes);
  CHECK(changes.began == std::vector<BoxGrid::Id>{1});
  changes.clear();
  grid.put(3, point, changes);
  std::sort(changes.began.begin(), changes.began.end());
  CHECK(changes.began == std::vector<BoxGrid::Id>{0, 1});
  changes.clear();
  grid.remove(1, changes);
  std::sort(changes.ended.begin(), changes.ended.end());
  CHECK(changes.ended == std::vector<BoxGrid::Id>{0, 2, 3});
}

TEST_CASE("Boxes that jump far or come in crowds are found in a box grid", "[box_grid]") {
  Random random(31);
  for (const double far : {0.0, 1e5, 1e12}) {
    BoxGrid grid;
    std::vector<StaticBox> boxes(300, random_box(random, 1, 1, 0));
    std::set<std::pair<BoxGrid::Id, BoxGrid::Id>> pairs;
    BoxGrid::Changes changes;
    for (int round = 0; round < 3000; ++round) {
      const auto id = static_cast<BoxGrid::Id>(random.below(boxes.size()));
      // To one of two crowds, or to one of many rows far from each other, of which some share buckets.
      const double at = random.one_in(2) ? far * random.integer(0, 1) : far + 1024.0 * random.integer(-40, 40);
      boxes[id] = random_box(random, 1, 3, at);
      changes.clear();
      grid.put(id, boxes[id], changes);
      for (const auto other : changes.ended) REQUIRE(pairs.erase(ordered(id, other)) == 1);
      for (const auto other : changes.began) REQUIRE(pairs.insert(ordered(id, other)).second);
    }
    std::set<std::pair<BoxGrid::Id, BoxGrid::Id>> expected;
    for (BoxGrid::Id a = 0; a < boxes.size(); ++a) {
      for (BoxGrid::Id b = a + 1; b < boxes.size(); ++b) {
        if (grid.contains(a) && grid.contains(b) && boxes[a].overlaps(boxes[b])) expected.insert({a, b});
      }
    }
    CHECK(pairs == expected);
    CHECK(expected.size() > 30);
  }
}

/// Puts boxes of at most this size about a centre, in turn; false if what it tells is not what brute force gives.
bool put_all(BoxGrid& grid, std::map<BoxGrid::Id, StaticBox>& boxes, BoxGrid::Id count, Random& random, double size,
             double side) {
  std::set<std::pair<BoxGrid::Id, BoxGrid::Id>> before, pairs, after;
  const auto overlapping = [&](auto& found) {
    for (auto a = boxes.begin(); a != boxes.end(); ++a) {
      for (auto b = std::next(a); b != boxes.end(); ++b) {
        if (a->second.overlaps(b->second)) found.emplace(a->first, b->first);
      }
    }
  };
  overlapping(pairs);
  BoxGrid::Changes changes;
  bool right = true;
  for (BoxGrid::Id id = 0; id < count; ++id) {
    boxes[id] = random_box(random, size, side, 0);
    changes.clear();
    grid.put(id, boxes[id], changes);
    for (const auto other : changes.ended) right = pairs.erase(ordered(id, other)) == 1 && right;
    for (const auto other : changes.began) right = pairs.insert(ordered(id, other)).second && right;
  }
  overlapping(after);
  return right && pairs == after;
}

TEST_CASE("The cells of a box grid follow the spacing of its boxes", "[box_grid]") {
  Random random(47);
  BoxGrid grid;
  std::map<BoxGrid::Id, StaticBox> boxes;
  grid.choose_cells(1e-3);
  const double fine = grid.least_cell();
  CHECK(fine > 1e-3);
  CHECK(fine < 1e-2);
  // More than it had room for, and far from each other: their spacing is 200 / 10, not that of the first.
  CHECK(put_all(grid, boxes, 1000, random, 1, 100));
  const double coarse = grid.least_cell();
  CHECK(coarse > 20);
  CHECK(coarse < 80);
  // They gather in a corner of what was one cell.
  for (int round = 0; round < 30; ++round) CHECK(put_all(grid, boxes, 1000, random, 0.01, 0.5));
  CHECK(grid.least_cell() < 0.1 * coarse);
  // And scatter.
  CHECK(put_all(grid, boxes, 1000, random, 1, 100));
}

TEST_CASE("Cells are not made smaller than crowded boxes that would not fit", "[box_grid]") {
  Random random(53);
  BoxGrid grid;
  std::map<BoxGrid::Id, StaticBox> boxes;
  for (int round = 0; round < 20; ++round) CHECK(put_all(grid, boxes, 500, random, 1, 0.1));  // all overlap
  CHECK(grid.least_cell() > 0.1);
}

TEST_CASE("A box grid does not take a guest of one level for itself in another", "[box_grid]") {
  // Few boxes, so few buckets, and many levels.
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const StaticBox nowhere{Eigen::Array3d::Constant(infinity), Eigen::Array3d::Constant(-infinity)};
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Random random(seed);
    BoxGrid grid;
    std::map<BoxGrid::Id, StaticBox> boxes;
    BoxGrid::Changes changes;
    bool right = true;
    for (int round = 0; round < 300; ++round) {
      const auto id = static_cast<BoxGrid::Id>(random.below(12));
      const StaticBox before = boxes.contains(id) ? boxes[id] : nowhere;
      boxes[id] = random_box(random, std::ldexp(1.0, random.integer(0, 9)), 60, 0);
      changes.clear();
      grid.put(id, boxes[id], changes);
      std::set<BoxGrid::Id> began, ended;
      for (const auto& [other, box] : boxes) {
        const bool was = before.overlaps(box);
        const bool is = boxes[id].overlaps(box);
        if (other != id && is && !was) began.insert(other);
        if (other != id && was && !is) ended.insert(other);
      }
      right = right && began == std::set<BoxGrid::Id>(changes.began.begin(), changes.began.end());
      right = right && ended == std::set<BoxGrid::Id>(changes.ended.begin(), changes.ended.end());
      right = right && began.size() + ended.size() == changes.began.size() + changes.ended.size();
    }
    INFO("seed " << seed);
    CHECK(right);
  }
}

TEST_CASE("Boxes that are announced and enter in any order overlap as they do", "[box_grid]") {
  Random random(23);
  for (const int spread : {0, 8}) {
    BoxGrid grid;
    std::vector<StaticBox> boxes;
    for (int i = 0; i < 400; ++i) {
      boxes.push_back(random_box(random, std::ldexp(1.0, random.integer(-spread, spread)), 6, 0));
    }
    grid.reserve(static_cast<BoxGrid::Id>(boxes.size()));
    std::vector<BoxGrid::Id> order;
    for (BoxGrid::Id id = 0; id < boxes.size(); ++id) {
      grid.announce(id, boxes[id]);
      order.insert(order.begin() + static_cast<std::ptrdiff_t>(random.below(order.size() + 1)), id);
    }
    std::set<std::pair<BoxGrid::Id, BoxGrid::Id>> pairs, expected;
    std::size_t reports = 0;
    BoxGrid::Changes changes;
    for (const BoxGrid::Id id : order) {
      changes.clear();
      grid.enter(id, changes);
      reports += changes.began.size() + changes.ended.size();
      for (const BoxGrid::Id other : changes.began) pairs.insert(ordered(id, other));
    }
    for (BoxGrid::Id a = 0; a < boxes.size(); ++a) {
      for (BoxGrid::Id b = a + 1; b < boxes.size(); ++b) {
        if (boxes[a].overlaps(boxes[b])) expected.insert({a, b});
      }
    }
    CHECK(pairs == expected);
    CHECK(reports == expected.size());
    CHECK(expected.size() > 50);
    // And it goes on as if they had been put in.
    for (BoxGrid::Id id = 0; id < boxes.size(); ++id) {
      changes.clear();
      grid.remove(id, changes);
      for (const BoxGrid::Id other : changes.ended) pairs.erase(ordered(id, other));
    }
    CHECK(pairs.empty());
    CHECK(grid.size() == 0);
  }
}

TEST_CASE("Boxes that settle are found by those that come and move", "[box_grid]") {
  std::size_t wrong = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Random random(seed);
    const auto count = static_cast<BoxGrid::Id>(1 + random.below(60));
    const auto random_box = [&] {
      StaticBox box;
      for (int d = 0; d < 3; ++d) {
        box.min[d] = random.between(-5, 5);
        box.max[d] = box.min[d] + std::exp(random.between(-2, 2));
      }
      return box;
    };
    BoxGrid settled, entered;
    settled.reserve(count);
    entered.reserve(count);
    std::vector<BoxGrid::Id> ids;
    BoxGrid::Changes changes, expected;
    for (BoxGrid::Id id = 0; id < count; ++id) {
      const StaticBox box = random_box();
      ids.push_back(id);
      settled.announce(id, box);
      entered.put(id, box, expected);
    }
    settled.settle(ids);
    for (int step = 0; step < 100; ++step) {
      changes.clear(), expected.clear();
      const auto id = static_cast<BoxGrid::Id>(random.below(count + 1));
      const StaticBox box = random_box();
      settled.put(id, box, changes);
      entered.put(id, box, expected);
      for (auto* list : {&changes.began, &changes.ended, &expected.began, &expected.ended}) {
        std::sort(list->begin(), list->end());
      }
      wrong += changes.began != expected.began || changes.ended != expected.ended;
    }
  }
  CHECK(wrong == 0);
}

TEST_CASE("Boxes of many levels that share the buckets of a small table", "[box_grid]") {
  constexpr BoxGrid::Id count = 24;
  std::size_t wrong = 0;
  std::size_t changed = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Random random(seed);
    BoxGrid grid;
    std::vector<StaticBox> boxes(count);
    std::set<std::pair<BoxGrid::Id, BoxGrid::Id>> overlapping;
    BoxGrid::Changes changes;
    for (BoxGrid::Id step = 0; step < 200; ++step) {
      const auto id = step < count ? step : static_cast<BoxGrid::Id>(random.below(count));
      const bool anew = step < count || random.one_in(2);
      for (int d = 0; d < 3; ++d) {
        const double size = anew ? std::exp(random.between(-2, 2)) : boxes[id].max[d] - boxes[id].min[d];
        const double low = anew ? random.between(-5, 5) : boxes[id].min[d] + random.between(-0.3, 0.3);
        boxes[id].min[d] = low;
        boxes[id].max[d] = low + size;
      }
      changes.clear();
      grid.put(id, boxes[id], changes);
      for (const auto other : changes.ended) wrong += overlapping.erase(std::minmax(id, other)) != 1;
      for (const auto other : changes.began) wrong += !overlapping.insert(std::minmax(id, other)).second;
      changed += changes.began.size() + changes.ended.size();
      for (BoxGrid::Id other = 0; other < std::min(step, count); ++other) {
        if (other == id) continue;
        wrong += boxes[id].overlaps(boxes[other]) != overlapping.contains(std::minmax(id, other));
      }
    }
  }
  CHECK(wrong == 0);
  CHECK(changed > 10'000);
}

}  // namespace
}  // namespace kds::collision
