// The methods of this library that are compared, and what one run of one of them took.
#pragma once

#include "collision/world.hpp"
#include "tests/benchmarks/speed/hardware_counters.hpp"
#include "tests/benchmarks/speed/scenes.hpp"
#include "tests/benchmarks/thread_time.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace speed {

struct Method {
  std::string name;  ///< as the tool calls it
  kds::collision::BroadPhaseKind kind;
  std::size_t most_bodies = std::numeric_limits<std::size_t>::max();  ///< more would not fit into memory
};

/// All that the library has, the default first.
const std::vector<Method>& methods();
const Method& method(const std::string& name);

struct Drive {
  double rate = 60;     ///< Hz; results are asked for so often, and swept boxes renewed
  double duration = 1;  ///< s of simulated time
  std::size_t threads = 1;
  double (*clock)() = kds::benchmarks::thread_seconds;  ///< what set-up and run are taken by
};

/// A contact, to compare with others'.
struct Meeting {
  double time;
  kds::collision::BodyId a, b;
};

struct Outcome {
  double setup = 0;          ///< s by the drive's clock from the scene to the first instant
  double run = 0;            ///< s from there to the end
  std::uint64_t events = 0;  ///< contacts, walls, overlaps, holds
  std::uint64_t hash = 0;    ///< of all of them, bit by bit; the order of those at one time does not count
  kds::collision::WorldCounters counters;     ///< set-up and run
  kds::collision::WorldCounters after_setup;  ///< what of it was set-up
  HardwareCounts hardware;                    ///< set-up and run

  double total() const { return setup + run; }
};

/// Runs the scene with elastic balls and walls. `meetings` may be null.
Outcome run_method(const BallScene& scene, const Method& method, const Drive& drive,
                   std::vector<Meeting>* meetings = nullptr);

/// The world's options for a scene and a method.
kds::collision::WorldOptions world_options(const BallScene& scene, const Method& method, const Drive& drive);
/// Puts the balls of a scene in; one description serves all.
void add_balls(kds::collision::World<1>& world, const BallScene& scene);

}  // namespace speed
