// The clock of a world as its callers know it.
#pragma once

#include "kds/arithmetic/lattice.hpp"

namespace kds::collision {

/// Callers know the time up to which the world has been run. A search for the next event runs ahead of it, and what it
/// has found out holds until something changes.
struct CallersClock {
  double now = 0;                   ///< s: Clock::now is not before it
  double looked_for_until = never;  ///< s: the horizon of a simulator: the search need not find later events
  double idle_until = -never;       ///< s: nothing is due before it
  bool idle_for_ever = false;       ///< no event comes at all
  double next_time = -never;        ///< s: of the next event; -never if it has not been searched for

  /// Something has changed: the search begins anew. `at`: a time before which nothing is due all the same.
  void forget_next_event(double at = -never) {
    idle_until = -never;
    next_time = at;
    idle_for_ever = false;
  }
};

}  // namespace kds::collision
