// The ways in which a scenario is run: all must give the same log.
#pragma once

#include "collision/broad_phase/broad_phase_kind.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "tests/fuzz/random_worlds/scenario.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace kds::fuzz {

using collision::BroadPhaseKind;

struct Way {
  BroadPhaseKind broad_phase = BroadPhaseKind::all_pairs;
  double rate = 8;  ///< Hz, of the frames of `sap`
  double window = never;
  std::size_t threads = 1;
  int kdop = 6;
  bool audits = false;         ///< after each step
  int stops = 0;               ///< each advance is made in so many more parts
  bool budgets = false;        ///< each step is for a budget of no time
  std::size_t save_every = 0;  ///< steps; each time the world is saved and loaded into another one (0: never)
  BroadPhaseKind load_into = BroadPhaseKind::all_pairs;  ///< that world's, in turn with `broad_phase`
  bool saves_between_calls = false;                      ///< before each call; of large worlds, before each advance
  static constexpr std::size_t most_bodies_saved_often = 18;
  bool runs_ahead = false;  ///< what is saved is loaded by the same world, after some steps more that are undone by it
  double growth = 1;        ///< of all shapes; one that is not 1 makes a wrong world, to check the comparison

  std::string name() const;
};

/// What others are compared with.
Way reference_way(const Scenario& scenario);
/// Some of the other ways, chosen by the seed.
std::vector<Way> ways_of(const Scenario& scenario);

}  // namespace kds::fuzz
