// Contacts of meshes that bend, with each other and with shapes that keep theirs.
#pragma once

#include "certificates/point_motion.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"

namespace kds::collision {

/// The tests (see pair_tests.hpp) of a mesh that bends (a) with any shape that keeps its orientation, or bends, too.
///
/// Laws. Two shapes are in contact from when they are no farther apart than a tolerance, the part `bending_tolerance`
/// of the radius of a, until they are farther apart by more than that, and less than twice that. (1) Nothing is missed
/// and nothing is late: they do not touch before that time (surface_contact.hpp). (2) Early by the tolerance at most.
/// (3) Both times are functions of the two shapes and motions alone: they do not depend on when is asked. Meshes are
/// surfaces, balls, boxes and capsules solid. (4) A separation that lasts less than 2^-10 of a piece may be passed over
/// while surfaces slide on each other in one plane (SurfaceTouching).
///
/// Mode `resolved`: contact is between one half of the tolerance and all of it, and of features that approach. What is
/// within the tolerance when a piece begins, as after an impulse, is in contact if it approaches there, or later if it
/// comes nearer by another part of the tolerance before it has left (SurfaceQuery::approaching). So what is turned back
/// at each contact never touches.
///
/// Method. The time is cut into pieces, at the keyframes of both; where nothing bends any more they grow from one to
/// the next. In each piece contacts and separations follow each other from its beginning, by SurfaceSearch and
/// SurfaceTouching. Pieces during which the balls around the two shapes are apart are passed over.
///
/// Cost: that of a step of the two surfaces, and a search, for each piece that is looked at.
template <int Degree>
struct BendingContact {
  using Body = TranslatingShape<Degree>;

  static double first_contact(const Body& a, const Body& b, double t0, double horizon, ContactMode mode, FoundTouch*);
  /// Until the balls around them overlap.
  static double apart_until(const Body& a, const Body& b, double t0, double horizon, PairMemory&);
  static bool in_contact(const Body& a, const Body& b, double t);
  static double first_separation(const Body& a, const Body& b, double t0, double horizon);
  /// Of several features within the tolerance those that approach fastest, then the closest.
  static Contact contact_at(const Body& a, const Body& b, double t, const FoundTouch&);
};

extern template struct BendingContact<1>;
extern template struct BendingContact<2>;

/// How the surface of a shape moves where it touches, from a time on, beyond the motion of its body.
struct SurfaceRate {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();     ///< units of length a second
  Eigen::Vector3d normal_rate = Eigen::Vector3d::Zero();  ///< of the normal of the contact, 1/s, as it turns along
};

/// That of a mesh that bends, by the velocities of the vertices of the feature; of shapes that do not bend it is zero.
/// `point`: of the feature, from the centre of the body; `normal`: of the contact, of either sign.
SurfaceRate surface_rate(const PlacedShape& shape, const Feature& feature, const Eigen::Vector3d& point,
                         const Eigen::Vector3d& normal, double t);

}  // namespace kds::collision
