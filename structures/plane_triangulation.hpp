// Kinetic triangulations of moving points in the plane: the common part of Delaunay triangulation and convex hull.
#pragma once

#include "kds/audit.hpp"
#include "kds/framework/kinetic.hpp"
#include "structures/hull_headings.hpp"
#include "structures/lawson.hpp"
#include "structures/plane_predicates.hpp"
#include "structures/triangle_mesh.hpp"
#include "structures/triangulation_edges.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace kds::structures {

/// The property that a triangulation proves in addition.
enum class Criterion { delaunay, hull };

/// Maintains a triangulation of moving points whose hull is convex and, if asked for, whose edges are all Delaunay.
///
/// The proof. Each triangle has positive area (Orientation); the hull turns left at each of its vertices (Orientation);
/// and it goes round once: each of its edges is certified to lead to the right or to the left (DirectionOrder), and
/// they form one stretch to the right and one to the left. Then the angles add up so that the triangles around each
/// vertex go round once too, and so do not overlap anywhere (see docs/framework.md). Each edge is locally Delaunay
/// (InCircle), so all are [Lawson77]. Without that condition, points that change places within one spacing of the clock
/// could leave two layers of triangles whose edges are all Delaunay.
///
/// Repair: an edge whose certificate fails is flipped. Where flips cannot repair it (points that pass through each
/// other within one spacing of the clock) the triangulation is built anew at that instant; rebuilds() counts this.
///
/// Points that stay in one place together share a vertex. While all points stay on one line there is no triangle, and
/// nothing is known of them: flat().
template <class Path, Criterion What>
class PlaneTriangulationRule {
 public:
  using Element = Path;
  using Edge = TriangleMesh::Edge;
  static constexpr const char* name = What == Criterion::delaunay ? "Delaunay" : "ConvexHull";
  static constexpr Id infinite = TriangleMesh::infinite;

  /// The triangles; those with the vertex `infinite` lie outside the hull.
  const TriangleMesh& mesh() const { return mesh_; }
  /// Whether all points are on one line, or fewer than three.
  bool flat() const { return mesh_.empty(); }
  /// The vertex that represents a point: itself, or one that stays in the same place.
  Id vertex(Id id) const { return id < same_as_.size() && same_as_[id] != nobody ? same_as_[id] : id; }
  /// Whether some points share a vertex.
  bool has_shared_vertices() const { return hidden_ > 0; }
  /// Ids on the hull, counter-clockwise, beginning with the lowest id; those on its edges are among them. Empty if
  /// flat(). O(points of the hull).
  std::vector<Id> hull() const;
  /// The edges between points, under numbers that they keep. Those of a convex hull are not numbered.
  const TriangulationEdges& edges() const { return edges_; }
  /// What structures that stand on a triangulation use of its triangles, in a plane that repeats itself as well as in
  /// one that does not: the corners, origin of a half-edge first, and their places. Corners that are at_infinity() have
  /// no place.
  using Corner = Id;
  std::array<Corner, 3> corners(Edge h) const { return {mesh_.origin(h), mesh_.target(h), mesh_.apex(h)}; }
  static bool at_infinity(Corner corner) { return corner == infinite; }
  using Place = Path;
  const Place& place(Corner corner, const MovingSet<Path>& x) const { return x[corner]; }
  /// Certificate that an edge is not longer than another.
  using LengthOrder = certificates::DistanceOrder<Path>;
  LengthOrder length_order(TriangulationEdges::Number edge, TriangulationEdges::Number other,
                           const MovingSet<Path>& x) const {
    const auto [a, b] = edges_.ends(edge);
    const auto [c, d] = edges_.ends(other);
    return {x[a], x[b], x[c], x[d]};
  }
  /// How often it has been built anew.
  std::uint64_t rebuilds() const { return rebuilds_; }

  using Orientation = certificates::Orientation<Path>;
  using InCircle = certificates::InCircle<Path>;
  using Direction = certificates::DirectionOrder<Path, 2>;
  using Choice = std::variant<std::monostate, Orientation, InCircle, Direction>;

  /// What it reports to rules that stand on it: edges, or triangles; a convex hull its triangles only, of which those
  /// at infinity tell of the edges of the hull (hull_edges.hpp).
  using Change = std::conditional_t<What == Criterion::delaunay, Changes<EdgeChange, TriangleChange>, TriangleChange>;
  using Pen = Repair<Path, Change>;

  // Slots 4 t, 4 t + 1, 4 t + 2: the edges of triangle t, each known by the lesser of its half-edges; 4 t + 3: its
  // area, or, if it is infinite, the direction of its edge of the hull.
  Choice certificate(Slot slot, const MovingSet<Path>& x) const;
  std::vector<Id> members(Slot slot) const;
  Effect repair(Slot slot, Pen& repair);
  void insert(Id id, Pen& repair);
  void remove(Id id, Pen& repair);
  bool keeps(Id id, const Path& next, Pen& repair);
  void change(Id id, Pen& repair);
  void build(Pen& repair) { rebuild(nobody, repair); }
  void audit(const MovingSet<Path>& x, double now) const;
  typename kds::detail::ChangeTypes<Change>::Lists changes_from_nothing() const;

  template <class Archive>
  void archive(Archive& archive) {
    archive(mesh_, headings_, same_as_, hidden_, near_, busy_at_, repairs_, rebuilds_, edges_);
  }

 private:
  using Predicates = PlanePredicates<Path>;

  bool has_infinite_neighbour(std::uint32_t t) const {
    for (Edge h = 3 * t; h < 3 * t + 3; ++h) {
      if (mesh_.apex(mesh_.twin(h)) == infinite) return true;
    }
    return false;
  }

  /// The triangle on the other side of the hull from an infinite one; a finite one gives itself.
  std::uint32_t behind(std::uint32_t t) const {
    for (Edge h = 3 * t; h < 3 * t + 3; ++h) {
      if (mesh_.apex(h) == infinite) return mesh_.twin(h) / 3;
    }
    return t;
  }
  bool look_round(const Predicates& is, Pen& repair);
  bool turn_back(std::uint32_t t, Lawson<Predicates>& lawson);
  void place(Id id, Lawson<Predicates>& lawson);
  void rebuild(Id without, Pen& repair);
  void certify_touched(Pen& repair);
  void report_touched(Pen& repair);
  void report_moved(Id id, Pen& repair);

  TriangleMesh mesh_;
  HullHeadings headings_;
  std::vector<Id> same_as_;   ///< by point: the vertex that it shares, if it has none of its own
  std::uint64_t hidden_ = 0;  ///< how many share one
  std::uint32_t near_ = 0;    ///< a triangle to begin walks with
  double busy_at_ = -never;   ///< time of the last event, and how many there have been at that time
  std::uint64_t repairs_ = 0;
  std::uint64_t rebuilds_ = 0;
  TriangulationEdges edges_;
  std::vector<std::uint32_t> touched_;
};

// ---------------------------------------------------------------------------------------------------------------

template <class Path, Criterion What>
std::vector<Id> PlaneTriangulationRule<Path, What>::hull() const {
  std::vector<Id> ids;
  if (flat()) return ids;
  const Edge first = mesh_.from(infinite);
  Edge h = first;
  do {
    ids.push_back(mesh_.target(h));
    h = mesh_.clockwise(h);  // clockwise around infinity is counter-clockwise around the points
  } while (h != first);
  std::rotate(ids.begin(), std::min_element(ids.begin(), ids.end()), ids.end());
  return ids;
}

template <class Path, Criterion What>
auto PlaneTriangulationRule<Path, What>::changes_from_nothing() const ->
    typename kds::detail::ChangeTypes<Change>::Lists {
  std::vector<TriangleChange> triangles;
  for (std::uint32_t t = 0; t < mesh_.end_triangle(); ++t) {
    if (mesh_.in_use(t)) triangles.push_back({t});
  }
  if constexpr (What == Criterion::hull) {
    return triangles;
  } else {
    std::vector<EdgeChange> edges;
    for (TriangulationEdges::Number edge = 0; edge < edges_.end(); ++edge) {
      if (edges_.contains(edge)) edges.push_back({EdgeChange::What::came, edge, edges_.ends(edge)});
    }
    return {std::move(edges), std::move(triangles)};
  }
}

template <class Path, Criterion What>
auto PlaneTriangulationRule<Path, What>::certificate(Slot slot, const MovingSet<Path>& x) const -> Choice {
  const std::uint32_t t = slot / 4;
  if (t >= mesh_.end_triangle() || !mesh_.in_use(t)) return {};
  if (slot % 4 == 3) {
    if (!mesh_.finite(t)) return headings_.certificate(mesh_, t, x);
    if (has_infinite_neighbour(t)) return {};  // The area is certified as that of the apex of a hull edge.
    return Orientation{x[mesh_.origin(3 * t)], x[mesh_.origin(3 * t + 1)], x[mesh_.origin(3 * t + 2)]};
  }
  const Edge h = 3 * t + slot % 4;
  if (mesh_.twin(h) < h) return {};
  const Id a = mesh_.origin(h), b = mesh_.target(h), c = mesh_.apex(h), d = mesh_.apex(mesh_.twin(h));
  if (a == infinite) return Orientation{x[c], x[b], x[d]};
  if (b == infinite) return Orientation{x[d], x[a], x[c]};
  if (c == infinite) return Orientation{x[b], x[a], x[d]};
  if (d == infinite) return Orientation{x[a], x[b], x[c]};
  if constexpr (What == Criterion::hull) return {};
  return InCircle{x[a], x[b], x[c], x[d]};
}

template <class Path, Criterion What>
std::vector<Id> PlaneTriangulationRule<Path, What>::members(Slot slot) const {
  const std::uint32_t t = slot / 4;
  const Edge h = 3 * t + (slot % 4 == 3 ? 0 : slot % 4);
  std::vector<Id> ids{mesh_.origin(h), mesh_.target(h), mesh_.apex(h)};
  if (slot % 4 != 3) ids.push_back(mesh_.apex(mesh_.twin(h)));
  std::erase(ids, infinite);
  return ids;
}

template <class Path, Criterion What>
Effect PlaneTriangulationRule<Path, What>::repair(Slot slot, Pen& repair) {
  if (busy_at_ != repair.now()) repairs_ = 0;
  busy_at_ = repair.now();
  const Predicates is{repair.elements(), repair.now()};
  Lawson<Predicates> lawson(mesh_, is, touched_);
  const std::uint32_t t = slot / 4;
  const Edge h = 3 * t + (slot % 4 == 3 ? 0 : slot % 4);
  // Flips end if all signs are those of one valid state. After points have passed through each other they may not end.
  bool repaired = ++repairs_ <= 64 + 4 * mesh_.size();
  const bool turned = !mesh_.finite(t) && slot % 4 == 3;
  if (repaired && turned) {
    headings_.find(mesh_, t, is);
  } else if (repaired && slot % 4 != 3 && lawson.flippable(h)) {
    lawson.flip(h);
  } else if (repaired) {
    const std::uint32_t other = mesh_.twin(h) / 3;
    repaired = turn_back(t, lawson) || (slot % 4 != 3 && (turn_back(other, lawson) || turn_back(behind(t), lawson)));
  }
  bool at_hull = turned;
  for (const std::uint32_t touched : touched_) at_hull = at_hull || !mesh_.finite(touched);
  const bool external = !turned && (What == Criterion::delaunay || at_hull);
  if (repaired) certify_touched(repair);
  if (repaired && at_hull && !headings_.go_round_once(mesh_)) repaired = look_round(is, repair);
  if (repaired) return external ? Effect::external : Effect::internal;
  rebuild(nobody, repair);
  return Effect::external;
}

/// Updates the headings of all hull edges: more of them may have turned at this time. False if the hull does not go
/// round once.
template <class Path, Criterion What>
bool PlaneTriangulationRule<Path, What>::look_round(const Predicates& is, Pen& repair) {
  for (std::uint32_t t = 0; t < mesh_.end_triangle(); ++t) {
    if (!mesh_.in_use(t) || mesh_.finite(t)) continue;
    headings_.find(mesh_, t, is);
    repair.certify(4 * t + 3);
  }
  return headings_.go_round_once(mesh_);
}

/// Flips the edge that a triangle has turned over. False if it has not, or there is no such edge.
template <class Path, Criterion What>
bool PlaneTriangulationRule<Path, What>::turn_back(std::uint32_t t, Lawson<Predicates>& lawson) {
  if (!mesh_.finite(t) || lawson.area(t) >= 0) return false;
  Edge hull_edge = TriangleMesh::none;
  int hull_edges = 0;
  for (Edge h = 3 * t; h < 3 * t + 3; ++h) {
    if (mesh_.apex(mesh_.twin(h)) == infinite) {
      hull_edge = h;
      ++hull_edges;
    } else if (lawson.flippable(h)) {
      lawson.flip(h);
      return true;
    }
  }
  if (hull_edges != 1 || !lawson.flippable(hull_edge)) return false;
  lawson.flip(hull_edge);
  return true;
}

template <class Path, Criterion What>
void PlaneTriangulationRule<Path, What>::audit(const MovingSet<Path>& x, double now) const {
  const auto fail = [](Id id, const char* what) {
    throw AuditFailure(name + (": id " + std::to_string(id)) + ": " + what);
  };
  mesh_.audit();
  if constexpr (What == Criterion::delaunay) edges_.audit(mesh_);
  if (!flat() && !headings_.go_round_once(mesh_)) fail(nobody, "the hull does not go round once");
  const Predicates is{x, now};
  std::uint64_t hidden = 0;
  for (Id id = 0; id < x.end_id() && !flat(); ++id) {
    const bool has_twin = id < same_as_.size() && same_as_[id] != nobody;
    hidden += has_twin;
    if (!x.contains(id)) {
      if (has_twin || mesh_.contains(id)) fail(id, "is in the triangulation, but not in the set");
    } else if (has_twin ? mesh_.contains(id) || !mesh_.contains(same_as_[id]) : !mesh_.contains(id)) {
      fail(id, "has no vertex, or two");
    } else if (has_twin && !is.same(id, same_as_[id])) {
      fail(id, "is not where its vertex is");
    }
  }
  if (!flat() && hidden != hidden_) fail(nobody, "the number of points without vertex is another");
}

}  // namespace kds::structures

#include "structures/plane_triangulation_edits.hpp"
