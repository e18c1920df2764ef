// What the tools do: a scene in, events out.
#pragma once

#include "collision/parallel/processes.hpp"

namespace kds_collide {

/// Codes that a tool ends with.
inline constexpr int done = 0;
inline constexpr int run_failed = 1;
inline constexpr int bad_input = 2;

/// Processes that run a scene together.
struct Together {
  kds::collision::Processes& processes;
  /// Ends all of them with this code: something has failed in one, and the others wait for it.
  void (*end_all)(int code);
  /// True in one process of each machine, once: what a signal tells all of them is said there. Called by signal
  /// handlers.
  bool (*may_say)();
};

/// Does what the command line says; returns the code to end with. `name`: of the tool, in messages. Where several
/// processes run the scene, each calls this with the same arguments; process 0 writes the files and the messages.
int run_tool(int argc, char** argv, const char* name, const Together* together = nullptr);

}  // namespace kds_collide
