// Delaunay triangulation of a plane that repeats itself, at an instant: insertion, removal and flips.
#pragma once

#include "structures/periodic_mesh.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace kds::structures {

/// Edits a PeriodicMesh as Lawson edits the mesh of a plane that does not repeat itself; there is no hull here.
/// Predicates: orientation, in_circle and same of VertexCopy (PeriodicPredicates). Papers: [Lawson77] flips, which end
/// in a Delaunay triangulation of a torus too [Bobenko07]; [Guibas85] insertion; [Devillers02] walking.
///
/// Law: triangles have positive area.
///
/// Cost: as Lawson.
template <class Predicates>
class PeriodicLawson {
 public:
  using Edge = PeriodicMesh::Edge;

  /// A place in the mesh: a half-edge of the triangle, its origin displaced by `at`.
  struct Place {
    Edge edge;
    PeriodOffset at;
  };
  /// What has become of a point that was to be inserted.
  struct Found {
    bool same;          ///< whether a vertex is and stays at the same place: then the point has not been inserted
    VertexCopy vertex;  ///< if `same`, that vertex
  };

  /// `touched` collects the triangles that have changed, `changed` the edges that have come, gone or been flipped.
  PeriodicLawson(PeriodicMesh& mesh, const Predicates& predicates, std::vector<std::uint32_t>& touched,
                 std::vector<PeriodicMesh::Number>& changed)
      : mesh_(mesh), is_(predicates), touched_(touched), changed_(changed) {}

  /// Inserts a vertex, looking for its place from the half-edge `near`, whose origin is displaced by `at` against the
  /// point. Precondition: the mesh is not empty.
  Found insert(Id vertex, Edge near, const PeriodOffset& at) {
    const VertexCopy point{vertex, {}};
    const Place place = locate(point, {near, at});
    for (const VertexCopy& corner : mesh_.corners(place.edge, place.at)) {
      if (is_.same(corner, point)) return {true, corner};
    }
    const Edge first = place.edge - place.edge % 3;
    const PeriodOffset first_at = go_to(place, first).at;
    std::vector<Edge> edges;
    for (const Edge h : mesh_.split(first / 3, vertex, -first_at)) {
      touched_.push_back(h / 3);
      changed_.push_back(mesh_.edge(PeriodicMesh::next(h)));
      edges.push_back(h);
    }
    legalise(std::move(edges));
    return {false, point};
  }

  /// Removes a vertex that is not the only one; false if the mesh has to be built anew: the vertex is joined to itself.
  bool remove(Id vertex) {
    if (mesh_.connected(vertex, vertex)) return false;
    while (mesh_.valence(vertex) > 3) {
      Edge victim = PeriodicMesh::none;
      if (!mesh_.any_from(vertex, [&](Edge h) { return can_leave(victim = h); })) return false;
      flip(victim);
    }
    touch(vertex);
    mesh_.merge(vertex);
    std::vector<Edge> edges;  // The edges of all triangles that cover the place of the vertex now.
    for (const std::uint32_t t : touched_) {
      if (mesh_.in_use(t)) edges.insert(edges.end(), {3 * t, 3 * t + 1, 3 * t + 2});
    }
    legalise(std::move(edges));
    return true;
  }

  /// Whether the triangles around a vertex have positive area.
  bool fits(Id vertex) const {
    return !mesh_.any_from(vertex, [&](Edge h) { return area(h / 3) <= 0; });
  }

  /// Counts the edges and triangles around a vertex as changed.
  void touch(Id vertex) {
    mesh_.for_each_from(vertex, [&](Edge h) {
      touched_.push_back(h / 3);
      changed_.push_back(mesh_.edge(h));
    });
  }

  /// Flips edges around a vertex that are not legal. Precondition: the vertex fits.
  void legalise_around(Id vertex) {
    std::vector<Edge> edges;
    mesh_.for_each_from(vertex, [&](Edge h) {
      touched_.push_back(h / 3);
      edges.push_back(h);
      edges.push_back(PeriodicMesh::next(h));
    });
    legalise(std::move(edges));
  }

  /// Whether a flip leaves triangles of positive area.
  bool flippable(Edge h) const {
    const auto [a, b, c, d] = mesh_.corners_beside(h);
    return is_.orientation(a, d, c) > 0 && is_.orientation(d, b, c) > 0;
  }

  /// Throws std::range_error if the new edge is longer than an offset can express.
  void flip(Edge h) {
    const auto [a, b, c, d] = mesh_.corners_beside(h);
    require_near(d, c);
    touched_.push_back(h / 3);
    touched_.push_back(mesh_.twin(h) / 3);
    changed_.push_back(mesh_.edge(h));
    mesh_.flip(h);
  }

  /// Sign of a triangle's area.
  int area(std::uint32_t triangle) const {
    const auto [a, b, c] = mesh_.corners(3 * triangle);
    return is_.orientation(a, b, c);
  }

 private:
  /// Whether the edge may be flipped away from its origin, which is to be removed and may lie on the new edge then.
  bool can_leave(Edge h) const {
    const auto [a, b, c, d] = mesh_.corners_beside(h);
    return is_.orientation(a, d, c) >= 0 && is_.orientation(d, b, c) > 0;
  }

  static void require_near(const VertexCopy& from, const VertexCopy& to) {
    const auto far = [](std::int64_t periods) {
      return periods > certificates::farthest_offset || periods < -certificates::farthest_offset;
    };
    const PeriodOffset apart = to.offset - from.offset;
    if (!far(apart.x) && !far(apart.y)) return;
    throw std::range_error("periodic triangulation: points " + std::to_string(from.id) + " and " +
                           std::to_string(to.id) + " are more than 2^52 periods apart");
  }

  /// Flips until all edges that can be reached from these are legal.
  void legalise(std::vector<Edge> edges) {
    while (!edges.empty()) {
      const Edge h = edges.back();
      edges.pop_back();
      if (is_.in_circle(mesh_.corners_beside(h)) >= 0 || !flippable(h)) continue;
      const Edge first = h - h % 3, second = mesh_.twin(h) - mesh_.twin(h) % 3;
      flip(h);
      for (const Edge outer : {first, first + 2, second, second + 1}) edges.push_back(outer);
    }
  }

  /// The same triangle seen from another of its half-edges.
  Place go_to(const Place& place, Edge h) const {
    if (h == place.edge) return place;
    if (h == PeriodicMesh::next(place.edge)) return {h, place.at + mesh_.offset(place.edge)};
    return {h, place.at - mesh_.offset(h)};
  }

  /// A triangle that a point is in, or on the edge of. The walk ends because the triangulation is one of the plane, and
  /// because its steps are random.
  Place locate(const VertexCopy& point, Place place) const {
    std::uint32_t dice = point.id + 1;
    for (;;) {
      // A random first edge: a walk that always begins with the same one may go round in circles.
      dice = dice * 1664525u + 1013904223u;
      const Edge first = place.edge - place.edge % 3;
      bool inside = true;
      for (std::uint32_t i = 0; i < 3 && inside; ++i) {
        const Place side = go_to(place, first + ((dice >> 30) + i) % 3);
        const auto [a, b, c] = mesh_.corners(side.edge, side.at);
        if (is_.orientation(a, b, point) >= 0) continue;
        place = {mesh_.twin(side.edge), side.at + mesh_.offset(side.edge)};
        inside = false;
      }
      if (inside) return place;
    }
  }

  PeriodicMesh& mesh_;
  const Predicates& is_;
  std::vector<std::uint32_t>& touched_;
  std::vector<PeriodicMesh::Number>& changed_;
};

}  // namespace kds::structures
