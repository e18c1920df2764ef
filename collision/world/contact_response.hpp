// What follows from contacts.
#pragma once

#include "collision/response/contact_law.hpp"
#include "collision/world/bending_bounces.hpp"
#include "collision/world/bounces.hpp"
#include "collision/world/guard.hpp"
#include "collision/world/listener_calls.hpp"
#include "collision/world/motion_updates.hpp"
#include "collision/world/turning/turning_bounces.hpp"
#include "collision/world/world_parts.hpp"

#include <cstdint>
#include <type_traits>

namespace kds::collision {

/// Processes contacts and separations of bodies: they are reported, the bodies respond as the options say, and pairs
/// that approach all the same are let pass.
template <class Motion>
class ContactResponse {
 public:
  ContactResponse(WorldParts<Motion>& parts, MotionUpdates<Motion>& motions, ListenerCalls<Motion>& calls,
                  const Guard& guard);
  ContactResponse(const ContactResponse&) = delete;
  ContactResponse& operator=(const ContactResponse&) = delete;

  /// The next event of the pairs; of bodies and walls; of meshes that bend, each with itself. Precondition: it is due.
  void process_pair();
  void process_wall() { bounces_.process_wall(); }
  void process_self_contact();

 private:
  void process_contact(BodySlot a, BodySlot b, const Contact& contact);
  void respond_by_law(BodySlot a, BodySlot b, const Contact& contact);
  MeetingBody meeting_body(BodySlot slot) const;
  void require_lawful(BodySlot slot, const Velocities& before, const Velocities& after) const;
  void change_velocities(BodySlot slot, const Velocities& after);
  void let_through(BodySlot a, BodySlot b, const Contact& contact);
  std::uint64_t count_meeting(BodySlot a, BodySlot b);
  std::uint64_t patience() const { return 10 * std::uint64_t{options_.zeno.contacts}; }

  const WorldOptions& options_;
  const Clock& clock_;
  WorldCounters& counters_;
  Bodies<Motion>& bodies_;
  Reports& reports_;
  RestingPart<Motion>& resting_;
  Pairs<Motion>& pairs_;
  SelfContacts<Motion>& self_contacts_;
  MotionUpdates<Motion>& motions_;
  ListenerCalls<Motion>& calls_;
  const Guard& guard_;
  BendingBounces<Motion> bending_;
  std::conditional_t<turns<Motion>, TurningBounces<Motion>, Bounces<Motion>> bounces_;
};

}  // namespace kds::collision
