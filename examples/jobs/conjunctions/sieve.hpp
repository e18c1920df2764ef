// Conjunction screening by sampling, to compare with: the method of public screeners.
#pragma once

#include "examples/jobs/conjunctions/conjunction.hpp"
#include "examples/jobs/conjunctions/orbit.hpp"

#include <cstdint>
#include <functional>
#include <span>

namespace conjunctions {

struct SieveCost {
  double propagation = 0;  ///< states of objects, CPU s
  double grid = 0;         ///< sorting into cells, and candidates
  double refinement = 0;   ///< of candidates
  std::uint64_t candidates = 0;
};

/// All objects are propagated to each multiple of `step` (s) and sorted into a grid whose cells are so wide that a pair
/// which is near at any time within half a step is found in neighbouring cells; a pair that may be near, by its
/// relative velocity and a bound on accelerations, is refined with the orbits themselves: the closest approach where
/// the distance ceases to fall, entry and exit by steps outwards and bisection. So no pair that comes near is missed,
/// except one that enters and leaves and enters again within one step of time.
///
/// Calls found(conjunction), in no particular order.
SieveCost sieve(std::span<const Elements> catalogue, const Screening& options, double step,
                const std::function<void(const Conjunction&)>& found);

}  // namespace conjunctions
