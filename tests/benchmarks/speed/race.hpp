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
  double setup = 0;  ///< CPU s
  double run = 0;    ///< CPU s
  std::uint64_t contacts = 0;
  std::uint64_t events = 0;      ///< and their
  std::uint64_t hash = 0;        ///< hash, where they must agree bit by bit
  std::uint64_t tests = 0;       ///< dynamic tests of pairs
  std::uint64_t wrong = 0;       ///< contacts that are not those expected
  double worst_time = 0;         ///< s; greatest difference of a contact's time from that expected
  std::uint64_t peak_bytes = 0;  ///< memory of the process, where asked for
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
  int rounds = 9;           ///< of each that is not too slow
  int most_rounds = 60;     ///< they go on, up to so many, until ratios are known to within
  double precision = 0.01;  ///< either way: the ratio to the first entrant, of all that are not `far`
  double far = 2;           ///< times the best so far: no more than `rounds`
  double hopeless = 20;     ///< times the best so far: ended there and not run again
  double floor = 0.25;      ///< CPU s that everybody gets
  double cap = 20;          ///< CPU s that nobody gets more of
  double least = 0.02;      ///< CPU s a round is filled with by repeating short runs, of which the lower tenth counts;
                            ///< each round begins with a run that does not count, but for the first, which is that
  double patience = 8;      ///< CPU s after which an entrant has no further rounds
};

/// One round: shows that all works, measures nothing.
inline constexpr RaceOptions single_round{.rounds = 1, .most_rounds = 1};

/// CPU s of one round; NaN where the entrant was not run.
struct Round {
  double total, run;
};

struct Result {
  std::string name;
  bool cut = false;           ///< ended: `run` is empty, `best.run` says after how many seconds
  Run best;                   ///< of all rounds, by total
  double best_run = 0;        ///< the least `run` of all rounds, set-up aside
  std::vector<Round> rounds = {};  ///< the first of which has memory still to get
};

/// A median and the 95 % confidence interval about it.
struct Ratio {
  double median, low, high;
};

/// How many times as long x takes as y: the median over rounds, in each of which the two ran soon one after the other.
///
/// Something else on the machine makes a program up to half slower for milliseconds or for minutes. It meets both of a
/// round alike, and where it does not, the median passes over it; a quotient of two best times has to wait until both
/// have had a quiet moment. The first rounds do not count, except where one of the two has fewer than three others:
/// then best is divided by best, and the interval is that quotient alone. So it is where one was ended (the quotient is
/// then a bound).
Ratio ratio(const Result& x, const Result& y, double Round::*part = &Round::total);

/// Runs all in turn, round by round, each run in a process of its own; every other round in the reverse order. Results
/// in the order of the entrants.
std::vector<Result> race(const std::vector<Entrant>& entrants, const RaceOptions& options);

/// Throws std::runtime_error where two that were not cut found other events.
void check_agreement(const std::vector<Result>& results, const std::string& where);

}  // namespace speed
