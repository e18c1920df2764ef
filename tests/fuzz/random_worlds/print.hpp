// Prints a scenario as a program.
#pragma once

#include "tests/fuzz/random_worlds/log.hpp"
#include "tests/fuzz/random_worlds/scenario.hpp"
#include "tests/fuzz/random_worlds/way.hpp"

namespace kds::fuzz {

/// To stdout: a program that needs the library and tests/collision/event_log.hpp alone, runs the scenario in the
/// reference way and in the other and prints both logs. Reactions are those that are written down.
void print_program(const Scenario& scenario, const Way& way, const Difference& difference);

}  // namespace kds::fuzz
