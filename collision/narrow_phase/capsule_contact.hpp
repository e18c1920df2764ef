// Dynamic tests of capsules with balls, capsules and boxes, by exact signs.
#pragma once

#include "collision/degrees.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/narrow_phase/piecewise_contact.hpp"
#include "collision/narrow_phase/rounded_zonotope.hpp"

namespace kds::collision {

/// How two shapes that have a rounded_core() touch, in doubles: the normal leads from the nearest point of the zonotope
/// that is the difference of their cores to the place of b; where the cores overlap, out of its nearest face. The point
/// is in the middle of the features that face each other, as for boxes.
template <int Degree>
Contact rounded_contact(const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b, double t);

/// The tests (see pair_tests.hpp) of a capsule with a ball, a capsule or a box.
template <int Degree>
struct CapsuleContact : PiecewiseContact<Degree, RoundedZonotope<Degree>, rounded_contact<Degree>> {
  using Piecewise = PiecewiseContact<Degree, RoundedZonotope<Degree>, rounded_contact<Degree>>;
  using Body = TranslatingShape<Degree>;

  /// One separating direction suffices: the pieces, a dozen times as much work, are for pairs that are near already.
  static double apart_until(const Body& a, const Body& b, double t0, double horizon, PairMemory& memory) {
    if (!(t0 <= horizon)) return never;
    const double until = RoundedZonotope<Degree>(a, b, t0, horizon).apart_until();
    return until > t0 ? until : Piecewise::apart_until(a, b, t0, horizon, memory);
  }
};

#define KDS_DECLARE(degree) \
  extern template Contact rounded_contact(const TranslatingShape<degree>&, const TranslatingShape<degree>&, double);
KDS_FOR_ALL_DEGREES(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
