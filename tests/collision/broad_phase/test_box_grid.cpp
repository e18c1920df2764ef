// The hierarchical hash grid against brute force.
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

namespace kds::collision::test_box_grid {
namespace {

using namespace tests;

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
  CHECK(changes.began == BoxGrid::Ids{0});
  changes.clear();
  grid.put(2, far, changes);
  CHECK(changes.began == BoxGrid::Ids{1});
  changes.clear();
  grid.put(3, point, changes);
  std::sort(changes.began.begin(), changes.began.end());
  CHECK(changes.began == BoxGrid::Ids{0, 1});
  changes.clear();
  grid.remove(1, changes);
  std::sort(changes.ended.begin(), changes.ended.end());
  CHECK(changes.ended == BoxGrid::Ids{0, 2, 3});
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

TEST_CASE("Boxes that enter together are found by those that come and move", "[box_grid]") {
  std::size_t seen = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Random random(seed);
    std::size_t wrong = 0;
    const auto count = static_cast<BoxGrid::Id>(1 + random.below(60));
    const auto random_box = [&] {
      StaticBox box;
      for (int d = 0; d < 3; ++d) {
        box.min[d] = random.between(-5, 5);
        box.max[d] = box.min[d] + std::exp(random.between(-2, 2));
      }
      return box;
    };
    BoxGrid together, entered;
    together.reserve(count);
    entered.reserve(count);
    std::vector<BoxGrid::Id> ids;
    BoxGrid::Changes changes, expected;
    for (BoxGrid::Id id = 0; id < count; ++id) {
      const StaticBox box = random_box();
      ids.push_back(id);
      together.announce(id, box);
      entered.put(id, box, expected);
    }
    together.enter_all(ids);
    for (int step = 0; step < 100; ++step) {
      changes.clear(), expected.clear();
      const auto id = static_cast<BoxGrid::Id>(random.below(count + 1));
      const StaticBox box = random_box();
      together.put(id, box, changes);
      entered.put(id, box, expected);
      for (auto* list : {&changes.began, &changes.ended, &expected.began, &expected.ended}) {
        std::sort(list->begin(), list->end());
      }
      wrong += changes.began != expected.began || changes.ended != expected.ended;
      seen += expected.began.size() + expected.ended.size();
    }
    INFO("seed " << seed);
    CHECK(wrong == 0);
  }
  CHECK(seen > 300);
}

}  // namespace
}  // namespace kds::collision::test_box_grid
