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
  using Change = EdgeChange;
  using Pen = Repair<Path, Change>;

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
    if (in_tree_[longer]) return Effect::internal;
    exchanged_ = {longer, shorter};
    return Effect::external;
  }
  Effect renewed() {
    const std::vector<std::uint8_t> before = std::exchange(in_tree_, {});
    in_tree_.resize(this->inner().edges().end(), false);
    clear_parts();
    for (const Edge edge : this->order()) in_tree_[edge] = unite(edge);
    return in_tree_ == before ? Effect::internal : Effect::external;
  }

  // It reports which edges come into the tree, leave it, and have an end that moves otherwise.
  Effect repair(Slot slot, Pen& repair) {
    const Effect effect = Base::repair(slot, repair);
    if (effect == Effect::external) {
      for (const Edge edge : exchanged_) tell(edge, repair);
    }
    return effect;
  }
  Effect follow(std::span<const EdgeChange> changes, Pen& repair) {
    for (const EdgeChange& change : changes) {
      if (change.what == EdgeChange::What::moved) moved_.push_back(change.edge);
    }
    return Base::follow(changes, repair);
  }
  Effect followed(Pen& repair) {
    const Effect effect = Base::followed(repair);
    told_.resize(std::max<std::size_t>(told_.size(), in_tree_.size()), nothing);
    for (Edge edge = 0; edge < told_.size(); ++edge) tell(edge, repair);
    for (const Edge edge : moved_) {
      if (contains(edge)) repair.report({EdgeChange::What::moved, edge, told_[edge]});
    }
    moved_.clear();
    return effect;
  }
  std::vector<EdgeChange> changes_from_nothing() const {
    std::vector<EdgeChange> changes;
    for (Edge edge = 0; edge < told_.size(); ++edge) {
      if (contains(edge)) changes.push_back({EdgeChange::What::came, edge, told_[edge]});
    }
    return changes;
  }

  template <class Archive>
  void archive(Archive& archive) {
    Base::archive(archive);
    archive(in_tree_, told_);
  }

 private:
  using Ends = std::array<Id, 2>;
  static constexpr Ends nothing{nobody, nobody};

  /// A number may be that of another edge than before.
  void tell(Edge edge, Pen& repair) {
    const Ends before = std::exchange(told_[edge], contains(edge) ? ids(edge) : nothing);
    if (before == told_[edge]) return;
    if (before != nothing) repair.report({EdgeChange::What::went, edge, before});
    if (told_[edge] != nothing) repair.report({EdgeChange::What::came, edge, told_[edge]});
  }
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
  std::vector<Ends> told_;             ///< by edge: the ends, as it has reported them; nothing if it is not in the tree
  std::array<Edge, 2> exchanged_{};    ///< in the event that is processed: the one that went and the one that came
  std::vector<Edge> moved_;            ///< in the edit that is followed: edges that have an end with a new motion
  std::vector<Id> parent_;             ///< of points, in parts of the tree
};

}  // namespace kds::structures
