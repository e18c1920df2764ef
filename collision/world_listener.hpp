// How a world reports its events.
#pragma once

#include "certificates/point_motion.hpp"
#include "collision/body_id.hpp"
#include "collision/narrow_phase/contact.hpp"

#include <cstdint>

namespace kds::collision {

/// An event of two bodies, a with the lower id: a contact, an overlap, a separation, the start or end of rest ... Or of
/// a mesh that bends and itself: then a is b.
struct PairEvent {
  BodyId a;
  BodyId b;
  Contact contact;
  std::uint64_t user_data_a = 0;  ///< BodyDescription::user_data, also of bodies that have been removed
  std::uint64_t user_data_b = 0;
};

/// A body's bounding sphere meets a wall: 0 is -x, 1 is +x, 2 is -y ... 5 is +z.
struct WallEvent {
  BodyId body;
  int wall;
  Contact contact;  ///< the point lies on the wall; the normal points out of the domain; there are no features
  std::uint64_t user_data = 0;
};

/// The number of a timer: 0, 1, 2, ... in the order in which they are set.
using TimerId = std::uint64_t;

template <class Motion>
class BasicWorld;

/// Its functions are called for events in the order of their times. The order of events at one time does not depend on
/// the broad phase either: bodies come by their ids, which is the order in which they were added.
/// What follows from an event, or from what callers do, comes before the next event, in this order:
/// 1. `rebound_suppressed`, `wakes`, `passes`, `rests`, each by (a, b), then `moved` and `piece`, by body; resting
///    contacts that begin and end at one instant are not reported;
/// 2. `pair_began` and `pair_ended`, by (a, b); volumes that part and meet again at one instant are not reported;
/// 3. separations of bodies that have been removed, by (a, b);
/// 4. overlaps, by (a, b).
/// Events at one time are in this order: pieces that start, and pairs that begin and end as the bodies move on, by
/// (a, b), with all of the above; timers, in the order in which they were set; walls, by body; contacts and
/// separations, by (a, b); then those of meshes that bend with themselves, by body.
///
/// Every callback may change motions, add and remove bodies, the ones concerned included; the world is consistent when
/// it is called, and later reports of the same instant are made of the world as it is then. (Of bodies that pass
/// through each other, sensors and those in worlds without response, an overlap that has been found is reported though
/// a jump in a callback has ended it; its separation follows at the same instant.) To advance, save or load the world
/// from within a callback throws std::logic_error. WorldOptions::most_edits limits the changes. What a callback throws
/// comes out of the step, and the run may go on: the clock stands at the event, which has been processed; only the
/// remaining reports of that event are lost.
template <class Motion>
class BasicWorldListener {
 public:
  virtual ~BasicWorldListener() = default;
  /// Penetration begins; motions are as after response.
  virtual void contact(BasicWorld<Motion>&, const PairEvent&) {}
  /// Penetration ends: in mode `none`, and of sensors in every mode.
  virtual void separation(BasicWorld<Motion>&, const PairEvent&) {}
  /// The two are in contact when one of them enters the world or, in the modes that resolve contacts, jumps. (In mode
  /// `none`, and for sensors, a jump into contact is a contact.)
  virtual void overlap(BasicWorld<Motion>&, const PairEvent&) {}
  virtual void wall(BasicWorld<Motion>&, const WallEvent&) {}  ///< motions are as after response
  /// With WorldOptions.report_pairs: the bounding volumes of two bodies, the first with the lower id, begin and cease
  /// to overlap at a time in s.
  virtual void pair_began(BasicWorld<Motion>&, BodyId, BodyId, double) {}
  virtual void pair_ended(BasicWorld<Motion>&, BodyId, BodyId, double) {}
  virtual void rebound_suppressed(BasicWorld<Motion>&, const PairEvent&) {}  ///< the Zeno policy has acted on a pair
  virtual void rebound_suppressed_at_wall(BasicWorld<Motion>&, const WallEvent&) {}  ///< or on a body and a wall
  /// Two bodies, or a body and a wall, begin to rest on each other (docs/resting.md: they lie or slide), and cease to:
  /// they part, something strikes them, or one of them jumps or is removed. The contact is that of this moment.
  virtual void rests(BasicWorld<Motion>&, const PairEvent&) {}
  virtual void rests_at_wall(BasicWorld<Motion>&, const WallEvent&) {}
  virtual void wakes(BasicWorld<Motion>&, const PairEvent&) {}
  virtual void wakes_at_wall(BasicWorld<Motion>&, const WallEvent&) {}
  /// Two bodies pass through each other until they have separated: no motion keeps them apart (a piston), their
  /// meetings do not end, or a callback has left them approaching.
  virtual void passes(BasicWorld<Motion>&, const PairEvent&) {}
  /// The motion of a body has changed that takes no part in the event: resting contacts pass on what happens to other
  /// bodies, and, if hears_pieces(), a body that precesses begins its next piece.
  virtual void moved(BasicWorld<Motion>&, BodyId) {}
  /// Whether `moved` has to be called for every piece of the bodies that precess. Else such bodies cost less while they
  /// are far from all others (docs/turning.md), and `moved` is called for some of the pieces; all else is the same.
  /// Asked by advance_to().
  virtual bool hears_pieces() const { return false; }
  /// With WorldOptions.report_pieces: a piece of a body's motion has started that is not the first, or that made it
  /// enter.
  virtual void piece(BasicWorld<Motion>&, BodyId) {}
  virtual void timer(BasicWorld<Motion>&, TimerId) {}  ///< of BasicWorld::set_timer(): now() is its time
};

/// Of a World<Degree>.
template <int Degree>
using WorldListener = BasicWorldListener<certificates::PointMotion<Degree>>;

}  // namespace kds::collision
