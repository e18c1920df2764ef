#include "tests/benchmarks/speed/race_of_scene.hpp"

#include "io/run.hpp"
#include "tests/benchmarks/speed/methods.hpp"

#include <bit>
#include <stdexcept>

namespace speed {
namespace {

struct Hasher final : kds::io::EventSink {
  Run run;
  void on_event(const kds::io::Event& e) override {
    ++run.events;
    run.hash += (std::bit_cast<std::uint64_t>(e.time) ^ (std::uint64_t{e.a} << 32 | e.b)) * 0x9E3779B97F4A7C15u;
  }
};

}  // namespace

Run run_scene(const kds::io::Scene& scene, const std::string& method, double rate) {
  Hasher sink;
  kds::io::RunOptions options;
  options.broad_phase = method;
  options.rate = rate;
  const auto result = kds::io::run(scene, options, sink);
  Run run = sink.run;
  run.setup = result.setup_cpu_seconds;
  run.run = result.run_cpu_seconds;
  run.contacts = result.contacts;
  run.tests = result.pair_tests;
  run.counters.pairs_begun = result.pairs_begun;
  run.counters.broad_phase.swaps = result.swaps;
  run.counters.broad_phase.certificates = result.certificates;
  run.counters.broad_phase.box_updates = result.box_updates;
  return run;
}

std::vector<Result> race_methods(const kds::io::Scene& scene, double rate, bool quick) {
  std::vector<Entrant> entrants;
  for (const Method& m : methods()) {
    if (scene.bodies.size() > m.most_bodies) continue;
    entrants.push_back({m.name, [&scene, &m, rate] { return run_scene(scene, m.name, rate); }});
  }
  RaceOptions options = quick ? single_round : RaceOptions{};
  options.hopeless = 1e9;
  options.patience = 3;
  auto results = race(entrants, options);
  check_agreement(results, "a scene of the tool");
  return results;
}

const Result& of(const std::vector<Result>& results, const std::string& name) {
  for (const Result& r : results) {
    if (r.name == name) return r;
  }
  throw std::runtime_error("no method " + name);
}

}  // namespace speed
