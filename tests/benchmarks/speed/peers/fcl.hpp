// FCL's tree manager.
#pragma once

#include "tests/benchmarks/speed/peers/peers.hpp"

#include <vector>

namespace speed {

void add_fcl(std::vector<Peer>& list);

}  // namespace speed
