// How motions change: of one body in all parts of a world.
#pragma once

#include "collision/body_motion.hpp"
#include "collision/broad_phase/kinetic_box.hpp"
#include "collision/world/resting/resting_contacts.hpp"
#include "collision/world/world_parts.hpp"

#include <cstddef>
#include <memory>

namespace kds::collision {

/// Gives bodies other motions, and tells all parts: when a piece of a script begins, when a caller says so, after a
/// contact, and when resting contacts solve for the bodies that they carry. Sensors follow the bodies that they are
/// attached to.
template <class Motion>
class MotionUpdates final : private RestingListener<Motion> {
 public:
  explicit MotionUpdates(WorldParts<Motion>& parts);

  /// A body that has entered moves otherwise from now on. `jumped`: from another place.
  void set(BodySlot slot, const Motion& motion, bool jumped);
  /// A caller gives a body a motion, which ends its script. If it has not entered, it is to enter now.
  void give(BodySlot slot, const Motion& motion);
  /// The bodies that rest on a body, or that it rests on, have to be solved for anew. Its script goes on. Precondition:
  /// it has entered, and `motion` is the one that it would have without its contacts.
  void move_freely(BodySlot slot, const Motion& motion);
  /// A body that has not entered has begun its motion, and so have the sensors that are attached to it.
  void wait_to_enter(BodySlot slot);
  /// Its volume has changed although it moves as before.
  void update_volume(BodySlot slot, const KineticBox<Motion::degree>& box);
  /// Begins all pieces of scripts that are due, at once: bodies that jump together are not apart in between. But those
  /// of bodies that enter only make them wait, so of these only `most` are begun.
  void start_pieces(std::size_t most);

  /// A body moves otherwise, and nothing else follows: the parts learn of it after that has been reported, since a
  /// listener often removes such a body. One at a time.
  void set_after_report(BodySlot slot, const Motion& motion);
  /// That body, of which the parts know the motion before; `no_body` if there is none.
  BodySlot awaiting_report() const { return reported_; }
  void take_up_reported();
  void forget_reported() { reported_ = no_body; }

  // turning/turning_pieces.cpp: bodies that precess
  /// A piece of a body that precesses is over. The next begins where it ends, so nothing has jumped.
  void turn_on() requires(turns<Motion>);
  /// Bodies that were left alone, and of which pairs are to be tested for more than whether their balls meet, get the
  /// pieces that they would have otherwise.
  void look_at_tested() requires(turns<Motion>);
  /// All of them get these.
  void look_at_all() requires(turns<Motion>);
  /// Its motion, or those of all, are about to be read: what was left alone has the piece that it would have otherwise,
  /// and stays alone.
  void read(BodySlot slot) requires(turns<Motion>);
  void read_all() requires(turns<Motion>);

 private:
  /// Changes the motion of a body that takes no part in the event, and reports it.
  void change(BodySlot slot, const Motion& motion);
  void move_attached(BodySlot slot, bool jumped);
  double left_alone_until(BodySlot slot) requires(turns<Motion>);
  void look_at(BodySlot slot) requires(turns<Motion>);
  void turn(BodySlot slot, const Motion& motion) requires(turns<Motion>);

  // Of resting contacts (RestingListener).
  void take_up(BodySlot slot, const Motion& motion) override;
  void changed(BodySlot a, BodySlot b) override { pairs_.changed(a, b); }
  void let_pass(BodySlot a, BodySlot b) override { pairs_.let_pass(a, b); }
  void tell_rebound_suppressed(BodySlot a, BodySlot b) override;
  void tell_resting(bool begins, const detail::RestingContact& contact) override;
  void tell_passes(const detail::RestingContact& contact) override;
  void tell_touched(BodySlot slot) override;
  Contact contact_of(const detail::RestingContact& contact) const;

  const WorldOptions& options_;
  const Clock& clock_;
  WorldCounters& counters_;
  Profile* profile_;
  Bodies<Motion>& bodies_;
  Scripts<Motion>& scripts_;
  Tumbling<Motion>& tumbling_;
  Volumes<Motion>& volumes_;
  WallTimes<Motion>& walls_;
  Reports& reports_;
  RestingPart<Motion>& resting_;
  Pairs<Motion>& pairs_;
  const std::unique_ptr<BroadPhase<Motion::degree>>& broad_phase_;
  BodySlot reported_ = no_body;
};

}  // namespace kds::collision
