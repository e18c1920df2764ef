// Dynamic tests of convex hulls with balls, boxes, capsules and each other, by exact signs.
#pragma once

#include "collision/degrees.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/narrow_phase/piecewise_contact.hpp"
#include "collision/narrow_phase/rounded_polytope.hpp"

namespace kds::collision {

/// How a hull (a) and another solid touch, in doubles. The normal is that of the plane of their difference (see
/// RoundedPolytope) below which they are least deep; if b is round, it leads from the nearest point of that difference
/// to the place of b. The point is in the middle of the features that face each other, as for boxes.
template <int Degree>
Contact hull_contact(const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b, double t);

/// A time from now on before which a plane keeps a hull (a) and another solid apart, or `never` if it does until the
/// horizon; now if none is found.
///
/// Method: the direction from the nearest point of their difference to the place of b separates them; doubles with a
/// bound on their error (QuickMotion) tell for how long. From that time on another direction is found, and so on.
template <int Degree>
double hulls_apart_until(const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b, double now,
                         double horizon);

/// The tests (see pair_tests.hpp) of a hull with a ball, a box, a capsule or a hull.
template <int Degree>
struct HullContact : PiecewiseContact<Degree, RoundedPolytope<Degree>, hull_contact<Degree>> {
  using Body = TranslatingShape<Degree>;

  static double apart_until(const Body& a, const Body& b, double t0, double horizon, PairMemory&) {
    return t0 <= horizon ? hulls_apart_until(a, b, t0, horizon) : never;
  }
};

#define KDS_DECLARE(degree)                                                                                          \
  extern template Contact hull_contact(const TranslatingShape<degree>&, const TranslatingShape<degree>&, double);    \
  extern template double hulls_apart_until(const TranslatingShape<degree>&, const TranslatingShape<degree>&, double, \
                                           double);
KDS_FOR_ALL_DEGREES(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
