// Dynamic tests of half-spaces with balls, boxes, capsules, hulls and meshes, by exact signs.
#pragma once

#include "collision/degrees.hpp"
#include "collision/narrow_phase/above_half_space.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/narrow_phase/piecewise_contact.hpp"

namespace kds::collision {

/// How a half-space (a) and a shape touch: the normal leads out of the half-space, and the point is the middle of what
/// is lowest of b.
template <int Degree>
Contact half_space_contact(const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b, double t);

/// The tests (see pair_tests.hpp) of a half-space with a ball, a box, a capsule, a hull or a mesh: contact is the first
/// double just after which the lowest place of the shape is below the plane. So it is exact for meshes, too: what is in
/// a half-space has a vertex in it, and no margin is needed.
template <int Degree>
struct HalfSpaceContact : PiecewiseContact<Degree, AboveHalfSpace<Degree>, half_space_contact<Degree>> {};

/// Two half-spaces, which never meet: both are fixed.
template <class Motion>
struct HalfSpacesContact {
  using Body = MovingShape<Motion>;

  static double first_contact(const Body&, const Body&, double, double, ContactMode, FoundTouch*) { return never; }
  static double apart_until(const Body&, const Body&, double, double, PairMemory&) { return never; }
  static bool in_contact(const Body&, const Body&, double) { return false; }
  static double first_separation(const Body&, const Body&, double t0, double) { return t0; }
  static Contact contact_at(const Body&, const Body&, double t, const FoundTouch&) { return {.time = t}; }
};

#define KDS_DECLARE(degree) \
  extern template Contact half_space_contact(const TranslatingShape<degree>&, const TranslatingShape<degree>&, double);
KDS_FOR_ALL_DEGREES(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
