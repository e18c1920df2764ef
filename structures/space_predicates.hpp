// Predicates of points in space at an instant, decided by the exact signs of certificates.
#pragma once

#include "certificates/space_certificates.hpp"
#include "kds/framework/moving_set.hpp"
#include "structures/tetrahedron_mesh.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace kds::structures {

inline constexpr std::array<std::array<double, 3>, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

/// Signs at now+. A sign is 0 only if the points stay degenerate; that of in_sphere() only if all five stay in one
/// plane, because of its perturbation.
///
/// Perturbation: five points that stay on one sphere (orthogonal to one, with weights) are treated as if the height of
/// each, |p|^2 - weight, were larger by a positive number that is infinitely small, and infinitely small compared with
/// that of every lower id. So the triangulation is unique, and depends on nothing but the motions and the ids. With
/// heights h the predicate is a determinant linear in them; if it vanishes its sign is that of the first of its
/// cofactors, by ascending id, that does not: orientations of four of the points. Paper: [Devillers11], with ids in
/// place of coordinates, so that a perturbed predicate stays the same one while points move.
template <class Path>
struct SpacePredicates {
  using Orientation = certificates::SpaceOrientation<Path>;
  using InSphere = certificates::InSphere<Path>;

  const MovingSet<Path>& x;
  double now;
  Id changing = nobody;        ///< this one is treated as if it
  const Path* next = nullptr;  ///< had this motion

  /// > 0 if a, b, c turn counter-clockwise, seen from d.
  int orientation(Id a, Id b, Id c, Id d) const { return sign_after(Orientation{at(a), at(b), at(c), at(d)}, now); }
  int orientation(const std::array<Id, 3>& abc, Id d) const { return orientation(abc[0], abc[1], abc[2], d); }

  /// > 0 if a tetrahedron with these corners has a positive volume.
  int orientation(const std::array<Id, 4>& abcd) const { return orientation(abcd[0], abcd[1], abcd[2], abcd[3]); }
  /// Whether a point is in a finite tetrahedron, or on its boundary.
  bool is_in(const TetrahedronMesh& mesh, std::uint32_t t, Id point) const {
    for (TetrahedronMesh::Facet f = 4 * t; f < 4 * t + 4; ++f) {
      if (orientation(mesh.facet(f), point) < 0) return false;
    }
    return true;
  }

  bool collinear(Id a, Id b, Id c) const {
    for (const int axis : {0, 1, 2}) {
      if (sign_after(certificates::NormalDirection<Path>{at(a), at(b), at(c), axis}, now) != 0) return false;
    }
    return true;
  }
  bool same(Id a, Id b) const {
    for (const auto& along : axes) {
      if (sign_after(certificates::DirectionOrder<Path, 3>{at(a), at(b), along}, now) != 0) return false;
    }
    return true;
  }

  /// < 0 if e is inside the sphere through a, b, c, d, which are positively oriented; with the perturbation.
  int in_sphere(const std::array<Id, 4>& abcd, Id e) const {
    const int sign = unperturbed(abcd, e);
    if (sign != 0) return sign;
    for (int rank = 0; rank < 5; ++rank) {
      const auto [p, q, r, s] = cofactor(abcd, e, rank);
      if (const int of_cofactor = orientation(p, q, r, s)) return of_cofactor;
    }
    return 0;
  }
  int unperturbed(const std::array<Id, 4>& abcd, Id e) const {
    const auto& [a, b, c, d] = abcd;
    return sign_after(InSphere{at(a), at(b), at(c), at(d), at(e)}, now);
  }

  /// The four points whose orientation is the cofactor of the rank-th lowest id's height.
  static std::array<Id, 4> cofactor(const std::array<Id, 4>& abcd, Id e, int rank) {
    const std::array<Id, 5> points{abcd[0], abcd[1], abcd[2], abcd[3], e};
    std::array<std::size_t, 5> order{0, 1, 2, 3, 4};
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return points[i] < points[j]; });
    const std::size_t left_out = order[static_cast<std::size_t>(rank)];
    std::array<Id, 4> rest{};
    for (std::size_t i = 0, to = 0; i < 5; ++i) {
      if (i != left_out) rest[to++] = points[i];
    }
    if (left_out % 2 == 1) std::swap(rest[0], rest[1]);
    return rest;
  }

 private:
  const Path& at(Id id) const { return id == changing ? *next : x[id]; }
};

}  // namespace kds::structures
