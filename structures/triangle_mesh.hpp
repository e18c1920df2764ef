// Triangles that share edges, closed to a sphere by a vertex at infinity: the combinatorial side of a triangulation.
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

/// Half-edges in an array. Half-edge h = 3 t + i leads from corner i of triangle t to the next, its triangle on the
/// left; the third corner is its apex. The vertex `infinite` makes a triangle with each edge of the convex hull, so
/// that every half-edge has a twin and the hull is no special case. It has no coordinates. Paper: [Guibas85], with
/// triangles in place of quad-edges.
///
/// Cost: O(1) for everything but valence(), connected() and rename(), which are linear in the valence, and audit().
/// Numbers of triangles are kept until they are removed, and then used again.
class TriangleMesh {
 public:
  using Edge = std::uint32_t;
  static constexpr Id infinite = nobody;
  static constexpr Edge none = std::numeric_limits<Edge>::max();

  static Edge next(Edge h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static Edge previous(Edge h) { return h % 3 == 0 ? h + 2 : h - 1; }

  Edge twin(Edge h) const { return twin_[h]; }
  Id origin(Edge h) const { return origin_[h]; }
  Id target(Edge h) const { return origin_[next(h)]; }
  Id apex(Edge h) const { return origin_[previous(h)]; }
  /// The next half-edge from the same origin, clockwise... and counter-clockwise.
  Edge clockwise(Edge h) const { return next(twin_[h]); }
  Edge counter_clockwise(Edge h) const { return twin_[previous(h)]; }

  bool contains(Id vertex) const {
    return vertex == infinite ? at_infinity_ != none : vertex < from_.size() && from_[vertex] != none;
  }
  /// A half-edge from a vertex. Precondition: contains(vertex).
  Edge from(Id vertex) const { return vertex == infinite ? at_infinity_ : from_[vertex]; }

  /// Ids of vertices are below this, but for the infinite one.
  Id end_vertex() const { return static_cast<Id>(from_.size()); }
  /// Numbers of triangles are below this; not all of them need be in_use().
  std::uint32_t end_triangle() const { return static_cast<std::uint32_t>(twin_.size() / 3); }
  bool in_use(std::uint32_t triangle) const { return twin_[3 * std::size_t{triangle}] != none; }
  bool finite(std::uint32_t triangle) const {
    const Edge h = 3 * triangle;
    return origin_[h] != infinite && origin_[h + 1] != infinite && origin_[h + 2] != infinite;
  }
  std::size_t size() const { return twin_.size() / 3 - free_.size(); }  ///< triangles, infinite ones included
  bool empty() const { return size() == 0; }

  /// Calls f with each half-edge from a vertex, clockwise, until it returns true. Returns whether it has. Precondition:
  /// contains(vertex).
  template <class F>
  bool any_from(Id vertex, const F& f) const {
    const Edge first = from(vertex);
    Edge h = first;
    do {
      if (f(h)) return true;
      h = clockwise(h);
    } while (h != first);
    return false;
  }
  /// The same for all of them.
  template <class F>
  void for_each_from(Id vertex, const F& f) const {
    any_from(vertex, [&f](Edge h) { return f(h), false; });
  }

  /// How many edges a vertex has.
  std::size_t valence(Id vertex) const {
    std::size_t count = 0;
    for_each_from(vertex, [&count](Edge) { ++count; });
    return count;
  }

  /// Whether an edge leads from a to b. O(valence of a).
  bool connected(Id a, Id b) const {
    return any_from(a, [&](Edge h) { return target(h) == b; });
  }

  void clear() { *this = {}; }

  /// Begins with the triangle a, b, c and three infinite ones. Precondition: empty.
  void begin(Id a, Id b, Id c) {
    clear();
    for (const auto& corners :
         {std::array{a, b, c}, std::array{b, a, infinite}, std::array{c, b, infinite}, std::array{a, c, infinite}}) {
      create(corners);
    }
    join(0, 3), join(1, 6), join(2, 9);
    join(4, 11), join(5, 7), join(8, 10);
  }

  /// Puts a vertex into a triangle, and returns the half-edge opposite to it in each of the three triangles around it.
  /// Precondition: !contains(vertex).
  std::array<Edge, 3> split(std::uint32_t triangle, Id vertex) {
    const Edge h = 3 * triangle;
    const std::array<Id, 3> corner{origin_[h], origin_[h + 1], origin_[h + 2]};
    const Edge second_outside = twin_[h + 1];
    const Edge third_outside = twin_[h + 2];
    const Edge second = create({corner[1], corner[2], vertex});
    const Edge third = create({corner[2], corner[0], vertex});
    set_origin(h + 2, vertex);
    set_origin(second, corner[1]);  // from() of the corners may have been half-edges that have moved
    set_origin(third, corner[2]);
    join(second, second_outside);
    join(third, third_outside);
    join(h + 1, second + 2), join(second + 1, third + 2), join(third + 1, h + 2);
    return {h, second, third};
  }

  /// Takes out a vertex with three edges, and returns the number of the one triangle that remains.
  std::uint32_t merge(Id vertex) {
    const Edge first = from(vertex);
    const Edge second = clockwise(first);
    const Edge third = clockwise(second);
    const std::array outer{twin_[next(first)], twin_[next(third)], twin_[next(second)]};
    const std::array corner{target(first), target(third), target(second)};
    // Clockwise: first, second, third. So the triangle left of `first` has the corners first, third, and so on.
    const std::uint32_t kept = first / 3;
    release(second / 3);
    release(third / 3);
    const Edge h = 3 * kept;
    for (Edge i = 0; i < 3; ++i) {
      set_origin(h + i, corner[i]);
      join(h + i, outer[i]);
    }
    from_[vertex] = none;
    return kept;
  }

  /// Replaces the edge a-b between the triangles a, b, c and b, a, d by the edge d-c. The triangles keep their numbers:
  /// that of h is then a, d, c.
  void flip(Edge h) {
    const Edge g = twin_[h];
    const Id a = origin_[h], b = origin_[g], c = apex(h), d = apex(g);
    const Outer before = outer_before(h), after = outer_after(h);
    Outer beyond{};
    for (std::size_t i = 0; i < 4; ++i) {
      beyond[i] = twin_[before[i]];
      // The two triangles may share another edge where the surface is not a sphere.
      const auto shared = std::find(before.begin(), before.end(), beyond[i]);
      if (shared != before.end()) beyond[i] = after[static_cast<std::size_t>(shared - before.begin())];
    }
    const Edge first = after[0], second = after[2];
    set_origin(first, a), set_origin(first + 1, d), set_origin(first + 2, c);
    set_origin(second, d), set_origin(second + 1, b), set_origin(second + 2, c);
    join(first + 1, second + 2);
    for (std::size_t i = 0; i < 4; ++i) join(after[i], beyond[i]);
  }

  /// Gives a vertex another id. Precondition: the other is not in the mesh.
  void rename(Id vertex, Id other) {
    for_each_from(vertex, [&](Edge h) { set_origin(h, other); });
    from_[vertex] = none;
  }

  /// Throws AuditFailure unless it is a sphere.
  void audit() const {
    const std::size_t vertices = audit_links();
    if (!empty() && size() != 2 * vertices - 4) {
      throw AuditFailure("TriangleMesh: " + std::to_string(size()) + " triangles are not as many as on a sphere");
    }
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(origin_, twin_, from_, at_infinity_, free_);
  }

 protected:
  /// The half-edges a-d, c-a, d-b, b-c around an edge h that is to be flipped; and where a flip puts them.
  using Outer = std::array<Edge, 4>;
  Outer outer_before(Edge h) const {
    const Edge g = twin_[h];
    return {next(g), previous(h), previous(g), next(h)};
  }
  Outer outer_after(Edge h) const {
    const Edge first = h - h % 3, second = twin_[h] - twin_[h] % 3;
    return {first, first + 2, second, second + 1};
  }

  Edge create(const std::array<Id, 3>& corners) {
    const Edge h = 3 * free_.take(end_triangle());
    if (h == twin_.size()) {
      origin_.resize(h + std::size_t{3}, infinite);
      twin_.resize(h + std::size_t{3}, 0);
    }
    for (Edge i = 0; i < 3; ++i) set_origin(h + i, corners[i]);
    return h;
  }

  void release(std::uint32_t triangle) {
    free_.give_back(triangle);
    for (Edge h = 3 * triangle; h < 3 * triangle + 3; ++h) twin_[h] = none;
  }

  void set_origin(Edge h, Id vertex) {
    origin_[h] = vertex;
    if (vertex == infinite) {
      at_infinity_ = h;
      return;
    }
    if (vertex >= from_.size()) from_.resize(vertex + std::size_t{1}, none);
    from_[vertex] = h;
  }

  void join(Edge h, Edge g) {
    twin_[h] = g;
    twin_[g] = h;
  }

  /// Throws AuditFailure unless half-edges are twins and begin at vertices; returns the number of vertices.
  std::size_t audit_links() const {
    const auto fail = [](std::size_t h, const char* what) {
      throw AuditFailure("TriangleMesh: half-edge " + std::to_string(h) + ": " + what);
    };
    for (std::uint32_t t = 0; t < end_triangle(); ++t) {
      if (!in_use(t)) continue;
      for (Edge h = 3 * t; h < 3 * t + 3; ++h) {
        if (twin_[h] == none || twin_[twin_[h]] != h) fail(h, "is not its twin's twin");
        if (origin(twin_[h]) != target(h)) fail(h, "does not end where its twin begins");
        if (!contains(origin_[h]) || origin_[from(origin_[h])] != origin_[h])
          fail(h, "begins at a vertex that is not there");
      }
    }
    std::size_t vertices = contains(infinite);
    for (const Edge h : from_) vertices += h != none;
    return vertices;
  }

 private:
  std::vector<Id> origin_;
  std::vector<Edge> twin_;
  std::vector<Edge> from_;  ///< of a vertex
  Edge at_infinity_ = none;
  FreeNumbers free_;  ///< of triangles
};

}  // namespace kds::structures
