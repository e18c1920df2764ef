// Delaunay and regular triangulation in space at an instant: insertion and flips, decided by signs.
#pragma once

#include "structures/tetrahedron_mesh.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace kds::structures {

/// What a change of a mesh has replaced.
struct Replaced {
  std::vector<std::uint32_t> removed;  ///< numbers of tetrahedra; `created` may use them again
  std::vector<std::uint32_t> created;
  std::vector<Id> gone;  ///< vertices that the mesh has lost
  bool sound = true;     ///< whether the mesh is still a sphere
};

/// Edits a mesh that is the regular triangulation of its vertices; flip() any mesh of positive volumes.
///
/// Predicates: orientation(a, b, c, d) > 0 if a, b, c turn counter-clockwise seen from d; in_sphere(abcd, e) < 0 if e
/// is inside the sphere of a, b, c, d, and never 0 where these have a volume; same(a, b), collinear(a, b, c) if the
/// points stay so; is_in(mesh, t, p) if p is in a tetrahedron. All signs are exact and those of one instant. Papers:
/// [Bowyer81], [Watson81], [Edelsbrunner96] for weights, [Devillers11] for the degeneracies, [Devillers02] for walking.
///
/// Why no degeneracy is special: a point on the plane of a facet is in conflict with both tetrahedra at that facet or
/// with neither, since for both the predicate is that of the circle in the plane. So each facet of the boundary of
/// what is replaced has the new point strictly on its inner side.
///
/// Cost: a walk of O(n^(1/3)) tetrahedra, and what is replaced, O(1) expected for points in random order.
template <class Predicates>
class BowyerWatson {
 public:
  using Facet = TetrahedronMesh::Facet;
  using Corners = TetrahedronMesh::Corners;
  static constexpr Id infinite = TetrahedronMesh::infinite;

  BowyerWatson(TetrahedronMesh& mesh, const Predicates& predicates) : mesh_(mesh), is_(predicates) {}

  /// Begins a mesh with four of the ids that are not in one plane; false if there are none. O(n).
  bool begin(const std::vector<Id>& ids) {
    std::vector<Id> base;
    for (const Id id : ids) {
      if (base.size() == 3) {
        const int side = is_.orientation(base[0], base[1], base[2], id);
        if (side == 0) continue;
        mesh_.begin({base[0], base[side > 0 ? 1 : 2], base[side > 0 ? 2 : 1], id});
        return true;
      }
      const bool in_vain =
          (base.size() == 1 && is_.same(base[0], id)) || (base.size() == 2 && is_.collinear(base[0], base[1], id));
      if (!in_vain) base.push_back(id);
    }
    return false;
  }

  /// A tetrahedron that a point is in, or on the boundary of; an infinite one if the point is outside. The walk begins
  /// at `near`. Precondition: the mesh is not empty.
  std::uint32_t locate(Id point, std::uint32_t near) const {
    std::uint32_t t = near;
    if (!mesh_.finite(t)) t = mesh_.twin(mesh_.opposite(t, infinite)) / 4;
    std::uint32_t dice = point + 1;
    for (std::size_t step = 0; step < 100 + 4 * mesh_.size(); ++step) {
      // A random first facet: a walk that always begins with the same one may go round in circles.
      dice = dice * 1664525u + 1013904223u;
      const Facet beyond = facet_before(t, point, dice >> 30);
      if (beyond == TetrahedronMesh::none) return t;
      t = mesh_.twin(beyond) / 4;
      if (!mesh_.finite(t)) return t;
    }
    for (t = 0; t < mesh_.end_tetrahedron(); ++t) {
      if (mesh_.in_use(t) && mesh_.finite(t) && is_.is_in(mesh_, t, point)) return t;
    }
    for (t = 0; t < mesh_.end_tetrahedron(); ++t) {
      if (mesh_.in_use(t) && !mesh_.finite(t) && conflict(t, point)) return t;
    }
    return TetrahedronMesh::none;
  }

  /// Whether a tetrahedron cannot stay when a point is inserted: the point is inside its sphere or, if it is infinite,
  /// beyond its facet of the hull; or on the plane of that and inside the circle, and so in conflict with what is
  /// behind it.
  bool conflict(std::uint32_t t, Id point) const {
    if (mesh_.finite(t)) return is_.in_sphere(mesh_.corners(t), point) < 0;
    const Facet base = mesh_.opposite(t, infinite);
    const int side = is_.orientation(mesh_.facet(base), point);
    return side > 0 || (side == 0 && conflict(mesh_.twin(base) / 4, point));
  }

  /// Makes a vertex of a point. Precondition: it is in conflict with `place`, which locate() has found.
  Replaced insert(Id point, std::uint32_t place) {
    std::vector<std::uint32_t> cavity{place};
    std::vector<Corners> others;
    std::vector<std::uint32_t> spared;
    const auto listed = [](const std::vector<std::uint32_t>& list, std::uint32_t t) {
      return std::find(list.begin(), list.end(), t) != list.end();
    };
    for (std::size_t i = 0; i < cavity.size(); ++i) {
      const std::uint32_t t = cavity[i];
      for (std::uint32_t corner = 0; corner < 4; ++corner) {
        const std::uint32_t next = mesh_.twin(4 * t + corner) / 4;
        if (listed(cavity, next)) continue;
        if (!listed(spared, next)) {
          if (conflict(next, point)) {
            cavity.push_back(next);
            continue;
          }
          spared.push_back(next);
        }
        others.push_back(with_corner(t, corner, point));
      }
    }
    return replace(cavity, others);
  }

  /// Flips a facet: two tetrahedra become three, or three around one of its edges become two. False, with nothing
  /// done, if neither gives tetrahedra of positive volume that are not there already. Papers: [Lawson86], [Joe89].
  bool flip(Facet f, Replaced& replaced) {
    const std::uint32_t t = f / 4, other = mesh_.twin(f) / 4;
    const Id e = mesh_.apex(mesh_.twin(f)), d = mesh_.apex(f);
    std::vector<Corners> three;
    for (std::uint32_t corner = 0; corner < 4; ++corner) {
      if (4 * t + corner == f) continue;
      const Id left_out = mesh_.apex(4 * t + corner);
      const std::uint32_t third = mesh_.twin(4 * t + corner) / 4;
      if (third == mesh_.twin(mesh_.opposite(other, left_out)) / 4) {
        std::vector<Corners> two;
        for (std::uint32_t i = 0; i < 4; ++i) {
          if (i != corner && 4 * t + i != f) two.push_back(with_corner(t, i, e));
        }
        if (positive(two) && !mesh_.contains_facet(d, left_out, e)) {
          replaced = replace({t, other, third}, two);
          return true;
        }
      }
      three.push_back(with_corner(t, corner, e));
    }
    if (!positive(three) || mesh_.connected(d, e)) return false;
    replaced = replace({t, other}, three);
    return true;
  }

  Replaced replace(const std::vector<std::uint32_t>& removed, const std::vector<Corners>& others) {
    std::vector<Id> vertices;
    for (const std::uint32_t t : removed) {
      for (const Id v : mesh_.corners(t)) vertices.push_back(v);
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    Replaced result{removed, mesh_.replace(removed, others), {}, true};
    for (const Id v : vertices) {
      if (!mesh_.contains(v)) result.gone.push_back(v);
    }
    return result;
  }

 private:
  bool positive(const std::vector<Corners>& tetrahedra) const {
    return std::all_of(tetrahedra.begin(), tetrahedra.end(), [&](const Corners& c) {
      return std::find(c.begin(), c.end(), infinite) != c.end() || is_.orientation(c) > 0;
    });
  }

  Corners with_corner(std::uint32_t t, std::uint32_t corner, Id vertex) const {
    Corners corners = mesh_.corners(t);
    corners[corner] = vertex;
    return corners;
  }

  /// A facet of a finite tetrahedron that has the point beyond it, or none.
  Facet facet_before(std::uint32_t t, Id point, std::uint32_t first) const {
    for (std::uint32_t i = 0; i < 4; ++i) {
      const Facet f = 4 * t + (first + i) % 4;
      if (is_.orientation(mesh_.facet(f), point) < 0) return f;
    }
    return TetrahedronMesh::none;
  }

  TetrahedronMesh& mesh_;
  const Predicates& is_;
};

}  // namespace kds::structures
