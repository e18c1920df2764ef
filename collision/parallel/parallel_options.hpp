// How a scene is divided among worlds.
#pragma once

#include "collision/parallel/domain_sets.hpp"

#include <cstddef>
#include <cstdint>

namespace kds::collision {

class StepListener;

/// How a scene is divided among threads and processes.
struct ParallelOptions {
  std::size_t threads =
      0;  ///< of each process; 0 for as many as the machine has, or one if there are several processes
  /// Into how many domains the scene is divided, at most `most_domains`. 0: one for each thread, or fewer, so that each
  /// has some 10 000 bodies. A scene with one domain runs as one world.
  std::size_t domains = 0;
  /// How far beyond its domain a world knows bodies: this many mean distances of neighbours, and the greatest diameter
  /// of a body that contacts move. > 0. More makes windows longer and the worlds larger.
  double halo = 3;
  /// s, > 0: the longest window. The engine finds out how long windows can be; with shorter ones the listener is told
  /// of events sooner, and they cost more.
  double longest_window = 1e300;
  /// If not null, the events of divided stretches are told to this, in each process those of its own domains, and no
  /// events are sent (collision/parallel/step_events.hpp); the listener is told only of stretches that are run as one
  /// world. Either all processes have one or none. Must outlive the world.
  StepListener* steps = nullptr;
};

/// What a ParallelWorld has done so far. Only the first four are of the scene; the others say how it was run.
struct ParallelCounters {
  std::uint64_t contacts = 0;
  std::uint64_t separations = 0;
  std::uint64_t overlaps = 0;
  std::uint64_t wall_contacts = 0;
  std::uint64_t windows = 0;            ///< that held
  std::uint64_t steps = 0;              ///< of windows; that held
  std::uint64_t windows_failed = 0;     ///< that were run again, shorter or as one world
  std::uint64_t stretches_whole = 0;    ///< stretches of time that were run as one world
  std::uint64_t divisions = 0;          ///< times the scene was divided anew
  std::uint64_t bodies_owned = 0;       ///< by all domains, summed over steps
  std::uint64_t bodies_known = 0;       ///< copies included; the ratio is the redundancy in bodies
  std::uint64_t events_computed = 0;    ///< in steps that held, by all domains, those of copies included
  std::uint64_t events_of_busiest = 0;  ///< the same, by the domain that computed most in a step
  std::uint64_t copies_corrected = 0;
  std::uint64_t copies_made = 0;  ///< of bodies that came near a domain, in windows that were followed by a step
};

/// Throws std::invalid_argument, naming the option, for one that is out of range.
void validate(const ParallelOptions& options);

}  // namespace kds::collision
