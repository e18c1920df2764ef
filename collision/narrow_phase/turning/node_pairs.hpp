// Pairs of nodes of the trees of two bodies that turn: how they are opened, and taken eight at a time.
#pragma once

#include "collision/narrow_phase/turning/turning_mesh_sides.hpp"
#include "collision/narrow_phase/turning/turning_nodes.hpp"

#include <algorithm>
#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace kds::collision {

/// A node of each body, by its number.
struct NodePair {
  std::uint32_t a, b;
  friend auto operator<=>(const NodePair&, const NodePair&) = default;
};

/// Some of a list, and the nodes to look at.
template <class Item>
struct ItemsTogether {
  std::array<Item, std::size_t{most_together}> items;
  NodesTogether nodes;
};

/// The pairs of nodes of a mesh (a) and a MeshOfPair, BoxOfPair, BallOfPair or CapsuleOfPair (b). Refers to both.
template <class Side>
class NodePairs {
 public:
  NodePairs(const MeshOfPair& a, const Side& b) : a_(a), b_(b) {}

  bool are_leaves(NodePair nodes) const { return a_.is_leaf(nodes.a) && b_.is_leaf(nodes.b); }

  /// Calls take(pair) for the halves of the larger node. Precondition: they are no leaves.
  template <class Take>
  void open(NodePair nodes, const Take& take) const {
    if (b_.is_leaf(nodes.b) || (!a_.is_leaf(nodes.a) && a_.radius(nodes.a) >= b_.radius(nodes.b))) {
      const std::uint32_t child = a_.first_child(nodes.a);
      take(NodePair{child + 1, nodes.b}), take(NodePair{child, nodes.b});
    } else {
      const std::uint32_t child = b_.first_child(nodes.b);
      take(NodePair{nodes.a, child + 1}), take(NodePair{nodes.a, child});
    }
  }

  /// Calls take(pair) for up to eight pairs that are all there is, below the roots: to look at eight costs as much as
  /// to look at one.
  template <class Take>
  void first(const Take& take, int levels = 3) const {
    first({0, 0}, levels, take);
  }

  /// Takes them from the end of a list that is not empty. nodes_of(item): its pair of nodes.
  template <class Item, class NodesOf>
  ItemsTogether<Item> take_together(std::vector<Item>& list, const NodesOf& nodes_of) const {
    ItemsTogether<Item> together;
    const std::size_t count = std::min(list.size(), together.items.size());
    together.nodes.count = static_cast<int>(count);
    for (std::size_t i = 0; i < together.items.size(); ++i) {
      const Item& item = list[list.size() - std::min(i + 1, count)];
      if (i < count) together.items[i] = item;
      const NodePair& nodes = std::invoke(nodes_of, item);
      together.nodes.a[i] = numbers_of(a_.node(nodes.a)), together.nodes.b[i] = numbers_of(b_.node(nodes.b));
    }
    list.resize(list.size() - count);
    return together;
  }

 private:
  template <class Take>
  void first(NodePair nodes, int levels, const Take& take) const {
    if (levels == 0 || are_leaves(nodes)) return take(nodes);
    open(nodes, [&](NodePair halves) { first(halves, levels - 1, take); });
  }

  const MeshOfPair& a_;
  const Side& b_;
};

}  // namespace kds::collision
