// Kinetic Gabriel graph in the plane.
#pragma once

#include "certificates/empty_disc.hpp"
#include "kds/audit.hpp"
#include "structures/delaunay.hpp"
#include "structures/selection.hpp"
#include "structures/triangulation_subset.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kds::structures {

/// Keeps which two of moving points are Gabriel neighbours: the closed disc that has them as ends of a diameter
/// contains no other point. It stands on a Delaunay triangulation:
///
///     Kinetic<DelaunayRule<Path>> triangulation(points, now);
///     Kinetic<GabrielGraphRule<Path>> gabriel(triangulation, now);
///
/// or on a periodic one, GabrielGraphRule<Path, PeriodicDelaunayRule<Path>>, as the graph of all copies: a pair of ids
/// is in it for each copy of the second that is a neighbour, and a point may be a neighbour of its own copy.
///
/// Such pairs are edges of that, and of an edge only the third corners of the two triangles beside it have to be
/// compared with the disc [Matula80]; definition: [Gabriel69]. Points that stay on the border of a disc are in it: so
/// the graph is a function of the points also where the triangulation is not. It contains the spanning tree.
///
/// It reports its edges that come, go, and have an end that moves otherwise (EdgeChange), under the numbers of the
/// triangulation, so that other rules may stand on it.
///
/// Cost, besides that of the triangulation: an event of its own is one edge, at most 2 certificates, of degree 2 for
/// linear and 4 for quadratic paths; a flip concerns 6 edges (responsive: 12 marked). 2 certificates for an edge of the
/// graph and 1 for any other, in all fewer than 6 n (compact); a point is in at most two for each of its edges and of
/// those opposite (as local as the triangulation). Each event of its own is external, a change of the graph, since of
/// the two angles opposite an edge of a Delaunay triangulation at most one is obtuse (efficient).
///
/// Points that stay in one place count as one (DelaunayRule::vertex). While all points stay on one line nothing is
/// known (DelaunayRule::flat).
template <class Path, class Delaunay = DelaunayRule<Path>>
class GabrielGraphRule : public StandsOn<Telling<Delaunay, TriangleChange>> {
 public:
  static constexpr const char* name = "GabrielGraph";
  using Element = Path;
  using Change = EdgeChange;
  using Pen = RepairOf<GabrielGraphRule>;
  using Edge = TriangulationEdges::Number;
  using Outside = certificates::OutsideDisc<typename Delaunay::Place>;

  /// Whether an edge of the triangulation is in the graph.
  bool contains(Edge edge) const { return graph_.contains(edge); }
  /// The lower id first. Precondition: contains(edge).
  std::array<Id, 2> ends(Edge edge) const { return graph_.ids(edge); }
  /// Numbers of edges are below this.
  Edge end_edge() const { return graph_.end(); }
  /// Each with the lower id first, in ascending order. O(n log n).
  std::vector<std::array<Id, 2>> edges() const { return graph_.all(); }

  // Slot: twice the number of an edge, and which of the two triangles beside it.
  std::optional<Outside> certificate(Slot slot, const MovingSet<Path>& x) const {
    const int sign = selection_.certified(slot / 2, slot % 2);
    if (sign == 0) return std::nullopt;
    return condition(slot, x, sign);
  }
  std::array<Id, 3> members(Slot slot) const {
    const auto [a, b, c] = corners(slot);
    return {id_of(a), id_of(b), id_of(c)};
  }

  Effect repair(Slot slot, Pen& repair) {
    const Edge edge = slot / 2;
    selection_.turn(edge, slot % 2, meets(edge, repair));
    return take_up(edge, repair) ? Effect::external : Effect::internal;
  }
  Effect follow(std::span<const TriangleChange> changes, Pen& repair) {
    bool other = false;
    for (const Edge edge : sides_.take_up(changes, this->inner().mesh(), edge_of())) {
      if (this->inner().edges().contains(edge)) {
        selection_.look(edge, meets(edge, repair));
      } else {
        selection_.let_go(edge);
      }
      other = take_up(edge, repair) || other;
    }
    return other ? Effect::external : Effect::internal;
  }
  /// Nothing is left to do: the changes of its triangles have been followed already.
  void change(Id id, Pen& repair) {
    if (!this->inner().mesh().contains(id)) return;
    this->inner().mesh().for_each_from(id, [&](TriangleMesh::Edge h) {
      const Edge edge = this->inner().edges().of(h);
      if (contains(edge)) repair.report({EdgeChange::What::moved, edge, ends(edge)});
    });
  }
  std::vector<EdgeChange> changes_from_nothing() const {
    std::vector<EdgeChange> changes;
    for (Edge edge = 0; edge < end_edge(); ++edge) {
      if (contains(edge)) changes.push_back({EdgeChange::What::came, edge, ends(edge)});
    }
    return changes;
  }

  void audit(const MovingSet<Path>& /*elements*/, double /*now*/) const {
    const auto& edges = this->inner().edges();
    sides_.audit(this->inner().mesh(), edge_of());
    for (Edge edge = 0; edge < std::max(edges.end(), end_edge()); ++edge) {
      if (selection_.knows(edge) != edges.contains(edge) || selection_.contains(edge) != contains(edge) ||
          (contains(edge) && !graph_.contains(edge, ends_in(edge)))) {
        throw AuditFailure(name + (": edge " + std::to_string(edge)) + ": is not as in the triangulation");
      }
    }
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(selection_, graph_, sides_);
  }

 private:
  using Corner = typename Delaunay::Corner;

  auto edge_of() const {
    return [this](TriangleMesh::Edge h) { return this->inner().edges().of(h); };
  }
  /// The ends of an edge, and the third corner of the triangle beside it.
  std::array<Corner, 3> corners(Slot slot) const {
    const TriangleMesh::Edge h = this->inner().edges().half_edge(slot / 2);
    return this->inner().corners(slot % 2 == 0 ? h : this->inner().mesh().twin(h));
  }
  std::array<Corner, 2> ends_in(Edge edge) const {
    const auto [a, b, beside] = corners(2 * edge);
    return in_ascending_order(std::array{a, b});
  }
  /// None on the outer side of an edge of the hull.
  std::optional<Outside> condition(Slot slot, const MovingSet<Path>& x, int sign) const {
    const auto [a, b, c] = corners(slot);
    const Delaunay& delaunay = this->inner();
    if (delaunay.at_infinity(c)) return std::nullopt;
    return Outside{delaunay.place(a, x), delaunay.place(b, x), delaunay.place(c, x), static_cast<double>(sign)};
  }
  auto meets(Edge edge, const Pen& repair) const {
    return [this, edge, &repair](std::size_t side) {
      const auto outside = condition(2 * edge + static_cast<Slot>(side), repair.elements(), 1);
      return !outside || repair.sign(*outside) > 0;
    };
  }
  /// Looks at an edge again. Returns whether the graph has changed.
  bool take_up(Edge edge, Pen& repair) {
    repair.certify(2 * edge);
    repair.certify(2 * edge + 1);
    const auto report = [&](EdgeChange::What what, Edge number, const std::array<Id, 2>& ends) {
      repair.report({what, number, ends});
    };
    if (selection_.contains(edge)) return graph_.put(edge, ends_in(edge), report);
    return graph_.take_out(edge, report);
  }

  Selection<2> selection_;
  TriangulationSubset<2, Corner> graph_;
  PartsOfTriangles sides_;
};

}  // namespace kds::structures
