// The parts of a world, and the broad phase that serves them.
#pragma once

#include "collision/body_motion.hpp"
#include "collision/broad_phase/broad_phase.hpp"
#include "collision/profile.hpp"
#include "collision/world/bodies.hpp"
#include "collision/world/clock.hpp"
#include "collision/world/pairs/pairs.hpp"
#include "collision/world/reports.hpp"
#include "collision/world/resting/resting_contacts.hpp"
#include "collision/world/scripts.hpp"
#include "collision/world/self_contacts.hpp"
#include "collision/world/timers.hpp"
#include "collision/world/turning/tumbling.hpp"
#include "collision/world/unbounded.hpp"
#include "collision/world/volumes.hpp"
#include "collision/world/wall_times.hpp"
#include "collision/world/world_part.hpp"
#include "collision/world_counters.hpp"
#include "collision/world_options.hpp"

#include <cstddef>
#include <memory>

namespace kds::collision {

/// The parts of a world, each with a state, a queue and laws of its own (world_part.hpp), with what they share:
/// options, clock, counters, and the broad phase, which is made for the bodies as they are. What one event or one edit
/// means to several parts is in the classes that are given these: motion_updates.hpp, membership.hpp,
/// contact_response.hpp.
///
/// Law: each body that has entered has the same motion in the bodies, the broad phase, the pairs, the wall times, and
/// the volumes; audit() checks it. MotionUpdates says when a bounce off a wall may be late.
template <class BodyMotionType>
struct WorldParts {
  using Motion = BodyMotionType;
  using Resting = RestingPart<Motion>;

  /// Throws std::invalid_argument for options that are not valid.
  explicit WorldParts(const WorldOptions& given);
  WorldParts(const WorldParts&) = delete;
  WorldParts& operator=(const WorldParts&) = delete;

  /// The parts, in the order in which their events are processed if they are due at one time.
  auto list() { return list_of(*this); }
  auto list() const { return list_of(*this); }

  /// Makes a broad phase for the bodies as they are now; pairs are listed as it finds them.
  void rebuild_broad_phase();
  /// Makes one without bodies.
  void make_broad_phase();
  /// Puts the clock back to t after a search for events has run ahead of it: it has moved the broad phase beyond all
  /// times at which bounding volumes meet and part, and nothing else has happened since.
  void go_back(double t);
  /// Makes events up to `limit` known, and those of a window after the present horizon.
  void extend_horizon(double limit);
  /// Makes room for so many bodies. Throws std::length_error if there cannot be so many.
  void reserve(std::size_t size);

  /// Whether work of this instant is left to be done or reported.
  bool any_work() const { return bodies.any_waits() || !resting.solved() || !pairs.tested() || !reports.empty(); }
  /// The motion that a body would have at t without its resting contacts.
  Motion free_motion(BodySlot slot, double t) const;
  /// All counts, with those of the broad phase.
  WorldCounters all_counters() const;
  /// Null if nobody wants one.
  Profile* profile() { return options.profile ? &work_profile : nullptr; }
  /// audit.cpp. Throws AuditFailure if the parts are not consistent just after t.
  void audit(double t) const;

  const WorldOptions options;
  Clock clock;
  WorldCounters counters;
  Profile work_profile;
  Bodies<Motion> bodies;
  Scripts<Motion> scripts;
  Timers timers;
  Tumbling<Motion> tumbling;
  Volumes<Motion> volumes;
  WallTimes<Motion> walls;
  Reports reports;
  Resting resting;
  Pairs<Motion> pairs;
  Unbounded<Motion> unbounded;
  SelfContacts<Motion> self_contacts;
  std::unique_ptr<BroadPhase<Motion::degree>> broad_phase;
  std::size_t expected = 0;  ///< the broad phase has been told of the bodies in slots below this
  BodySlot reserved = 0;     ///< it has been asked to make room for those below this

 private:
  template <class Self>
  static auto list_of(Self& self) {
    return PartList(self.scripts, self.tumbling, self.pairs.box_times(), self.volumes, self.timers, self.walls,
                    self.resting, self.pairs, self.self_contacts, self.unbounded);
  }
};

}  // namespace kds::collision
