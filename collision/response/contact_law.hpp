// How bodies respond to contacts, as a function that a caller gives.
#pragma once

#include <Eigen/Core>

#include <cstdint>

namespace kds::collision {

/// How a body moves at an instant: its centre, in length/s, and about it, in rad/s (zero for bodies that keep their
/// orientation).
struct Velocities {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();

  friend bool operator==(const Velocities&, const Velocities&) = default;
};

/// A body that meets another one.
struct MeetingBody {
  Eigen::Vector3d centre;
  Velocities before;
  double inverse_mass = 0;  ///< 0 if it is fixed
  double restitution = 1;
  std::uint64_t user_data = 0;
};

/// Two bodies that meet: a is the one with the lower id.
struct Meeting {
  double time;  ///< s
  Eigen::Vector3d point;
  Eigen::Vector3d normal;  ///< from a to b, of unit length
  MeetingBody a, b;
};

/// The response to contacts in mode `callback` (WorldOptions::law), of a World or of a ParallelWorld. A pair that it
/// leaves approaching passes through until it has separated.
///
/// So that the log of a ParallelWorld does not depend on how a scene is divided, an implementation keeps to two rules:
/// 1. What respond() does depends on the meeting alone. It may be called more than once for a contact, and for one that
///    proves later not to happen, since a domain did not know all bodies nearby.
/// 2. It has no effect but on the velocities, and may be called by several threads at once.
class ContactLaw {
 public:
  virtual ~ContactLaw() = default;
  /// Changes the velocities, which are those before the contact. They must be finite, and those of a fixed body, and
  /// the angular ones of bodies that keep their orientation, must stay as they are (else std::logic_error). Scripts and
  /// accelerations go on. Not called for sensors, nor where both bodies are fixed.
  virtual void respond(const Meeting& meeting, Velocities& a, Velocities& b) const = 0;
};

}  // namespace kds::collision
