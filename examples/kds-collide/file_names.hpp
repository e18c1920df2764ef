// The files that a run reads and writes: none may be another.
#pragma once

#include "examples/kds-collide/arguments.hpp"
#include "io/scene.hpp"

namespace kds_collide {

/// Throws ArgumentError if a file that is written, at any time of the run and by any of its processes, is another one
/// that is written, or one that is read. `scene`: null as long as it has not been read; else what it names counts, too.
void check_files_differ(const Arguments& arguments, const kds::io::Scene* scene = nullptr);

}  // namespace kds_collide
