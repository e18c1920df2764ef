// CPU time a body, memory and time to the first answer, from a thousand balls to a million at one density.
#include "tests/benchmarks/csv_file.hpp"
#include "tests/benchmarks/speed/memory.hpp"
#include "tests/benchmarks/speed/methods.hpp"
#include "tests/benchmarks/speed/race.hpp"
#include "tests/benchmarks/speed/report.hpp"

#include <string>
#include <vector>

namespace speed {

using kds::benchmarks::open_csv;
using kds::benchmarks::tell;

std::vector<Target> measure_growth(const Settings& settings) {
  auto file = open_csv(settings.folder, "speed-growth.csv");
  tell(file,
       "bodies,method,setup_us_a_body,run_us_a_body,setup_cpu,run_cpu,peak_mib,contacts,swaps,tests,certificates,"
       "box_updates,instructions,cache_misses,page_faults,cut\n");
  std::vector<std::size_t> sizes{1000, 10'000};
  if (!settings.quick) sizes.insert(sizes.end(), {100'000, 1'000'000});
  double first = 0;
  Result last;
  for (const std::size_t n : sizes) {
    SceneOptions options;
    options.bodies = n;
    const BallScene scene = make_scene(options);
    const Drive drive{60, 1};
    std::vector<Entrant> entrants;
    for (const Method& m : methods()) {
      if (n > m.most_bodies) continue;
      entrants.push_back({m.name, [&scene, drive, &m] {
                            reset_peak_memory();
                            Run run = to_run(run_method(scene, m, drive));
                            run.peak_bytes = peak_memory();
                            return run;
                          }});
    }
    RaceOptions race_options = settings.quick ? single_round : RaceOptions{};
    race_options.cap = 15;
    const auto results = race(entrants, race_options);
    check_agreement(results, std::to_string(n) + " balls");
    for (const Result& r : results) {
      const double share = 1e6 / static_cast<double>(n);
      const auto& counters = r.best.counters;
      const auto number = [](std::uint64_t x) { return static_cast<unsigned long long>(x); };
      const auto count = [](std::int64_t x) { return static_cast<long long>(x); };
      tell(file, "%zu,%s,%.3f,%.3f,%.6f,%.6f,%.1f,%llu,%llu,%llu,%llu,%llu,%lld,%lld,%lld,%d\n", n, r.name.c_str(),
           share * r.best.setup, share * r.best_run, r.best.setup, r.best_run,
           static_cast<double>(r.best.peak_bytes) * 0x1p-20, number(r.best.contacts),
           number(counters.broad_phase.swaps), number(r.best.tests), number(counters.broad_phase.certificates),
           number(counters.broad_phase.box_updates), count(r.best.hardware.instructions),
           count(r.best.hardware.cache_misses), count(r.best.hardware.page_faults), r.cut);
    }
    last = results.front();
    const double a_body = (last.cut ? last.best.run : last.best.total()) / static_cast<double>(n);
    if (first == 0) first = a_body;
    if (n == sizes.back()) {
      const std::string what = "auto: CPU a body at " + std::to_string(n) + " balls over that at 1000";
      const std::string note = last.cut ? " (ended: more than this)" : "";
      std::vector<Target> targets{{what + note, a_body / first, '<', 3, "x"}};
      if (!last.cut) {
        targets.push_back({"auto: memory of the process at " + std::to_string(n) + " balls",
                           static_cast<double>(last.best.peak_bytes) * 0x1p-20, '<', 1024, "MiB"});
      }
      return targets;
    }
  }
  return {};
}

}  // namespace speed
