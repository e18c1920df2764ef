// Narrow phase: when two moving shapes touch, and where.
#pragma once

#include "certificates/point_motion.hpp"
#include "collision/narrow_phase/contact.hpp"
#include "collision/shapes/shape.hpp"
#include "kds/arithmetic/lattice.hpp"

#include <cstdint>

namespace kds::collision {

/// What happens to bodies that touch.
enum class ContactMode {
  transparent,  ///< they pass through each other; contact and separation alternate
  resolved,     ///< an impulse turns them back: contact counts only while they approach
};

/// A shape on its way.
template <int Degree>
struct MovingShape {
  const PlacedShape& shape;
  const certificates::PointMotion<Degree>& motion;
};

/// The triangles of two shapes that touch first, and when: what contact_at would look for again. It saves time and
/// decides nothing.
struct FoundTouch {
  double time = never;  ///< on the clock; `never`: nothing is known
  double tau = 0;       ///< s, from the epoch of the pair
  std::uint32_t triangle_a = 0, triangle_b = 0;
};

/// The first time t in [t0, horizon] at which a and b come into contact, or `never`.
///
/// Spheres and boxes: the first double just after which they penetrate, by exact signs (for boxes and spheres against
/// boxes: of the shapes that their rounded axes describe). Meshes: never late, early by at most the margin of
/// mesh_contact.hpp. The answer depends on the two shapes and motions alone, and on t0 only in that earlier contacts
/// are passed over.
///
/// Mode `resolved`: shapes that overlap at t0 by rounding (an impulse has just been applied) are in contact only if
/// they approach. Mode `transparent`: t0 itself where they overlap there.
///
/// `found`, where it is wanted, is told which triangles touch, if that is a help to contact_at; else it stays.
template <int Degree>
double first_contact(const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t0, double horizon,
                     ContactMode mode, FoundTouch* found = nullptr);

/// What a pair remembers from test to test. It saves time and decides nothing.
struct PairMemory {
  static constexpr std::uint8_t none = 255;
  std::uint8_t axis = none;  ///< the number of the axis that separated the two
};

/// A time before which a and b do not come into contact.
struct ContactEstimate {
  double time;
  bool exact;  ///< it is the time of the first contact, or `never` if there is none
};

/// The same for less, mostly, or a time that is not later: the kinetic separating axis. As long as there is a direction
/// along which the boxes around the shapes (boxes: the shapes themselves) are apart, nothing happens; the last such
/// direction fails at a root of a polynomial of the motion's degree. Until then the pair needs no test, unless a motion
/// changes, and then the old direction is tried first, and most of what a contact asks for was never asked.
template <int Degree>
ContactEstimate estimated_first_contact(const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t0,
                                        double horizon, ContactMode mode, PairMemory& memory,
                                        FoundTouch* found = nullptr);

/// Whether a and b penetrate just after t.
template <int Degree>
bool in_contact(const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t);

/// The first time t in [t0, horizon] just after which a and b do not penetrate, or `never`.
template <int Degree>
double first_separation(const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t0, double horizon);

/// Point, normal and features of the contact at t, a time that first_contact or in_contact has named. In doubles:
/// accurate to some ulps of the coordinates. `found`: by first_contact, of the same motions; the contact is the same
/// without it.
template <int Degree>
Contact contact_at(const MovingShape<Degree>& a, const MovingShape<Degree>& b, double t, const FoundTouch& found = {});

/// The same of two balls, of which the first has this radius.
template <int Degree>
Contact ball_contact_at(const certificates::PointMotion<Degree>& a, const certificates::PointMotion<Degree>& b,
                        double radius_a, double t) {
  Contact contact;
  contact.time = t;
  const Eigen::Vector3d centre_a = a.position(t);
  const Eigen::Vector3d apart = b.position(t) - centre_a;
  if (apart.norm() > 0) contact.normal = apart.normalized();  // concentric balls: the default direction
  contact.point = centre_a + contact.normal * radius_a;
  return contact;
}

}  // namespace kds::collision
