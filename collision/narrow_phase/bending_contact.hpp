// Contacts of meshes that bend, with each other and with rigid shapes.
#pragma once

#include "collision/motions.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"

namespace kds::collision {

/// The tests (see pair_tests.hpp) of a mesh that bends (a) with any bounded shape, which may turn, or bend too. What
/// bends does not turn.
///
/// Laws. Two shapes are in contact from when they are no farther apart than a tolerance, the part `bending_tolerance`
/// of the radius of a, until they are farther apart by more than that, and less than twice that. (1) Nothing is missed
/// and nothing is late: they do not touch before that time (surface_contact.hpp). (2) Early by the tolerance at most;
/// where bodies turn, by a quarter of it more. (3) Both times are functions of the two shapes and motions alone: they
/// do not depend on the time from which they are searched. Meshes are surfaces, balls, boxes, capsules and hulls solid.
/// (4) A separation that lasts less than 2^-10 of a piece may be passed over while surfaces slide on each other in one
/// plane (SurfaceTouching).
///
/// Mode `resolved`: contact is between one half of the tolerance and all of it, and of features that approach. What is
/// within the tolerance when a piece begins, as after an impulse, is in contact if it approaches there, or later if it
/// comes nearer by another part of the tolerance before it has left (SurfaceQuery::approaching). So bodies that an
/// impulse turns back at each contact never touch.
///
/// Method. The time is cut into pieces, at the keyframes of both; where nothing bends any more they grow from one to
/// the next. In each piece contacts and separations follow each other from its beginning, by SurfaceSearch and
/// SurfaceTouching. Pieces during which the balls around the two shapes are apart are passed over. Where a body turns
/// pieces are cut into equal parts, in which its points move nearly on parabolas (RigidSurface::move); as long as the
/// two are not near many parts are taken as one, with parabolas that follow the points less closely.
///
/// Cost: that of a step of the two surfaces, and a search, for each piece that is looked at. A body that turns, and is
/// as large as the mesh, has some 300 parts a radian; those in which it is near are looked at one by one.
template <class Motion>
struct BendingContact {
  using Body = MovingShape<Motion>;

  static double first_contact(const Body& a, const Body& b, double t0, double horizon, ContactMode mode, FoundTouch*);
  /// Until the balls around them overlap.
  static double apart_until(const Body& a, const Body& b, double t0, double horizon, PairMemory&);
  static bool in_contact(const Body& a, const Body& b, double t);
  static double first_separation(const Body& a, const Body& b, double t0, double horizon);
  /// Of several pairs of features within the tolerance it takes the one that approaches fastest, then the closest.
  static Contact contact_at(const Body& a, const Body& b, double t, const FoundTouch&);
};

#define KDS_DECLARE(motion) extern template struct BendingContact<motion>;
KDS_FOR_ALL_QUADRATIC(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
