// Scenes of meshes, as the tool runs them: the rings of [Paper] section 5, and models of over 6 000 triangles.
#include "examples/kds-collide/run.hpp"
#include "tests/benchmarks/csv_file.hpp"
#include "tests/benchmarks/generated_scene.hpp"
#include "tests/benchmarks/speed/methods.hpp"
#include "tests/benchmarks/speed/race.hpp"
#include "tests/benchmarks/speed/report.hpp"

#include <bit>
#include <cstdio>
#include <string>
#include <vector>

namespace speed {
namespace {

using kds::benchmarks::generated_scene;
using kds::benchmarks::open_csv;
using kds::benchmarks::tell;

struct Hasher final : kds_collide::EventSink {
  Run run;
  void on_event(const kds_collide::Event& e) override {
    ++run.events;
    run.hash += (std::bit_cast<std::uint64_t>(e.time) ^ (std::uint64_t{e.a} << 32 | e.b)) * 0x9E3779B97F4A7C15u;
  }
};

Run run_scene(const kds_collide::Scene& scene, const std::string& method, double rate) {
  Hasher sink;
  kds_collide::RunOptions options;
  options.broad_phase = method;
  options.rate = rate;
  const auto result = kds_collide::run(scene, options, sink);
  Run run = sink.run;
  run.setup = result.setup_cpu_seconds;
  run.run = result.run_cpu_seconds;
  run.contacts = result.contacts;
  run.tests = result.pair_tests;
  run.counters.broad_phase.swaps = result.swaps;
  run.counters.broad_phase.certificates = result.certificates;
  run.counters.broad_phase.box_updates = result.box_updates;
  return run;
}

std::vector<Result> race_methods(const kds_collide::Scene& scene, double rate, const Settings& settings) {
  std::vector<Entrant> entrants;
  for (const Method& m : methods()) {
    if (scene.bodies.size() > m.most_bodies) continue;
    entrants.push_back({m.name, [&scene, &m, rate] { return run_scene(scene, m.name, rate); }});
  }
  RaceOptions options;
  options.rounds = settings.quick ? 1 : 7;
  options.hopeless = 1e9;
  options.patience = 1;
  auto results = race(entrants, options);
  check_agreement(results, "meshes");
  return results;
}

const Result& of(const std::vector<Result>& results, const std::string& name) {
  for (const Result& r : results) {
    if (r.name == name) return r;
  }
  throw std::runtime_error("no method " + name);
}

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
    const auto results = race_methods(scene, rate, settings);
    tell_rows(file, rate, seconds, results);
    const Result& swept = of(results, "sap");
    const auto ratio = [&](const char* name, bool with_setup) {
      const Result& r = of(results, name);
      return with_setup ? swept.best.total() / r.best.total() : swept.best_run / r.best_run;
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
  const auto results = race_methods(scene, rate, settings);
  tell_rows(file, rate, scene.end_time, results);
  const double frames = rate * (scene.end_time - scene.begin_time);
  const Result& ours = results.front();
  return {{"auto: 100 models of 6 000 triangles: frames of 1/60 s a second", frames / ours.best_run, '>', 1000, "1/s"},
          {"the same with set-up", frames / ours.best.total(), '>', 1000, "1/s"}};
}

}  // namespace speed
