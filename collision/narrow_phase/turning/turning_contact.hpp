// Contacts of bodies that turn: balls, boxes, capsules and convex hulls, also with half-spaces, by exact signs.
#pragma once

#include "certificates/turning/rigid_motion.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/shapes/shape.hpp"

namespace kds::collision {

// The functions of narrow_phase.hpp for bodies that turn. What they answer is a function of motions and shapes alone,
// as there: contact is the first double just after which the two penetrate, by exact signs.
//
// A box is the exact box of its half extents, a hull that of its points, turned by the exact rotation of its motion:
// nothing of it is rounded. A half-space comes first, does not turn, and has a normal that is rounded, once, when it is
// turned as its motion says; what is in it has a corner in it, also where that is a mesh. The rotation in PlacedShape
// does not count; orientations are those of motions.
//
// Mode `resolved`, bodies that overlap by rounding: they are in contact if they approach at some point that they share,
// faster than by roundings. If they do not, they are looked at again when they have parted and meet, or when their
// overlap has grown by more than roundings, and by twice as much each time.

/// In what time two bodies turn by some radians, s: how far exact tests look at a time. Finite.
template <int Degree>
double time_to_look_ahead(const certificates::RigidMotion<Degree>& a, const certificates::RigidMotion<Degree>& b);

/// Whether the turning of two bodies matters: not for two balls, or a ball and a half-space, since a ball covers the
/// same place in all orientations and a half-space does not turn.
inline bool turning_counts(const PlacedShape& a, const PlacedShape& b) {
  const auto counts = [](const Shape& shape) { return ball_radius(shape) == 0 && !unbounded(shape); };
  return counts(a.shape) || counts(b.shape);
}

/// The tests of two bodies that can both turn, or of a half-space (a) and a body that can turn.
template <int Degree>
struct TurningContact {
  using Motion = certificates::RigidMotion<Degree>;
  using Body = MovingShape<Motion>;

  static double first_contact(const Body& a, const Body& b, double t0, double horizon, ContactMode mode, FoundTouch*);
  /// The same, or a later time, up to `farthest`, before which there is no contact: {never, false} if there is none
  /// until then. With `earlier` perhaps an earlier one.
  static ContactEstimate estimated_contact(const Body& a, const Body& b, double t0, double horizon, double farthest,
                                           ContactMode mode, bool earlier);
  /// A time before which there is no contact; t0 where that takes exact signs.
  static double apart_until(const Body& a, const Body& b, double t0, double horizon, PairMemory&);
  static bool in_contact(const Body& a, const Body& b, double t);
  static double first_separation(const Body& a, const Body& b, double t0, double horizon);

  /// Point, normal and features of the shapes in their places at t. The point is the middle of the points that the two
  /// share or, where that does not approach but another one does, the corner of that set that approaches fastest.
  static Contact contact_at(const Body& a, const Body& b, double t, const FoundTouch&);
};

#define KDS_DECLARE(degree)                                                           \
  extern template struct TurningContact<degree>;                                      \
  extern template double time_to_look_ahead(const certificates::RigidMotion<degree>&, \
                                            const certificates::RigidMotion<degree>&);
KDS_DECLARE(1) KDS_DECLARE(2)
#undef KDS_DECLARE

}  // namespace kds::collision
