// Kinetic Voronoi cells in the plane.
#pragma once

#include "kds/audit.hpp"
#include "kds/motion.hpp"
#include "structures/delaunay.hpp"
#include "structures/triangulation_subset.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace kds::structures {

/// The cell of a point at a time: the places that are not nearer to any other point. Counter-clockwise.
struct VoronoiCell {
  using Vector = std::array<double, 2>;

  /// The points beyond its sides. Of a bounded cell side i leads from vertices[i - 1] (of i = 0, the last one) to
  /// vertices[i]; of an unbounded one the first side comes from infinity and the last one leads there, so that it has
  /// one vertex less.
  std::vector<Id> neighbours;
  std::vector<Vector> vertices;  ///< length
  bool bounded = true;
  /// Of an unbounded cell: the directions from its first and from its last vertex to infinity. Not of unit length.
  std::array<Vector, 2> directions{};
};

/// A point has come, gone, or got other neighbours, or its cell has become bounded or unbounded.
struct NeighboursChange {
  Id id;

  friend bool operator==(const NeighboursChange&, const NeighboursChange&) = default;
};

/// Keeps for each of moving points its neighbours in the Voronoi diagram, in order around it, and gives its cell at any
/// time. It stands on a Delaunay triangulation, whose edges these are [Guibas91]:
///
///     Kinetic<DelaunayRule<Path>> triangulation(points, now);
///     Kinetic<VoronoiCellsRule<Path>> cells(triangulation, now);
///     cells.rule().cell(id, points, now)
///
/// or on a periodic one, VoronoiCellsRule<Path, PeriodicDelaunayRule<Path>>, where neighbours are copies of points, and
/// all cells are bounded.
///
/// It reports each point whose neighbours have become others (NeighboursChange), so that other rules may stand on it.
///
/// Cost, besides that of the triangulation: no certificates and no events of its own; O(neighbours) for each corner of
/// a triangle that changes, of which a flip has four. All events that it follows are external. Memory: two ids for
/// each neighbour.
///
/// If four or more points stay on one circle, two of them that the triangulation joins are neighbours, and the side
/// between them may have the length 0. Points that stay in one place share a cell. While all points stay on one line
/// nothing is known (DelaunayRule::flat).
template <class Path, class Delaunay = DelaunayRule<Path>>
class VoronoiCellsRule : public StandsOn<Telling<Delaunay, TriangleChange>> {
 public:
  static constexpr const char* name = "VoronoiCells";
  using Element = Path;
  using Change = NeighboursChange;
  /// An id; or a VertexCopy, displaced against vertex(id) itself (PeriodicDelaunayRule::vertex).
  using Neighbour = typename Delaunay::Corner;
  using Pen = RepairOf<VoronoiCellsRule>;

  /// Counter-clockwise; of an unbounded cell those on the hull are the first and the last, of a bounded one the lowest
  /// id is the first, or the lowest of its copies. Empty if the point is not there, or nothing is known. O(1).
  const std::vector<Neighbour>& neighbours(Id id) const {
    const Id vertex = this->inner().vertex(id);
    return vertex < around_.size() ? around_[vertex].neighbours : nowhere_.neighbours;
  }
  /// Whether the cell has an end in all directions. Precondition: it has neighbours.
  bool bounded(Id id) const { return around_[this->inner().vertex(id)].bounded; }

  /// At a time t, not before the last event or after the next one of the triangulation. Vertices are computed in
  /// double-doubles relative to the point and rounded; where a triangle is flat at t itself its vertex is infinitely
  /// far, and so not finite. Throws std::out_of_range if there is no such point, or nothing is known of it. Not for
  /// samples. Of points that share a vertex it is the cell of that. O(neighbours).
  VoronoiCell cell(Id id, const MovingSet<Path>& points, double t) const;

  std::monostate certificate(Slot /*slot*/, const MovingSet<Path>& /*elements*/) const { return {}; }
  std::array<Id, 0> members(Slot /*slot*/) const { return {}; }
  Effect repair(Slot /*slot*/, Pen& /*repair*/) { return Effect::internal; }
  Effect follow(std::span<const TriangleChange> changes, Pen& repair);
  std::vector<NeighboursChange> changes_from_nothing() const {
    std::vector<NeighboursChange> changes;
    for (Id id = 0; id < around_.size(); ++id) {
      if (!around_[id].neighbours.empty()) changes.push_back({id});
    }
    return changes;
  }

  void audit(const MovingSet<Path>& /*elements*/, double /*now*/) const {
    corners_.audit(this->inner().mesh(), origin_of());
    for (Id id = 0; id < std::max<std::size_t>(around_.size(), this->inner().mesh().end_vertex()); ++id) {
      if ((id < around_.size() ? around_[id] : nowhere_) != look(id)) {
        throw AuditFailure(name + (": point " + std::to_string(id)) + ": has other neighbours");
      }
    }
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(around_, corners_);
  }

 private:
  struct Around {
    std::vector<Neighbour> neighbours;
    bool bounded = true;

    friend bool operator==(const Around&, const Around&) = default;
    template <class Archive>
    void archive(Archive& archive) {
      archive(neighbours, bounded);
    }
  };

  auto origin_of() const {
    return [this](TriangleMesh::Edge h) { return this->inner().mesh().origin(h); };
  }
  /// The neighbours of a point in the triangulation.
  Around look(Id id) const;
  bool take_up(Id id, Pen& repair);

  std::vector<Around> around_;  ///< by vertex
  Around nowhere_;
  PartsOfTriangles corners_;
};

// ---------------------------------------------------------------------------------------------------------------

namespace detail {

/// Relative to a point from which a and b are seen: the centre of the circle through the three.
template <class Path>
std::array<double, 2> circle_centre(const Path& from, const Path& a, const Path& b, double t) {
  const auto relative = [&](const Path& to, int axis) {
    return extended_difference(to.axis(axis), from.axis(axis), t).middle;
  };
  const DoubleDouble ux = relative(a, 0), uy = relative(a, 1), vx = relative(b, 0), vy = relative(b, 1);
  const DoubleDouble u = ux * ux + uy * uy, v = vx * vx + vy * vy, area = (ux * vy - uy * vx) * 2.0;
  // Divided in doubles, so that a flat triangle gives infinity.
  return {static_cast<double>(vy * u - uy * v) / static_cast<double>(area),
          static_cast<double>(ux * v - vx * u) / static_cast<double>(area)};
}

}  // namespace detail

template <class Path, class Delaunay>
VoronoiCell VoronoiCellsRule<Path, Delaunay>::cell(Id id, const MovingSet<Path>& points, double t) const {
  if (neighbours(id).empty()) {
    throw std::out_of_range(std::string(name) + ": nothing is known of a point " + std::to_string(id));
  }
  const Id vertex = this->inner().vertex(id);
  const auto& around = neighbours(vertex);
  const auto place = [&](const Neighbour& neighbour) -> decltype(auto) {
    return this->inner().place(neighbour, points);
  };
  VoronoiCell cell{{}, {}, bounded(vertex)};
  const std::size_t n = around.size();
  for (const Neighbour& neighbour : around) cell.neighbours.push_back(id_of(neighbour));
  for (std::size_t i = 0; i < (cell.bounded ? n : n - 1); ++i) {
    const auto centre =
        detail::circle_centre(place(Neighbour{vertex}), place(around[i]), place(around[(i + 1) % n]), t);
    cell.vertices.push_back({points[vertex].axis(0)(t) + centre[0], points[vertex].axis(1)(t) + centre[1]});
  }
  if (!cell.bounded) {  // outwards, at right angles to the edges of the hull, which has the points on its left
    const auto outwards = [&](const Neighbour& from, const Neighbour& to) {
      const auto& p = place(from);
      const auto& q = place(to);
      return VoronoiCell::Vector{static_cast<double>(extended_difference(q.axis(1), p.axis(1), t).middle),
                                 static_cast<double>(extended_difference(p.axis(0), q.axis(0), t).middle)};
    };
    cell.directions = {outwards(Neighbour{vertex}, around.front()), outwards(around.back(), Neighbour{vertex})};
  }
  return cell;
}

template <class Path, class Delaunay>
auto VoronoiCellsRule<Path, Delaunay>::look(Id id) const -> Around {
  Around around;
  if (!this->inner().mesh().contains(id)) return around;
  std::vector<Neighbour>& all = around.neighbours;
  this->inner().mesh().for_each_from(id, [&](TriangleMesh::Edge h) { all.push_back(this->inner().corners(h)[1]); });
  std::reverse(all.begin(), all.end());
  const auto at_infinity = std::find_if(all.begin(), all.end(), Delaunay::at_infinity);
  around.bounded = at_infinity == all.end();
  std::rotate(all.begin(), around.bounded ? std::min_element(all.begin(), all.end()) : at_infinity, all.end());
  if (!around.bounded) all.erase(all.begin());
  return around;
}

/// Looks at a point again. Returns whether its neighbours have changed.
template <class Path, class Delaunay>
bool VoronoiCellsRule<Path, Delaunay>::take_up(Id id, Pen& repair) {
  if (id >= around_.size()) around_.resize(id + std::size_t{1});
  const Around before = std::exchange(around_[id], look(id));
  if (around_[id] == before) return false;
  repair.report({id});
  return true;
}

template <class Path, class Delaunay>
Effect VoronoiCellsRule<Path, Delaunay>::follow(std::span<const TriangleChange> changes, Pen& repair) {
  bool other = false;
  for (const Id id : corners_.take_up(changes, this->inner().mesh(), origin_of())) other = take_up(id, repair) || other;
  return other ? Effect::external : Effect::internal;
}

}  // namespace kds::structures
