// What a second thread gains: seconds that pass, not CPU time, until the first answer and from there on.
#include "tests/benchmarks/csv_file.hpp"
#include "tests/benchmarks/speed/methods.hpp"
#include "tests/benchmarks/speed/race.hpp"
#include "tests/benchmarks/speed/report.hpp"

#include <string>
#include <vector>

namespace speed {

using kds::benchmarks::open_csv;
using kds::benchmarks::tell;

std::vector<Target> measure_threads(const Settings& settings) {
  auto file = open_csv(settings.folder, "speed-threads.csv");
  tell(file, "bodies,threads,setup_s,run_s,ratio,low,high\n");
  std::vector<std::size_t> sizes{10'000};
  if (!settings.quick) sizes.insert(sizes.end(), {100'000, 1'000'000});
  for (const std::size_t n : sizes) {
    SceneOptions options;
    options.bodies = n;
    const BallScene scene = make_scene(options);
    std::vector<Entrant> entrants;
    for (const std::size_t threads : {1, 2}) {
      const Drive drive{.threads = threads, .clock = kds::benchmarks::wall_seconds};
      entrants.push_back(
          {std::to_string(threads), [&scene, drive] { return to_run(run_method(scene, methods().front(), drive)); }});
    }
    RaceOptions race_options = settings.quick ? single_round : RaceOptions{};
    race_options.patience = 30;
    const auto results = race(entrants, race_options);
    check_agreement(results, std::to_string(n) + " balls");
    for (const Result& r : results) {
      const Ratio to_one = ratio(r, results.front());
      tell(file, "%zu,%s,%.6f,%.6f,%.3f,%.3f,%.3f\n", n, r.name.c_str(), r.best.setup, r.best_run, to_one.median,
           to_one.low, to_one.high);
    }
  }
  return {};
}

}  // namespace speed
