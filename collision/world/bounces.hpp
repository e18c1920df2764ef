// How bodies that keep their orientation bounce, and which of their contacts last.
#pragma once

#include "collision/world/bending_bounces.hpp"
#include "collision/world/listener_calls.hpp"
#include "collision/world/motion_updates.hpp"
#include "collision/world/world_parts.hpp"

#include <cstdint>

namespace kds::collision {

/// The response to contacts of bodies that keep their orientation. TurningBounces is that for bodies that turn.
template <class Motion>
class Bounces {
 public:
  Bounces(WorldParts<Motion>& parts, MotionUpdates<Motion>& motions, ListenerCalls<Motion>& calls,
          const BendingBounces<Motion>& bending);

  /// The rate at which b parts from a along the normal just after the contact; where it is zero, its first derivative
  /// that is not, up to a positive factor.
  double parting(BodySlot a, BodySlot b, const Contact& contact) const;
  /// Of two bodies that have met others `burst` times at nearly one time. Returns whether the Zeno policy acted.
  bool respond(BodySlot a, BodySlot b, const Contact& contact, std::uint64_t burst);
  /// A body bounces off a wall, which is reported. Precondition: it is due.
  void process_wall();

 private:
  using Resting = RestingPart<Motion>;

  bool stays(double rebound, double pressed, double size, std::uint64_t burst) const;
  bool endless(std::uint64_t burst) const;
  void bounce_off_wall(BodySlot slot, const Motion& motion);
  void bounce_off_surface(BodySlot a, BodySlot b, const Contact& contact, std::uint64_t burst);
  bool strike(BodySlot a, BodySlot b, const Contact& contact, double restitution);
  bool bounce_or_rest(BodySlot a, BodySlot b, const Contact& contact, double restitution, std::uint64_t burst);
  void begin_rest(BodySlot a, BodySlot b, const Contact& contact);

  const WorldOptions& options_;
  const Clock& clock_;
  WorldCounters& counters_;
  Bodies<Motion>& bodies_;
  const Volumes<Motion>& volumes_;
  const WallTimes<Motion>& walls_;
  Resting& resting_;
  MotionUpdates<Motion>& motions_;
  ListenerCalls<Motion>& calls_;
  const BendingBounces<Motion>& bending_;
};

}  // namespace kds::collision
