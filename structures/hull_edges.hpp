// The edges of a kinetic convex hull as things that come and go.
#pragma once

#include "kds/audit.hpp"
#include "kds/framework/kinetic.hpp"
#include "structures/convex_hull.hpp"
#include "structures/hull_headings.hpp"
#include "structures/triangulation_edges.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace kds::structures {

/// An edge of a convex hull has come or gone, or one of its ends has got a new motion.
struct HullEdgeChange {
  enum class What : std::uint8_t { came, went, moved };  ///< moved: an end has got a new motion
  What what;
  Id from, to;  ///< counter-clockwise

  friend bool operator==(const HullEdgeChange&, const HullEdgeChange&) = default;
};

/// Keeps the hull of moving points as a ring, edge by edge, and tells which edges come and go (HullEdgeChange), so that
/// rules about the hull may stand on it. It stands on a convex hull, or on a Delaunay triangulation,
/// HullEdgesRule<Path, DelaunayRule<Path>>, which has the same hull:
///
///     Kinetic<ConvexHullRule<Path>> hull(points, now);
///     Kinetic<HullEdgesRule<Path>> edges(hull, now);
///
/// Points that stay on an edge of the hull divide it. While all points stay on one line there is no hull (flat()).
///
/// Cost, besides that of the triangulation: no certificates; O(k log k) for k triangles that change. Events that it
/// follows are external if an edge comes or goes. Memory: two ids for each triangle and each point.
template <class Path, class Triangulation = ConvexHullRule<Path>>
class HullEdgesRule : public StandsOn<Telling<Triangulation, TriangleChange>> {
 public:
  static constexpr const char* name = "HullEdges";
  using Element = Path;
  using Change = HullEdgeChange;
  using Pen = Repair<Path, Change>;

  /// Whether an edge leads on from this point: whether it is on the hull.
  bool contains(Id from) const { return next(from) != nobody; }
  /// The points after it and before it, counter-clockwise; nobody if it is not on the hull.
  Id next(Id from) const { return from < ring_.size() ? ring_[from].next : nobody; }
  Id previous(Id to) const { return to < ring_.size() ? ring_[to].previous : nobody; }

  std::monostate certificate(Slot /*slot*/, const MovingSet<Path>& /*elements*/) const { return {}; }
  std::array<Id, 0> members(Slot /*slot*/) const { return {}; }
  Effect repair(Slot /*slot*/, Pen& /*repair*/) { return Effect::internal; }

  Effect follow(std::span<const TriangleChange> changes, Pen& repair);
  /// Its edges have been followed already: only that they move otherwise is left to tell.
  void change(Id id, Pen& repair) {
    if (!contains(id)) return;
    repair.report({HullEdgeChange::What::moved, previous(id), id});
    repair.report({HullEdgeChange::What::moved, id, next(id)});
  }
  std::vector<HullEdgeChange> changes_from_nothing() const {
    std::vector<HullEdgeChange> changes;
    for (Id id = 0; id < ring_.size(); ++id) {
      if (contains(id)) changes.push_back({HullEdgeChange::What::came, id, next(id)});
    }
    return changes;
  }

  void audit(const MovingSet<Path>& /*elements*/, double /*now*/) const;

  template <class Archive>
  void archive(Archive& archive) {
    archive(ring_, edge_of_);
  }

 private:
  using Edge = std::array<Id, 2>;
  static constexpr Edge no_edge{nobody, nobody};
  struct Beside {
    Id next = nobody, previous = nobody;
  };

  /// The edge of the hull that a triangle is at; no_edge if it is finite, or not in use.
  Edge look(std::uint32_t triangle) const {
    const TriangleMesh& mesh = this->inner().mesh();
    const bool at_hull = triangle < mesh.end_triangle() && mesh.in_use(triangle) && !mesh.finite(triangle);
    return at_hull ? HullHeadings::edge(mesh, triangle) : no_edge;
  }
  /// Of two lists of edges, tells of those that are only in the first.
  static bool tell_difference(const std::vector<Edge>& these, const std::vector<Edge>& those, HullEdgeChange::What what,
                              std::vector<Edge>& difference, Pen& repair) {
    difference.clear();
    std::set_difference(these.begin(), these.end(), those.begin(), those.end(), std::back_inserter(difference));
    for (const auto& [from, to] : difference) repair.report({what, from, to});
    return !difference.empty();
  }

  std::vector<Beside> ring_;   ///< by point
  std::vector<Edge> edge_of_;  ///< by triangle; no_edge of one that is not at the hull
  std::vector<Edge> old_, new_, went_, came_;
};

// ---------------------------------------------------------------------------------------------------------------

/// An edge may come to be at a triangle of another number: then it has neither come nor gone.
template <class Path, class Triangulation>
Effect HullEdgesRule<Path, Triangulation>::follow(std::span<const TriangleChange> changes, Pen& repair) {
  old_.clear();
  new_.clear();
  edge_of_.resize(std::max<std::size_t>(edge_of_.size(), this->inner().mesh().end_triangle()), no_edge);
  for (const auto& [triangle] : changes) {
    const Edge now = look(triangle), before = std::exchange(edge_of_[triangle], now);
    if (now == before) continue;  // also if the triangle has been named before
    if (before != no_edge) old_.push_back(before);
    if (now != no_edge) new_.push_back(now);
  }
  std::sort(old_.begin(), old_.end());
  std::sort(new_.begin(), new_.end());
  const bool some_went = tell_difference(old_, new_, HullEdgeChange::What::went, went_, repair);
  const bool some_came = tell_difference(new_, old_, HullEdgeChange::What::came, came_, repair);
  for (const auto& [from, to] : went_) ring_[from].next = ring_[to].previous = nobody;
  for (const auto& [from, to] : came_) {
    if (std::max(from, to) >= ring_.size()) ring_.resize(std::max(from, to) + std::size_t{1});
    ring_[from].next = to;
    ring_[to].previous = from;
  }
  return some_went || some_came ? Effect::external : Effect::internal;
}

template <class Path, class Triangulation>
void HullEdgesRule<Path, Triangulation>::audit(const MovingSet<Path>& /*elements*/, double /*now*/) const {
  const auto require = [](bool right, Id id, const char* what) {
    if (!right) throw AuditFailure(name + (": id " + std::to_string(id)) + ": " + what);
  };
  std::size_t edges = 0;
  for (std::uint32_t t = 0; t < std::max<std::size_t>(edge_of_.size(), this->inner().mesh().end_triangle()); ++t) {
    const Edge known = t < edge_of_.size() ? edge_of_[t] : no_edge;
    require(known == look(t), known[0], "the edge of a triangle is another");
    if (known == no_edge) continue;
    ++edges;
    require(next(known[0]) == known[1] && previous(known[1]) == known[0], known[0], "its neighbours are others");
  }
  for (Id id = 0; id < ring_.size(); ++id) edges -= contains(id);
  require(edges == 0, nobody, "there are other edges");
}

}  // namespace kds::structures
