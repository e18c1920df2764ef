// Which bodies the parts of a world know.
#pragma once

#include "collision/world/motion_updates.hpp"
#include "collision/world/world_parts.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace kds::collision {

/// Bodies that enter the parts of a world, leave them, or leave and enter again since they may collide with others from
/// now on.
template <class Motion>
class Membership {
 public:
  using Begin = typename Pairs<Motion>::Begin;

  Membership(WorldParts<Motion>& parts, MotionUpdates<Motion>& motions);

  /// As soon as there is a mesh all volumes include contact gaps: this enlarges those of the bodies that are there.
  void make_room_for_meshes();
  /// Bodies that wait enter, in order, at most so many.
  void enter_waiting(std::size_t most);
  /// Those enter that are alive and have not entered. `begin`: how their pairs begin.
  void enter(std::span<const BodySlot> entering, Begin begin);
  /// Removes a body. Precondition: no sensor is attached to it.
  void take_out(BodySlot slot);
  /// Removes it with the sensors that are attached to it.
  void take_out_with_sensors(BodySlot slot);
  /// Gives back memory that the bodies which are left do not need, once three in four have gone. What is stored by slot
  /// stays: ids have slots in them, and any slot may be given again. Cost: O(1) a body that goes, amortised. To be
  /// called between steps.
  void fit() {
    constexpr std::size_t least_worth_it = 4096;
    constexpr std::size_t most_slots_a_body = 16;  // or it would cost too much to look at all slots
    most_ = std::max(most_, bodies_.size());
    if (most_ < least_worth_it || 4 * bodies_.size() > most_) return;
    if (most_slots_a_body * most_ >= bodies_.slots()) fit_to_rest();
  }
  /// Makes a change of those with which a body that has entered may collide. The body leaves the broad phase, which
  /// ends all its pairs except those that overlap, and enters it again.
  template <class Change>
  void filter_anew(BodySlot slot, const Change& change);

 private:
  using Entry = typename BroadPhase<Motion::degree>::Entry;

  void expect_waiting();
  void fit_to_rest();

  const WorldOptions& options_;
  const Clock& clock_;
  Profile* profile_;
  Bodies<Motion>& bodies_;
  Volumes<Motion>& volumes_;
  WallTimes<Motion>& walls_;
  Reports& reports_;
  RestingPart<Motion>& resting_;
  Pairs<Motion>& pairs_;
  Unbounded<Motion>& unbounded_;
  SelfContacts<Motion>& self_contacts_;
  const std::unique_ptr<BroadPhase<Motion::degree>>& broad_phase_;
  WorldParts<Motion>& parts_;
  MotionUpdates<Motion>& motions_;
  std::size_t most_ = 0;  ///< bodies that there have been since memory was given back
};

template <class Motion>
template <class Change>
void Membership<Motion>::filter_anew(BodySlot slot, const Change& change) {
  // Events of the broad phase that are due happen before the change.
  while (broad_phase_->advance(clock_.now, pairs_)) {
  }
  const Motion free = parts_.free_motion(slot, clock_.now);
  if (bodies_.in_broad_phase(slot)) broad_phase_->remove(slot, clock_.now, pairs_);
  unbounded_.end_pairs(slot);
  change();
  if (bodies_.in_broad_phase(slot)) {
    const KineticBox<Motion::degree> box = volumes_.renew(slot);
    const Entry entry{slot, &box};
    broad_phase_->insert({&entry, 1}, clock_.now, pairs_);
  }
  unbounded_.begin_pairs(slot);
  volumes_.schedule(slot);
  if (resting_.drop_filtered(slot)) motions_.move_freely(slot, free);
}

}  // namespace kds::collision
