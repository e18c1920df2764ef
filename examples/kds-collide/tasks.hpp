// What the tools do beside running a scene.
#pragma once

#include "examples/kds-collide/arguments.hpp"

namespace kds_collide {

void list_broad_phases();
/// Writes a scene of many bodies.
void generate(const Arguments& arguments);
/// Makes one log of the events of all processes.
void merge(const Arguments& arguments);

}  // namespace kds_collide
