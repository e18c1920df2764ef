// How callers change a world.
#pragma once

#include "collision/body_description.hpp"
#include "collision/response/principal_inertia.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "collision/world/callers_clock.hpp"
#include "collision/world/edits/edit_limit.hpp"
#include "collision/world/guard.hpp"
#include "collision/world/membership.hpp"
#include "collision/world/motion_updates.hpp"
#include "collision/world/world_parts.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace kds::collision {

/// The functions of a world (world.hpp documents them) that add, remove, move and change bodies, and set timers. Each
/// checks what it is given before it changes anything.
template <class Motion>
class Edits {
 public:
  using Description = BasicBodyDescription<Motion>;

  Edits(WorldParts<Motion>& parts, MotionUpdates<Motion>& motions, Membership<Motion>& membership, Guard& guard,
        CallersClock& callers);
  Edits(const Edits&) = delete;
  Edits& operator=(const Edits&) = delete;

  // edits.cpp
  void reserve(std::size_t bodies);
  BodyId add_body(const Description& description);
  void remove_body(BodyId id);
  // motion_edits.cpp
  void update_motion(BodyId id, std::span<const Motion> pieces);
  void append_motion(BodyId id, std::span<const Motion> pieces);
  void update_vertices(BodyId id, std::vector<MeshScript::Keyframe> keyframes);
  // property_edits.cpp
  void set_mass(BodyId id, double mass);
  void set_restitution(BodyId id, double restitution);
  void set_filter(BodyId id, std::uint32_t category, std::uint32_t collides_with);
  void set_group(BodyId id, std::uint32_t group);
  void ignore_pair(BodyId a, BodyId b, bool ignored);
  void set_user_data(BodyId id, std::uint64_t user_data);
  TimerId set_timer(double t);
  bool cancel_timer(TimerId timer);

  /// Begins an edit by `function`: refuses it where the world cannot be changed, and otherwise brings the parts to the
  /// time that callers know. `removed`: the body that will be removed, if one is.
  void begin(const char* function, BodySlot removed = no_body);
  /// Something changes, so the time of the next event has to be searched for again: where bodies change after the next
  /// step, which finds out what follows now. Edits by callbacks are counted, so that a run ends.
  void count(bool of_bodies = true);

  /// Of the edits by callbacks.
  const EditLimit& limit() const { return limit_; }
  void set_limit(const EditLimit& limit) { limit_ = limit; }

 private:
  BodyId add_attached(const Description& description);
  BodySlot put(const Description& description, std::shared_ptr<const PlacedShape> shape,
               const std::optional<PrincipalInertia>& principal);
  void require_own_motion(BodySlot slot, const char* function) const;
  void require_turns_for(BodySlot slot, std::span<const Motion> pieces, const char* name) const;
  void give_filter(BodySlot slot, const CollisionFilter& after);

  const WorldOptions& options_;
  const Clock& clock_;
  WorldCounters& counters_;
  Bodies<Motion>& bodies_;
  Scripts<Motion>& scripts_;
  Timers& timers_;
  Tumbling<Motion>& tumbling_;
  Volumes<Motion>& volumes_;
  RestingPart<Motion>& resting_;
  Pairs<Motion>& pairs_;
  SelfContacts<Motion>& self_contacts_;
  WorldParts<Motion>& parts_;
  MotionUpdates<Motion>& motions_;
  Membership<Motion>& membership_;
  Guard& guard_;
  CallersClock& callers_;
  EditLimit limit_;
};

}  // namespace kds::collision
