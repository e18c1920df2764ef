// Some of the edges or triangles of a triangulation, which a rule that stands on it keeps and reports.
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

/// A corner of a triangulation is a point, or a copy of one (VertexCopy in periodic_mesh.hpp).
inline Id id_of(Id corner) { return corner; }
template <std::size_t N>
std::array<Id, N> in_ascending_order(std::array<Id, N> corners) {
  std::sort(corners.begin(), corners.end());
  return corners;
}

/// Edges (two corners) or triangles (three) by the numbers that they have in the triangulation, with their corners in
/// ascending order: these tell which one has gone when its number has been given to another.
template <std::size_t Corners, class Corner = Id>
class TriangulationSubset {
 public:
  using Number = std::uint32_t;
  using Ids = std::array<Id, Corners>;
  using Part = std::array<Corner, Corners>;
  using What = EdgeChange::What;

  bool contains(Number part) const { return part < parts_.size() && id_of(parts_[part].corners[0]) != nobody; }
  /// Whether it contains just this part under this number.
  bool contains(Number part, const Part& corners) const { return contains(part) && parts_[part].corners == corners; }
  /// Precondition: contains(part).
  Ids ids(Number part) const {
    Ids ids;
    std::transform(parts_[part].corners.begin(), parts_[part].corners.end(), ids.begin(),
                   [](const Corner& corner) { return id_of(corner); });
    return ids;
  }
  /// Numbers are below this.
  Number end() const { return static_cast<Number>(parts_.size()); }

  /// The corners of each, in ascending order. O(n log n).
  std::vector<Ids> all() const {
    std::vector<Ids> result;
    for (Number part = 0; part < end(); ++part) {
      if (contains(part)) result.push_back(ids(part));
    }
    std::sort(result.begin(), result.end());
    return result;
  }

  /// Adds a part, or puts it in the place of another, and calls report(What, number, ids) for the part that went and
  /// for the one that came. Returns whether there was a change to report.
  template <class Report>
  bool put(Number part, const Part& corners, const Report& report) {
    if (contains(part, corners)) return false;
    take_out(part, report);
    if (part >= parts_.size()) parts_.resize(part + std::size_t{1}, absent());
    parts_[part] = {corners};
    report(What::came, part, ids(part));
    return true;
  }
  template <class Report>
  bool take_out(Number part, const Report& report) {
    if (!contains(part)) return false;
    const Ids gone = ids(part);
    parts_[part] = absent();
    report(What::went, part, gone);
    return true;
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(parts_);
  }

 private:
  struct Entry {
    Part corners;

    template <class Archive>
    void archive(Archive& archive) {
      for (Corner& corner : corners) archive(corner);
    }
  };
  static Entry absent() {
    Entry none;
    none.corners.fill(Corner{nobody});
    return none;
  }

  std::vector<Entry> parts_;
};

/// Remembers the edges, or the corners, of each triangle. So it knows which of these a change of triangles concerns:
/// those that the triangles had and those that they have. All other edges have the same triangles beside them, and all
/// other points the same triangles around them.
///
/// `of(h)` gives the number of the edge of a half-edge, or the id of its origin; `none` where there is none.
class PartsOfTriangles {
 public:
  using Number = std::uint32_t;
  static constexpr Number none = TriangulationEdges::none;
  static_assert(none == TriangleMesh::infinite);

  /// The parts that changes concern, each once, in ascending order. To be called once for all changes of a call.
  template <class Mesh, class Of>
  const std::vector<Number>& take_up(std::span<const TriangleChange> changes, const Mesh& mesh, const Of& of) {
    concerned_.clear();
    known_.resize(std::max<std::size_t>(known_.size(), 3 * std::size_t{mesh.end_triangle()}), none);
    for (const TriangleChange& change : changes) {
      const bool there = change.triangle < mesh.end_triangle() && mesh.in_use(change.triangle);
      for (TriangleMesh::Edge h = 3 * change.triangle; h < 3 * change.triangle + 3; ++h) {
        const Number now = there ? of(h) : none;
        concerned_.push_back(std::exchange(known_[h], now));
        concerned_.push_back(now);
      }
    }
    std::sort(concerned_.begin(), concerned_.end());
    concerned_.erase(std::unique(concerned_.begin(), concerned_.end()), concerned_.end());
    if (!concerned_.empty() && concerned_.back() == none) concerned_.pop_back();
    return concerned_;
  }

  /// Throws AuditFailure unless it knows the parts of all triangles.
  template <class Mesh, class Of>
  void audit(const Mesh& mesh, const Of& of) const {
    for (TriangleMesh::Edge h = 0; h < std::max<std::size_t>(known_.size(), 3 * std::size_t{mesh.end_triangle()});
         ++h) {
      const bool there = h / 3 < mesh.end_triangle() && mesh.in_use(h / 3);
      if ((h < known_.size() ? known_[h] : none) != (there ? of(h) : none)) {
        throw AuditFailure("PartsOfTriangles: half-edge " + std::to_string(h) + ": is taken for another");
      }
    }
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(known_);
  }

 private:
  std::vector<Number> known_;  ///< by half-edge
  std::vector<Number> concerned_;
};

}  // namespace kds::structures
