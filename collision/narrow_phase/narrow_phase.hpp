// Narrow phase: when two moving shapes touch, and where.
#pragma once

#include "certificates/point_motion.hpp"
#include "collision/narrow_phase/contact.hpp"
#include "collision/shapes/shape.hpp"
#include "collision/vectors.hpp"
#include "kds/arithmetic/lattice.hpp"

#include <cstdint>

namespace kds::collision {

/// What happens to bodies that touch.
enum class ContactMode {
  transparent,  ///< they pass through each other; contact and separation alternate
  resolved,     ///< an impulse turns them back: contact counts only while they approach
};

/// A shape and its motion; refers to both.
template <class Motion>
struct MovingShape {
  const PlacedShape& shape;
  const Motion& motion;
};

/// A shape that keeps its orientation.
template <int Degree>
using TranslatingShape = MovingShape<certificates::PointMotion<Degree>>;

/// The triangles of two shapes that touch first, and when: what contact_at would look for again. It saves time; all
/// answers are the same without it.
struct FoundTouch {
  double time = never;  ///< on the clock; `never`: nothing is known
  double tau = 0;       ///< s, from the epoch of the pair: the later of the two motions' starts
  std::uint32_t triangle_a = 0, triangle_b = 0;
};

/// Whether there are tests for shapes of this kind that move so: bodies that turn are balls, boxes, capsules, hulls,
/// meshes and compounds; meshes that bend move on straight lines and parabolas.
template <class Motion>
bool can_move_by(const Shape& shape);

/// The first time t in [t0, horizon] at which a and b come into contact, or `never`.
///
/// Spheres, boxes and capsules: the first double just after which they penetrate, by exact signs, of shapes as their
/// rounded axes describe them. (Two boxes with edges that are parallel but for an angle below 2^-40 may be found early,
/// by at most that part of their size: box_and_box.hpp.) Meshes: never late, early by at most the margin of
/// mesh_contact.hpp; but of bodies that turn by exact signs, too (turning_mesh_contact.hpp). The answer depends on the
/// two shapes and motions alone, and on t0 only in that earlier contacts are passed over.
///
/// Of bodies that turn the horizon is finite, here and below.
///
/// Mode `resolved`: shapes that overlap at t0 by rounding (an impulse has just been applied) are in contact only if
/// they approach. Mode `transparent`: t0 itself where they overlap there.
///
/// If `found` is given and meshes touch, it receives the triangles, where contact_at can use them; otherwise it does
/// not change. Precondition, here and below: where there is a mesh, both motions have started by t0 (or t).
template <class Motion>
double first_contact(const MovingShape<Motion>& a, const MovingShape<Motion>& b, double t0, double horizon,
                     ContactMode mode, FoundTouch* found = nullptr);

/// What a pair remembers from test to test. It saves time; all answers are the same without it.
struct PairMemory {
  static constexpr std::uint8_t none = 255;
  std::uint8_t axis = none;  ///< the number of the axis that separated the two
};

/// A time before which a and b do not come into contact.
struct ContactEstimate {
  double time;
  bool exact;  ///< it is the time of the first contact, or `never` if there is none
};

/// As first_contact, or an earlier time before which there is no contact, which mostly costs less: the kinetic
/// separating axis. As long as there is a direction along which the boxes around the shapes (of boxes: the shapes
/// themselves) are apart, nothing happens; the last such direction fails at a root of a polynomial of the motion's
/// degree. Until then the pair needs no further test. If a motion changes before, the old direction is tried first; so
/// for most pairs the exact time is never asked for. Two balls: the time of first_contact.
template <class Motion>
ContactEstimate estimated_first_contact(const MovingShape<Motion>& a, const MovingShape<Motion>& b, double t0,
                                        double horizon, ContactMode mode, PairMemory& memory,
                                        FoundTouch* found = nullptr);

/// As first_contact, but for bodies that turn it looks only some turns ahead: if there is no contact in these, it
/// returns the time from which to go on.
template <class Motion>
ContactEstimate certified_first_contact(const MovingShape<Motion>& a, const MovingShape<Motion>& b, double t0,
                                        double horizon, ContactMode mode, FoundTouch* found = nullptr);
/// The same of first_separation.
template <class Motion>
ContactEstimate certified_first_separation(const MovingShape<Motion>& a, const MovingShape<Motion>& b, double t0,
                                           double horizon);

/// Whether a and b penetrate just after t.
template <class Motion>
bool in_contact(const MovingShape<Motion>& a, const MovingShape<Motion>& b, double t);

/// The first time t in [t0, horizon] just after which a and b do not penetrate, or `never`.
template <class Motion>
double first_separation(const MovingShape<Motion>& a, const MovingShape<Motion>& b, double t0, double horizon);

/// Point, normal and features of the contact at t, a time that first_contact, in_contact or first_separation has named.
/// In doubles: accurate to some ulps of the coordinates. `found`: what first_contact has told of the same motions; the
/// contact is the same without it.
template <class Motion>
Contact contact_at(const MovingShape<Motion>& a, const MovingShape<Motion>& b, double t, const FoundTouch& found = {});

/// The same of two balls; the first has the radius `radius_a`. Concentric balls have the normal (1, 0, 0).
template <int Degree>
Contact ball_contact_at(const certificates::PointMotion<Degree>& a, const certificates::PointMotion<Degree>& b,
                        double radius_a, double t) {
  Contact contact;
  contact.time = t;
  const Eigen::Vector3d centre_a = a.position(t);
  const Eigen::Vector3d apart = b.position(t) - centre_a;
  if (norm(apart) > 0) contact.normal = normalized(apart);
  contact.point = centre_a + contact.normal * radius_a;
  return contact;
}

}  // namespace kds::collision
