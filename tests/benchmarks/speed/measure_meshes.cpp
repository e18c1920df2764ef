// Scenes of meshes, as the tool runs them: the rings of [Coming06] section 5, and models of over 6 000 triangles.
#include "tests/benchmarks/csv_file.hpp"
#include "tests/benchmarks/generated_scene.hpp"
#include "tests/benchmarks/speed/race.hpp"
#include "tests/benchmarks/speed/race_of_scene.hpp"
#include "tests/benchmarks/speed/report.hpp"

#include <string>
#include <vector>

namespace speed {
namespace {

using kds::benchmarks::generated_scene;
using kds::benchmarks::open_csv;
using kds::benchmarks::tell;

void tell_rows(std::ofstream& file, double rate, double seconds, const std::vector<Result>& results) {
  for (const Result& r : results) {
    const auto number = [](std::uint64_t x) { return static_cast<unsigned long long>(x); };
    tell(file, "%g,%g,%s,%.6f,%.6f,%llu,%llu,%llu,%llu,%d\n", rate, seconds, r.name.c_str(), r.best.setup, r.best_run,
         number(r.best.contacts), number(r.best.tests), number(r.best.counters.broad_phase.swaps),
         number(r.best.counters.broad_phase.certificates), r.cut);
  }
}

constexpr const char* header = "rate,sim_seconds,method,setup_cpu,run_cpu,contacts,tests,swaps,certificates,cut\n";

}  // namespace

std::vector<Target> measure_rings(const Settings& settings) {
  auto file = open_csv(settings.folder, "speed-rings.csv");
  tell(file, header);
  std::vector<Target> targets;
  for (const auto& [rate, seconds] : {std::pair{60.0, 1.0}, std::pair{1000.0, 1.0}, std::pair{1000.0, 10.0}}) {
    const auto scene =
        generated_scene({.kind = "rings", .bodies = 1000, .density = 0.01, .seed = 1000, .end_time = seconds});
    const auto results = race_methods(scene, rate, settings.quick);
    tell_rows(file, rate, seconds, results);
    const Result& swept = of(results, "sap");
    const auto ratio = [&](const char* name, bool with_setup) {
      return speed::ratio(swept, of(results, name), with_setup ? &Round::total : &Round::run).median;
    };
    if (rate < 1000) continue;
    for (const auto& [name, wanted] : {std::pair{"kinetic-sap", 10.0}, std::pair{"auto", 50.0}}) {
      for (const bool with_setup : {true, false}) {
        targets.push_back({std::string(name) + " against own sap: 1000 rings 1 % 1000 Hz " +
                               (seconds == 1 ? "1 s" : "10 s") + (with_setup ? " with set-up" : " run alone"),
                           ratio(name, with_setup), '>', wanted, "x"});
      }
    }
  }
  return targets;
}

std::vector<Target> measure_models(const Settings& settings) {
  const auto scene = generated_scene({.kind = "models", .bodies = 100, .density = 0.05, .seed = 7});
  auto file = open_csv(settings.folder, "speed-models.csv");
  tell(file, header);
  constexpr double rate = 60;
  const auto results = race_methods(scene, rate, settings.quick);
  tell_rows(file, rate, scene.end_time, results);
  const double frames = rate * (scene.end_time - scene.begin_time);
  const Result& ours = results.front();
  return {{"auto: 100 models of 6 000 triangles: frames of 1/60 s a second", frames / ours.best_run, '>', 1000, "1/s"},
          {"the same with set-up", frames / ours.best.total(), '>', 1000, "1/s"}};
}

}  // namespace speed
