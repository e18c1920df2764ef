// Contacts of meshes that turn, with meshes, boxes, balls and capsules.
#pragma once

#include "certificates/turning/rigid_motion.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"

namespace kds::collision {

/// The tests of a mesh (a) with a mesh, a box, a ball or a capsule (b) of bodies that turn.
///
/// Law. A mesh is its surface, a set of triangles; a ball, a box or a capsule is solid. Contact is the first double
/// just after which a triangle of a penetrates b, or a triangle of b, by exact signs (see TurningTriangles,
/// TurningTriangleAndBox, TurningTriangleAndBall, TurningTriangleAndCapsule for what penetrates). What touches, or
/// slides in one plane, is not in contact.
///
/// Two closed meshes penetrate, too, if the surface of each enters the solid that the other bounds at an edge that lies
/// in the plane of a triangle at all times (FlushEntry), as crates of one outline that fall on each other: of these no
/// two triangles do more than touch. Surfaces that are not closed do not penetrate then.
///
/// What is exact of a mesh are its vertices times its scale, each coordinate rounded to a double (scaled_vertex), as
/// points of the body, turned by the exact rotation of its motion. All parts use these numbers.
///
/// Method. Pairs of nodes of the trees wait in a queue, each until the time up to which they are proven to be apart, in
/// floats. The pair whose time is the earliest is looked at then, with those that come soon after it, some at a time
/// (nodes_apart): proven again, if that lasts for a while, or else split. Pairs of triangles are proven apart by
/// floats, some at a time (TriangleGaps), by doubles (TurningHulls), and only where that does not help on, by exact
/// signs (WaysApart). So the time that is found does not depend on what floats and doubles prove.
///
/// Mode `resolved`: a pair of triangles that penetrates counts if it approaches where it touches, faster than by
/// roundings. Otherwise it is passed over until it has parted and meets again, or until its overlap has grown by more
/// than roundings, which is decided in doubles; where they do not tell, for a short time, and then twice the time each.
/// So of two triangles that touch but for roundings, and part, doubles tell all that counts: whether they penetrate at
/// first is not asked.
template <int Degree>
struct TurningMeshContact {
  using Motion = certificates::RigidMotion<Degree>;
  using Body = MovingShape<Motion>;

  /// In FoundTouch the triangles are leaves of the trees, of b the only one where it is no mesh.
  static double first_contact(const Body& a, const Body& b, double t0, double horizon, ContactMode mode, FoundTouch*);
  /// A time before which there is no contact; t0 where the balls around the two overlap.
  static double apart_until(const Body& a, const Body& b, double t0, double horizon, PairMemory&);
  static bool in_contact(const Body& a, const Body& b, double t);
  static double first_separation(const Body& a, const Body& b, double t0, double horizon);

  /// Of the pair of triangles that approaches fastest among those that penetrate just after t (or, where none does, did
  /// just before t, or are nearest): along the direction in which they are the least deep in each other, in doubles.
  static Contact contact_at(const Body& a, const Body& b, double t, const FoundTouch&);
};

#define KDS_DECLARE(degree) extern template struct TurningMeshContact<degree>;
KDS_DECLARE(1) KDS_DECLARE(2)
#undef KDS_DECLARE

}  // namespace kds::collision
