// The part of a regular triangulation in space around some tetrahedra that are wrong, built anew.
#pragma once

#include "structures/bowyer_watson.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

namespace kds::structures {

/// Takes some tetrahedra out of a mesh, and fills the hole with the regular triangulation of its vertices.
///
/// That triangulation is made on its own; where a facet of the hole's boundary is not one of its facets, the hole takes
/// in the tetrahedron beyond that facet, and the vertices of that are inserted. Then those tetrahedra that lie inside
/// the boundary are what is missing. This does what flips cannot do alone: facets whose neighbours must be replaced
/// first, four points that stay in one plane, vertices that become hidden; and it removes vertices. Paper:
/// [Devillers11], which removes a vertex so. The filling fits for the reason given there: regular triangulations with
/// the perturbation are unique, and a sphere that is empty of all points is also empty of some of them. So a hole that
/// covers all wrong tetrahedra can be filled; a smaller one can where fewer are wrong.
///
/// Cost: O(m log m) and the insertion of the hole's vertices, for m tetrahedra around them.
template <class Predicates>
class LocalRebuild {
 public:
  using Facet = TetrahedronMesh::Facet;
  using Corners = TetrahedronMesh::Corners;
  static constexpr Id infinite = TetrahedronMesh::infinite;

  LocalRebuild(TetrahedronMesh& mesh, const Predicates& predicates)
      : mesh_(mesh), is_(predicates), inner_(filling_, predicates) {}

  /// `without` is a vertex to leave out, with all its tetrahedra in the hole, or `nobody`. hidden(t, f) calls f for
  /// each point that is no vertex and lies in tetrahedron t: it may become one. Nothing is changed, and nothing is
  /// returned, if the hole would become the whole mesh.
  template <class Hidden>
  std::optional<Replaced> operator()(std::vector<std::uint32_t> hole, Id without, const Hidden& hidden) {
    seen_.insert(infinite);
    seen_.insert(without);
    in_hole_.insert(hole.begin(), hole.end());
    std::vector<Id> waiting;
    std::optional<std::vector<Corners>> inside;
    for (std::size_t taken = 0; !inside;) {
      for (; taken < hole.size(); ++taken) {
        const auto take = [&](Id id) {
          if (seen_.insert(id).second) waiting.push_back(id);
        };
        for (const Id corner : mesh_.corners(hole[taken])) take(corner);
        hidden(hole[taken], take);
      }
      insert(waiting);
      if (grow(hole, false)) continue;
      inside = inside_of(hole, without);
      if (!inside && !grow(hole, true)) return std::nullopt;
    }
    const auto others = tetrahedra_outside(hole);
    Replaced replaced = BowyerWatson<Predicates>(mesh_, is_).replace(hole, *inside);
    replaced.sound = is_sphere(others, *inside);
    return replaced;
  }

 private:
  /// Inserts the points that wait, as soon as some of them are not in one plane.
  void insert(std::vector<Id>& waiting) {
    if (filling_.empty() && !inner_.begin(waiting)) return;
    for (const Id id : waiting) {
      if (filling_.contains(id)) continue;
      std::uint32_t near = filling_.at(infinite);
      near = inner_.locate(id, near);
      if (inner_.conflict(near, id)) inner_.insert(id, near);
    }
    waiting.clear();
  }

  /// Takes into the hole the tetrahedra beyond those facets of the boundary that are not facets of the filling, or
  /// beyond all, and notes those that are. Returns whether the hole has grown.
  bool grow(std::vector<std::uint32_t>& hole, bool everywhere) {
    std::vector<std::pair<std::array<Id, 3>, Facet>> facets;
    for (std::uint32_t t = 0; t < filling_.end_tetrahedron(); ++t) {
      for (Facet f = 4 * t; filling_.in_use(t) && f < 4 * t + 4; ++f) facets.emplace_back(turned(filling_.facet(f)), f);
    }
    std::sort(facets.begin(), facets.end());
    boundary_.clear();
    const std::size_t before = hole.size();
    for (std::size_t i = 0; i < before; ++i) {
      for (Facet f = 4 * hole[i]; f < 4 * hole[i] + 4; ++f) {
        const std::uint32_t beyond = mesh_.twin(f) / 4;
        if (in_hole_.contains(beyond)) continue;
        const std::pair wanted{turned(mesh_.facet(f)), Facet{0}};
        const auto found = std::lower_bound(facets.begin(), facets.end(), wanted);
        if (!everywhere && found != facets.end() && found->first == wanted.first) {
          boundary_.push_back(found->second);
        } else {
          in_hole_.insert(beyond);
          hole.push_back(beyond);
        }
      }
    }
    return hole.size() > before;
  }

  /// The tetrahedra of the filling inside the boundary. None if there is no boundary, or if it does not separate them
  /// from the others; if a vertex of the hole is among the others only; or if they lie outside the hull, and nothing of
  /// the hole does, because a tetrahedron has turned over.
  std::optional<std::vector<Corners>> inside_of(const std::vector<std::uint32_t>& hole, Id without) const {
    std::vector<std::uint8_t> is_boundary(4 * std::size_t{filling_.end_tetrahedron()}, 0);
    std::vector<std::uint8_t> is_inside(filling_.end_tetrahedron(), 0);
    std::vector<std::uint32_t> inside;
    const auto enter = [&](std::uint32_t t) {
      if (!is_inside[t]) inside.push_back(t);
      is_inside[t] = 1;
    };
    for (const Facet f : boundary_) {
      is_boundary[f] = 1;
      enter(f / 4);
    }
    for (std::size_t i = 0; i < inside.size(); ++i) {
      for (Facet f = 4 * inside[i]; f < 4 * inside[i] + 4; ++f) {
        if (is_boundary[f]) continue;
        if (is_boundary[filling_.twin(f)]) return std::nullopt;
        enter(filling_.twin(f) / 4);
      }
    }
    const bool hole_at_hull = std::any_of(hole.begin(), hole.end(), [&](std::uint32_t t) { return !mesh_.finite(t); });
    if (inside.empty()) return std::nullopt;
    std::vector<Corners> corners;
    std::unordered_set<Id> vertices;
    for (const std::uint32_t t : inside) {
      corners.push_back(filling_.corners(t));
      vertices.insert(corners.back().begin(), corners.back().end());
    }
    if (vertices.contains(infinite) && !hole_at_hull) return std::nullopt;
    for (const std::uint32_t t : hole) {
      for (const Id v : mesh_.corners(t)) {
        if (v != without && filling_.contains(v) && !vertices.contains(v)) return std::nullopt;
      }
    }
    return corners;
  }

  /// How many tetrahedra outside the hole each of its vertices has.
  std::unordered_map<Id, std::size_t> tetrahedra_outside(const std::vector<std::uint32_t>& hole) const {
    std::unordered_map<Id, std::size_t> result;
    for (const std::uint32_t t : hole) {
      for (const Id v : mesh_.corners(t)) {
        if (result.contains(v)) continue;
        const std::vector<std::uint32_t> star = mesh_.star(v);
        result[v] = static_cast<std::size_t>(
            std::count_if(star.begin(), star.end(), [&](std::uint32_t s) { return !in_hole_.contains(s); }));
      }
    }
    return result;
  }
  /// Whether there is a ball around each vertex of the filling. In a mesh of layers there may be none.
  bool is_sphere(std::unordered_map<Id, std::size_t> tetrahedra, const std::vector<Corners>& inside) const {
    for (const Corners& corners : inside) {
      for (const Id v : corners) ++tetrahedra[v];
    }
    return std::all_of(tetrahedra.begin(), tetrahedra.end(), [&](const auto& vertex) {
      const auto [v, count] = vertex;
      return count == 0 || (mesh_.contains(v) && mesh_.ball_around(v) == count);
    });
  }

  /// The same orientation, the lowest id first.
  static std::array<Id, 3> turned(std::array<Id, 3> facet) {
    std::rotate(facet.begin(), std::min_element(facet.begin(), facet.end()), facet.end());
    return facet;
  }

  TetrahedronMesh& mesh_;
  const Predicates& is_;
  TetrahedronMesh filling_;
  BowyerWatson<Predicates> inner_;
  std::unordered_set<Id> seen_;
  std::unordered_set<std::uint32_t> in_hole_;
  std::vector<Facet> boundary_;  ///< facets of the filling, seen from inside the hole
};

}  // namespace kds::structures
