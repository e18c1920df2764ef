// Kinetic Delaunay and regular triangulations of moving points in space.
#pragma once

#include "certificates/distance_order.hpp"
#include "kds/audit.hpp"
#include "kds/framework/kinetic.hpp"
#include "structures/bowyer_watson.hpp"
#include "structures/hidden_points.hpp"
#include "structures/hull_facings.hpp"
#include "structures/local_rebuild.hpp"
#include "structures/space_predicates.hpp"
#include "structures/spatial_edges.hpp"
#include "structures/tetrahedron_mesh.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

namespace kds::structures {

/// Maintains the Delaunay triangulation of moving points in space: no point is inside the sphere through the corners of
/// a tetrahedron. If the points have weights (WeightedPoint, or any path with weight()), it is the regular
/// triangulation, also called weighted Delaunay or power triangulation; a point that has no vertex in that is *hidden*,
/// and lies in a tetrahedron that is known. So does a point that stays in one place with another of the same weight.
///
/// If five or more points stay on one sphere it is one of the triangulations with that property, by a perturbation
/// (SpacePredicates): so it is unique, and a function of the motions and the ids.
///
/// The proof. Each tetrahedron has a positive volume (SpaceOrientation); each facet is locally Delaunay (InSphere); the
/// hull is convex at each of its edges (SpaceOrientation), and goes round once (HullFacings). These certificates imply
/// the state by themselves: docs/triangulations-in-space.md. With weights each hidden point is certified to be in its
/// tetrahedron, and outside its sphere.
///
/// Repair: a facet whose certificate fails is flipped. Where flips cannot repair it (several events at one time, four
/// points that stay in one plane, a vertex that becomes hidden) its neighbourhood is built anew, as far as is necessary
/// (LocalRebuild); and everything, if that should fail (rebuilds()).
///
/// Papers: [Basch99], [Guibas04]; [Edelsbrunner96] for weights; [Devillers11]. Certificates of degree 5 for linear, 10
/// for quadratic paths. Sampled paths are not supported: for them zero is no sign.
///
/// Cost, where most vertices have some 15 neighbours: an event is a flip, O(1) certificates (responsive: 21 marked, 9
/// of them in-sphere tests; more where a neighbourhood is built anew); 20 n certificates (compact: 13 n facets, 7 n
/// volumes); an element is in some 100 (not local in the worst case); every event is a change of the triangulation,
/// except where a facet or edge of the hull turns, or a hidden point moves on (efficient). Insertion O(n^(1/3)) for the
/// walk and O(neighbours); removal O(neighbours); a new motion that keeps the tetrahedra around it O(neighbours), any
/// other a removal and an insertion. An event at the hull takes O(facets of the hull), without arithmetic.
///
/// It reports its edges, and its tetrahedra, to rules that stand on it. Those about the edges of a Delaunay
/// triangulation (ClosestPairRule, NearestNeighboursRule, SpanningTreeRule) are for points in space if it is given them
/// in place of DelaunayRule: SpanningTreeRule<Path, SpatialDelaunayRule<Path>>.
///
/// While all points stay in one plane there is no tetrahedron, and nothing is known of them: flat().
template <class Path>
class SpatialTriangulationRule {
  static_assert(!Sampled<Path>, "triangulations in space: sampled paths are not supported");

 public:
  using Element = Path;
  using Facet = TetrahedronMesh::Facet;
  static constexpr bool weighted = certificates::Weighted<Path>;
  static constexpr const char* name = weighted ? "RegularTriangulation" : "SpatialDelaunay";
  static constexpr Id infinite = TetrahedronMesh::infinite;

  /// The tetrahedra; those with the vertex `infinite` lie outside the hull.
  const TetrahedronMesh& mesh() const { return mesh_; }
  /// Whether all points are in one plane, or fewer than four.
  bool flat() const { return mesh_.empty(); }
  /// The points that have no vertex, and the tetrahedra that they are in. None if flat().
  const HiddenPoints& hidden() const { return hidden_; }
  /// The vertices that an edge joins to this one, ascending; `infinite`, the last, for those of the hull.
  /// Precondition: it is a vertex. O(neighbours).
  std::vector<Id> neighbours(Id vertex) const;
  /// The edges between points, under numbers that they keep.
  const SpatialEdges& edges() const { return edges_; }
  /// The vertex that represents a point: itself, or one that stays in the same place.
  Id vertex(Id id) const requires(!weighted) { return hidden_.contains(id) ? same_as_[id] : id; }
  /// Whether some points share a vertex.
  bool has_shared_vertices() const requires(!weighted) { return hidden_.size() > 0; }
  /// Certificate that an edge is not longer than another.
  using LengthOrder = certificates::DistanceOrder<Path>;
  LengthOrder length_order(SpatialEdges::Number edge, SpatialEdges::Number other, const MovingSet<Path>& x) const
      requires(!weighted) {
    const auto [a, b] = edges_.ends(edge);
    const auto [c, d] = edges_.ends(other);
    return {x[a], x[b], x[c], x[d]};
  }
  /// The corners of the facets of the hull, counter-clockwise seen from outside. O(facets of the hull).
  std::vector<std::array<Id, 3>> hull() const;
  /// How often a part has been built anew because flips could not repair it; and how often the whole.
  std::uint64_t local_rebuilds() const { return local_rebuilds_; }
  std::uint64_t rebuilds() const { return rebuilds_; }

  using Orientation = certificates::SpaceOrientation<Path>;
  using InSphere = certificates::InSphere<Path>;
  using Facing = certificates::NormalDirection<Path>;
  using Direction = certificates::DirectionOrder<Path, 3>;
  using Choice = std::variant<std::monostate, InSphere, Orientation, Facing, Direction>;

  using Change = Changes<EdgeChange, TetrahedronChange>;
  using Pen = Repair<Path, Change>;

  // Slots of tetrahedron t: `stride` t + i for its facets, each known by the lesser of its two numbers; then, with i =
  // 4, its volume or, if it is infinite, the way its facet of the hull faces. At an edge of the hull, which is the
  // facet of two infinite tetrahedra, the greater number has the way that the edge leads. With weights five more: those
  // of the hidden point whose *id* is t: that it is on the inner side of the four facets, and outside the sphere.
  static constexpr Slot stride = weighted ? 10 : 5;
  Choice certificate(Slot slot, const MovingSet<Path>& x) const;
  std::vector<Id> members(Slot slot) const;
  Effect repair(Slot slot, Pen& repair);
  void insert(Id id, Pen& repair);
  void remove(Id id, Pen& repair);
  bool keeps(Id id, const Path& next, Pen& repair);
  void change(Id id, Pen& repair);
  void build(Pen& repair) {
    rebuild(nobody, repair);
    report_touched(repair);
  }
  void audit(const MovingSet<Path>& x, double now) const;
  std::tuple<std::vector<EdgeChange>, std::vector<TetrahedronChange>> changes_from_nothing() const;

  template <class Archive>
  void archive(Archive& archive) {
    archive(mesh_, hull_, hidden_, kind_, hidden_kind_, near_, busy_at_, repairs_, local_rebuilds_, rebuilds_);
    archive(edges_, same_as_);
    if constexpr (Archive::loading) {
      archive.require(kind_.size() == 5 * std::size_t{mesh_.end_tetrahedron()} || flat(), "a mesh has other facets");
    }
  }

 private:
  using Predicates = SpacePredicates<Path>;
  using Mesher = BowyerWatson<Predicates>;

  /// Which certificate proves a fact: none, since it always holds; the polynomial itself; or, if the polynomial of a
  /// sphere vanishes, its cofactor number kind - perturbed.
  enum Kind : std::uint8_t { none = 0, plain = 1, perturbed = 2 };

  Choice sphere_certificate(std::uint8_t kind, const TetrahedronMesh::Corners& abcd, Id e,
                            const MovingSet<Path>& x) const;
  Choice hidden_certificate(Id id, Slot part, const MovingSet<Path>& x) const;
  static std::uint8_t sphere_kind(const TetrahedronMesh::Corners& abcd, Id e, const Predicates& is);
  Id companion(Id id, std::uint32_t t, const Predicates& is) const;
  bool moves_along(Id id, std::uint32_t t, const Predicates& is) const { return companion(id, t, is) != nobody; }
  std::uint8_t hidden_kind(Id id, const Predicates& is) const;
  std::uint8_t facet_kind(Facet f, const Predicates& is) const;
  bool holds(Facet f, const Predicates& is) const;
  /// The facet of the hull at an infinite tetrahedron, and the corner of its neighbour across facet f, orientated so
  /// that the hull is convex there if they are not negative.
  std::array<Id, 4> hinge(Facet f) const {
    const auto [a, b, c] = mesh_.facet(mesh_.opposite(f / 4, infinite));
    return {b, a, c, mesh_.apex(mesh_.twin(f))};
  }
  bool at_hull(Facet f) const {
    return mesh_.apex(f) != infinite && !mesh_.finite(f / 4) && mesh_.apex(mesh_.twin(f)) != infinite;
  }
  static Orientation orientation(const std::array<Id, 4>& p, const MovingSet<Path>& x) {
    return {x[p[0]], x[p[1]], x[p[2]], x[p[3]]};
  }

  bool flip(Slot slot, const Predicates& is, Pen& repair);
  bool build_around(std::vector<std::uint32_t> wrong, Id without, const Predicates& is, Pen& repair);
  void place(Id id, std::uint32_t near, const Predicates& is, Pen& repair);
  void complete_change(const Replaced& replaced, Id without, const Predicates& is, Pen& repair);
  std::uint32_t home_of(Id id, const std::vector<std::uint32_t>& tetrahedra, const Predicates& is) const;
  void hide(Id id, std::uint32_t t, const Predicates& is, Pen& repair);
  void reveal(Id id, Pen& repair);
  void prove(const std::vector<std::uint32_t>& tetrahedra, const Predicates& is, Pen& repair);
  void prove_facet(Facet f, const Predicates& is, Pen& repair);
  void begin() {
    at_hull_ = lost_ = false;
    places_ = 0;
  }
  bool sound() const { return !lost_ && !(at_hull_ && !hull_.goes_round_once(mesh_)); }
  bool look_round(const Predicates& is, Pen& repair);
  void rebuild(Id without, Pen& repair);
  void report_touched(Pen& repair);

  TetrahedronMesh mesh_;
  HullFacings hull_;
  HiddenPoints hidden_;
  std::vector<std::uint8_t> kind_;         ///< by 5 t + i, as slots are
  std::vector<std::uint8_t> hidden_kind_;  ///< by id: of the sphere that a hidden point is outside of
  std::vector<Id> same_as_;                ///< by id: the vertex that a hidden point without weight moves with
  SpatialEdges edges_;
  std::uint32_t near_ = 0;   ///< a tetrahedron to begin walks with
  double busy_at_ = -never;  ///< time of the last event, and how many there have been at that time
  std::uint64_t repairs_ = 0;
  std::uint64_t local_rebuilds_ = 0;
  std::uint64_t rebuilds_ = 0;
  // Of this event or edit: whether it has changed what HullFacings stores; whether a point has found no place.
  bool at_hull_ = false;
  bool lost_ = false;
  std::size_t places_ = 0;              ///< how many points it has placed
  std::vector<std::uint32_t> touched_;  ///< tetrahedra that are other ones
};

/// The Delaunay triangulation of points in space, and the regular triangulation of such with weights.
template <class Path>
using SpatialDelaunayRule = SpatialTriangulationRule<Path>;
template <certificates::Weighted Path>
using RegularTriangulationRule = SpatialTriangulationRule<Path>;

// ---------------------------------------------------------------------------------------------------------------

template <class Path>
std::vector<Id> SpatialTriangulationRule<Path>::neighbours(Id vertex) const {
  std::vector<Id> result;
  for (const std::uint32_t t : mesh_.star(vertex)) {
    for (const Id corner : mesh_.corners(t)) {
      if (corner != vertex) result.push_back(corner);
    }
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

template <class Path>
std::vector<std::array<Id, 3>> SpatialTriangulationRule<Path>::hull() const {
  std::vector<std::array<Id, 3>> result;
  if (flat()) return result;
  for (const std::uint32_t t : mesh_.star(infinite)) result.push_back(mesh_.facet(mesh_.opposite(t, infinite)));
  return result;
}

template <class Path>
auto SpatialTriangulationRule<Path>::sphere_certificate(std::uint8_t kind, const TetrahedronMesh::Corners& abcd, Id e,
                                                        const MovingSet<Path>& x) const -> Choice {
  if (kind == none) return {};
  if (kind == plain) return InSphere{x[abcd[0]], x[abcd[1]], x[abcd[2]], x[abcd[3]], x[e]};
  return orientation(Predicates::cofactor(abcd, e, kind - perturbed), x);
}

template <class Path>
auto SpatialTriangulationRule<Path>::certificate(Slot slot, const MovingSet<Path>& x) const -> Choice {
  const std::uint32_t t = slot / stride;
  const Slot part = slot % stride;
  if (part >= 5) return hidden_certificate(t, part - 5, x);
  if (t >= mesh_.end_tetrahedron() || !mesh_.in_use(t)) return {};
  if (part == 4) {
    if (!mesh_.finite(t)) return hull_.certificate(mesh_, t, x);
    return orientation(mesh_.corners(t), x);
  }
  const Facet f = 4 * t + part;
  const std::uint8_t kind = kind_[5 * t + part];
  if (kind == none) return {};
  if (mesh_.finite(t)) return sphere_certificate(kind, mesh_.corners(t), mesh_.apex(mesh_.twin(f)), x);
  if (f > mesh_.twin(f)) return hull_.edge_certificate(mesh_, f, x);
  return orientation(hinge(f), x);
}

template <class Path>
auto SpatialTriangulationRule<Path>::hidden_certificate(Id id, Slot part, const MovingSet<Path>& x) const -> Choice {
  if (!hidden_.contains(id) || hidden_kind_[id] == none) return {};
  const std::uint32_t t = hidden_.place(id);
  if (part == 4) return sphere_certificate(hidden_kind_[id], mesh_.corners(t), id, x);
  const auto [a, b, c] = mesh_.facet(4 * t + part);
  return orientation({a, b, c, id}, x);
}

template <class Path>
std::vector<Id> SpatialTriangulationRule<Path>::members(Slot slot) const {
  const std::uint32_t t = slot / stride;
  const Slot part = slot % stride;
  std::vector<Id> ids;
  if (part >= 5) {
    const TetrahedronMesh::Corners corners = mesh_.corners(hidden_.place(t));
    ids.assign(corners.begin(), corners.end());
    ids.push_back(t);
  } else {
    const TetrahedronMesh::Corners corners = mesh_.corners(t);
    ids.assign(corners.begin(), corners.end());
    if (part != 4) ids.push_back(mesh_.apex(mesh_.twin(4 * t + part)));
  }
  std::erase(ids, infinite);
  return ids;
}

template <class Path>
Effect SpatialTriangulationRule<Path>::repair(Slot slot, Pen& repair) {
  if (busy_at_ != repair.now()) repairs_ = 0;
  busy_at_ = repair.now();
  const Predicates is{repair.elements(), repair.now()};
  const std::uint32_t t = slot / stride;
  const Slot part = slot % stride;
  const Facet f = 4 * t + part;
  begin();
  Effect effect = Effect::external;
  // Flips end if all signs are those of one valid state. After points have passed through each other they may not end.
  bool repaired = ++repairs_ <= 64 + 4 * mesh_.size();
  if (part >= 5) {
    const std::uint32_t near = hidden_.place(t);
    reveal(t, repair);
    place(t, near, is, repair);
    if (hidden_.contains(t)) effect = Effect::internal;
  } else if (!mesh_.finite(t) && (part == 4 || (at_hull(f) && f > mesh_.twin(f)))) {
    effect = Effect::internal;
    at_hull_ = true;
    part == 4 ? prove({t}, is, repair) : prove_facet(f, is, repair);
  } else if (repaired && !flip(slot, is, repair)) {
    std::vector<std::uint32_t> wrong{t};
    if (part != 4) wrong.push_back(mesh_.twin(f) / 4);
    repaired = build_around(wrong, nobody, is, repair);
    ++local_rebuilds_;
  }
  if (repaired && !sound()) repaired = !lost_ && look_round(is, repair);
  if (!repaired) {
    rebuild(nobody, repair);
    effect = Effect::external;
  }
  report_touched(repair);
  return effect;
}

template <class Path>
auto SpatialTriangulationRule<Path>::changes_from_nothing() const
    -> std::tuple<std::vector<EdgeChange>, std::vector<TetrahedronChange>> {
  std::vector<EdgeChange> edges;
  for (SpatialEdges::Number edge = 0; edge < edges_.end(); ++edge) {
    if (edges_.contains(edge)) edges.push_back({EdgeChange::What::came, edge, edges_.ends(edge)});
  }
  std::vector<TetrahedronChange> tetrahedra;
  for (std::uint32_t t = 0; t < mesh_.end_tetrahedron(); ++t) {
    if (mesh_.in_use(t)) tetrahedra.push_back({t});
  }
  return {std::move(edges), std::move(tetrahedra)};
}

template <class Path>
void SpatialTriangulationRule<Path>::audit(const MovingSet<Path>& x, double now) const {
  const auto fail = [](Id id, const char* what) {
    throw AuditFailure(name + (": id " + std::to_string(id)) + ": " + what);
  };
  edges_.audit(mesh_);
  if (flat()) return;
  mesh_.audit();
  if (!hull_.goes_round_once(mesh_)) fail(nobody, "the hull does not go round once");
  const Predicates is{x, now};
  for (std::uint32_t t = 0; t < mesh_.end_tetrahedron(); ++t) {
    for (Facet f = 4 * t; mesh_.in_use(t) && f < 4 * t + 4; ++f) {
      if (kind_[5 * t + f % 4] != facet_kind(f, is))
        fail(mesh_.apex(f), "has a wrong kind of certificate opposite to it");
    }
  }
  std::size_t hidden = 0;
  for (Id id = 0; id < x.end_id(); ++id) {
    hidden += hidden_.contains(id);
    if (!x.contains(id)) {
      if (hidden_.contains(id) || mesh_.contains(id)) fail(id, "is in the triangulation, but not in the set");
      continue;
    }
    if (hidden_.contains(id) == mesh_.contains(id)) fail(id, "is a vertex and hidden, or neither");
    if (mesh_.contains(id)) continue;
    const std::uint32_t t = hidden_.place(id);
    if (!mesh_.in_use(t) || !mesh_.finite(t)) fail(id, "is hidden in no tetrahedron");
    if (!weighted && !moves_along(id, t, is)) fail(id, "is hidden, but not where a vertex is");
    if (!weighted && (!mesh_.contains(same_as_[id]) || !is.same(id, same_as_[id]))) fail(id, "is with another vertex");
    if (weighted && hidden_kind_[id] != hidden_kind(id, is)) fail(id, "has a wrong kind of certificate");
  }
  if (hidden != hidden_.size()) fail(nobody, "the number of hidden points is another");
}

}  // namespace kds::structures

#include "structures/spatial_triangulation_edits.hpp"
