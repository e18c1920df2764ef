// Dynamic tests of bodies of several parts: the tests of their parts.
#pragma once

#include "collision/motions.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"

namespace kds::collision {

/// The tests (see pair_tests.hpp) of a compound (a) with any shape, also another compound.
///
/// The two are in contact while a part of one is in contact with a part of the other: so times are as exact as those of
/// the parts. Where contacts are resolved, each pair of parts is judged by itself: it counts if it approaches along its
/// own normal, and for bodies that turn, faster than by roundings. Parts move with their body, whose motion is not
/// rounded for it.
///
/// The contact at a time is the contact of the first pair of parts, in the order of the parts of a, then of b, that are
/// in contact and approach; if none approaches, of the first pair in contact; if none is in contact, of the first pair
/// that was in contact until then, else of the nearest pair. Its features are those of the two parts.
///
/// Cost: a few roots in doubles for each pair of parts, or, where there are many, for each pair of groups of parts that
/// come near each other (PartTree, PartPairs; of bodies that turn TurningPartPairs), and the tests of those whose
/// boxes, or balls, meet.
template <class Motion>
struct CompoundContact {
  using Body = MovingShape<Motion>;

  static double first_contact(const Body& a, const Body& b, double t0, double horizon, ContactMode mode,
                              FoundTouch* found);
  static double apart_until(const Body& a, const Body& b, double t0, double horizon, PairMemory& memory);
  static bool in_contact(const Body& a, const Body& b, double t);
  static double first_separation(const Body& a, const Body& b, double t0, double horizon);
  static Contact contact_at(const Body& a, const Body& b, double t, const FoundTouch& found);
};

#define KDS_DECLARE(motion) extern template struct CompoundContact<motion>;
KDS_FOR_ALL_MOTIONS(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
