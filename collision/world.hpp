// The collision detection engine: bodies, broad phase, contacts, response.
#pragma once

#include "collision/body_description.hpp"
#include "collision/body_id.hpp"
#include "collision/body_motion.hpp"
#include "collision/broad_phase/body_visitor.hpp"
#include "collision/broad_phase/kinetic_box.hpp"
#include "collision/free_turning.hpp"
#include "collision/fwd.hpp"
#include "collision/motions.hpp"
#include "collision/profile.hpp"
#include "collision/shapes/mesh_keyframe.hpp"
#include "collision/world_counters.hpp"
#include "collision/world_listener.hpp"
#include "collision/world_options.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace kds::collision {

template <class BodyMotionType>
class Engine;

namespace detail {
template <class Motion>
struct EngineOf;
}

/// Moves bodies through time and reports their contacts at exact times. The type of motion is a template parameter
/// (body_motion.hpp): most worlds are a World<Degree>, below, whose bodies keep their orientation.
///
/// [Coming06] Figure 2. Events are, in this order where times are equal: pieces of motion that start (of scripts, then
/// of bodies that precess), changes of the broad phase, bounding volumes that have to be renewed, timers, walls,
/// resting contacts that end, contacts and separations by (a, b), those of meshes that bend with themselves. The broad
/// phase makes no difference: WorldListener states the order of reports.
///
/// It is made of parts, which docs/design.md lists, behind one pointer (world/engine.hpp): programs that use a world
/// compile none of them.
///
/// Adding, removing and moving bodies calls no listener: the consequences are reported by the next step, at now().
///
/// A call that refuses its arguments changes nothing, and an exception of a listener comes out of the step after its
/// event has been processed: the world can be used after both. But if something interrupts a change half-way (a box
/// function that throws, memory exhausted), the world cannot be used further: it can be queried and destroyed, and all
/// functions that would run, change, check or save it throw std::logic_error and say why.
///
/// Degree 1 (straight paths) has no cost from degree 2, nor either from degrees 3 to 5 (splines), which are in a
/// separate library, kds::collision_splines (docs/splines.md). Lengths and masses are in units of the caller's choice,
/// times in seconds. An id that was never given, or whose body was removed, throws std::out_of_range, which names the
/// id and says which of the two it is (in resting() and touching(), for either id).
template <class BodyMotionType>
class BasicWorld final {
  static_assert(BodyMotion<BodyMotionType>,
                "World: bodies move as body_motion.hpp says, and those that turn want kds::collision_turning");
  static_assert(BodyMotionType::degree >= 1 && BodyMotionType::degree <= KDS_GREATEST_DEGREE,
                "World: bodies move on lines (degree 1) or parabolas (degree 2), and with kds::collision_splines on "
                "curves of degree 3 to 5");
  static_assert(has_compiled_world<BodyMotionType> || BodyMotionType::degree < 1 ||
                    BodyMotionType::degree > KDS_GREATEST_DEGREE,
                "World: no world of bodies with this type of motion is compiled in the library: those of bodies that "
                "turn (RigidMotion) are in kds::collision_turning, of degree 1 and 2; collision/motions.hpp says which "
                "there are");

 public:
  using Motion = BodyMotionType;
  using Description = BasicBodyDescription<Motion>;
  using Listener = BasicWorldListener<Motion>;

  /// Throws std::invalid_argument, naming the option, for an option that is out of range or does not fit the others,
  /// and std::runtime_error where arithmetic is not that of kds/arithmetic/strict.hpp. The listener, if there is one,
  /// must outlive the world.
  explicit BasicWorld(const WorldOptions& options, Listener* listener = nullptr);
  ~BasicWorld();
  BasicWorld(const BasicWorld&) = delete;
  BasicWorld& operator=(const BasicWorld&) = delete;

  /// Adds a body and returns its id, which no other body of this world ever gets: 0, 1, 2, ... as long as none has been
  /// removed (body_id.hpp). Throws std::invalid_argument, naming the member that is wrong; then nothing is added.
  /// Cheapest when many are added between two steps.
  BodyId add_body(const Description& description);

  /// Makes room for this many bodies in all, and as many pairs, at once: for a quarter of a microsecond a body. Never
  /// needed, but saves time and memory where many are added, and the long steps of advance_for() in which tables grow;
  /// not to be called for each few of many. Changes no event. Throws std::length_error for more than there are
  /// slots.
  void reserve(std::size_t bodies);

  /// Removes a body. Its pairs end, and in mode `none` its contacts separate, with reports.
  void remove_body(BodyId id);

  /// Replaces the motion from now() on, and discards the pieces still to come. A body that was to enter later enters
  /// now. In the modes that resolve contacts a body that jumps enters anew: a contact there is reported as an overlap.
  /// In mode `none`, and of sensors, a jump begins and ends contacts. Throws std::invalid_argument for a motion that is
  /// not finite or starts after now().
  void update_motion(BodyId id, const Motion& motion);

  /// The same for a motion in pieces, each starting later than the one before: the last that has started by now()
  /// replaces the motion, as above, and those after it are to come. Throws, naming the piece, as add_body() does.
  void update_motion(BodyId id, std::span<const Motion> pieces);

  /// Adds pieces of motion after those that are still to come: so a stream of pieces needs no more than the next ones.
  /// Throws std::invalid_argument, naming the piece, unless each starts later than now() and than the one before.
  void append_motion(BodyId id, std::span<const Motion> pieces);

  /// Replaces what is still to come of the vertices of a mesh that bends: from where they are at now() they move on
  /// straight lines to the first of these keyframes, from there to the next, and stand still after the last; with none
  /// they stand still from now() on. So a simulator of cloth gives the end of each of its steps:
  ///
  ///     world.update_vertices(cloth, {{t + h, positions}});
  ///
  /// Nothing jumps, and nothing in the past changes. The motion of the body goes on as it was. Throws
  /// std::invalid_argument for a body that does not bend, and, naming the keyframe, unless each is later than now() and
  /// than the one before, and has a position for each vertex, finite and in range.
  void update_vertices(BodyId id, std::vector<MeshKeyframe> keyframes);

  /// Gives a body another mass; the inertia of one that turns changes by the same factor, and its motion does not
  /// change. Throws std::invalid_argument for a body that is fixed, and for a mass that add_body() would not take.
  void set_mass(BodyId id, double mass);
  /// Counts from the next contact on. Throws std::invalid_argument unless in [0, 1].
  void set_restitution(BodyId id, double restitution);
  /// Gives a body another category and mask (BodyDescription). Contacts with bodies that it may not collide with any
  /// more end: those of bodies that pass through each other separate, with reports, and what rests on it, or below it,
  /// wakes. Where it is in contact with a body with which it could not collide before, that is reported as an overlap.
  void set_filter(BodyId id, std::uint32_t category, std::uint32_t collides_with);
  /// The same for its group (BodyDescription), and for one pair of bodies: those that are ignored do not collide,
  /// whatever their masks. Throws std::invalid_argument for a body and itself.
  void set_group(BodyId id, std::uint32_t group);
  void ignore_pair(BodyId a, BodyId b, bool ignored = true);
  void set_user_data(BodyId id, std::uint64_t user_data);

  /// At a time in s the listener's timer() is called: after pieces of motion that start then, before contacts. Timers
  /// of one time ring in the order in which they were set. Throws std::invalid_argument for a time that is before
  /// now() or not finite.
  TimerId set_timer(double t);
  /// False if there is no such timer any more, or never was.
  bool cancel_timer(TimerId timer);

  /// Processes everything up to and including t. Throws std::invalid_argument where t is before now() or not finite,
  /// std::logic_error if called from within a callback, and std::runtime_error as WorldOptions::most_edits says.
  void advance_to(double t);

  /// Processes the next event not later than `limit`, if there is one. False if there is none; then the clock is at
  /// `limit`, or at the last event if that is not finite, as it has to be where bodies turn, which may come near each
  /// other for ever, and for `sap`, whose frames never end. Throws as advance_to() does, but for a time in the past.
  bool step(double limit = never);

  /// Processes events up to t until this much time of the wall clock has passed, but at least one, or a small part of
  /// the work before it: bodies that enter, pairs to test and what the broad phase does in between come in parts of
  /// less than a millisecond, as a rule. True if t was reached. The log is that of advance_to(), whatever the budgets.
  /// Not divided, so that they may exceed the budget, are a call of a listener, a heap that comes to rest, predictions
  /// beyond the end of a window, pieces that start at one time and are not the first of their bodies, the growth of a
  /// table and the turn of a queue, which take some 0.2 us a body in the world. With reserve(), before bodies are
  /// added, and the default broad phase no table grows but the queue, if pairs are not more than bodies. The methods
  /// `sap`, `kinetic_sap` and `all_pairs` take time in proportion to the bodies for each small part that enters
  /// (figures in docs/benchmarks.md). Throws as advance_to() does, and std::invalid_argument for a budget that is
  /// negative or not a number.
  bool advance_for(double budget_seconds, double t);

  // A world is a KineticStructure: it runs in a Simulator beside others, one clock for all (docs/framework.md). Before
  // it is changed it has to be advanced to that clock, if nothing is due there.

  /// The time of the next event, `never` if none is found within the horizon; now() if bodies have been added or
  /// changed there, and the consequences are not known yet. Nothing that can be observed changes: the result of the
  /// search is kept for the next step, and the search is repeated if the world is changed before that time, at the cost
  /// of adding all bodies. Throws as step() does, also std::invalid_argument where step() needs a limit and the horizon
  /// is `never`.
  double next_time() const;
  /// Processes what is due at next_time(). False if no event has come of it: then the consequences of changes by the
  /// caller have been found out. Throws as step() does.
  bool process();
  /// From then on next_time() looks for events up to the horizon, which is `never` at first; how far they are predicted
  /// at a time is in WorldOptions::window. Throws std::logic_error as step() does. O(1).
  void extend_horizon(double now, double horizon);
  /// As audit(), at a time from now() on before which nothing is due.
  void audit(double t) const;

  double now() const;
  std::size_t size() const;
  bool contains(BodyId id) const;

  /// Includes the accelerations by resting contacts; to change a motion, begin with free_motion(). The reference is
  /// valid until bodies are added, removed or moved, or the clock advances.
  const Motion& motion(BodyId id) const;
  /// The motion that the body would have without its resting contacts: with the acceleration that the caller gave last.
  Motion free_motion(BodyId id) const;
  /// The orientation, angular velocity and angular momentum at now() of a body that turns freely. Those of a body that
  /// precesses are exact up to roundings, while its motion() consists of pieces with a constant angular velocity, whose
  /// orientation differs by up to WorldOptions::orientation_error. Throws std::invalid_argument for a body whose
  /// turning is not changed by contacts.
  FreeTurning free_turning(BodyId id) const requires(turns<Motion>);
  PlacedShape shape(BodyId id) const;
  double mass(BodyId id) const;
  bool sensor(BodyId id) const;
  bool fixed(BodyId id) const;
  double restitution(BodyId id) const;
  std::uint32_t category(BodyId id) const;
  std::uint32_t collides_with(BodyId id) const;
  std::uint32_t group(BodyId id) const;
  bool ignores_pair(BodyId a, BodyId b) const;
  std::uint64_t user_data(BodyId id) const;
  /// The body that a sensor moves with, none if it is not attached.
  std::optional<BodyId> attached_to(BodyId id) const;

  /// Whether a and b are in contact; only for bodies that pass through each other (mode `none`, sensors), otherwise
  /// false. Of one body: whether it touches itself, if it reports that (BodyDescription::self_contacts).
  bool touching(BodyId a, BodyId b) const;

  /// Whether a and b rest on each other (mode `elastic` only), or a rests at a wall, numbered as in WallEvent (all
  /// modes; std::out_of_range for any other number).
  bool resting(BodyId a, BodyId b) const;
  bool resting_at_wall(BodyId a, int wall) const;

  /// Calls visit(id), in order of the ids, for each body that a body touches or rests on, as touching() and
  /// resting() say. `visit` is called when the answer is complete, and may change the world.
  void visit_partners(BodyId id, BodyVisitor visit) const;

  /// Calls visit(id), in order of the ids, for each body, those that enter later included. `visit` is called when the
  /// answer is complete, and may change the world. O(n log n), n being the most that there have been at one time.
  void visit_bodies(BodyVisitor visit) const;

  WorldCounters counters() const;
  /// The broad phase in use: a name of broad_phase_kind.hpp; "auto" is "grid", or "few-boxes" with few bodies.
  std::string_view broad_phase() const;
  /// All zero unless WorldOptions.profile is set.
  const Profile& work_profile() const;

  // Queries: bodies that are near, judged by their bounding volumes. Volumes and boxes are closed, so those that touch
  // meet, and volumes are rounded outward, by less than 2^-48 of the coordinates and of the distance moved since their
  // motions began. Bodies that collide with nothing are visited too, and those that are to enter at now(), but not
  // those that enter later. Answers do not depend on the broad phase; the cost is in BroadPhase, and O(n) if some body
  // does not collide with all others or next_time() has looked ahead. Callbacks may make queries, and so may several
  // threads while none calls anything else. `visit` is called when the answer is complete, and may change the world.
  // These throw std::invalid_argument for a box or a time that is out of range, and std::logic_error in box functions
  // and where the world can no longer be used.

  /// Calls visit(id), in order of the ids, for each body whose bounding volume meets the box [min, max] at now().
  /// Ends may be infinite.
  void visit_overlapping(const Eigen::Vector3d& min, const Eigen::Vector3d& max, BodyVisitor visit) const;

  /// The same for each body whose bounding box may meet a moving box at some time from now() to `until`, with the
  /// motions of now(): the swept AABBs of the two are compared.
  void visit_swept(const KineticBox<Motion::degree>& box, double until, BodyVisitor visit) const;

  /// Checks the broad phase against the motions, exactly, and the pairs against brute force, in O(n^2); throws
  /// AuditFailure. Just after bodies were added or moved, while work at now() is left to the next step, only the broad
  /// phase is checked.
  void audit() const { audit(now()); }

  /// Saves or loads all that decides later events: see save() and restore() in kds/framework/snapshot.hpp. A world that
  /// is loaded, with the same options (but see docs/framework.md), has the same contacts at the same times, bit for
  /// bit. Throws std::invalid_argument for a body with a box function, std::logic_error in a callback.
  template <class Archive>
  void archive(Archive& archive);

 private:
  friend struct detail::EngineOf<Motion>;

  std::unique_ptr<Engine<Motion>> engine_;
};

/// A world of bodies that keep their orientation, on paths of a degree.
template <int Degree>
using World = BasicWorld<certificates::PointMotion<Degree>>;

/// Bodies that turn, on paths of degree 1 or 2: docs/turning.md says which, and how they respond to contacts. In a
/// separate library, kds::collision_turning.
template <int Degree>
using TurningWorld = BasicWorld<certificates::RigidMotion<Degree>>;

#define KDS_DECLARE(motion) extern template class BasicWorld<motion>;
KDS_FOR_ALL_MOTIONS(KDS_DECLARE)
#undef KDS_DECLARE

}  // namespace kds::collision
