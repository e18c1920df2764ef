// How a periodic world reports its events.
#pragma once

#include "collision/narrow_phase/contact.hpp"
#include "collision/periodic/period_lattice.hpp"
#include "collision/world_listener.hpp"

#include <cstdint>

namespace kds::collision {

/// Two bodies, a with the lower id, and the copy of b that a meets: b moved by `offset` periods. The contact is where a
/// is; its normal points from a to that copy of b.
struct PeriodicEvent {
  BodyId a;
  BodyId b;
  Offset offset;
  Contact contact;
  double impulse = 0;  ///< mass * length/s: given to b along the normal, and to a against it
  std::uint64_t user_data_a = 0;
  std::uint64_t user_data_b = 0;
};

template <int Degree>
class PeriodicWorld;

/// Told of events in order of time; at one time as BasicWorldListener says, by ids in PeriodicWorld::world(), and of
/// `wrapped` last. Callbacks may add, remove and move bodies.
template <int Degree>
class PeriodicListener {
 public:
  virtual ~PeriodicListener() = default;
  virtual void contact(PeriodicWorld<Degree>&, const PeriodicEvent&) {}  ///< motions are as after the impulse
  /// Two overlap when one of them is added, or is given a motion that begins elsewhere; they pass through each other
  /// until they have separated.
  virtual void overlap(PeriodicWorld<Degree>&, const PeriodicEvent&) {}
  /// Two pass through each other until they have separated: both are fixed, or a callback has left them approaching, or
  /// their contacts do not end (ZenoPolicy).
  virtual void passes(PeriodicWorld<Degree>&, const PeriodicEvent&) {}
  virtual void wall(PeriodicWorld<Degree>&, const WallEvent&) {}  ///< motions are as after response
  /// A body has left the box and come in at the other side: its place has changed by minus this many periods.
  virtual void wrapped(PeriodicWorld<Degree>&, BodyId, const Offset&) {}
};

}  // namespace kds::collision
