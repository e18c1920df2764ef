// Delaunay triangulation at an instant: insertion, removal and flips, decided by signs.
#pragma once

#include "structures/triangle_mesh.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace kds::structures {

/// Edits a mesh that is the Delaunay triangulation of its vertices, or any triangulation of them.
///
/// Predicates: orientation(a, b, c) > 0 if a, b, c turn counter-clockwise; in_circle(a, b, c, d) < 0 if d is inside the
/// circle through a, b, c; same(a, b) if the two stay one point. The signs are exact and those of one instant; 0 means
/// that the points stay degenerate. Papers: [Lawson77] flips, [Guibas85] insertion, [Devillers02] walking.
///
/// Law: triangles have positive area; a vertex on an edge of the hull is a vertex of the hull.
///
/// Cost: insertion O(1) expected flips for points in random order, after a walk of O(sqrt n); removal O(k^2) for k
/// edges.
template <class Predicates>
class Lawson {
 public:
  using Edge = TriangleMesh::Edge;
  static constexpr Id infinite = TriangleMesh::infinite;

  /// `touched` collects the triangles that have changed.
  Lawson(TriangleMesh& mesh, const Predicates& predicates, std::vector<std::uint32_t>& touched)
      : mesh_(mesh), is_(predicates), touched_(touched) {}

  /// Begins a mesh with three of the ids that are not on one line; false if there are none. O(n).
  bool begin(const std::vector<Id>& ids) {
    for (std::size_t i = 1; i < ids.size(); ++i) {
      if (is_.same(ids[0], ids[i])) continue;
      for (std::size_t j = i + 1; j < ids.size(); ++j) {
        const int side = is_.orientation(ids[0], ids[i], ids[j]);
        if (side == 0) continue;
        mesh_.begin(ids[0], ids[side > 0 ? i : j], ids[side > 0 ? j : i]);
        for (std::uint32_t t = 0; t < 4; ++t) touched_.push_back(t);
        return true;
      }
      return false;
    }
    return false;
  }

  /// Inserts a vertex, looking for its place from the triangle `near`, and returns `nobody`. If the mesh has a vertex
  /// that stays the same point, returns that and inserts nothing. Precondition: the mesh is not empty.
  Id insert(Id vertex, std::uint32_t near) {
    const std::uint32_t place = locate(vertex, near);
    for (Edge h = 3 * place; h < 3 * place + 3; ++h) {
      if (mesh_.origin(h) != infinite && is_.same(mesh_.origin(h), vertex)) return mesh_.origin(h);
    }
    std::vector<Edge> edges;
    for (const Edge h : mesh_.split(place, vertex)) {
      touched_.push_back(h / 3);
      edges.push_back(h);
    }
    legalise(std::move(edges));
    return nobody;
  }

  /// Removes a vertex; false, with an invalid mesh, if it has to be built anew: fewer than three vertices would remain,
  /// or all that remain are on one line.
  bool remove(Id vertex) {
    while (mesh_.valence(vertex) > 3) {
      Edge victim = TriangleMesh::none;
      const bool has_ear = mesh_.any_from(vertex, [&](Edge h) {
        victim = h;
        return mesh_.apex(h) != infinite && mesh_.apex(mesh_.twin(h)) != infinite && mesh_.target(h) != infinite &&
               flippable(h);
      });
      // A vertex of the hull: vertices behind it become part of the hull.
      const bool found = has_ear || mesh_.any_from(vertex, [&](Edge h) {
        victim = h;
        return mesh_.apex(h) == infinite && !mesh_.connected(mesh_.apex(mesh_.twin(h)), infinite);
      });
      if (!found) return false;
      flip(victim);
    }
    if (mesh_.size() < 6) return false;
    mesh_.for_each_from(vertex, [&](Edge h) { touched_.push_back(h / 3); });
    mesh_.merge(vertex);
    bool solid = false;
    for (std::uint32_t t = 0; t < mesh_.end_triangle() && !solid; ++t) solid = mesh_.in_use(t) && mesh_.finite(t);
    if (!solid) return false;
    std::vector<Edge> edges;  // The edges of all triangles that cover the place of the vertex now.
    for (const std::uint32_t t : touched_) {
      if (mesh_.in_use(t)) edges.insert(edges.end(), {3 * t, 3 * t + 1, 3 * t + 2});
    }
    legalise(std::move(edges));
    return true;
  }

  /// Whether the triangles around a vertex have positive area, and the hull turns left there.
  bool fits(Id vertex) const {
    return !mesh_.any_from(vertex, [&](Edge h) {
      if (mesh_.finite(h / 3)) return area(h / 3) <= 0;
      for (Edge e = h - h % 3; e < h - h % 3 + 3; ++e) {
        const bool infinite_edge = mesh_.origin(e) == infinite || mesh_.target(e) == infinite;
        if (infinite_edge && edge(e) <= 0) return true;
      }
      return false;
    });
  }

  /// Flips edges around a vertex that are not legal. Precondition: the vertex fits.
  void legalise_around(Id vertex) {
    std::vector<Edge> edges;
    mesh_.for_each_from(vertex, [&](Edge h) {
      touched_.push_back(h / 3);
      edges.push_back(h);
      edges.push_back(TriangleMesh::next(h));
    });
    legalise(std::move(edges));
  }

  /// Sign of the certificate of an edge: that it is Delaunay, or, at the hull, that the points inside lie inside and
  /// that the hull turns left. It is 0 if the apex of a hull edge stays on the edge.
  int edge(Edge h) const {
    const auto [a, b, c, d] = corners(h);
    if (a == infinite) return is_.orientation(c, b, d);
    if (b == infinite) return is_.orientation(d, a, c);
    if (c == infinite) return is_.orientation(b, a, d);
    if (d == infinite) return is_.orientation(a, b, c);
    return is_.in_circle(a, b, c, d);
  }

  /// Whether a flip leaves triangles of positive area.
  bool flippable(Edge h) const {
    const auto [a, b, c, d] = corners(h);
    if (c == infinite || d == infinite) return !mesh_.connected(c == infinite ? d : c, infinite);
    if (a == infinite || b == infinite) {
      const bool positive = a == infinite ? is_.orientation(d, b, c) > 0 : is_.orientation(a, d, c) > 0;
      return positive && !mesh_.connected(c, d);
    }
    return is_.orientation(a, d, c) > 0 && is_.orientation(d, b, c) > 0;
  }

  void flip(Edge h) {
    touched_.push_back(h / 3);
    touched_.push_back(mesh_.twin(h) / 3);
    mesh_.flip(h);
  }

  /// Sign of a triangle's area. Precondition: it is finite.
  int area(std::uint32_t triangle) const {
    const Edge h = 3 * triangle;
    return is_.orientation(mesh_.origin(h), mesh_.origin(h + 1), mesh_.origin(h + 2));
  }

  /// a, b, c, d of an edge a-b between the triangles a, b, c and b, a, d.
  std::array<Id, 4> corners(Edge h) const {
    return {mesh_.origin(h), mesh_.target(h), mesh_.apex(h), mesh_.apex(mesh_.twin(h))};
  }

 private:
  /// Flips until all edges that can be reached from these are legal.
  void legalise(std::vector<Edge> edges) {
    while (!edges.empty()) {
      const Edge h = edges.back();
      edges.pop_back();
      const int sign = edge(h);
      const bool at_hull = mesh_.apex(h) == infinite || mesh_.apex(mesh_.twin(h)) == infinite;
      if (sign > 0 || (sign == 0 && !at_hull) || !flippable(h)) continue;
      flip(h);
      const Edge first = h - h % 3;
      const Edge second = mesh_.twin(first + 1) - mesh_.twin(first + 1) % 3;
      for (const Edge outer : {first, first + 2, second, second + 1}) edges.push_back(outer);
    }
  }

  /// A triangle that a point is in, or on the edge of; an infinite one if the point is outside.
  std::uint32_t locate(Id point, std::uint32_t near) {
    const std::size_t patience = 100 + 4 * mesh_.size();
    std::uint32_t t = near;
    if (!mesh_.finite(t)) t = mesh_.twin(finite_edge(t)) / 3;
    std::uint32_t dice = point + 1;
    for (std::size_t step = 0; step < patience; ++step) {
      // A random first edge: a walk that always begins with the same one may go round in circles.
      dice = dice * 1664525u + 1013904223u;
      const Edge beyond = edge_before(t, point, dice >> 30);
      if (beyond == TriangleMesh::none) return t;
      t = mesh_.twin(beyond) / 3;
      if (!mesh_.finite(t)) return t;
    }
    for (t = 0; t < mesh_.end_triangle(); ++t) {
      if (mesh_.in_use(t) && mesh_.finite(t) && edge_before(t, point, 0) == TriangleMesh::none) return t;
    }
    for (t = 0;; ++t) {
      if (mesh_.in_use(t) && !mesh_.finite(t) && is_beyond(finite_edge(t), point)) return t;
    }
  }

  /// An edge of a finite triangle that has the point beyond it, or none.
  Edge edge_before(std::uint32_t t, Id point, std::uint32_t first) const {
    for (std::uint32_t i = 0; i < 3; ++i) {
      const Edge h = 3 * t + (first + i) % 3;
      if (is_.orientation(mesh_.origin(h), mesh_.target(h), point) < 0) return h;
    }
    return TriangleMesh::none;
  }

  bool is_beyond(Edge h, Id point) const { return is_.orientation(mesh_.origin(h), mesh_.target(h), point) > 0; }

  Edge finite_edge(std::uint32_t t) const {
    Edge h = 3 * t;
    while (mesh_.apex(h) != infinite) ++h;
    return h;
  }

  TriangleMesh& mesh_;
  const Predicates& is_;
  std::vector<std::uint32_t>& touched_;
};

}  // namespace kds::structures
