// The events of a divided scene, step by step, as each of several processes has them.
#pragma once

#include "collision/parallel/world_events.hpp"

#include <cstddef>
#include <stdexcept>
#include <utility>
#include <vector>

namespace kds::collision {

/// The events of a step of a window, as the domains of one process have recorded them.
struct StepEvents {
  std::size_t domains = 0;                       ///< of the scene
  std::size_t first = 0;                         ///< the domain that logs[0] is of; those of the others follow
  std::vector<std::vector<DomainEvent>> logs{};  ///< of the domains of this process; there may be none
};

/// Told of the steps of a ParallelWorld in place of its listener, in each process of what its own domains have
/// recorded: so no events are sent. merged() makes one log of what all processes were told.
class StepListener {
 public:
  virtual ~StepListener() = default;
  /// Called once for each step that holds, in the same order in all processes, with nothing to tell too. It must not
  /// call functions of the world that is telling it. If it throws, the step counts as told.
  virtual void on_step(const StepEvents& events) = 0;
};

/// The events of a step in the order of one world. `of_processes`: by rank. Throws std::invalid_argument if they are
/// not of all domains.
inline EventMerge merged(std::vector<StepEvents> of_processes) {
  std::vector<std::vector<DomainEvent>> logs;
  for (StepEvents& events : of_processes) {
    if (events.domains != of_processes[0].domains || (events.first != logs.size() && !events.logs.empty())) {
      throw std::invalid_argument("merged: the events are not of one step");
    }
    for (auto& log : events.logs) logs.push_back(std::move(log));
  }
  if (!of_processes.empty() && logs.size() != of_processes[0].domains) {
    throw std::invalid_argument("merged: the events of a process are missing");
  }
  return EventMerge(std::move(logs));
}

}  // namespace kds::collision
