// Certificates that prove that the hull of a triangulation goes round only once.
#pragma once

#include "structures/plane_predicates.hpp"
#include "structures/triangle_mesh.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace kds::structures {

/// Stores the heading of each edge of the hull, counter-clockwise: to the right or to the left; up or down if it stays
/// vertical. A closed polygon that turns left at each of its vertices is convex if and only if its edges form one
/// stretch that leads forward (right, or up) and one that leads back: otherwise it goes round more than once, like a
/// pentagram.
class HullHeadings {
 public:
  /// The edge of the hull that an infinite triangle is at, counter-clockwise.
  static std::array<Id, 2> edge(const TriangleMesh& mesh, std::uint32_t t) {
    TriangleMesh::Edge h = 3 * t;
    while (mesh.apex(h) != TriangleMesh::infinite) ++h;
    return {mesh.target(h), mesh.origin(h)};
  }

  /// Updates the heading of an infinite triangle's hull edge. O(1).
  template <class Path>
  void find(const TriangleMesh& mesh, std::uint32_t t, const PlanePredicates<Path>& is) {
    if (heading_.size() <= t) heading_.resize(mesh.end_triangle(), Heading::none);
    const auto [from, to] = edge(mesh, t);
    const int right = is.order(from, to, along_x);
    if (right != 0) {
      heading_[t] = right > 0 ? Heading::right : Heading::left;
    } else {
      heading_[t] = is.order(from, to, along_y) > 0 ? Heading::up : Heading::down;
    }
  }

  /// The certificate that the edge keeps its heading.
  template <class Path>
  certificates::DirectionOrder<Path, 2> certificate(const TriangleMesh& mesh, std::uint32_t t,
                                                    const MovingSet<Path>& x) const {
    const auto [from, to] = edge(mesh, t);
    const bool upright = heading_[t] == Heading::up || heading_[t] == Heading::down;
    const bool forward = is_forward(t);
    return {x[forward ? from : to], x[forward ? to : from], upright ? along_y : along_x};
  }

  /// Decided by the stored headings. O(points of the hull), no arithmetic.
  bool go_round_once(const TriangleMesh& mesh) const {
    int changes = 0;
    const TriangleMesh::Edge first = mesh.from(TriangleMesh::infinite);
    TriangleMesh::Edge h = first;
    do {
      const TriangleMesh::Edge next = mesh.clockwise(h);
      changes += is_forward(h / 3) != is_forward(next / 3);
      h = next;
    } while (h != first);
    return changes == 2;
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(heading_);
  }

 private:
  enum class Heading : std::int8_t { none, right, left, up, down };

  bool is_forward(std::uint32_t t) const { return heading_[t] == Heading::right || heading_[t] == Heading::up; }

  std::vector<Heading> heading_;  ///< of an infinite triangle
};

}  // namespace kds::structures
