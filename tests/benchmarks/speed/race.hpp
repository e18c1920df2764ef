// Several ways of doing one thing, timed in turn.
#pragma once

#include "collision/world.hpp"
#include "tests/benchmarks/speed/methods.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace speed {

/// What one run took and found. Comes out of a child process, so it holds no pointers.
struct Run {
  double setup = 0;             ///< CPU s
  double run = 0;               ///< CPU s
  std::uint64_t contacts = 0;
  std::uint64_t events = 0;     ///< and their
  std::uint64_t hash = 0;       ///< hash, where they must agree bit by bit
  std::uint64_t tests = 0;      ///< dynamic tests of pairs
  std::uint64_t wrong = 0;      ///< contacts that are not those expected
  double worst_time = 0;        ///< s; greatest difference of a contact's time from that expected
  std::uint64_t peak_bytes = 0; ///< memory of the process, where asked for
  kds::collision::WorldCounters counters;
  kds::collision::WorldCounters after_setup;  ///< of these
  HardwareCounts hardware;

  double total() const { return setup + run; }
};
Run to_run(const Outcome& outcome);

struct Entrant {
  std::string name;
  std::function<Run()> run;
};

struct RaceOptions {
  int rounds = 5;            ///< of each that is not too slow; the best counts
  int most_rounds = 0;       ///< if more: they go on, up to so many, until all have settled
  double hopeless = 20;      ///< times the best so far: ended there and not run again
  double far = 2;            ///< times the best so far: no more than `rounds`
  double floor = 0.25;       ///< CPU s that everybody gets
  double cap = 20;           ///< CPU s that nobody gets more of
  double least = 0.02;       ///< CPU s a round is filled with by repeating short runs, of which the lower tenth counts;
                             ///< each round begins with a run that does not count, but for the first, which is that
  double patience = 8;       ///< CPU s after which an entrant has no further rounds
};

/// All have settled when in so many rounds nobody's best has fallen by more than this part.
inline constexpr int settled_rounds = 15;
inline constexpr double settled_part = 0.01;

struct Result {
  std::string name;
  bool cut = false;    ///< ended: `run` is empty, `best.run` says after how many seconds
  Run best;            ///< of all rounds, by total
  double best_run = 0; ///< the least `run` of all rounds, set-up aside
};

/// Runs all in turn, round by round, each run in a process of its own; every other round in the reverse order. Results
/// in the order of the entrants.
///
/// What else the machine does only lengthens a run. So the best of all counts, and is found when it has not become any
/// better for some rounds: a rule that looks at no ratio, and treats all near the best alike.
std::vector<Result> race(const std::vector<Entrant>& entrants, const RaceOptions& options);

/// Throws std::runtime_error where two that were not cut found other events.
void check_agreement(const std::vector<Result>& results, const std::string& where);

}  // namespace speed
