// Runs a scene and measures what must never be.
#pragma once

#include "collision/broad_phase/broad_phase_kind.hpp"
#include "tests/fuzz/random_piles/scene.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace kds::piles {

/// Something wrong, once a kind: when it was seen first, and how bad it became.
struct Finding {
  std::string what;  ///< "overlap", "outside", "energy", "momentum", "stall", "audit", "throws", ...
  double first = 0;  ///< s
  double worst = 0;  ///< in the unit of its limit
  std::string text;  ///< more about the first
};

struct Result {
  std::vector<Finding> findings{};
  std::uint64_t events = 0;
  double seconds = 0;  ///< of the processor
  double reached = 0;  ///< s of simulated time
  double overlap = 0;  ///< the deepest, with a wall too, in parts of the smaller of two radii
  double energy = 0;   ///< the greatest rise that lasts, in parts of the energy at the start
  double kinetic = 0;  ///< at the end, in parts of the energy at the start
};

/// s of simulated time between measurements of all bodies.
inline constexpr double sample = 0.05;
/// Deeper than this part of the smaller bounding radius is wrong.
inline constexpr double deepest_overlap = 1e-9;
/// More than this part of the energy at the start, gained for good since it was least, is wrong.
inline constexpr double greatest_gain = 1e-3;
/// Momentum may change by this part of the sum of its magnitudes, where nothing acts from outside.
inline constexpr double greatest_change_of_momentum = 1e-12;

/// A run that makes more steps, or takes more seconds of the processor, is a stall.
struct Budget {
  std::uint64_t steps = 20'000'000;
  double seconds = 20;
  /// If given: the run ends when this has been found and is as bad as that.
  std::string sought{};
  double least = 0;
};

/// Whether what is sought has been found.
bool found(const Budget& budget, const Result& result);

/// Runs and measures: at each event what has moved, or all if there are few bodies, and all each `sample`.
Result measure(const Scene& scene, const Budget& budget);

/// Compares the events, bit for bit, with those of another broad phase, and of a world saved and loaded in the midst.
/// What differs is added to the result. Precondition: the scene was measured within the budget.
void compare_ways(const Scene& scene, const Budget& budget, Result& result);

}  // namespace kds::piles
