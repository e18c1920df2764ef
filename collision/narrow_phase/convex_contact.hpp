// Dynamic tests of spheres and boxes, by exact signs.
#pragma once

#include "collision/degrees.hpp"
#include "collision/narrow_phase/box_and_ball.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/narrow_phase/piecewise_contact.hpp"

namespace kds::collision {

// The tests (see pair_tests.hpp) of balls and boxes.
//
// Method: the set of relative positions in which two convex shapes penetrate is a union of convex *pieces* (one for two
// spheres or two boxes; slabs, edge cylinders and vertex balls for a box and a sphere), and each piece is a conjunction
// of polynomial certificates that are all broken inside it. The first contact is the least of the pieces' first times,
// each found by jumping from one failure time to the next. A filter in doubles decides most cases (quick_motion.hpp).
// Paper: [Eberly01] for the separating axes; [Basch99] for certificates that witness disjointness.

/// Two balls.
template <int Degree>
struct BallsContact {
  using Body = TranslatingShape<Degree>;

  static double first_contact(const Body& a, const Body& b, double t0, double horizon, ContactMode mode, FoundTouch*);
  static double apart_until(const Body& a, const Body& b, double t0, double horizon, PairMemory& memory);
  static bool in_contact(const Body& a, const Body& b, double t);
  static double first_separation(const Body& a, const Body& b, double t0, double horizon);
  static Contact contact_at(const Body& a, const Body& b, double t, const FoundTouch&);
};

/// Two boxes.
template <int Degree>
struct BoxesContact {
  using Body = TranslatingShape<Degree>;

  static double first_contact(const Body& a, const Body& b, double t0, double horizon, ContactMode mode, FoundTouch*);
  static double apart_until(const Body& a, const Body& b, double t0, double horizon, PairMemory& memory);
  static bool in_contact(const Body& a, const Body& b, double t);
  static double first_separation(const Body& a, const Body& b, double t0, double horizon);
  static Contact contact_at(const Body& a, const Body& b, double t, const FoundTouch&);
};

/// How a box (a) and a ball (b) touch: at the point of the box nearest the ball's centre.
template <int Degree>
Contact box_ball_contact(const TranslatingShape<Degree>& a, const TranslatingShape<Degree>& b, double t);

/// A box (a) and a ball (b).
template <int Degree>
using BoxBallContact = PiecewiseContact<Degree, BoxAndBall<Degree>, box_ball_contact<Degree>>;

#define KDS_DECLARE(degree)                    \
  extern template struct BallsContact<degree>; \
  extern template struct BoxesContact<degree>; \
  extern template Contact box_ball_contact(const TranslatingShape<degree>&, const TranslatingShape<degree>&, double);
KDS_FOR_ALL_DEGREES(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
