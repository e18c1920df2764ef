// Kinetic Voronoi cells in the plane.
#pragma once

#include "kds/audit.hpp"
#include "kds/motion.hpp"
#include "structures/delaunay.hpp"

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

/// A point has got other neighbours, come, gone, or its cell has become bounded or unbounded.
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
/// It reports each point whose neighbours have become others (NeighboursChange), so that other rules may stand on it.
///
/// Cost, besides that of the triangulation: no certificates and no events of its own; O(neighbours) for each corner of
/// a triangle that changes, of which a flip has four. All events that it follows are external. Memory: an id for each
/// neighbour.
///
/// If four or more points stay on one circle, two of them that the triangulation joins are neighbours, and the side
/// between them may have the length 0. Points that stay in one place share a cell. While all points stay on one line
/// nothing is known (DelaunayRule::flat).
template <class Path>
class VoronoiCellsRule : public StandsOn<DelaunayRule<Path>, TriangleChange> {
 public:
  static constexpr const char* name = "VoronoiCells";
  using Element = Path;
  using Change = NeighboursChange;
  using Pen = RepairOf<VoronoiCellsRule>;

  /// Counter-clockwise; of an unbounded cell those on the hull are the first and the last, of a bounded one the lowest
  /// id is the first. Empty if the point is not there, or nothing is known. O(1).
  const std::vector<Id>& neighbours(Id id) const {
    const Id vertex = this->inner().vertex(id);
    return vertex < around_.size() ? around_[vertex].neighbours : nowhere_.neighbours;
  }
  /// Whether the cell has an end in all directions. Precondition: it has neighbours.
  bool bounded(Id id) const { return around_[this->inner().vertex(id)].bounded; }

  /// At a time t, not before the last event or after the next one of the triangulation. Vertices are computed in
  /// double-doubles relative to the point and rounded; where a triangle is flat at t itself its vertex is infinitely
  /// far, and so not finite. Throws std::out_of_range if there is no such point, or nothing is known of it. Not for
  /// samples. O(neighbours).
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
    for (Id id = 0; id < std::max<std::size_t>(around_.size(), this->inner().mesh().end_vertex()); ++id) {
      if ((id < around_.size() ? around_[id] : nowhere_) != look(id)) {
        throw AuditFailure(name + (": point " + std::to_string(id)) + ": has other neighbours");
      }
    }
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(around_);
  }

 private:
  struct Around {
    std::vector<Id> neighbours;
    bool bounded = true;

    friend bool operator==(const Around&, const Around&) = default;
    template <class Archive>
    void archive(Archive& archive) {
      archive(neighbours, bounded);
    }
  };

  /// What the triangulation says of a point.
  Around look(Id id) const;
  bool take_up(Id id, Pen& repair);

  std::vector<Around> around_;  ///< by vertex
  Around nowhere_;
  std::vector<Id> gone_;
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

template <class Path>
VoronoiCell VoronoiCellsRule<Path>::cell(Id id, const MovingSet<Path>& points, double t) const {
  if (neighbours(id).empty()) {
    throw std::out_of_range(std::string(name) + ": nothing is known of a point " + std::to_string(id));
  }
  VoronoiCell cell{neighbours(id), {}, bounded(id)};
  const Path& at = points[id];
  const std::size_t n = cell.neighbours.size();
  for (std::size_t i = 0; i < (cell.bounded ? n : n - 1); ++i) {
    const auto centre = detail::circle_centre(at, points[cell.neighbours[i]], points[cell.neighbours[(i + 1) % n]], t);
    cell.vertices.push_back({at.axis(0)(t) + centre[0], at.axis(1)(t) + centre[1]});
  }
  if (!cell.bounded) {  // outwards, at right angles to the edges of the hull, which has the points on its left
    const auto outwards = [t](const Path& from, const Path& to) {
      return VoronoiCell::Vector{static_cast<double>(extended_difference(to.axis(1), from.axis(1), t).middle),
                                 static_cast<double>(extended_difference(from.axis(0), to.axis(0), t).middle)};
    };
    cell.directions = {outwards(at, points[cell.neighbours.front()]), outwards(points[cell.neighbours.back()], at)};
  }
  return cell;
}

template <class Path>
auto VoronoiCellsRule<Path>::look(Id id) const -> Around {
  const TriangleMesh& mesh = this->inner().mesh();
  Around around;
  if (!mesh.contains(id)) return around;
  std::vector<Id>& ids = around.neighbours;
  TriangleMesh::Edge h = mesh.from(id);
  do {
    ids.push_back(mesh.target(h));
    h = mesh.counter_clockwise(h);
  } while (h != mesh.from(id));
  const auto at_infinity = std::find(ids.begin(), ids.end(), TriangleMesh::infinite);
  around.bounded = at_infinity == ids.end();
  std::rotate(ids.begin(), around.bounded ? std::min_element(ids.begin(), ids.end()) : at_infinity, ids.end());
  if (!around.bounded) ids.erase(ids.begin());
  return around;
}

/// Whether its neighbours are others.
template <class Path>
bool VoronoiCellsRule<Path>::take_up(Id id, Pen& repair) {
  if (id >= around_.size()) around_.resize(id + std::size_t{1});
  Around before = std::exchange(around_[id], look(id));
  if (around_[id] == before) return false;
  repair.report({id});
  for (const Id other : before.neighbours) {  // one that has left the triangulation is no corner of any triangle
    if (!this->inner().mesh().contains(other)) gone_.push_back(other);
  }
  return true;
}

template <class Path>
Effect VoronoiCellsRule<Path>::follow(std::span<const TriangleChange> changes, Pen& repair) {
  bool other = false;
  const TriangleMesh& mesh = this->inner().mesh();
  gone_.clear();
  for (const TriangleChange& change : changes) {
    if (change.triangle >= mesh.end_triangle() || !mesh.in_use(change.triangle)) continue;
    for (TriangleMesh::Edge h = 3 * change.triangle; h < 3 * change.triangle + 3; ++h) {
      if (mesh.origin(h) != TriangleMesh::infinite) other = take_up(mesh.origin(h), repair) || other;
    }
  }
  for (std::size_t i = 0; i < gone_.size(); ++i) other = take_up(gone_[i], repair) || other;
  for (Id id = 0; id < around_.size() && this->inner().flat(); ++id) other = take_up(id, repair) || other;
  return other ? Effect::external : Effect::internal;
}

}  // namespace kds::structures
