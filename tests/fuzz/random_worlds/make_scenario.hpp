// A random scenario from a seed.
#pragma once

#include "tests/fuzz/random_worlds/draw.hpp"
#include "tests/fuzz/random_worlds/scenario.hpp"

#include <cstdint>

namespace kds::fuzz {

struct DrawnScenario {
  Scenario scenario;
  Style style;  ///< for bodies that callbacks add
};

/// The same from a seed on every machine.
DrawnScenario make_scenario(std::uint64_t seed);

}  // namespace kds::fuzz
