// Triangles of a plane that repeats itself: a mesh of a torus, whose edges know which copies they join.
#pragma once

#include "certificates/path_copy.hpp"
#include "kds/audit.hpp"
#include "kds/framework/free_numbers.hpp"
#include "structures/triangle_mesh.hpp"

#include <algorithm>
#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace kds::structures {

using certificates::PeriodOffset;

/// One of the copies of a vertex.
struct VertexCopy {
  Id id = nobody;
  PeriodOffset offset{};

  friend auto operator<=>(const VertexCopy&, const VertexCopy&) = default;
  friend Id id_of(const VertexCopy& copy) { return copy.id; }

  template <class Archive>
  void archive(Archive& archive) {
    archive(id, offset);
  }
};

/// The corners of an edge or a triangle, displaced so that the first is the point itself. They identify it among others
/// with the same ids.
template <std::size_t N>
std::array<VertexCopy, N> in_ascending_order(std::array<VertexCopy, N> corners) {
  std::sort(corners.begin(), corners.end());
  const PeriodOffset first = corners[0].offset;
  for (VertexCopy& corner : corners) corner.offset = corner.offset - first;
  return corners;
}

/// A triangulation of the whole plane that is the same in each period, stored once. It is a TriangleMesh without a
/// vertex at infinity, and each half-edge has an offset: it leads from a copy of its origin to the copy of its target
/// that is displaced by that many periods more. So nothing depends on which copy of a vertex is the point itself, and
/// points may cross the ends of the rectangle without a change of the mesh.
///
/// Law: around a triangle offsets add up to zero; those of twins are opposite. Edges may lead from a vertex to itself,
/// several may join the same two vertices, and two triangles may share two or three edges: with one vertex there are
/// two triangles and three edges. Papers: [Bobenko07], triangulations of flat surfaces in this sense. Differs from
/// [Caroli09], who keep several copies of each point as long as there are such edges.
///
/// Edges are numbered: three for each vertex. A flip gives the new edge the number of the old one.
///
/// Cost: as TriangleMesh.
class PeriodicMesh : private TriangleMesh {
 public:
  using Number = std::uint32_t;
  using TriangleMesh::any_from;
  using TriangleMesh::apex;
  using TriangleMesh::clockwise;
  using TriangleMesh::connected;
  using TriangleMesh::contains;
  using TriangleMesh::counter_clockwise;
  using TriangleMesh::Edge;
  using TriangleMesh::empty;
  using TriangleMesh::end_triangle;
  using TriangleMesh::end_vertex;
  using TriangleMesh::finite;
  using TriangleMesh::for_each_from;
  using TriangleMesh::from;
  using TriangleMesh::in_use;
  using TriangleMesh::next;
  using TriangleMesh::none;
  using TriangleMesh::origin;
  using TriangleMesh::previous;
  using TriangleMesh::rename;
  using TriangleMesh::size;
  using TriangleMesh::target;
  using TriangleMesh::twin;
  using TriangleMesh::valence;

  const PeriodOffset& offset(Edge h) const { return offset_[h]; }
  /// The corners of a half-edge's triangle, its origin first, which is displaced by `at`.
  std::array<VertexCopy, 3> corners(Edge h, const PeriodOffset& at = {}) const {
    return {{{origin(h), at}, {target(h), at + offset_[h]}, {apex(h), at - offset_[previous(h)]}}};
  }
  /// a, b, c, d of an edge a-b between the triangles a, b, c and b, a, d.
  std::array<VertexCopy, 4> corners_beside(Edge h) const {
    const auto [a, b, c] = corners(h);
    return {a, b, c, {apex(twin(h)), offset_[next(twin(h))]}};
  }

  /// Numbers of edges are below this; not all of them need be there.
  Number end_edge() const { return static_cast<Number>(half_edge_.size()); }
  bool contains_edge(Number edge) const { return edge < end_edge() && half_edge_[edge] != none; }
  Number edge(Edge h) const { return edge_[h]; }
  /// One of an edge's two half-edges. Precondition: contains_edge(edge).
  Edge half_edge(Number edge) const { return half_edge_[edge]; }

  void clear() { *this = {}; }

  /// Begins with one vertex, whose copies are the corners of the rectangles: two triangles. Precondition: empty.
  void begin(Id vertex) {
    clear();
    create({vertex, vertex, vertex});
    create({vertex, vertex, vertex});
    join(0, 4), join(1, 5), join(2, 3);
    offset_ = {{1, 0}, {0, 1}, {-1, -1}, {1, 1}, {-1, 0}, {0, -1}};
    edge_ = {0, 1, 2, 2, 0, 1};
    half_edge_ = {0, 1, 2};
  }

  /// Puts a vertex, displaced by `at` against the first corner, into a triangle, and returns the half-edge opposite to
  /// it in each of the three triangles around it. Precondition: !contains(vertex).
  std::array<Edge, 3> split(std::uint32_t triangle, Id vertex, const PeriodOffset& at) {
    const Edge h = 3 * triangle;
    const PeriodOffset first = offset_[h], second = offset_[h + 1], third = offset_[h + 2];
    const Number second_edge = edge_[h + 1], third_edge = edge_[h + 2];
    const std::array<Edge, 3> opposite = TriangleMesh::split(triangle, vertex);
    offset_.resize(3 * std::size_t{end_triangle()});
    edge_.resize(offset_.size());
    set(opposite[1], second, second_edge);
    set(opposite[2], third, third_edge);
    // From each corner to the vertex: of the triangle at `opposite` the previous half-edge leads from the vertex there.
    const std::array from_corner{at, at - first, at + third};
    for (std::size_t i = 0; i < 3; ++i) {
      const Number edge = new_edge();
      set(previous(opposite[i]), -from_corner[i], edge);
      set(twin(previous(opposite[i])), from_corner[i], edge);
    }
    return opposite;
  }

  /// Takes out a vertex with three edges that lead to other vertices, and returns the number of the one triangle that
  /// remains.
  std::uint32_t merge(Id vertex) {
    const Edge first = from(vertex), second = clockwise(first), third = clockwise(second);
    const std::array outer{next(first), next(third), next(second)};
    std::array<PeriodOffset, 3> offsets;
    std::array<Number, 3> edges{};
    for (std::size_t i = 0; i < 3; ++i) {
      offsets[i] = offset_[outer[i]];
      edges[i] = edge_[outer[i]];
    }
    for (const Edge spoke : {first, second, third}) {
      half_edge_[edge_[spoke]] = none;
      free_edges_.give_back(edge_[spoke]);
    }
    const std::uint32_t kept = TriangleMesh::merge(vertex);
    for (Edge i = 0; i < 3; ++i) set(3 * kept + i, offsets[i], edges[i]);
    return kept;
  }

  /// Replaces the edge a-b between the triangles a, b, c and b, a, d by the edge d-c.
  void flip(Edge h) {
    const Outer before = outer_before(h), after = outer_after(h);
    const Number diagonal = edge_[h];
    const PeriodOffset d_to_c = -offset_[previous(h)] - offset_[next(twin(h))];
    std::array<PeriodOffset, 4> offsets;
    std::array<Number, 4> edges{};
    for (std::size_t i = 0; i < 4; ++i) {
      offsets[i] = offset_[before[i]];
      edges[i] = edge_[before[i]];
    }
    TriangleMesh::flip(h);
    for (std::size_t i = 0; i < 4; ++i) set(after[i], offsets[i], edges[i]);
    set(after[0] + 1, d_to_c, diagonal);
    set(after[2] + 2, -d_to_c, diagonal);
  }

  /// To be called when the point of a vertex has jumped by whole periods, so that its copies are where they were.
  void displace(Id vertex, const PeriodOffset& by) {
    for_each_from(vertex, [&](Edge h) {
      offset_[h] = offset_[h] + by;
      offset_[twin(h)] = offset_[twin(h)] - by;
    });
  }

  /// Throws AuditFailure unless it covers the plane once.
  void audit() const {
    const auto require = [](bool right, std::size_t h, const char* what) {
      if (!right) throw AuditFailure("PeriodicMesh: half-edge " + std::to_string(h) + ": " + what);
    };
    const std::size_t vertices = audit_links();
    require(size() == 2 * vertices, 0, "the triangles are not as many as on a torus");
    // Twice the area in periods, which does not depend on where the points are. Summands may wrap, the sum does not.
    std::uint64_t layers = 0;
    std::size_t half_edges = 0;
    for (Edge h = 0; h < 3 * end_triangle(); ++h) {
      if (!in_use(h / 3)) continue;
      ++half_edges;
      require(offset_[twin(h)] == -offset_[h], h, "leads elsewhere than its twin leads back");
      require(offset_[h] + offset_[next(h)] + offset_[previous(h)] == PeriodOffset{}, h, "is of no closed triangle");
      require(contains_edge(edge_[h]) && edge_[twin(h)] == edge_[h], h, "has not the number of its edge");
      require(half_edge_[edge_[h]] == h || half_edge_[edge_[h]] == twin(h), h, "its edge is another one");
      const auto u = unsigned_parts(offset_[h]), v = unsigned_parts(offset_[next(h)]);
      if (h % 3 == 0) layers += u[0] * v[1] - u[1] * v[0];
    }
    require(half_edges == 2 * (half_edge_.size() - free_edges_.size()), 0, "there are edges that no triangle has");
    require(empty() || layers == 2, 0, "the triangles do not cover the plane once");
  }

  template <class Archive>
  void archive(Archive& archive) {
    TriangleMesh::archive(archive);
    archive(offset_, edge_, half_edge_, free_edges_);
  }

 private:
  static std::array<std::uint64_t, 2> unsigned_parts(const PeriodOffset& offset) {
    return {static_cast<std::uint64_t>(offset.x), static_cast<std::uint64_t>(offset.y)};
  }

  void set(Edge h, const PeriodOffset& offset, Number edge) {
    offset_[h] = offset;
    edge_[h] = edge;
    half_edge_[edge] = h;
  }

  Number new_edge() {
    const Number edge = free_edges_.take(end_edge());
    if (edge == end_edge()) half_edge_.push_back(none);
    return edge;
  }

  std::vector<PeriodOffset> offset_;  ///< of a half-edge
  std::vector<Number> edge_;          ///< of a half-edge
  std::vector<Edge> half_edge_;       ///< of an edge; none if it is not there
  FreeNumbers free_edges_;
};

}  // namespace kds::structures
