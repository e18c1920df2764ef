// Runs a scene.
#pragma once

#include "collision/parallel/processes.hpp"
#include "collision/parallel/step_events.hpp"
#include "collision/profile.hpp"
#include "io/events.hpp"
#include "io/scene.hpp"
#include "kds/framework/snapshot.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace kds::io {

/// How a scene is run.
struct RunOptions {
  std::string broad_phase = "auto";  ///< a name in collision/broad_phase/broad_phase_kind.hpp
  int kdop = 6;                      ///< 6, boxes, or, for "kinetic-sap", 14, 18 or 26
  double orientation_error = 1e-3;   ///< rad, of bodies that precess: WorldOptions
  double shortest_flight = 1e-3;     ///< s, of bodies that turn and are pressed together: WorldOptions
  double rate = 0;                   ///< Hz: how often results are asked for; 0 is once, at the end. "sap" needs it
  bool pairs = false;                ///< tell of bounding volumes too
  bool steady_progress = false;      ///< call on_time about a hundred times, or more, in a run of 1e-306 s or more
  bool profile = false;              ///< measure where the time goes
  std::size_t threads = 1;           ///< how many take in bodies, where there are many; 0: as many as the machine has
  /// Into how many domains the scene is divided, which the threads run; 0: as many as is best for them. With more than
  /// one the sink is not told of motions, so there are no pictures. The events do not depend on it.
  std::size_t domains = 1;
  /// If not null, these run the scene together, divided into domains: all call run() with the same scene, or each with
  /// its share of it, and with the same options.
  /// The sink of process 0 is told of events. Must outlive the run.
  kds::collision::Processes* processes = nullptr;
  /// If not null, this is told in each process of what its own domains record, and the sink of process 0 only of events
  /// of stretches that are run as one world: see EventPart. Must outlive the run.
  kds::collision::StepListener* steps = nullptr;
  /// s of simulated time, > 0: whenever so much has gone by, the state of the run is given away, after the events up to
  /// then. Of a scene that is divided `checkpoint_bodies` is given the bodies, in each process its own, block by block;
  /// afterwards `checkpoint` the time, in all processes, and in process 0 with all the rest, as by
  /// BasicParallelWorld::save_parts(). 0: never.
  double checkpoint_every = 0;
  std::function<void(std::vector<char>)> checkpoint_bodies{};
  std::function<void(const Snapshot&, double time)> checkpoint{};
  /// If not null, the run goes on from this state, of a run of the same scene with the same options but `processes`,
  /// `steps`, `domains`, `threads` and those about checkpoints; the same in all processes. RunResult is about what
  /// follows. `resume_bodies`: if there were blocks, gives each process its share of them
  /// (BasicParallelWorld::load_parts()).
  const Snapshot* resume = nullptr;
  std::function<bool(std::vector<char>&)> resume_bodies{};
};

/// What a run took and did. Where several processes ran it, what they did is summed, and what it took is that of the
/// one that took most.
struct RunResult {
  std::string broad_phase;       ///< the one used, as World::broad_phase() names it
  double setup_cpu_seconds = 0;  ///< making the world and all that happens at begin_time
  double run_cpu_seconds = 0;    ///< from there on
  double sim_seconds = 0;        ///< simulated time
  std::uint64_t bodies = 0;
  std::uint64_t swaps = 0;         ///< exchanges of neighbours in the sorted lists
  std::uint64_t certificates = 0;  ///< failure times computed by the broad phase
  std::uint64_t box_updates = 0;   ///< bounding volumes computed or changed
  std::uint64_t pairs_begun = 0;   ///< pairs handed on by the broad phase
  std::uint64_t pair_tests = 0;    ///< dynamic intersection tests
  std::uint64_t contacts = 0;
  std::uint64_t separations = 0;
  std::uint64_t overlaps = 0;
  std::uint64_t wall_contacts = 0;
  std::uint64_t motion_updates = 0;
  std::uint64_t rotation_pieces = 0;     ///< of bodies that precess
  std::uint64_t orientation_resets = 0;  ///< times such a body was not turned as it should have been for too long
  std::uint64_t held = 0;                ///< times the policy for endless bounces acted
  std::uint64_t domains = 1;             ///< into which the scene was divided at the end
  std::uint64_t windows = 0;             ///< of a divided scene
  std::uint64_t windows_failed = 0;
  std::uint64_t bodies_owned = 0;  ///< summed over domains and the steps of windows
  std::uint64_t bodies_known = 0;  ///< the same, copies of bodies of other domains included
  std::uint64_t processes = 1;
  std::uint64_t exchanges = 0;        ///< in which processes could send messages to others
  std::uint64_t messages = 0;         ///< sent in these, by all processes
  std::uint64_t bytes_exchanged = 0;  ///< in these messages
  std::uint64_t peak_memory_bytes = 0;
  kds::collision::Profile profile;  ///< where the time went, if asked for
};

/// Runs the scene from its begin_time to its end_time, and tells `sink`. Throws std::invalid_argument for options it
/// cannot follow, and what the sink throws.
RunResult run(const Scene& scene, const RunOptions& options, EventSink& sink);

}  // namespace kds::io
