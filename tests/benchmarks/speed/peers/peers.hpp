// Broad phases of other libraries, in the setting that their users get continuous collision detection from: swept boxes
// at a rate, and an exact test of two balls for each pair of boxes that overlap.
#pragma once

#include "tests/benchmarks/speed/methods.hpp"
#include "tests/benchmarks/speed/scenes.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace speed {

struct PeerOutcome {
  double setup = 0;         ///< CPU s from the scene to the first frame
  double run = 0;           ///< CPU s of all frames
  std::uint64_t tests = 0;  ///< of two balls
  double total() const { return setup + run; }
};

struct Peer {
  const char* name;
  PeerOutcome (*run)(const BallScene&, const Drive&, std::vector<Meeting>*);
  std::size_t most_bodies = std::numeric_limits<std::size_t>::max();  ///< by the width of its handles
};

/// Those this program was built with: none, some or all.
std::vector<Peer> peers();
/// Libraries that were not there when it was built.
std::vector<const char*> missing_peers();

}  // namespace speed
