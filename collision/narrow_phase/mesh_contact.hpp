// Dynamic intersection tests of triangle meshes with meshes, boxes, balls and capsules.
#pragma once

#include "collision/degrees.hpp"
#include "collision/narrow_phase/mesh_margins.hpp"
#include "collision/narrow_phase/narrow_phase.hpp"
#include "collision/narrow_phase/relative_motion.hpp"
#include "collision/shapes/shape.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <optional>

namespace kds::collision {

/// A contact of a mesh (a) with another shape (b).
struct MeshTouch {
  double tau;  ///< s, from the motion's epoch
  std::uint32_t triangle_a;
  std::uint32_t triangle_b;  ///< 0 unless b is a mesh
  /// Found by first_contact: no other pair of triangles that touches just after tau has touched before this one.
  bool foremost = false;
};

/// Where and how they touch.
struct MeshTouchPlace {
  Eigen::Vector3d point;   ///< from the centre of a
  Eigen::Vector3d normal;  ///< unit, from a to b
  Feature feature_a;
  Feature feature_b;
};

/// A mesh (a) and any other shape (b), and the motion of b relative to a. Times are tau >= 0, from the motion's epoch.
///
/// A mesh is a surface: a body wholly inside it does not touch it. Other shapes are solid.
///
/// Laws. (1) Never late, never missed: contact is reported while surfaces are nearer than the contact gap (see
/// ContactGap for its size and derivation), and so no vertex or edge slips between two triangles that share an edge.
/// (Predictions end where the gap has grown to 2^-7 of the shapes: see `widest_gap` in mesh_margins.hpp.) (2) Early by
/// the gap and the rounding of the tests, at most 53/64 of it, measured along each separating axis (docs/accuracy.md:
/// 1.03 gaps were seen). (3) The times are closed forms of the shapes and the motion polynomial: they do not depend on
/// the window that is searched, or on the order of the walk through the trees. (4) Contact holds from its beginning
/// until just before its end: at the time that first_free_time returns there is none. (5) Among contacts at the same
/// time the one of the lowest triangle of a, then of b, wins.
///
/// Paper: [Gottschalk96] for the trees, [Eberly01] for dynamic separating axes. Cost: O(log n) box tests for a contact
/// of two convex parts, more as more of the surfaces run close to each other.
template <int Degree>
class MeshPair {
 public:
  /// Keeps references to the shapes, and a copy of the motion. Precondition: the shape of a is a mesh.
  MeshPair(const PlacedShape& a, const PlacedShape& b, const RelativeMotion<Degree>& motion);

  /// The first contact in [tau0, tau1]. Mode `transparent`: tau0 itself if they touch there. Mode `resolved`: a pair of
  /// triangles that touches at tau0 counts only if it approaches along its axis of least penetration; otherwise from
  /// when it turns to approach, or touches anew.
  std::optional<MeshTouch> first_contact(double tau0, double tau1, ContactMode mode) const;

  /// A time in [tau0, tau1] before which even the boxes around the shapes do not touch, or `never`.
  double apart_until(double tau0, double tau1) const;

  /// Whether they touch at tau.
  bool touching(double tau) const;

  /// The first time in [tau, limit] at which they do not touch, or `never`.
  double first_free_time(double tau, double limit) const;

  /// How they touch at tau. Of several touching pairs of triangles: one that approaches, the earliest to touch, the
  /// lowest. At a time when they have just ceased to touch: the pair that was last. `known`: the result of
  /// first_contact, if tau is its time, rounded to the clock; the answer is the same, at less cost.
  MeshTouchPlace where(double tau, const MeshTouch* known = nullptr) const;

 private:
  template <class Question>
  auto ask(const Question& question) const;

  const PlacedShape& a_;
  const PlacedShape& b_;
  RelativeMotion<Degree> motion_;
  ContactGap<Degree> gap_;
};

#define KDS_DECLARE(degree) extern template class MeshPair<degree>;
KDS_FOR_ALL_DEGREES(KDS_DECLARE)
#undef KDS_DECLARE

/// The tests (see pair_tests.hpp) of a mesh (a) with any shape.
///
/// The time of a contact is the first double t of the clock with t - epoch >= tau, where the difference is rounded, or
/// t0 if that is later.
template <int Degree>
struct MeshContact {
  using Body = TranslatingShape<Degree>;

  static double first_contact(const Body& a, const Body& b, double t0, double horizon, ContactMode mode,
                              FoundTouch* found = nullptr);
  static double apart_until(const Body& a, const Body& b, double t0, double horizon, PairMemory& memory);
  static bool in_contact(const Body& a, const Body& b, double t);
  static double first_separation(const Body& a, const Body& b, double t0, double horizon);
  static Contact contact_at(const Body& a, const Body& b, double t, const FoundTouch& found = {});
};

#define KDS_DECLARE(degree) extern template struct MeshContact<degree>;
KDS_FOR_ALL_DEGREES(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
