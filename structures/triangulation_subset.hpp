// Some of the edges and triangles of a triangulation, as a rule that stands on it keeps them and tells of them.
#pragma once

#include "kds/audit.hpp"
#include "structures/triangulation_edges.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace kds::structures {

/// Edges (two corners) or triangles (three) by the numbers that they have in the triangulation, with their corners: so
/// that it can be told which has gone when its number has been given to another.
template <std::size_t Corners>
class TriangulationSubset {
 public:
  using Number = std::uint32_t;
  using Ids = std::array<Id, Corners>;
  using What = EdgeChange::What;

  bool contains(Number part) const { return part < corners_.size() && corners_[part][0] != nobody; }
  /// Precondition: contains(part).
  const Ids& corners(Number part) const { return corners_[part]; }
  /// Numbers are below this.
  Number end() const { return static_cast<Number>(corners_.size()); }

  /// The corners of each, in ascending order. O(n log n).
  std::vector<Ids> all() const {
    std::vector<Ids> result;
    for (const Ids& corners : corners_) {
      if (corners[0] != nobody) result.push_back(corners);
    }
    std::sort(result.begin(), result.end());
    return result;
  }

  /// Takes a part in, or another in its place, and calls report(What, number, corners) for the one that went and for
  /// the one that came. Whether there was one to report.
  template <class Report>
  bool put(Number part, const Ids& corners, const Report& report) {
    if (contains(part) && corners_[part] == corners) return false;
    take_out(part, report);
    if (part >= corners_.size()) corners_.resize(part + std::size_t{1}, absent());
    corners_[part] = corners;
    report(What::came, part, corners);
    return true;
  }
  template <class Report>
  bool take_out(Number part, const Report& report) {
    if (!contains(part)) return false;
    report(What::went, part, std::exchange(corners_[part], absent()));
    return true;
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(corners_);
  }

 private:
  static constexpr Ids absent() {
    Ids none{};
    none.fill(nobody);
    return none;
  }

  std::vector<Ids> corners_;
};

/// Remembers the edges of each triangle, and so knows for triangles that change which edges that concerns: those that
/// they had and those that they have. All these have other triangles beside them, or are gone.
class EdgesOfTriangles {
 public:
  using Number = TriangulationEdges::Number;

  /// The edges that changes concern, each once, in ascending order. To be called once for all changes of a call.
  const std::vector<Number>& take_up(std::span<const TriangleChange> changes, const TriangleMesh& mesh,
                                     const TriangulationEdges& edges) {
    concerned_.clear();
    of_.resize(std::max<std::size_t>(of_.size(), 3 * std::size_t{mesh.end_triangle()}), TriangulationEdges::none);
    for (const TriangleChange& change : changes) {
      const bool there = change.triangle < mesh.end_triangle() && mesh.in_use(change.triangle);
      for (TriangleMesh::Edge h = 3 * change.triangle; h < 3 * change.triangle + 3; ++h) {
        const Number now = there ? edges.of(h) : TriangulationEdges::none;
        concerned_.push_back(std::exchange(of_[h], now));
        concerned_.push_back(now);
      }
    }
    std::sort(concerned_.begin(), concerned_.end());
    concerned_.erase(std::unique(concerned_.begin(), concerned_.end()), concerned_.end());
    if (!concerned_.empty() && concerned_.back() == TriangulationEdges::none) concerned_.pop_back();
    return concerned_;
  }

  /// Throws AuditFailure unless it knows the edges of all triangles.
  void audit(const TriangleMesh& mesh, const TriangulationEdges& edges) const {
    for (TriangleMesh::Edge h = 0; h < std::max<std::size_t>(of_.size(), 3 * std::size_t{mesh.end_triangle()}); ++h) {
      const bool there = h / 3 < mesh.end_triangle() && mesh.in_use(h / 3);
      if ((h < of_.size() ? of_[h] : TriangulationEdges::none) != (there ? edges.of(h) : TriangulationEdges::none)) {
        throw AuditFailure("EdgesOfTriangles: half-edge " + std::to_string(h) + ": is taken for another edge");
      }
    }
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(of_);
  }

 private:
  std::vector<Number> of_;  ///< by half-edge
  std::vector<Number> concerned_;
};

}  // namespace kds::structures
