// Time that runs backwards.
#pragma once

#include "kds/framework/moving_set.hpp"
#include "kds/simulator.hpp"

namespace kds {

/// A structure that can be run backwards: its motions are polynomials (Kinetic of such elements, sorted lists,
/// tournaments) and nothing is planned for later times (so not Pieces).
///
/// Semantic law: turn_round(now, horizon) makes laws 1 to 4 of KineticStructure hold for the reversed motions, the
/// clock now standing at `now`.
template <class S>
concept ReversibleStructure = KineticStructure<S> && requires(S& structure, double t) {
  structure.turn_round(t, t);
};

/// Turns time round: from now on the simulator runs into the past. All structures that are attached to the sets must be
/// its own, and all sets must be given.
///
/// A motion x(t) becomes x'(t') = x(-t'), which is exact: odd coefficients and the start change their signs. The clock
/// becomes its negative, and everything else works as before: advance_to(-3) goes back to 3 seconds, edits are edits of
/// the reversed motions, and a second reverse() turns to the future again.
///
/// Laws. (1) The state at clock -t is that of the motions just *before* t, as it is that just after t on the way
/// forward. (2) An event forward at F and the same one backward at clock -B have the exact root between them, B <= root
/// <= F: F is the first double not before it, B the last one not after it; so B = F where the root is a double, and
/// else B is the one below F. (A certificate that fails and holds again between two neighbouring doubles may have
/// events in one direction only.) (3) The events of this time are due again: those that were processed at it on the way
/// forward are undone by the next steps, or at once (tournaments). (4) Where several states are valid (heaps,
/// triangulations of points on a circle), which one a structure has depends on its earlier states, so it may differ
/// from that of the run forward.
///
/// The run goes into the past of the motions as they are *now*: edits are not undone. For a past with edits, see
/// History. Cost: a failure time for each certificate.
template <ReversibleStructure... Structures, Reversible... Elements>
void reverse(Simulator<Structures...>& simulator, MovingSet<Elements>&... sets) {
  (sets.turn_round(), ...);
  simulator.turn_round();
}

/// The time in seconds in the original direction: that of the simulator, or its negative if the set is turned round.
template <class AnySimulator, MovingElement E>
double time_of(const AnySimulator& simulator, const MovingSet<E>& set) {
  return set.backwards() ? 0.0 - simulator.now() : simulator.now();
}

}  // namespace kds
