// Dynamic tests of spheres and boxes, by exact signs.
#pragma once

#include "collision/degrees.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"

namespace kds::collision {

/// The functions of narrow_phase.hpp for shapes that are spheres or boxes. Precondition: none of the two is a mesh.
///
/// Method: the set of relative positions in which two convex shapes penetrate is a union of convex *pieces* (one for
/// two spheres or two boxes; slabs, edge cylinders and vertex balls for a box and a sphere), and each piece is a
/// conjunction of polynomial certificates that are all broken inside it. The first contact is the least of the
/// pieces' first times, each found by jumping from one failure time to the next. A filter in doubles decides most of
/// it (quick_motion.hpp).
/// Paper: [Eberly01] for the separating axes; [Basch99] for certificates that witness disjointness.
template <int Degree>
struct ConvexContact {
  using Body = MovingShape<Degree>;

  static double first_contact(const Body& a, const Body& b, double t0, double horizon, ContactMode mode);
  /// A time in [t0, never] before which there is no contact; later than the horizon if there is none until then.
  static double apart_until(const Body& a, const Body& b, double t0, double horizon, PairMemory& memory);
  static bool in_contact(const Body& a, const Body& b, double t);
  static double first_separation(const Body& a, const Body& b, double t0, double horizon);
  static Contact contact_at(const Body& a, const Body& b, double t);
};

#define KDS_DECLARE(degree) extern template struct ConvexContact<degree>;
KDS_FOR_ALL_DEGREES(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
