#include "tests/benchmarks/speed/race.hpp"

#include "tests/benchmarks/speed/isolated.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace speed {
namespace {

/// The run of median length of some, after one that is not counted: a new process has its memory still to get. It keeps
/// what it got: whether the C library gives memory back to the system between runs, to get it anew page by page, would
/// depend on the sizes of an entrant's blocks.
Run repeated(const Entrant& entrant, std::size_t times) {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
#endif
  entrant.run();
  std::vector<Run> runs;
  for (std::size_t k = 0; k < times; ++k) runs.push_back(entrant.run());
  const auto middle = runs.begin() + static_cast<std::ptrdiff_t>(runs.size() / 2);
  std::nth_element(runs.begin(), middle, runs.end(), [](const Run& x, const Run& y) { return x.total() < y.total(); });
  return *middle;
}

}  // namespace

Run to_run(const Outcome& outcome) {
  Run run;
  run.setup = outcome.setup;
  run.run = outcome.run;
  run.contacts = outcome.counters.contacts;
  run.events = outcome.events;
  run.hash = outcome.hash;
  run.tests = outcome.counters.pair_tests;
  run.counters = outcome.counters;
  run.after_setup = outcome.after_setup;
  run.hardware = outcome.hardware;
  return run;
}

std::vector<Result> race(const std::vector<Entrant>& entrants, const RaceOptions& options) {
  std::vector<Result> results;
  double best = std::numeric_limits<double>::infinity();
  for (const Entrant& entrant : entrants) {
    const double limit = std::min(options.cap, std::max(options.floor, options.hopeless * best));
    Result result;
    result.name = entrant.name;
    if (const auto run = isolated(limit, [&] { return entrant.run(); })) {
      result.best = *run;
      result.best_run = run->run;
      best = std::min(best, run->total());
    } else {
      result.cut = true;
      result.best.run = result.best_run = limit;
    }
    results.push_back(std::move(result));
  }
  for (int round = 1; round < options.rounds; ++round) {
    for (std::size_t i = 0; i < entrants.size(); ++i) {
      Result& result = results[i];
      const double once = result.best.total();
      if (result.cut || once > options.hopeless * best || once * round > options.patience) continue;
      const auto times = static_cast<std::size_t>(std::clamp(options.least / once, 1.0, 1000.0));
      const auto run = isolated(std::numeric_limits<double>::infinity(), [&] { return repeated(entrants[i], times); });
      if (!run) throw std::runtime_error(entrants[i].name + ": a run was ended");
      result.best_run = std::min(result.best_run, run->run);
      if (run->total() < once) result.best = *run;
    }
  }
  return results;
}

void check_agreement(const std::vector<Result>& results, const std::string& where) {
  const Result* first = nullptr;
  for (const Result& result : results) {
    if (result.cut) continue;
    if (!first) first = &result;
    if (result.best.events == first->best.events && result.best.hash == first->best.hash) continue;
    throw std::runtime_error(where + ": " + result.name + " has other events (" + std::to_string(result.best.events) +
                             ") than " + first->name + " (" + std::to_string(first->best.events) + ")");
  }
}

}  // namespace speed
