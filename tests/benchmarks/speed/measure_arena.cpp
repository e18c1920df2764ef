// Fast bullets that ignore each other, in a world and on Bullet's tree: whether both find the same hits, and how long
// they take.
#include "tests/benchmarks/csv_file.hpp"
#include "tests/benchmarks/speed/arena.hpp"
#include "tests/benchmarks/speed/race.hpp"
#include "tests/benchmarks/speed/report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

namespace speed {
namespace {

using kds::benchmarks::open_csv;
using kds::benchmarks::tell;

/// By bodies, then time, as two methods may round times that are nearly equal either way.
std::vector<Hit> in_order(std::vector<Hit> hits) {
  std::sort(hits.begin(), hits.end(), [](const Hit& x, const Hit& y) {
    return std::tie(x.bullet, x.target, x.time) < std::tie(y.bullet, y.target, y.time);
  });
  return hits;
}

Run to_run(const ArenaOutcome& outcome, std::vector<Hit> hits, const std::vector<Hit>& expected) {
  Run run;
  run.setup = outcome.setup;
  run.run = outcome.run;
  run.tests = outcome.tests;
  run.events = outcome.walls;
  run.contacts = hits.size();
  hits = in_order(std::move(hits));
  if (hits.size() != expected.size()) run.wrong = std::max(hits.size(), expected.size());
  for (std::size_t i = 0; run.wrong == 0 && i < hits.size(); ++i) {
    run.wrong += hits[i].bullet != expected[i].bullet || hits[i].target != expected[i].target;
    run.worst_time = std::max(run.worst_time, std::abs(hits[i].time - expected[i].time));
  }
  return run;
}

}  // namespace

std::vector<Target> measure_arena(const Settings& settings) {
  Arena arena;
  if (settings.quick) arena.duration = 1;
  std::vector<Hit> expected;
  run_arena(arena, expected);
  expected = in_order(std::move(expected));
  const auto entrant = [&](const char* name, ArenaOutcome (*run_it)(const Arena&, std::vector<Hit>&)) {
    return Entrant{name, [&arena, &expected, run_it] {
                     std::vector<Hit> hits;
                     hits.reserve(expected.size());
                     const ArenaOutcome outcome = run_it(arena, hits);
                     return to_run(outcome, std::move(hits), expected);
                   }};
  };
  std::vector<Entrant> entrants{entrant("auto", run_arena)};
#ifdef KDS_PEER_BULLET
  entrants.push_back(entrant("btDbvt", run_arena_by_bullet));
#else
  std::puts("built without Bullet: left out");
#endif
  const auto results = race(entrants, settings.quick ? single_round : RaceOptions{});
  auto file = open_csv(settings.folder, "speed-arena.csv");
  tell(file, "method,frames,setup_cpu,run_cpu,ms_a_frame,ratio,low,high,hits,walls,wrong,worst_time,tests\n");
  for (const Result& r : results) {
    const Ratio to_auto = ratio(r, results.front(), &Round::run);
    tell(file, "%s,%llu,%.6f,%.6f,%.4f,%.3f,%.3f,%.3f,%llu,%llu,%llu,%.1e,%llu\n", r.name.c_str(),
         static_cast<unsigned long long>(arena.frames()), r.best.setup, r.best_run,
         1e3 * r.best_run / static_cast<double>(arena.frames()), to_auto.median, to_auto.low, to_auto.high,
         static_cast<unsigned long long>(r.best.contacts), static_cast<unsigned long long>(r.best.events),
         static_cast<unsigned long long>(r.best.wrong), r.best.worst_time,
         static_cast<unsigned long long>(r.best.tests));
    constexpr double same_time = 1e-9;  // s; of times up to 20 s, from positions that the peer rounds
    if (r.best.wrong > 0 || r.best.worst_time > same_time) {
      throw std::runtime_error(r.name + " found other hits in the arena than " + results.front().name);
    }
  }
  std::vector<Target> targets;
  if (results.size() > 1) {
    const double times = ratio(results.back(), results.front(), &Round::run).median;
    targets.push_back({"auto against btDbvt: arena of 1500 bullets and 500 targets", times, '>', 1, "x"});
  }
  return targets;
}

}  // namespace speed
