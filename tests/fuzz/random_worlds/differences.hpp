// Runs a scenario in several ways and says which differ from the reference.
#pragma once

#include "tests/fuzz/random_worlds/log.hpp"
#include "tests/fuzz/random_worlds/make_scenario.hpp"
#include "tests/fuzz/random_worlds/way.hpp"

#include <vector>

namespace kds::fuzz {

struct WayThatDiffers {
  Way way;
  Difference difference;
};

/// One line that names what differs, without numbers: to count differences of a kind.
std::string kind_of(const Scenario& scenario, const WayThatDiffers& found);

/// All ways of the scenario that differ from the reference; the reference too, if it has accepted what it must refuse.
std::vector<WayThatDiffers> differences(const DrawnScenario& drawn, std::size_t* lines = nullptr);
/// The same of one way.
Difference difference(const DrawnScenario& drawn, const Way& way);
/// The scenario with all that its callbacks do in the reference and in that way, up to where they differ.
Scenario written_down(const DrawnScenario& drawn, const Way& way);

}  // namespace kds::fuzz
