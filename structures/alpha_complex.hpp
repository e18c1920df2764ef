// Kinetic alpha complex and alpha shape in the plane.
#pragma once

#include "certificates/empty_disc.hpp"
#include "kds/audit.hpp"
#include "structures/delaunay.hpp"
#include "structures/selection.hpp"
#include "structures/triangulation_subset.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

namespace kds::structures {

/// A triangle of an alpha complex that came or went, or of which a corner has got a new motion.
struct AlphaTriangleChange {
  using What = EdgeChange::What;
  What what;
  std::uint32_t triangle;     ///< its number in the triangulation; that of one that went is given to others
  std::array<Id, 3> corners;  ///< ascending

  friend bool operator==(const AlphaTriangleChange&, const AlphaTriangleChange&) = default;
};

/// Keeps which edges and triangles of a Delaunay triangulation of moving points are in their alpha complex: those whose
/// corners are on the border of an open disc that contains no point, of at most a given radius. What these and the
/// points cover is the alpha shape: the form of the points, seen with that radius. Paper: [Edelsbrunner83].
///
///     Kinetic<DelaunayRule<Path>> triangulation(points, now);
///     Kinetic<AlphaComplexRule<Path>> complex(triangulation, now, AlphaComplexRule<Path>(radius));
///
/// or on a periodic one, AlphaComplexRule<Path, PeriodicDelaunayRule<Path>>, as the complex of all copies: edges and
/// triangles are given by the ids of the points of which their corners are copies, which may be the same.
///
/// A triangle is in it if its circle is small enough. An edge is if a triangle beside it is; or if it is a Gabriel edge
/// (gabriel_graph.hpp) and not longer than twice the radius. Each is a conjunction of signs (Selection).
///
/// It reports edges and triangles (EdgeChange, AlphaTriangleChange) that come, go, and have a corner that moves
/// otherwise, so that other rules may stand on it.
///
/// Cost, besides that of the triangulation: an event of its own is one edge, or a triangle and its edges, at most 10
/// certificates; a flip concerns 6 edges and 2 triangles (responsive: 20 marked). 1 certificate for each triangle, and
/// at most 3 for each edge that has no triangle of the complex beside it, fewer than 11 n (compact); as local as the
/// triangulation. The circle of a triangle has a certificate of degree 6 for linear and 12 for quadratic paths, those
/// of edges are of degree 2 and 4. External events are changes of the complex; an event is internal only where an edge
/// that is not in it still misses another condition (efficient).
///
/// If four or more points stay on one circle, triangles and edges are those that the triangulation has. Points that
/// stay in one place count as one (DelaunayRule::vertex). While all points stay on one line nothing is known
/// (DelaunayRule::flat).
template <class Path, class Delaunay = DelaunayRule<Path>>
class AlphaComplexRule : public StandsOn<Telling<Delaunay, TriangleChange>> {
 public:
  static constexpr const char* name = "AlphaComplex";
  using Element = Path;
  using Change = Changes<EdgeChange, AlphaTriangleChange>;
  using Pen = RepairOf<AlphaComplexRule>;
  using Edge = TriangulationEdges::Number;
  using Triangle = std::uint32_t;
  using Outside = certificates::OutsideDisc<typename Delaunay::Place>;
  using Short = certificates::PairRadius<typename Delaunay::Place>;
  using Small = certificates::CircleRadius<typename Delaunay::Place>;
  using Choice = std::variant<std::monostate, Outside, Short, Small>;

  /// Throws std::invalid_argument for a radius that is negative or not finite. A length.
  explicit AlphaComplexRule(double radius = 0) : radius_(radius) {
    if (!(radius >= 0) || !std::isfinite(radius)) {
      throw std::invalid_argument("AlphaComplexRule: the radius must be >= 0 and finite, and is " +
                                  std::to_string(radius));
    }
  }

  double radius() const { return radius_; }
  /// For another radius, to be called in Kinetic::edit(): O(n) signs. Precondition: >= 0 and finite.
  void set_radius(double radius, Pen& repair);

  bool contains_edge(Edge edge) const { return edges_.contains(edge); }
  bool contains_triangle(Triangle triangle) const { return triangles_.contains(triangle); }
  /// How many triangles of the complex are beside an edge of it: of 2, it is inside the alpha shape; of 1, on its
  /// border; of 0, a part of its own, and the shape is on neither side. Precondition: contains_edge(edge).
  int triangles_beside(Edge edge) const {
    const auto& mesh = this->inner().mesh();
    const TriangleMesh::Edge h = this->inner().edges().half_edge(edge);
    return contains_triangle(h / 3) + contains_triangle(mesh.twin(h) / 3);
  }
  /// Ids of the ends or corners, each ascending, in ascending order. O(n log n).
  std::vector<std::array<Id, 2>> edges() const { return edges_.all(); }
  std::vector<std::array<Id, 3>> triangles() const { return triangles_.all(); }
  /// The same of the edges that have the shape on one side only, or on neither.
  std::vector<std::array<Id, 2>> border() const {
    std::vector<std::array<Id, 2>> result;
    for (Edge edge = 0; edge < edges_.end(); ++edge) {
      if (contains_edge(edge) && triangles_beside(edge) < 2) result.push_back(edges_.ids(edge));
    }
    std::sort(result.begin(), result.end());
    return result;
  }

  // Slots 4 e, 4 e + 1: the third corners beside edge e are outside its disc; 4 e + 2: it is short enough. Slot 4 t +
  // 3: the circle of triangle t is small enough.
  Choice certificate(Slot slot, const MovingSet<Path>& x) const {
    const Slot part = slot / 4;
    const int sign = slot % 4 == 3 ? small_.certified(part, 0) : empty_.certified(part, slot % 4);
    return sign == 0 ? Choice{} : condition(slot, x, sign);
  }
  std::vector<Id> members(Slot slot) const {
    const auto [a, b, c] = slot % 4 == 3 ? corners_of(slot / 4) : corners_beside(slot / 4, slot % 4 % 2);
    return slot % 4 == 2 ? std::vector{id_of(a), id_of(b)} : std::vector{id_of(a), id_of(b), id_of(c)};
  }

  Effect repair(Slot slot, Pen& repair) {
    bool other = false;
    if (slot % 4 == 3) {
      const Triangle triangle = slot / 4;
      small_.turn(triangle, 0, meets(slot, repair));
      other = take_up_triangle(triangle, repair);
      for (TriangleMesh::Edge h = 3 * triangle; h < 3 * triangle + 3; ++h) {
        look_at_edge(this->inner().edges().of(h), repair);
        other = take_up_edge(this->inner().edges().of(h), repair) || other;
      }
    } else {
      empty_.turn(slot / 4, slot % 4, meets(4 * (slot / 4), repair));
      other = take_up_edge(slot / 4, repair);
    }
    return other ? Effect::external : Effect::internal;
  }
  Effect follow(std::span<const TriangleChange> changes, Pen& repair);
  /// Nothing is left to do: the changes of its triangles have been followed already.
  void change(Id id, Pen& repair);
  std::tuple<std::vector<EdgeChange>, std::vector<AlphaTriangleChange>> changes_from_nothing() const;

  void audit(const MovingSet<Path>& elements, double now) const;

  template <class Archive>
  void archive(Archive& archive) {
    archive(radius_, empty_, small_, edges_, triangles_, sides_);
  }

 private:
  using Corner = typename Delaunay::Corner;

  auto edge_of() const {
    return [this](TriangleMesh::Edge h) { return this->inner().edges().of(h); };
  }
  /// The ends of an edge, and the third corner of the triangle on one side of it.
  std::array<Corner, 3> corners_beside(Edge edge, std::size_t side) const {
    const TriangleMesh::Edge h = this->inner().edges().half_edge(edge);
    return this->inner().corners(side == 0 ? h : this->inner().mesh().twin(h));
  }
  std::array<Corner, 3> corners_of(Triangle triangle) const {
    return in_ascending_order(this->inner().corners(3 * triangle));
  }
  std::array<Corner, 2> ends_of(Edge edge) const {
    const auto [a, b, beside] = corners_beside(edge, 0);
    return in_ascending_order(std::array{a, b});
  }
  bool is_triangle(Triangle triangle) const {
    const auto& mesh = this->inner().mesh();
    return triangle < mesh.end_triangle() && mesh.in_use(triangle) && mesh.finite(triangle);
  }
  bool is_in(Edge edge) const {
    return this->inner().edges().contains(edge) && (empty_.contains(edge) || triangles_beside(edge) > 0);
  }

  /// None on the outer side of an edge of the hull.
  Choice condition(Slot slot, const MovingSet<Path>& x, double sign) const {
    const Delaunay& delaunay = this->inner();
    const auto [a, b, c] = slot % 4 == 3 ? corners_of(slot / 4) : corners_beside(slot / 4, slot % 4 % 2);
    if (slot % 4 == 2) return Short{delaunay.place(a, x), delaunay.place(b, x), radius_, sign};
    if (delaunay.at_infinity(c)) return {};
    if (slot % 4 == 3) {
      return Small{delaunay.place(a, x), delaunay.place(b, x), delaunay.place(c, x), radius_, sign};
    }
    return Outside{delaunay.place(a, x), delaunay.place(b, x), delaunay.place(c, x), sign};
  }
  /// For Selection: whether a condition is met, of those whose slots begin with this one.
  auto meets(Slot first, const Pen& repair) const {
    return [this, first, &repair](std::size_t i) {
      return repair.sign(condition(first + static_cast<Slot>(i), repair.elements(), 1)) >= 0;
    };
  }

  void look_at_triangle(Triangle triangle, Pen& repair) {
    if (is_triangle(triangle)) {
      small_.look(triangle, meets(4 * triangle + 3, repair));
    } else {
      small_.let_go(triangle);
    }
  }
  /// To be called after the triangles beside the edge have been looked at.
  void look_at_edge(Edge edge, Pen& repair) {
    if (this->inner().edges().contains(edge) && triangles_beside(edge) == 0) {
      empty_.look(edge, meets(4 * edge, repair));
    } else {
      empty_.let_go(edge);
    }
  }
  /// Looks at a triangle again. Returns whether the complex has changed.
  bool take_up_triangle(Triangle triangle, Pen& repair) {
    repair.certify(4 * triangle + 3);
    const auto report = [&](EdgeChange::What what, Triangle number, const std::array<Id, 3>& corners) {
      repair.report(AlphaTriangleChange{what, number, corners});
    };
    if (small_.contains(triangle)) return triangles_.put(triangle, corners_of(triangle), report);
    return triangles_.take_out(triangle, report);
  }
  bool take_up_edge(Edge edge, Pen& repair) {
    for (Slot slot = 4 * edge; slot < 4 * edge + 3; ++slot) repair.certify(slot);
    const auto report = [&](EdgeChange::What what, Edge number, const std::array<Id, 2>& ends) {
      repair.report(EdgeChange{what, number, ends});
    };
    if (is_in(edge)) return edges_.put(edge, ends_of(edge), report);
    return edges_.take_out(edge, report);
  }

  double radius_;
  Selection<3> empty_;  ///< edges without a triangle beside them, whose own disc is small enough and empty
  Selection<1> small_;  ///< triangles
  TriangulationSubset<2, Corner> edges_;
  TriangulationSubset<3, Corner> triangles_;
  PartsOfTriangles sides_;
};

// ---------------------------------------------------------------------------------------------------------------

template <class Path, class Delaunay>
void AlphaComplexRule<Path, Delaunay>::set_radius(double radius, Pen& repair) {
  radius_ = radius;
  const auto& edges = this->inner().edges();
  for (Triangle triangle = 0; triangle < this->inner().mesh().end_triangle(); ++triangle) {
    if (!is_triangle(triangle)) continue;
    look_at_triangle(triangle, repair);
    take_up_triangle(triangle, repair);
  }
  for (Edge edge = 0; edge < edges.end(); ++edge) {
    if (!edges.contains(edge)) continue;
    look_at_edge(edge, repair);
    take_up_edge(edge, repair);
  }
}

template <class Path, class Delaunay>
Effect AlphaComplexRule<Path, Delaunay>::follow(std::span<const TriangleChange> changes, Pen& repair) {
  bool other = false;
  for (const TriangleChange& change : changes) {
    look_at_triangle(change.triangle, repair);
    other = take_up_triangle(change.triangle, repair) || other;
  }
  for (const Edge edge : sides_.take_up(changes, this->inner().mesh(), edge_of())) {
    look_at_edge(edge, repair);
    other = take_up_edge(edge, repair) || other;
  }
  return other ? Effect::external : Effect::internal;
}

template <class Path, class Delaunay>
void AlphaComplexRule<Path, Delaunay>::change(Id id, Pen& repair) {
  if (!this->inner().mesh().contains(id)) return;
  this->inner().mesh().for_each_from(id, [&](TriangleMesh::Edge h) {
    const Edge edge = this->inner().edges().of(h);
    if (contains_edge(edge)) repair.report(EdgeChange{EdgeChange::What::moved, edge, edges_.ids(edge)});
    if (contains_triangle(h / 3)) {
      repair.report(AlphaTriangleChange{EdgeChange::What::moved, h / 3, triangles_.ids(h / 3)});
    }
  });
}

template <class Path, class Delaunay>
auto AlphaComplexRule<Path, Delaunay>::changes_from_nothing() const
    -> std::tuple<std::vector<EdgeChange>, std::vector<AlphaTriangleChange>> {
  std::vector<EdgeChange> edges;
  for (Edge edge = 0; edge < edges_.end(); ++edge) {
    if (contains_edge(edge)) edges.push_back({EdgeChange::What::came, edge, edges_.ids(edge)});
  }
  std::vector<AlphaTriangleChange> triangles;
  for (Triangle triangle = 0; triangle < triangles_.end(); ++triangle) {
    if (contains_triangle(triangle)) {
      triangles.push_back({EdgeChange::What::came, triangle, triangles_.ids(triangle)});
    }
  }
  return {std::move(edges), std::move(triangles)};
}

template <class Path, class Delaunay>
void AlphaComplexRule<Path, Delaunay>::audit(const MovingSet<Path>& /*elements*/, double /*now*/) const {
  const auto require = [](bool right, const char* part, std::uint32_t number) {
    if (right) return;
    throw AuditFailure(std::string(name) + ": " + part + " " + std::to_string(number) + ": is not as it should be");
  };
  const auto& edges = this->inner().edges();
  sides_.audit(this->inner().mesh(), edge_of());
  for (Edge edge = 0; edge < std::max(edges.end(), edges_.end()); ++edge) {
    const bool alone = edges.contains(edge) && triangles_beside(edge) == 0;
    require(empty_.knows(edge) == alone && contains_edge(edge) == is_in(edge), "edge", edge);
    require(!contains_edge(edge) || edges_.contains(edge, ends_of(edge)), "edge", edge);
  }
  for (Triangle triangle = 0; triangle < std::max(this->inner().mesh().end_triangle(), triangles_.end()); ++triangle) {
    require(small_.knows(triangle) == is_triangle(triangle), "triangle", triangle);
    require(contains_triangle(triangle) == small_.contains(triangle), "triangle", triangle);
    require(!contains_triangle(triangle) || triangles_.contains(triangle, corners_of(triangle)), "triangle", triangle);
  }
}

}  // namespace kds::structures
