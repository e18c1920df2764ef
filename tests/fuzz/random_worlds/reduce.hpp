// Makes a scenario smaller that is run differently by two ways.
#pragma once

#include "tests/fuzz/random_worlds/make_scenario.hpp"
#include "tests/fuzz/random_worlds/way.hpp"

namespace kds::fuzz {

/// Leaves out calls, reactions, pieces and options, and makes numbers simple, while the way still differs from the
/// reference in the same kind of line, as long as `seconds` last. Simplifies the way too.
Scenario reduced(const DrawnScenario& drawn, Way& way, double seconds);

}  // namespace kds::fuzz
