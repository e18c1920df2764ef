// Bullet's broad phases.
#pragma once

#include "tests/benchmarks/speed/peers/peers.hpp"

#include <vector>

namespace speed {

void add_bullet(std::vector<Peer>& list);

}  // namespace speed
