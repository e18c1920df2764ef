// The list of the examples, with all its events written down.
#pragma once

#include "examples/list_in_forty_lines.hpp"
#include "tests/structures/to_log.hpp"

namespace kds::tests {

template <int Degree, class Queue = DefaultEventQueue>
using LoggedList = Kinetic<examples::ListRule<Motion<Degree>>, ToLog, Queue>;

}  // namespace kds::tests
