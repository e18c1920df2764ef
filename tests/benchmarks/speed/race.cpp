#include "tests/benchmarks/speed/race.hpp"

#include "tests/benchmarks/speed/isolated.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace speed {
namespace {

/// Of some runs that than which a tenth are shorter, after one that is not counted: a new process has its memory still
/// to get. It keeps what it got: whether the C library gives memory back to the system between runs, to get it anew
/// page by page, would depend on the sizes of an entrant's blocks.
Run repeated(const Entrant& entrant, std::size_t times) {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
#endif
  entrant.run();
  std::vector<Run> runs;
  for (std::size_t k = 0; k < times; ++k) runs.push_back(entrant.run());
  const auto tenth = runs.begin() + static_cast<std::ptrdiff_t>(runs.size() / 10);
  std::nth_element(runs.begin(), tenth, runs.end(), [](const Run& x, const Run& y) { return x.total() < y.total(); });
  return *tenth;
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

Ratio ratio(const Result& x, const Result& y, double Round::*part) {
  std::vector<double> ratios;
  for (std::size_t k = 1; k < std::min(x.rounds.size(), y.rounds.size()); ++k) {
    const double r = x.rounds[k].*part / y.rounds[k].*part;
    if (!std::isnan(r)) ratios.push_back(r);
  }
  if (x.cut || y.cut || ratios.size() < 3) {
    const auto least = [&](const Result& of) { return part == &Round::run ? of.best_run : of.best.total(); };
    const double r = least(x) / least(y);
    return {r, r, r};
  }
  std::sort(ratios.begin(), ratios.end());
  // How many of n lie below the median is binomial: in 95 of 100 cases n / 2 within 1.96 sqrt(n) / 2, here rounded
  // down.
  const auto n = static_cast<double>(ratios.size());
  const auto below = static_cast<std::size_t>(std::max(0.0, (n - 1 - 1.96 * std::sqrt(n)) / 2));
  const std::size_t last = ratios.size() - 1;
  return {(ratios[last / 2] + ratios[last - last / 2]) / 2, ratios[below], ratios[last - below]};
}

std::vector<Result> race(const std::vector<Entrant>& entrants, const RaceOptions& options) {
  constexpr double not_run = std::numeric_limits<double>::quiet_NaN();
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
    result.rounds.push_back({result.best.total(), result.best.run});
    results.push_back(std::move(result));
  }
  const double hopeless = options.hopeless * best;  // of first runs, which have their memory still to get
  const auto is_known = [&](const Result& result) {
    if (result.cut || result.best.total() > options.far * best) return true;
    const Ratio r = ratio(result, results.front());
    return r.high - r.low <= 2 * options.precision * r.median;
  };
  for (int round = 1; round < std::max(options.rounds, options.most_rounds); ++round) {
    const bool extra = round >= options.rounds;
    if (extra && std::all_of(results.begin(), results.end(), is_known)) break;
    for (std::size_t k = 0; k < entrants.size(); ++k) {
      const std::size_t i = round % 2 == 0 ? k : entrants.size() - 1 - k;
      Result& result = results[i];
      result.rounds.push_back({not_run, not_run});
      const double once = result.best.total();
      if (result.cut || once > hopeless || once * round > options.patience) continue;
      if (extra && once > options.far * best) continue;
      const auto times = static_cast<std::size_t>(std::clamp(options.least / once, 1.0, 1000.0));
      const auto run = isolated(std::numeric_limits<double>::infinity(), [&] { return repeated(entrants[i], times); });
      if (!run) throw std::runtime_error(entrants[i].name + ": a run was ended");
      result.rounds.back() = {run->total(), run->run};
      result.best_run = std::min(result.best_run, run->run);
      if (run->total() < once) result.best = *run;
      best = std::min(best, result.best.total());
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
