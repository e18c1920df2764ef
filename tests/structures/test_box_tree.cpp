// The tree under the kinetic AABB tree: against brute force, and its depth.
#include "kds/framework/snapshot.hpp"
#include "kds/roots/failure_time.hpp"
#include "structures/box_tree.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

namespace test_box_tree {
namespace {

using namespace kds;
using namespace kds::tests;
using structures::BoxTree;
using structures::TreeBox;

TreeBox<3> random_box(Random& random, bool coarse) {
  TreeBox<3> box;
  for (std::size_t d = 0; d < 3; ++d) {
    box.min[d] = coarse ? random.integer(0, 3) : random.between(0, 10);
    box.max[d] = box.min[d] + (coarse ? random.integer(0, 1) : random.unit());
  }
  return box;
}

}  // namespace

TEST_CASE("a box tree finds what brute force finds", "[box_tree]") {
  for (const bool coarse : {false, true}) {
    const std::uint64_t seed = 970;
    CAPTURE(seed, coarse);
    Random random(seed);
    BoxTree<TreeBox<3>> tree;
    std::map<Id, TreeBox<3>> boxes;
    int wrong = 0;
    for (int step = 0; step < 2000; ++step) {
      const Id id = static_cast<Id>(random.below(200));
      const TreeBox<3> box = random_box(random, coarse);
      if (!boxes.contains(id)) {
        tree.insert(id, box);
        boxes[id] = box;
      } else if (random.one_in(3)) {
        tree.remove(id);
        boxes.erase(id);
      } else {
        TreeBox<3> next = box;
        if (random.one_in(2)) next = boxes[id], next.max[0] += 0.125;  // a little move
        tree.change(id, next);
        boxes[id] = next;
      }
      if (step % 50 == 0) tree.audit("tree");
      const TreeBox<3> asked = random_box(random, coarse);
      std::vector<Id> found, expected;
      tree.visit(asked, [&](Id other) { found.push_back(other); });
      std::sort(found.begin(), found.end());
      for (const auto& [other, other_box] : boxes) {
        if (other_box.overlaps(asked)) expected.push_back(other);
      }
      wrong += found != expected || tree.size() != boxes.size() || tree.contains(id) != boxes.contains(id);
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("surfaces spare visits: a tree of many small boxes is a small multiple of the best", "[box_tree]") {
  const std::uint64_t seed = 971;
  CAPTURE(seed);
  Random random(seed);
  BoxTree<TreeBox<2>> tree;
  const Id n = 1024;  // of a grid of 32 by 32, in random order
  std::vector<Id> order(n);
  for (Id id = 0; id < n; ++id) order[id] = id;
  for (Id id = n - 1; id > 0; --id) std::swap(order[id], order[random.below(id + std::size_t{1})]);
  for (const Id id : order) {
    const double x = id % 32, y = id / 32;
    tree.insert(id, {{x, y}, {x + 0.5, y + 0.5}});
  }
  // Halving in turn gives levels of 2^i boxes whose sides are 2^(-i / 2) of the whole: sum of 2^(i / 2) to i = 9.
  double halving = 0;
  for (int i = 0; i < 10; ++i) halving += std::pow(2, i / 2.0);
  CHECK(tree.relative_surface() > 0.5 * halving);
  CHECK(tree.relative_surface() < 1.5 * halving);
}

TEST_CASE("a box tree stays shallow where boxes are one, sorted or nested", "[box_tree][degeneracy]") {
  const Id n = 1000;
  const auto grow = [&](auto&& box_of) {
    BoxTree<TreeBox<2>> tree;
    for (Id id = 0; id < n; ++id) tree.insert(id, box_of(static_cast<double>(id)));
    tree.audit("tree");
    std::size_t found = 0;
    tree.visit(box_of(500), [&](Id) { ++found; });
    CHECK(found >= 1);
    const std::size_t depth = tree.depth();
    for (Id id = 0; id < n; id += 2) tree.remove(id);
    tree.audit("tree");
    for (Id id = 0; id < n; id += 2) tree.insert(id, box_of(static_cast<double>(id)));
    for (Id id = 1; id < n; id += 2) tree.change(id, box_of(static_cast<double>(n - id)));
    tree.audit("tree");
    return std::max(depth, tree.depth());
  };
  CHECK(grow([](double) { return TreeBox<2>{{1, 2}, {1, 2}}; }) < 20);
  CHECK(grow([](double) { return TreeBox<2>{{0, 0}, {never, never}}; }) < 20);
  CHECK(grow([](double i) { return TreeBox<2>{{i, 0}, {i + 0.5, 1}}; }) < 40);
  CHECK(grow([](double i) { return TreeBox<2>{{-i, -i}, {i, i}}; }) < n);  // no tree of these is good
}

TEST_CASE("a box of the tree may be given to its changes", "[box_tree]") {
  BoxTree<TreeBox<3>> tree;
  const TreeBox<3> box{{1, 2, 3}, {4, 5, 6}};
  tree.insert(0, box);
  for (Id id = 1; id < 300; ++id) tree.insert(id, tree.box(id - 1));
  tree.insert(300, {{10, 10, 10}, {11, 11, 11}});
  tree.change(1, tree.box(300));
  tree.change(1, tree.box(299));
  for (Id id = 0; id < 300; ++id) CHECK(tree.box(id) == box);
  tree.audit("BoxTree");
}

TEST_CASE("equal box trees are saved as equal bytes", "[box_tree][snapshot]") {
  const auto grown = [] {
    BoxTree<TreeBox<2>> tree;
    for (Id id = 0; id < 5; ++id) tree.insert(id, {{1.0 * id, 0}, {1.0 * id + 1, 1}});
    return tree;
  };
  BoxTree<TreeBox<2>> tree = grown(), other = grown();
  CHECK(save(tree) == save(other));
  // Nine nodes of 4 doubles and 5 numbers, five leaves, the root; and how long these lists and that of the free are.
  CHECK(save(tree).bytes().size() == 9 * (4 * 8 + 5 * 4) + 5 * 4 + 4 + 3 * (8 + 4));
}

}  // namespace test_box_tree
