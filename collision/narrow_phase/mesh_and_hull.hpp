// A mesh and a convex hull, whose surface is tested as a mesh, and which is solid.
#pragma once

#include "collision/degrees.hpp"
#include "collision/narrow_phase/mesh_contact.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"

namespace kds::collision {

/// The tests (see pair_tests.hpp) of a mesh (a) and a hull (b): those of the mesh and the surface of the hull, by the
/// gap law of mesh_contact.hpp. While these surfaces are apart each connected part of the mesh is wholly inside the
/// hull or wholly outside. A part inside counts as contact where bodies pass through each other. Where contacts are
/// resolved it does not: a mesh that begins inside meets the surface of the hull from there.
template <int Degree>
struct MeshHullContact {
  using Body = TranslatingShape<Degree>;

  static double first_contact(const Body& a, const Body& b, double t0, double horizon, ContactMode mode,
                              FoundTouch* found);
  static double apart_until(const Body& a, const Body& b, double t0, double horizon, PairMemory& memory);
  static bool in_contact(const Body& a, const Body& b, double t);
  static double first_separation(const Body& a, const Body& b, double t0, double horizon);
  static Contact contact_at(const Body& a, const Body& b, double t, const FoundTouch& found);
};

#define KDS_DECLARE(degree) extern template struct MeshHullContact<degree>;
KDS_FOR_ALL_DEGREES(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
