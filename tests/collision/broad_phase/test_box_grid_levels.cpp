// The levels and cells of the hierarchical hash grid, as boxes call for them.
#include "collision/broad_phase/box_grid.hpp"
#include "tests/collision/broad_phase/box_grid_boxes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace kds::collision::test_box_grid_levels {
namespace {

using namespace tests;

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

TEST_CASE("Boxes of many levels that share the buckets of a small table", "[box_grid]") {
  constexpr BoxGrid::Id count = 24;
  std::size_t changed = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Random random(seed);
    std::size_t wrong = 0;
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
    INFO("seed " << seed);
    CHECK(wrong == 0);
  }
  CHECK(changed > 10'000);
}

TEST_CASE("Large boxes that rest among small ones, and then move among small ones that rest", "[box_grid]") {
  constexpr BoxGrid::Id few = 3, count = 60;
  constexpr std::size_t never_scanned = std::size_t{1} << 20;
  std::size_t changed = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (const std::size_t scanned_per_change : {std::size_t{1}, CellTuning{}.scanned_per_change, never_scanned}) {
      Random random(seed);
      CellTuning tuning;
      tuning.scanned_per_change = scanned_per_change;
      BoxGrid grid(tuning);
      std::vector<StaticBox> boxes(count);
      std::set<std::pair<BoxGrid::Id, BoxGrid::Id>> overlapping;
      BoxGrid::Changes changes;
      std::size_t wrong = 0;
      const auto take = [&](BoxGrid::Id id) {
        for (const auto other : changes.ended) wrong += overlapping.erase(std::minmax(id, other)) != 1;
        for (const auto other : changes.began) wrong += !overlapping.insert(std::minmax(id, other)).second;
        changed += changes.began.size() + changes.ended.size();
        changes.clear();
      };
      const bool announced = random.one_in(2);
      for (BoxGrid::Id id = 0; id < count; ++id) {
        boxes[id] = random_box(random, id < few ? 40 : 1, 30, 0);
        if (announced) {
          if (id == 0) grid.reserve(count);
          grid.announce(id, boxes[id]);
        } else {
          grid.put(id, boxes[id], changes);
          take(id);
        }
      }
      for (BoxGrid::Id id = 0; announced && id < count; ++id) {
        grid.enter(id, changes);
        take(id);
      }
      for (int step = 0; step < 2000; ++step) {
        // In turn for so long that levels begin and cease to have guests.
        const bool large = step / 500 % 2 == 1 && !random.one_in(20);
        const auto id = static_cast<BoxGrid::Id>(large ? random.below(few) : few + random.below(count - few));
        if (grid.contains(id) && random.one_in(40)) {
          grid.remove(id, changes);
        } else {
          boxes[id] = random_box(random, id < few ? 40 : 1, 30, 0);
          grid.put(id, boxes[id], changes);
        }
        take(id);
        for (BoxGrid::Id other = 0; other < count; ++other) {
          if (other == id) continue;
          const bool right = grid.contains(id) && grid.contains(other) && boxes[id].overlaps(boxes[other]);
          wrong += right != overlapping.contains(std::minmax(id, other));
        }
      }
      INFO("seed " << seed << ", " << scanned_per_change << " compared in the time of a change");
      CHECK(wrong == 0);
    }
  }
  CHECK(changed > 10'000);
}

}  // namespace
}  // namespace kds::collision::test_box_grid_levels
