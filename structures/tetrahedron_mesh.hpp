// Tetrahedra that share facets, closed to a sphere by a vertex at infinity: the combinatorial side of a triangulation.
#pragma once

#include "kds/audit.hpp"
#include "kds/framework/free_numbers.hpp"
#include "kds/framework/moving_set.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace kds::structures {

/// Tetrahedra in an array. Facet f = 4 t + i is that of tetrahedron t opposite to its corner i, which is the facet's
/// apex. The vertex `infinite` makes a tetrahedron with each facet of the convex hull, so that every facet has a twin,
/// the same one as part of the tetrahedron on its other side, and the hull is no special case. It has no coordinates.
///
/// Every change replaces some tetrahedra by others with the same boundary: replace(). Cost: linear in what is replaced
/// (times a logarithm); star(), connected() and contains_facet() are linear in the tetrahedra around a vertex. Numbers
/// of tetrahedra are kept until they are removed, and then used again.
class TetrahedronMesh {
 public:
  using Facet = std::uint32_t;
  using Corners = std::array<Id, 4>;
  static constexpr Id infinite = nobody;
  static constexpr Facet none = std::numeric_limits<Facet>::max();

  /// The corners of facet i, in an order such that a positively oriented tetrahedron is that of these three and its
  /// corner i.
  static constexpr std::array<std::array<std::uint32_t, 3>, 4> corners_of_facet{
      {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}}};

  Facet twin(Facet f) const { return twin_[f]; }
  /// The corner opposite to a facet.
  Id apex(Facet f) const { return corner_[f]; }
  std::array<Id, 3> facet(Facet f) const {
    const Facet first = f - f % 4;
    const auto& i = corners_of_facet[f % 4];
    return {corner_[first + i[0]], corner_[first + i[1]], corner_[first + i[2]]};
  }
  Corners corners(std::uint32_t t) const {
    const std::size_t first = 4 * std::size_t{t};
    return {corner_[first], corner_[first + 1], corner_[first + 2], corner_[first + 3]};
  }
  /// The facet opposite to a corner. Precondition: it is one.
  Facet opposite(std::uint32_t t, Id corner) const {
    Facet f = 4 * t;
    while (corner_[f] != corner) ++f;
    return f;
  }
  bool has_corner(std::uint32_t t, Id vertex) const {
    const Corners c = corners(t);
    return c[0] == vertex || c[1] == vertex || c[2] == vertex || c[3] == vertex;
  }

  bool contains(Id vertex) const {
    return vertex == infinite ? at_infinity_ != none : vertex < at_.size() && at_[vertex] != none;
  }
  /// A tetrahedron with this corner. Precondition: contains(vertex).
  std::uint32_t at(Id vertex) const { return vertex == infinite ? at_infinity_ : at_[vertex]; }

  /// Vertices but the infinite one are below this.
  Id end_vertex() const { return static_cast<Id>(at_.size()); }
  /// Numbers of tetrahedra are below this; not all of them need be in_use().
  std::uint32_t end_tetrahedron() const { return static_cast<std::uint32_t>(twin_.size() / 4); }
  bool in_use(std::uint32_t t) const { return twin_[4 * std::size_t{t}] != none; }
  bool finite(std::uint32_t t) const { return !has_corner(t, infinite); }
  std::size_t size() const { return twin_.size() / 4 - free_.size(); }  ///< infinite ones included
  bool empty() const { return size() == 0; }

  /// The tetrahedra around a vertex. Precondition: contains(vertex).
  std::vector<std::uint32_t> star(Id vertex) const {
    std::vector<std::uint32_t> result{at(vertex)};
    std::vector<std::uint8_t>& seen = scratch();
    seen[result[0]] = 1;
    for (std::size_t i = 0; i < result.size(); ++i) {
      for (Facet f = 4 * result[i]; f < 4 * result[i] + 4; ++f) {
        const std::uint32_t next = twin_[f] / 4;
        if (corner_[f] == vertex || seen[next]) continue;
        seen[next] = 1;
        result.push_back(next);
      }
    }
    for (const std::uint32_t t : result) seen[t] = 0;
    return result;
  }
  /// How many tetrahedra are around a vertex; 0 if they are not a ball, by the characteristic of Euler.
  std::size_t ball_around(Id vertex) const {
    const std::vector<std::uint32_t> around = star(vertex);
    std::vector<Id> neighbours;
    for (const std::uint32_t t : around) {
      for (const Id corner : corners(t)) {
        if (corner != vertex) neighbours.push_back(corner);
      }
    }
    std::sort(neighbours.begin(), neighbours.end());
    const auto distinct = std::unique(neighbours.begin(), neighbours.end()) - neighbours.begin();
    return around.size() + 4 == 2 * static_cast<std::size_t>(distinct) ? around.size() : 0;
  }
  /// Whether an edge joins a and b.
  bool connected(Id a, Id b) const {
    for (const std::uint32_t t : star(a)) {
      if (has_corner(t, b)) return true;
    }
    return false;
  }
  /// Whether a, b and c are the corners of a facet.
  bool contains_facet(Id a, Id b, Id c) const {
    for (const std::uint32_t t : star(a)) {
      if (has_corner(t, b) && has_corner(t, c)) return true;
    }
    return false;
  }

  void clear() { *this = {}; }

  /// Begins with one tetrahedron, positively oriented, and the four infinite ones around it.
  void begin(const Corners& corners) {
    clear();
    std::vector<Corners> all{corners};
    for (std::size_t i = 0; i < 4; ++i) {
      const auto& f = corners_of_facet[i];
      all.push_back({corners[f[1]], corners[f[0]], corners[f[2]], infinite});
    }
    replace({}, all);
  }

  /// Replaces tetrahedra by others, given by their corners, and returns the numbers of these, in the same order. A
  /// vertex that was a corner only of those that are removed is no longer contained. Preconditions: the others are
  /// positively oriented and have the same boundary.
  std::vector<std::uint32_t> replace(const std::vector<std::uint32_t>& removed, const std::vector<Corners>& others);

  /// Throws AuditFailure unless each facet is shared by two tetrahedra that lie on its two sides, and the tetrahedra
  /// around each vertex are a ball.
  void audit() const;

  template <class Archive>
  void archive(Archive& archive) {
    archive(corner_, twin_, at_, at_infinity_, free_);
    if constexpr (Archive::loading) {
      archive.require(corner_.size() == twin_.size() && twin_.size() % 4 == 0, "a mesh has broken tetrahedra");
      for (Facet f = 0; f < twin_.size(); ++f) {
        if (twin_[f - f % 4] == none) continue;
        archive.require(twin_[f] < twin_.size() && twin_[twin_[f]] == f && contains(corner_[f]),
                        "the tetrahedra of a mesh do not fit together");
      }
      for (const Id v : vertices()) {
        archive.require(4 * std::size_t{at(v)} < twin_.size() && in_use(at(v)) && has_corner(at(v), v),
                        "a vertex of a mesh has no tetrahedron");
      }
      for (const std::uint32_t t : free_) {
        archive.require(4 * std::size_t{t} < twin_.size() && !in_use(t), "a free tetrahedron of a mesh is in use");
      }
    }
  }

 private:
  /// A facet on its way to its twin: its corners in ascending order.
  struct Open {
    std::array<Id, 3> corners;
    Facet facet;
    friend bool operator<(const Open& a, const Open& b) { return a.corners < b.corners; }
  };
  Open open(Facet f) const {
    std::array<Id, 3> c = facet(f);
    std::sort(c.begin(), c.end());
    return {c, f};
  }

  std::uint32_t create(const Corners& corners) {
    const std::uint32_t t = free_.take(end_tetrahedron());
    if (t == end_tetrahedron()) {
      corner_.resize(4 * std::size_t{t} + 4);
      twin_.resize(4 * std::size_t{t} + 4);
    }
    for (Facet i = 0; i < 4; ++i) {
      corner_[4 * t + i] = corners[i];
      twin_[4 * t + i] = 0;
      set_at(corners[i], t);
    }
    return t;
  }

  void set_at(Id vertex, std::uint32_t t) {
    if (vertex == infinite) {
      at_infinity_ = t;
      return;
    }
    if (vertex >= at_.size()) at_.resize(vertex + std::size_t{1}, none);
    at_[vertex] = t;
  }

  std::vector<Id> vertices() const {
    std::vector<Id> result;
    for (Id v = 0; v < at_.size(); ++v) {
      if (at_[v] != none) result.push_back(v);
    }
    if (at_infinity_ != none) result.push_back(infinite);
    return result;
  }

  /// A mark for each tetrahedron, all zero between calls.
  std::vector<std::uint8_t>& scratch() const {
    if (scratch_.size() < end_tetrahedron()) scratch_.resize(end_tetrahedron(), 0);
    return scratch_;
  }

  std::vector<Id> corner_;
  std::vector<Facet> twin_;
  std::vector<std::uint32_t> at_;  ///< a tetrahedron of a vertex
  std::uint32_t at_infinity_ = none;
  FreeNumbers free_;
  mutable std::vector<std::uint8_t> scratch_;
};

// ---------------------------------------------------------------------------------------------------------------

inline std::vector<std::uint32_t> TetrahedronMesh::replace(const std::vector<std::uint32_t>& removed,
                                                           const std::vector<Corners>& others) {
  std::vector<std::uint8_t>& gone = scratch();
  for (const std::uint32_t t : removed) gone[t] = 1;
  std::vector<Open> facets;
  for (const std::uint32_t t : removed) {
    for (Facet f = 4 * t; f < 4 * t + 4; ++f) {
      if (!gone[twin_[f] / 4]) facets.push_back(open(twin_[f]));
    }
    for (const Id v : corners(t)) {
      if (contains(v) && gone[at(v)]) set_at(v, none);
    }
  }
  for (const std::uint32_t t : removed) gone[t] = 0;
  for (auto t = removed.rbegin(); t != removed.rend(); ++t) {
    twin_[4 * std::size_t{*t}] = none;
    free_.give_back(*t);
  }
  std::vector<std::uint32_t> created;
  for (const Corners& corners : others) {
    const std::uint32_t t = create(corners);
    created.push_back(t);
    for (Facet f = 4 * t; f < 4 * t + 4; ++f) facets.push_back(open(f));
  }
  std::sort(facets.begin(), facets.end());
  for (std::size_t i = 0; i + 1 < facets.size(); i += 2) {
    twin_[facets[i].facet] = facets[i + 1].facet;
    twin_[facets[i + 1].facet] = facets[i].facet;
  }
  return created;
}

inline void TetrahedronMesh::audit() const {
  const auto fail = [](std::size_t f, const char* what) {
    throw AuditFailure("TetrahedronMesh: facet " + std::to_string(f) + ": " + what);
  };
  for (std::uint32_t t = 0; t < end_tetrahedron(); ++t) {
    if (!in_use(t)) continue;
    for (Facet f = 4 * t; f < 4 * t + 4; ++f) {
      if (twin_[f] >= twin_.size() || twin_[twin_[f]] != f || !in_use(twin_[f] / 4)) fail(f, "is not its twin's twin");
      // Seen from the other side, the three corners come in the opposite order.
      const auto [a, b, c] = facet(f);
      const std::array<Id, 3> other = facet(twin_[f]);
      if (other != std::array{b, a, c} && other != std::array{a, c, b} && other != std::array{c, b, a}) {
        fail(f, "has not the corners of its twin");
      }
      if (!contains(corner_[f]) || !in_use(at(corner_[f])) || !has_corner(at(corner_[f]), corner_[f])) {
        fail(f, "has an apex that is not there");
      }
    }
  }
  std::vector<std::size_t> valence(at_.size() + 1, 0);
  for (std::uint32_t t = 0; t < end_tetrahedron(); ++t) {
    if (!in_use(t)) continue;
    for (const Id v : corners(t)) ++valence[v == infinite ? at_.size() : v];
  }
  for (const Id v : vertices()) {
    if (ball_around(v) != valence[v == infinite ? at_.size() : v]) fail(4 * at(v), "is at a vertex without a ball");
  }
}

}  // namespace kds::structures
