// Contacts of meshes that bend with half-spaces.
#pragma once

#include "collision/motions.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"

namespace kds::collision {

/// The tests (see pair_tests.hpp) of a half-space (a) and a mesh that bends (b).
///
/// Laws. They are those of BendingContact: the two are in contact from when a vertex is no higher above the plane than
/// the tolerance, the part `bending_tolerance` of the radius of b, until no vertex is; what is below the plane touches.
/// Contact begins never late, and early by a half of the tolerance at most beyond it.
///
/// Method. From keyframe to keyframe the height of each vertex is a polynomial, whose roots tell when it is within the
/// tolerance. Pieces before the ball around the mesh reaches the plane are passed over.
///
/// Cost: O(n) for each piece that is looked at.
template <class Motion>
struct HalfSpaceAndBendingMesh {
  using Body = MovingShape<Motion>;

  static double first_contact(const Body& a, const Body& b, double t0, double horizon, ContactMode mode, FoundTouch*);
  /// Until the ball around the mesh meets the plane.
  static double apart_until(const Body& a, const Body& b, double t0, double horizon, PairMemory&);
  static bool in_contact(const Body& a, const Body& b, double t);
  static double first_separation(const Body& a, const Body& b, double t0, double horizon);
  /// With the lowest vertex; of several the first. The normal leads out of the half-space.
  static Contact contact_at(const Body& a, const Body& b, double t, const FoundTouch&);
};

#define KDS_DECLARE(motion) extern template struct HalfSpaceAndBendingMesh<motion>;
KDS_FOR_ALL_QUADRATIC(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
