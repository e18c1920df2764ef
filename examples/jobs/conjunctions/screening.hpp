// Conjunction screening: entry, closest approach and exit of all pairs at exact times, none missed.
#pragma once

#include "examples/jobs/conjunctions/conjunction.hpp"
#include "examples/jobs/conjunctions/orbit.hpp"

#include <cstdint>
#include <functional>
#include <span>

namespace conjunctions {

/// Where the time of a screening has gone, CPU s, and how much it has done.
struct ScreeningCost {
  double interpolation = 0;  ///< states of objects, and quintics through them
  double broad_phase = 0;    ///< which pairs may come near; in a world, giving it the quintics
  double pairs = 0;          ///< exact tests of those, and conjunctions; in a world, all events
  std::uint64_t pieces = 0;
  std::uint64_t candidates = 0;  ///< tests of pairs

  double total() const { return interpolation + broad_phase + pairs; }
};

/// By a world: each object is a ball of half the screening distance, in mode `none`; the world is given each piece of
/// motion when it begins.
///
/// Calls found(conjunction) for each when it ends, in order of exits. Memory: some hundred bytes an object, however
/// long the screening. Throws std::invalid_argument, before anything is found, for options that are not positive and
/// finite, and for orbits that cannot be interpolated.
ScreeningCost screen(std::span<const Elements> catalogue, const Screening& options,
                     const std::function<void(const Conjunction&)>& found);

/// The same conjunctions, at the same doubles, by windows of time: in each, pairs are found by a grid of cells around
/// the stretches that objects pass, and tested by the same certificates, without a world. Order: windows, and pairs in
/// each.
ScreeningCost screen_by_windows(std::span<const Elements> catalogue, const Screening& options,
                                const std::function<void(const Conjunction&)>& found);

/// Throws std::invalid_argument for options that are not positive and finite.
void check(const Screening& options);

}  // namespace conjunctions
