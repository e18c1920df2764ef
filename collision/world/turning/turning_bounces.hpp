// How bodies that turn bounce off each other, off meshes that bend, and off walls.
#pragma once

#include "collision/response/turning_impulse.hpp"
#include "collision/world/bending_bounces.hpp"
#include "collision/world/listener_calls.hpp"
#include "collision/world/motion_updates.hpp"
#include "collision/world/turning/turning_impact.hpp"
#include "collision/world/world_parts.hpp"

#include <cstdint>

namespace kds::collision {

/// The response to contacts of bodies that turn. Bounces is that for bodies that keep their orientation.
template <class Motion>
class TurningBounces {
 public:
  TurningBounces(WorldParts<Motion>& parts, MotionUpdates<Motion>& motions, ListenerCalls<Motion>& calls,
                 const BendingBounces<Motion>& bending);

  /// The rate at which b parts from a at the point of contact; 0 where it is no larger than roundings.
  double parting(BodySlot a, BodySlot b, const Contact& contact) const;
  /// Of two bodies that have met others `burst` times at nearly one time. Returns whether the Zeno policy acted.
  bool respond(BodySlot a, BodySlot b, const Contact& contact, std::uint64_t burst);
  /// A body bounces off a wall, which is reported. Precondition: it is due.
  void process_wall();

 private:
  double pressed(BodySlot a, const Motion& motion_a, BodySlot b, const Motion& motion_b, const Contact& contact) const;
  double rebound(double approach, double pressed, double restitution) const;
  bool rests_now(BodySlot a, BodySlot b, const Contact& contact);
  bool precesses(BodySlot slot) const { return tumbling_.has(slot) && !resting_.carries(slot); }
  Mobility mobility(BodySlot slot) const;
  Motion met(BodySlot slot, double t);
  TurningImpact<Motion> impact(BodySlot a, BodySlot b, const Contact& contact, std::uint64_t burst);
  void turn_back(BodySlot a, BodySlot b, Motion& motion_a, Motion& motion_b, const Contact& contact);
  // turning_collapse.cpp
  Collapse part_together(BodySlot a, BodySlot b, const Contact& contact, const TurningImpact<Motion>& hit,
                         std::uint64_t burst);

  const WorldOptions& options_;
  const Clock& clock_;
  WorldCounters& counters_;
  Bodies<Motion>& bodies_;
  Tumbling<Motion>& tumbling_;
  const WallTimes<Motion>& walls_;
  Reports& reports_;
  RestingPart<Motion>& resting_;
  MotionUpdates<Motion>& motions_;
  ListenerCalls<Motion>& calls_;
  const BendingBounces<Motion>& bending_;
};

}  // namespace kds::collision
