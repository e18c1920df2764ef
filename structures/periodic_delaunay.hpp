// Kinetic Delaunay triangulation of a plane that repeats itself.
#pragma once

#include "kds/audit.hpp"
#include "kds/framework/kinetic.hpp"
#include "kds/number_text.hpp"
#include "structures/periodic_lawson.hpp"
#include "structures/periodic_mesh.hpp"
#include "structures/periodic_predicates.hpp"
#include "structures/triangulation_edges.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

namespace kds::structures {

/// The Delaunay triangulation of moving points and of all their copies, displaced by whole periods along x and y: of
/// points on a flat torus, or in a rectangle whose opposite sides are one. Points may be anywhere, and move out of the
/// rectangle: of a point only the differences to others count, and these modulo the periods.
///
///     using Rule = PeriodicDelaunayRule<Path>;
///     Kinetic<Rule> triangulation(points, now, Rule({2, 1}));                         // 2 long, 1 high
///     triangulation.rule().mesh().corners(3 * t)                                      // of triangle t, with offsets
///
/// Any number of points will do, one too: then edges join a point to its own copies, or two points more than once (see
/// PeriodicMesh). There is no hull, and nothing is known only if there are no points.
///
/// The proof. Each triangle has positive area (Orientation). There are two for each vertex, so their angles add up to
/// one full turn a vertex; as around each vertex they add up to one or more, the triangles go round once everywhere.
/// How often they cover the plane is a matter of offsets (PeriodicMesh::audit), which no flip changes. Each edge is
/// locally Delaunay (InCircle of four copies), so all are [Lawson77], [Bobenko07]. All signs are exact: a period is a
/// double, and a displacement, its product with a whole number, is not rounded (PathCopy).
///
/// Repair: an edge whose certificate fails is flipped. Where flips cannot repair it (points that pass through each
/// other within one spacing of the clock) the triangulation is built anew at that instant; rebuilds() counts this.
/// Points that stay in one place together, up to periods, share a vertex. If four or more points stay on one circle, it
/// is one of the triangulations that have this property.
///
/// Cost: as DelaunayRule, with exactly 3 n edges and 2 n areas. A vertex that is joined to a copy of itself, which
/// happens only where an empty circle is as wide as a period, is removed by building anew, O(n) insertions.
///
/// Errors: std::invalid_argument for periods that are not > 0 and at most 2^900. Two neighbours may be at most 2^52
/// periods apart: std::range_error beyond, after which the structure cannot be used.
template <class Path>
class PeriodicDelaunayRule {
 public:
  using Element = Path;
  using Edge = PeriodicMesh::Edge;
  using Copy = certificates::PathCopy<Path>;
  static constexpr const char* name = "PeriodicDelaunay";

  /// Both periods are 1.
  PeriodicDelaunayRule() : PeriodicDelaunayRule(Periods{1, 1}) {}
  /// Periods along x and y, in units of length.
  explicit PeriodicDelaunayRule(const Periods& periods) : periods_(periods) {
    for (const double period : periods) {
      if (period > 0 && period <= certificates::longest_period) continue;
      throw std::invalid_argument("PeriodicDelaunay: a period must be > 0 and at most 2^900, not " +
                                  number_text(period));
    }
  }

  const Periods& periods() const { return periods_; }
  const PeriodicMesh& mesh() const { return mesh_; }
  /// Whether there are no points.
  bool flat() const { return mesh_.empty(); }
  /// The vertex that represents a point: itself, or one that stays in the same place up to periods.
  Id vertex(Id id) const { return hidden(id) ? same_as_[id].id : id; }
  /// Whether some points share a vertex.
  bool has_shared_vertices() const { return hidden_ > 0; }
  /// How often it has been built anew.
  std::uint64_t rebuilds() const { return rebuilds_; }

  /// As PlaneTriangulationRule: a corner is a copy of a vertex.
  using Corner = VertexCopy;
  std::array<Corner, 3> corners(Edge h) const { return mesh_.corners(h); }
  static bool at_infinity(const Corner& /*corner*/) { return false; }
  using Place = Copy;
  Place place(const Corner& corner, const MovingSet<Path>& x) const { return {x[corner.id], periods_, corner.offset}; }

  /// The edges under their numbers, as TriangulationEdges gives those of a plane.
  struct Edges {
    const PeriodicMesh& mesh;

    PeriodicMesh::Number end() const { return mesh.end_edge(); }
    bool contains(PeriodicMesh::Number edge) const { return mesh.contains_edge(edge); }
    /// The lower id first; twice the same where an edge joins a point to its own copy.
    std::array<Id, 2> ends(PeriodicMesh::Number edge) const {
      const Edge h = mesh.half_edge(edge);
      return {std::min(mesh.origin(h), mesh.target(h)), std::max(mesh.origin(h), mesh.target(h))};
    }
    PeriodicMesh::Number of(Edge h) const { return mesh.edge(h); }
    Edge half_edge(PeriodicMesh::Number edge) const { return mesh.half_edge(edge); }
  };
  Edges edges() const { return {mesh_}; }
  /// Certificate that an edge is not longer than another.
  using LengthOrder = certificates::DistanceOrder<Copy>;
  LengthOrder length_order(PeriodicMesh::Number edge, PeriodicMesh::Number other, const MovingSet<Path>& x) const {
    const PeriodicPredicates<Path> is{x, periods_};
    const auto [a, b, beside] = mesh_.corners(mesh_.half_edge(edge));
    const auto [c, d, beside_other] = mesh_.corners(mesh_.half_edge(other));
    return {is.at(a), is.at(b), is.at(c), is.at(d)};
  }

  using Choice = std::variant<std::monostate, certificates::Orientation<Copy>, certificates::InCircle<Copy>>;
  using Change = Changes<EdgeChange, TriangleChange>;
  using Pen = Repair<Path, Change>;

  // Slots 5 i, 5 i + 1, 5 i + 2: edges 3 i, 3 i + 1, 3 i + 2; then the areas of triangles 2 i, 2 i + 1.
  Choice certificate(Slot slot, const MovingSet<Path>& x) const;
  std::vector<Id> members(Slot slot) const;
  Effect repair(Slot slot, Pen& repair);
  void insert(Id id, Pen& repair);
  void remove(Id id, Pen& repair);
  bool keeps(Id id, const Path& next, Pen& repair);
  void change(Id id, Pen& repair);
  void build(Pen& repair) { rebuild(nobody, repair); }
  void audit(const MovingSet<Path>& x, double now) const;
  std::tuple<std::vector<EdgeChange>, std::vector<TriangleChange>> changes_from_nothing() const;

  template <class Archive>
  void archive(Archive& archive) {
    archive(periods_, mesh_, ends_, same_as_, hidden_, near_, busy_at_, repairs_, rebuilds_);
  }

 private:
  using Predicates = PeriodicPredicates<Path>;
  using Lawson = PeriodicLawson<Predicates>;

  static constexpr std::array<Id, 2> no_edge{nobody, nobody};
  static constexpr VertexCopy nowhere{nobody, {}};

  static bool is_edge(Slot slot) { return slot % 5 < 3; }
  static PeriodicMesh::Number edge_of(Slot slot) { return slot / 5 * 3 + slot % 5; }
  static std::uint32_t triangle_of(Slot slot) { return slot / 5 * 2 + slot % 5 - 3; }
  static Slot edge_slot(PeriodicMesh::Number edge) { return edge / 3 * 5 + edge % 3; }
  static Slot area_slot(std::uint32_t triangle) { return triangle / 2 * 5 + 3 + triangle % 2; }

  bool turn_back(std::uint32_t t, Lawson& lawson) const;
  void place(Id id, const Predicates& is, Lawson& lawson);
  void rebuild(Id without, Pen& repair);
  void certify_touched(Pen& repair);
  bool hidden(Id id) const { return id < same_as_.size() && same_as_[id].id != nobody; }

  Periods periods_;
  PeriodicMesh mesh_;
  std::vector<std::array<Id, 2>> ends_;  ///< by edge, as they have been reported; nobody if it is not there
  std::vector<VertexCopy> same_as_;      ///< by point: the copy that is in its place, if it has no vertex of its own
  std::uint64_t hidden_ = 0;             ///< how many share one
  std::uint32_t near_ = 0;               ///< a triangle to begin walks with
  double busy_at_ = -never;              ///< time of the last event, and how many there have been at that time
  std::uint64_t repairs_ = 0;
  std::uint64_t rebuilds_ = 0;
  PeriodOffset jump_;  ///< of the motion that keeps() has accepted
  std::vector<std::uint32_t> touched_;
  std::vector<PeriodicMesh::Number> changed_;
};

// ---------------------------------------------------------------------------------------------------------------

template <class Path>
auto PeriodicDelaunayRule<Path>::certificate(Slot slot, const MovingSet<Path>& x) const -> Choice {
  const Predicates is{x, periods_};
  if (is_edge(slot)) {
    if (!mesh_.contains_edge(edge_of(slot))) return {};
    return is.in_circle_of(mesh_.corners_beside(mesh_.half_edge(edge_of(slot))));
  }
  const std::uint32_t t = triangle_of(slot);
  if (t >= mesh_.end_triangle() || !mesh_.in_use(t)) return {};
  const auto [a, b, c] = mesh_.corners(3 * t);
  return is.orientation_of(a, b, c);
}

template <class Path>
std::vector<Id> PeriodicDelaunayRule<Path>::members(Slot slot) const {
  const Edge h = is_edge(slot) ? mesh_.half_edge(edge_of(slot)) : 3 * triangle_of(slot);
  std::vector<Id> ids{mesh_.origin(h), mesh_.target(h), mesh_.apex(h)};
  if (is_edge(slot)) ids.push_back(mesh_.apex(mesh_.twin(h)));
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

template <class Path>
Effect PeriodicDelaunayRule<Path>::repair(Slot slot, Pen& repair) {
  if (busy_at_ != repair.now()) repairs_ = 0;
  busy_at_ = repair.now();
  const Predicates is{repair.elements(), periods_, repair.now()};
  Lawson lawson(mesh_, is, touched_, changed_);
  // Flips end if all signs are those of one valid state. After points have passed through each other they may not end.
  bool repaired = ++repairs_ <= 64 + 4 * mesh_.size();
  if (repaired && is_edge(slot)) {
    const Edge h = mesh_.half_edge(edge_of(slot));
    if (lawson.flippable(h)) {
      lawson.flip(h);
    } else {
      const std::uint32_t other = mesh_.twin(h) / 3;
      repaired = turn_back(h / 3, lawson) || turn_back(other, lawson);
    }
  } else if (repaired) {
    repaired = turn_back(triangle_of(slot), lawson);
  }
  if (repaired) {
    certify_touched(repair);
  } else {
    rebuild(nobody, repair);
  }
  return Effect::external;
}

/// Flips the edge that a triangle has turned over. False if it has not, or there is no such edge.
template <class Path>
bool PeriodicDelaunayRule<Path>::turn_back(std::uint32_t t, Lawson& lawson) const {
  if (lawson.area(t) >= 0) return false;
  for (Edge h = 3 * t; h < 3 * t + 3; ++h) {
    if (!lawson.flippable(h)) continue;
    lawson.flip(h);
    return true;
  }
  return false;
}

template <class Path>
auto PeriodicDelaunayRule<Path>::changes_from_nothing() const
    -> std::tuple<std::vector<EdgeChange>, std::vector<TriangleChange>> {
  std::vector<EdgeChange> came;
  for (PeriodicMesh::Number edge = 0; edge < mesh_.end_edge(); ++edge) {
    if (mesh_.contains_edge(edge)) came.push_back({EdgeChange::What::came, edge, edges().ends(edge)});
  }
  std::vector<TriangleChange> triangles;
  for (std::uint32_t t = 0; t < mesh_.end_triangle(); ++t) {
    if (mesh_.in_use(t)) triangles.push_back({t});
  }
  return {std::move(came), std::move(triangles)};
}

template <class Path>
void PeriodicDelaunayRule<Path>::audit(const MovingSet<Path>& x, double now) const {
  const auto fail = [](Id id, const char* what) {
    throw AuditFailure(name + (": id " + std::to_string(id)) + ": " + what);
  };
  mesh_.audit();
  const Predicates is{x, periods_, now};
  std::uint64_t hidden_here = 0;
  for (Id id = 0; id < x.end_id(); ++id) {
    hidden_here += hidden(id);
    if (!x.contains(id)) {
      if (hidden(id) || mesh_.contains(id)) fail(id, "is in the triangulation, but not in the set");
    } else if (hidden(id) ? mesh_.contains(id) || !mesh_.contains(same_as_[id].id) : !mesh_.contains(id)) {
      fail(id, "has no vertex, or two");
    } else if (hidden(id) && !is.same({id, {}}, same_as_[id])) {
      fail(id, "is not where its vertex is");
    }
  }
  if (hidden_here != hidden_) fail(nobody, "the number of points without vertex is another");
  for (PeriodicMesh::Number edge = 0; edge < std::max<std::size_t>(ends_.size(), mesh_.end_edge()); ++edge) {
    const std::array<Id, 2> ends = mesh_.contains_edge(edge) ? edges().ends(edge) : no_edge;
    if ((edge < ends_.size() ? ends_[edge] : no_edge) != ends) fail(ends[0], "has an edge that was not reported");
  }
}

}  // namespace kds::structures

#include "structures/periodic_delaunay_edits.hpp"
