// How a world is to run.
#pragma once

#include "collision/broad_phase/broad_phase_kind.hpp"
#include "kds/arithmetic/lattice.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <optional>

namespace kds::collision {

class ContactLaw;

/// How the world responds to contacts of bodies. Walls reflect bodies in every mode.
enum class Response {
  none,      ///< reports contacts and separations; bodies pass through each other
  elastic,   ///< impulses by the bodies' restitution and, if they turn, friction; motions change at each contact
  callback,  ///< as elastic, but a law (WorldOptions::law) or the listener changes the motions; a pair that is left
             ///< approaching passes through
};

/// What ends bounces that pile up in time (Zeno). The rebound of a contact, of two bodies in mode `elastic` or with a
/// wall in any mode, is suppressed, and the contact rests from then on, if it
/// - has no rebound: restitution 0, or no speed of approach;
/// - would be back within interval / contacts, pressed by the acceleration that it has (a ball coming to rest), or rise
///   by roundings of the coordinates only;
/// - is of two bodies that have both met others more than `contacts` times within `interval` (fixed bodies and walls do
///   not count).
/// Bodies in resting contact lose their relative velocity along the normal and from then on move along the contact,
/// without friction and at no cost, by least constraint (least_constraint.hpp): forces pass through stacks. The contact
/// ends when the bodies are pulled or pushed apart, pushed together anew (which is a contact), lose their support or
/// slide off. Where bodies cannot be kept apart (between two fixed ones that close in) the pair is let pass until it
/// has separated. The same happens, in mode `callback` too, after ten times as many meetings. Each time the policy acts
/// is counted and reported, and a run always ends.
///
/// In worlds of bodies that turn this does not make contacts last: WorldOptions::shortest_flight says how bodies come
/// to rest there. Contacts within `interval` of bodies that have met others so often are resolved together, if they can
/// be: as one impact without rebound (docs/turning.md, collapses), so that no cascade of contacts goes on without end;
/// if nothing keeps two bodies apart, they are let pass.
///
/// Meetings are counted by body and not by pair: a pair is forgotten when its bounding volumes part, which may happen
/// at each bounce and at times that depend on the broad phase.
struct ZenoPolicy {
  std::uint32_t contacts = 100;  ///< > 0; more makes longer cascades exact and collapses slower
  double interval = 1e-9;        ///< s, >= 0
};

/// Reflecting walls: the bounding ball of each body, fixed ones included, stays inside the box [min, max]. A body that
/// begins outside is turned back where it moves farther out.
struct Walls {
  Eigen::Vector3d min;  ///< each coordinate below that of max
  Eigen::Vector3d max;
  double restitution = 1;  ///< in [0, 1]; see BodyDescription
};

/// How a world is simulated: its clock, its broad phase, and what contacts do.
struct WorldOptions {
  double start_time = 0;  ///< s; keep it near 0: event times are rounded to doubles, which are sparse far from it
  /// s, > 0; how far ahead events are predicted at a time. It makes no difference to events, in a Simulator either,
  /// whose window is another matter. A step without a limit that finds nothing within one more window looks at all time
  /// to come, and so do all steps from then on.
  double window = never;
  Response response = Response::none;
  /// With response `callback`, and only then: how bodies respond to contacts, before the listener is told of them
  /// (collision/response/contact_law.hpp). Null: as the listener changes their motions. Must outlive the world, and is no
  /// part of snapshots: the world that loads one has a law of its own.
  const ContactLaw* law = nullptr;
  BroadPhaseKind broad_phase = BroadPhaseKind::automatic;
  /// Hz, finite and >= 0; frame rate of the swept AABBs of `sap`, which needs one > 0 with a finite 1 / rate; other
  /// broad phases ignore it.
  double rate = 0;
  /// Bounding volumes of kinetic sweep and prune: 6, boxes; 14, 18 or 26, k-DOPs, tighter around shapes that are long,
  /// thin or round, and dearer to compute (docs/kdops.md). Other broad phases use boxes. Contacts are the same; the
  /// pairs reported are those whose volumes overlap.
  int kdop = 6;
  std::optional<Walls> walls{};
  bool report_pairs = false;   ///< tell the listener of bounding volumes that begin and cease to overlap
  bool report_pieces = false;  ///< tell the listener of pieces of motion that start
  bool profile = false;        ///< measure where the time goes
  /// Threads that share the work where thousands of bodies enter, or thousands of pairs are to be tested, at once; 0
  /// for as many as the machine has. All else, callbacks and box functions included, is done by the caller's thread.
  /// Events and counters do not depend on it.
  std::size_t threads = 1;
  ZenoPolicy zeno{};
  /// s, > 0. In worlds of bodies that turn, and on meshes that bend, bodies that are pressed together rebound fast
  /// enough to fly for at least this time, so that a run always ends. Of bodies that press on each other with the
  /// acceleration g it raises heights by g / 8 times its square (1.2 um at 10 m/s^2 and 1 ms), and costs a contact per
  /// flight. Bodies that turn come to rest when they move no faster than such flights make them, twice g times this
  /// (2 cm/s), and forces at the places where they touch hold them (docs/turning.md): then contacts cost nothing.
  double shortest_flight = 1e-3;
  /// rad, from 2^-30 to 1/8. Bodies that turn freely and whose moments of inertia differ precess. Their motion consists
  /// of pieces with a constant angular velocity, so short that the orientation differs from the solution of Euler's
  /// equations by at most this much; after contacts in quick succession by at most twice as much. The errors of pieces
  /// do not accumulate, and energy and momenta do not depend on this option. With the default no point of a body is off
  /// by more than a thousandth of its radius, for about five pieces a radian; a hundredth of it costs ten times as many
  /// pieces (docs/turning.md).
  double orientation_error = 1e-3;
  /// How often callbacks may add, remove or move bodies within zeno.interval of simulated time; 64 times the number of
  /// bodies, if that is more. The call that exceeds it throws std::runtime_error: callbacks that go on for ever at one
  /// time would stop the clock. Without callbacks a run always ends.
  std::uint64_t most_edits = 1'000'000;
};

/// Throws std::invalid_argument, naming the option, for one that is out of range by itself.
void validate(const WorldOptions& options);

}  // namespace kds::collision
