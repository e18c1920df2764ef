// Kinetic Euclidean minimum spanning tree in the plane.
#pragma once

#include "certificates/plane_certificates.hpp"
#include "structures/delaunay.hpp"
#include "structures/ordered.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace kds::structures {

/// Keeps a shortest tree that joins all points of the plane; or of a plane that repeats itself, one copy of each, where
/// it is SpanningTreeRule<Path, PeriodicDelaunayRule<Path>>. It stands on a Delaunay triangulation, whose edges contain
/// it [Shamos75], and keeps these in order of their lengths: the tree depends on that order only [Kruskal56]. When two
/// edges change places in this order, and the one that becomes longer is in the tree, the other takes its place there
/// if it closes a cycle of the tree that contains it.
///
/// Cost, besides that of the triangulation: three certificates for an event (responsive), and O(n) steps where an edge
/// of the tree is passed by another edge, or where one comes or goes; 3 n certificates (compact); as many events as
/// pairs of edges change their order, of which few change the tree (not efficient). External events are changes of the
/// tree.
///
/// Of points that stay in one place the tree has one (DelaunayRule::vertex). While all points stay on one line nothing
/// is known (DelaunayRule::flat).
template <class Path, class Delaunay = DelaunayRule<Path>>
class SpanningTreeRule
    : public OrderedRule<SpanningTreeRule<Path, Delaunay>, Delaunay, typename Delaunay::LengthOrder> {
  using Base = OrderedRule<SpanningTreeRule<Path, Delaunay>, Delaunay, typename Delaunay::LengthOrder>;

 public:
  static constexpr const char* name = "SpanningTree";
  using Edge = TriangulationEdges::Number;

  /// Whether an edge of the triangulation is in the tree.
  bool contains(Edge edge) const { return edge < in_tree_.size() && in_tree_[edge]; }
  /// Its edges, each with the lower id first, the shortest edge first. O(n).
  std::vector<std::array<Id, 2>> edges() const {
    std::vector<std::array<Id, 2>> result;
    for (const Edge edge : this->order()) {
      if (contains(edge)) result.push_back(ids(edge));
    }
    return result;
  }

  // What OrderedRule asks for.
  Edge candidate(const EdgeChange& change) const { return change.edge; }
  bool takes_part(Edge edge) const { return this->inner().edges().contains(edge); }
  std::array<Id, 2> ids(Edge edge) const { return this->inner().edges().ends(edge); }
  typename Delaunay::LengthOrder in_order(Edge edge, Edge other, const MovingSet<Path>& x) const {
    return this->inner().length_order(edge, other, x);
  }
  Effect swapped(Edge longer, Edge shorter) {
    if (!contains(longer) || contains(shorter)) return Effect::internal;
    in_tree_[longer] = false;
    clear_parts();  // the two into which the tree falls
    for (const Edge edge : this->order()) {
      if (in_tree_[edge]) unite(edge);
    }
    const auto [a, b] = ids(shorter);
    in_tree_[root(a) == root(b) ? longer : shorter] = true;
    return in_tree_[longer] ? Effect::internal : Effect::external;
  }
  Effect renewed(std::span<const EdgeChange> /*changes*/) {
    const std::vector<std::uint8_t> before = std::exchange(in_tree_, {});
    in_tree_.resize(this->inner().edges().end(), false);
    clear_parts();
    for (const Edge edge : this->order()) in_tree_[edge] = unite(edge);
    return in_tree_ == before ? Effect::internal : Effect::external;
  }

  template <class Archive>
  void archive(Archive& archive) {
    Base::archive(archive);
    archive(in_tree_);
  }

 private:
  void clear_parts() {
    parent_.resize(this->inner().mesh().end_vertex());
    std::iota(parent_.begin(), parent_.end(), Id{0});
  }
  Id root(Id id) {
    while (parent_[id] != id) id = parent_[id] = parent_[parent_[id]];
    return id;
  }
  /// Whether the ends were in different parts.
  bool unite(Edge edge) {
    const auto [a, b] = ids(edge);
    const Id from = root(a), to = root(b);
    parent_[from] = to;
    return from != to;
  }

  std::vector<std::uint8_t> in_tree_;  ///< by edge
  std::vector<Id> parent_;             ///< of points, in parts of the tree
};

}  // namespace kds::structures
