// Pairs of nodes of the trees of two bodies that turn: how they are opened, and taken four at a time.
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

/// Up to four of a list, and the nodes to look at; where there are less the last one more than once.
template <class Item>
struct FourOf {
  std::array<Item, 4> items;
  FourNodes a, b;
  std::size_t count;
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

  /// Calls take(pair) for up to four pairs that are all there is, below the roots: to look at four costs as much as to
  /// look at one.
  template <class Take>
  void first_four(const Take& take) const {
    const auto take_halves = [&](NodePair halves) { are_leaves(halves) ? take(halves) : open(halves, take); };
    are_leaves({0, 0}) ? take(NodePair{0, 0}) : open({0, 0}, take_halves);
  }

  /// Takes them from the end of a list that is not empty. nodes_of(item): its pair of nodes.
  template <class Item, class NodesOf>
  FourOf<Item> take_four(std::vector<Item>& list, const NodesOf& nodes_of) const {
    FourOf<Item> four{{}, {}, {}, std::min<std::size_t>(4, list.size())};
    for (std::size_t i = 0; i < 4; ++i) {
      four.items[i] = list[list.size() - std::min(i + 1, four.count)];
      const NodePair& nodes = std::invoke(nodes_of, four.items[i]);
      four.a[i] = &a_.node(nodes.a), four.b[i] = &b_.node(nodes.b);
    }
    list.resize(list.size() - four.count);
    return four;
  }

 private:
  const MeshOfPair& a_;
  const Side& b_;
};

}  // namespace kds::collision
