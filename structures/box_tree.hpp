// A bounding-volume tree of boxes that are inserted, removed and changed: which boxes overlap with this one?
#pragma once

#include "kds/audit.hpp"
#include "kds/framework/free_numbers.hpp"
#include "kds/framework/moving_set.hpp"
#include "structures/tree_box.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace kds::structures {

/// A binary tree with a box in each leaf, known by the caller's id; the box of an inner node is the hull of its two
/// children's. It knows nothing of time.
///
/// A Box is a TreeBox, or another class with hull(a, b), which overlaps with all that a or b overlaps with, overlaps(),
/// contains(), surface() and ==.
///
/// A box is inserted where it adds least to the surfaces of the nodes [Goldsmith87], going down from the root; on the
/// way back, a node and its nephew change places where that makes a box smaller [Kensler08]. Where surfaces do not
/// decide (equal boxes, or infinite ones) it goes to the side with fewer leaves. A box that changes but stays within
/// its parent's is changed where it is; any other is inserted anew.
///
/// Cost: insertion, removal and change O(depth), which is O(log n) except for nested boxes and the like; visit()
/// O(depth + boxes found), in scenes where boxes overlap with few others; 2 n - 1 nodes.
template <class Box>
class BoxTree {
 public:
  std::size_t size() const { return root_ == none ? 0 : nodes_[root_].leaves; }
  bool contains(Id id) const { return id < leaf_.size() && leaf_[id] != none; }
  /// Precondition: contains(id).
  const Box& box(Id id) const { return nodes_[leaf_[id]].box; }

  /// Precondition: !contains(id).
  void insert(Id id, Box box);
  /// Precondition: contains(id).
  void remove(Id id);
  /// Gives it another box. Precondition: contains(id).
  void change(Id id, Box box);

  /// Calls found(id) for all boxes that overlap with this one, or with whatever else a Box can be compared with, in no
  /// particular order. The tree must not be changed from within the call.
  template <class Other, class Found>
  void visit(const Other& box, Found&& found) const;

  /// The number of steps from the root to the deepest leaf: 0 for one box or none. O(n depth).
  std::size_t depth() const;
  /// Sum of the surfaces of inner nodes, that of the root being 1: a measure of the cost of a visit. 0 for fewer than
  /// two boxes; a NaN where the root's surface is zero or infinite. O(n).
  double relative_surface() const;

  /// Throws AuditFailure unless every node is the hull of its two, and is where it is said to be.
  void audit(const std::string& name) const;

  template <class Archive>
  void archive(Archive& archive) {
    archive(nodes_, free_, leaf_, root_);
  }

 private:
  using Place = std::uint32_t;
  static constexpr Place none = std::numeric_limits<Place>::max();

  struct Node {
    Box box;
    Place parent = none;
    std::array<Place, 2> child{none, none};  ///< both or neither
    std::uint32_t leaves = 1;                ///< below it, and itself
    Id id = nobody;                          ///< of a leaf

    bool is_leaf() const { return child[0] == none; }
    template <class Archive>
    void archive(Archive& archive) {
      archive(box, parent, child, leaves, id);
    }
  };

  Place take_node();
  Place best_sibling(const Box& box) const;
  /// Puts `other` in the place of `place` below its parent, or at the top.
  void replace(Place place, Place other);
  void update(Place place);
  void rotate(Place place);
  /// Updates boxes from here up to the root.
  void refit(Place place);

  std::vector<Node> nodes_;
  FreeNumbers free_;
  std::vector<Place> leaf_;  ///< by id
  Place root_ = none;
};

// ---------------------------------------------------------------------------------------------------------------

template <class Box>
void BoxTree<Box>::insert(Id id, Box box) {
  if (id >= leaf_.size()) leaf_.resize(id + std::size_t{1}, none);
  const Place leaf = take_node();
  nodes_[leaf].box = box;
  nodes_[leaf].id = id;
  leaf_[id] = leaf;
  if (root_ == none) return void(root_ = leaf);
  const Place sibling = best_sibling(box);
  const Place parent = take_node();
  replace(sibling, parent);
  nodes_[parent].child = {sibling, leaf};
  nodes_[sibling].parent = nodes_[leaf].parent = parent;
  refit(parent);
}

template <class Box>
void BoxTree<Box>::remove(Id id) {
  const Place leaf = leaf_[id];
  leaf_[id] = none;
  free_.give_back(leaf);
  if (leaf == root_) return void(root_ = none);
  const Place parent = nodes_[leaf].parent;
  const Place sibling = nodes_[parent].child[nodes_[parent].child[0] == leaf];
  replace(parent, sibling);
  free_.give_back(parent);
  refit(nodes_[sibling].parent);
}

template <class Box>
void BoxTree<Box>::change(Id id, Box box) {
  const Place parent = nodes_[leaf_[id]].parent;
  if (parent != none && !nodes_[parent].box.contains(box)) {
    remove(id);
    return insert(id, box);
  }
  nodes_[leaf_[id]].box = box;
  refit(parent);
}

template <class Box>
template <class Other, class Found>
void BoxTree<Box>::visit(const Other& box, Found&& found) const {
  if (root_ == none || !nodes_[root_].box.overlaps(box)) return;
  std::vector<Place> open{root_};
  while (!open.empty()) {
    const Node& node = nodes_[open.back()];
    open.pop_back();
    if (node.is_leaf()) {
      found(node.id);
      continue;
    }
    for (const Place child : node.child) {
      if (nodes_[child].box.overlaps(box)) open.push_back(child);
    }
  }
}

template <class Box>
typename BoxTree<Box>::Place BoxTree<Box>::take_node() {
  const Place place = free_.take(nodes_.size());
  if (place == nodes_.size()) nodes_.emplace_back();
  nodes_[place] = Node{};
  return place;
}

/// The node with which a new box is to share a parent. Stopping at a node adds a node with the surface of the hull;
/// going on enlarges this node by what the box adds to it, and costs at least what the box adds to the child.
template <class Box>
typename BoxTree<Box>::Place BoxTree<Box>::best_sibling(const Box& box) const {
  Place place = root_;
  while (!nodes_[place].is_leaf()) {
    const Node& node = nodes_[place];
    const double whole = hull(node.box, box).surface();
    const double grown = whole - node.box.surface();
    std::array<double, 2> cost;
    for (std::size_t i = 0; i < 2; ++i) {
      const Node& child = nodes_[node.child[i]];
      cost[i] = grown + hull(child.box, box).surface() - (child.is_leaf() ? 0 : child.box.surface());
    }
    if (whole < cost[0] && whole < cost[1]) break;
    const auto leaves = [&](std::size_t i) { return nodes_[node.child[i]].leaves; };
    const bool second = cost[1] < cost[0] || (!(cost[0] < cost[1]) && leaves(1) < leaves(0));
    place = node.child[second];
  }
  return place;
}

template <class Box>
void BoxTree<Box>::replace(Place place, Place other) {
  const Place parent = nodes_[place].parent;
  nodes_[other].parent = parent;
  if (parent == none) {
    root_ = other;
  } else {
    nodes_[parent].child[nodes_[parent].child[1] == place] = other;
  }
}

template <class Box>
void BoxTree<Box>::update(Place place) {
  Node& node = nodes_[place];
  const Node& left = nodes_[node.child[0]];
  const Node& right = nodes_[node.child[1]];
  node.box = hull(left.box, right.box);
  node.leaves = left.leaves + right.leaves;
}

/// [Kensler08]: of the four exchanges of a child with a child of its sibling, makes the one that saves the most
/// surface, if one saves any.
template <class Box>
void BoxTree<Box>::rotate(Place place) {
  double most = 0;
  std::size_t side = 0, which = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const Node& child = nodes_[nodes_[place].child[i]];
    const Node& other = nodes_[nodes_[place].child[1 - i]];
    if (other.is_leaf()) continue;
    for (std::size_t j = 0; j < 2; ++j) {
      const double saved = other.box.surface() - hull(child.box, nodes_[other.child[1 - j]].box).surface();
      if (saved > most) most = saved, side = i, which = j;
    }
  }
  if (!(most > 0)) return;
  const Place child = nodes_[place].child[side];
  const Place other = nodes_[place].child[1 - side];
  const Place nephew = nodes_[other].child[which];
  nodes_[place].child[side] = nephew;
  nodes_[nephew].parent = place;
  nodes_[other].child[which] = child;
  nodes_[child].parent = other;
  update(other);
}

template <class Box>
void BoxTree<Box>::refit(Place place) {
  for (; place != none; place = nodes_[place].parent) {
    const Box box = nodes_[place].box;
    const std::uint32_t leaves = nodes_[place].leaves;
    update(place);
    rotate(place);
    if (box == nodes_[place].box && leaves == nodes_[place].leaves) return;
  }
}

template <class Box>
std::size_t BoxTree<Box>::depth() const {
  std::size_t most = 0;
  for (const Place leaf : leaf_) {
    std::size_t steps = 0;
    for (Place at = leaf; at != none && at != root_; at = nodes_[at].parent) ++steps;
    most = std::max(most, steps);
  }
  return most;
}

template <class Box>
double BoxTree<Box>::relative_surface() const {
  if (size() < 2) return 0;
  double sum = 0;
  std::vector<Place> open{root_};
  while (!open.empty()) {
    const Node& node = nodes_[open.back()];
    open.pop_back();
    if (node.is_leaf()) continue;
    sum += node.box.surface();
    open.insert(open.end(), node.child.begin(), node.child.end());
  }
  return sum / nodes_[root_].box.surface();
}

template <class Box>
void BoxTree<Box>::audit(const std::string& name) const {
  const auto fail = [&](Place place, const char* what) {
    throw AuditFailure(name + ": node " + std::to_string(place) + ": " + what);
  };
  std::size_t met = 0;
  std::vector<Place> open;
  if (root_ != none) open.push_back(root_);
  if (root_ != none && nodes_[root_].parent != none) fail(root_, "the root has a parent");
  while (!open.empty()) {
    const Place place = open.back();
    const Node& node = nodes_[place];
    open.pop_back();
    if (++met > nodes_.size()) fail(place, "is met twice");
    if (node.is_leaf()) {
      if (node.leaves != 1 || !contains(node.id) || leaf_[node.id] != place) fail(place, "a leaf is misplaced");
      continue;
    }
    for (const Place child : node.child) {
      if (nodes_[child].parent != place) fail(child, "its parent is another");
      open.push_back(child);
    }
    const Node& left = nodes_[node.child[0]];
    const Node& right = nodes_[node.child[1]];
    if (node.box != hull(left.box, right.box)) fail(place, "is not the hull of its two");
    if (node.leaves != left.leaves + right.leaves) fail(place, "has not so many leaves");
  }
  if (met + free_.size() != nodes_.size()) fail(root_, "nodes are lost");
  const auto absent = static_cast<std::size_t>(std::count(leaf_.begin(), leaf_.end(), none));
  if (leaf_.size() - absent != size()) fail(root_, "boxes are lost");
}

}  // namespace kds::structures
