// CPU seconds per simulated second of all methods: [Paper] Figures 7 and 8; and what swept volumes cost in tests.
//
//     bench_methods bodies    [DIRECTORY [SAMPLES]]   n = 100 ... 1 000 rings at 1 000 Hz       -> bodies.csv
//     bench_methods frequency [DIRECTORY [SAMPLES]]   f = 10 ... 2 000 Hz, 1 000 rings, by work -> frequency.csv
//     bench_methods one-hertz [DIRECTORY [SAMPLES]]   pairs tested at f = 1 ... 1 000 Hz        -> one-hertz.csv
//
// Rings of 64 triangles at 1 % density, one simulated second, elastic; each figure is the mean over the samples, which
// are scenes of different seeds, run one method after the other so that a change of the machine's pace hits all alike.
// Every sample checks that the methods made the same contacts; it stops where they did not.

#include "collision/broad_phase/broad_phase_kind.hpp"
#include "examples/kds-collide/run.hpp"
#include "tests/benchmarks/csv_file.hpp"
#include "tests/benchmarks/generated_scene.hpp"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace kds_collide;
using kds::collision::Work;

using kds::benchmarks::open_csv;
using kds::benchmarks::tell;

/// All that the library has, the default first.
std::vector<std::string> all_methods() {
  std::vector<std::string> names;
  for (const auto& known : kds::collision::broad_phases) names.emplace_back(known.name);
  return names;
}

/// The times of all contacts, to compare methods by.
struct ContactTimes final : EventSink {
  std::vector<double> times;
  void on_event(const Event& event) override { times.push_back(event.time); }
};

struct Row {
  double setup = 0, run = 0, contacts = 0, tests = 0, pairs = 0, swaps = 0;
  double update = 0, sort = 0, prune = 0, test = 0;
};

/// Whoever is first would pay for memory that the others then find.
void run_uncounted(const Scene& scene, const std::string& method, double rate) {
  RunOptions options;
  options.broad_phase = method;
  options.rate = rate;
  ContactTimes contacts;
  run(scene, options, contacts);
}

/// Runs all methods on the same samples; rows in the order of the methods.
std::vector<Row> measure(const std::vector<std::string>& methods, const GeneratorOptions& scenes, double rate,
                         int samples, bool profile) {
  std::vector<Row> rows(methods.size());
  for (int sample = 0; sample < samples; ++sample) {
    GeneratorOptions generator = scenes;
    generator.seed = 1000 + static_cast<std::uint64_t>(sample);
    const Scene scene = kds::benchmarks::generated_scene(generator);
    std::vector<double> expected;
    if (sample == 0) run_uncounted(scene, methods.front(), rate);
    for (std::size_t m = 0; m < methods.size(); ++m) {
      RunOptions options;
      options.broad_phase = methods[m];
      options.rate = rate;
      options.profile = profile;
      ContactTimes contacts;
      const RunResult result = run(scene, options, contacts);
      if (m == 0) expected = contacts.times;
      if (contacts.times != expected) throw std::runtime_error(methods[m] + " made other contacts than " + methods[0]);
      Row& row = rows[m];
      const double share = 1.0 / samples;
      row.setup += share * result.setup_cpu_seconds;
      row.run += share * result.run_cpu_seconds;
      row.contacts += share * static_cast<double>(result.contacts);
      row.tests += share * static_cast<double>(result.pair_tests);
      row.pairs += share * static_cast<double>(result.pairs_begun);
      row.swaps += share * static_cast<double>(result.swaps);
      row.update += share * result.profile.seconds(Work::update);
      row.sort += share * result.profile.seconds(Work::sort);
      row.prune += share * result.profile.seconds(Work::prune);
      row.test += share * result.profile.seconds(Work::test);
    }
  }
  return rows;
}

void scalability(const std::filesystem::path& folder, int samples) {
  const std::vector<std::string> methods = all_methods();
  auto file = open_csv(folder, "bodies.csv");
  tell(file, "bodies,method,cpu_per_sim_second,setup_cpu,contacts,pair_tests,swaps\n");
  for (std::size_t n = 100; n <= 1000; n += 100) {
    const auto rows = measure(methods, {.bodies = n}, 1000, samples, false);
    for (std::size_t m = 0; m < methods.size(); ++m) {
      const Row& r = rows[m];
      tell(file, "%zu,%s,%.6f,%.6f,%.1f,%.1f,%.1f\n", n, methods[m].c_str(), r.setup + r.run, r.setup, r.contacts,
           r.tests, r.swaps);
    }
  }
}

void frequency(const std::filesystem::path& folder, int samples) {
  const std::vector<std::string> methods = all_methods();
  auto file = open_csv(folder, "frequency.csv");
  tell(file, "rate,method,cpu_per_sim_second,update,sort,prune,test\n");
  for (const double rate : {10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0}) {
    const auto plain = measure(methods, {}, rate, samples, false);
    const auto split = measure(methods, {}, rate, samples, true);
    for (std::size_t m = 0; m < methods.size(); ++m) {
      const Row& r = split[m];
      tell(file, "%g,%s,%.6f,%.6f,%.6f,%.6f,%.6f\n", rate, methods[m].c_str(), plain[m].setup + plain[m].run, r.update,
           r.sort, r.prune, r.test);
    }
  }
}

/// [Paper] section 4.3: swept volumes at 1 Hz made for over 30 % more dynamic tests than kinetic ones. Ten simulated
/// seconds; what all frames together tested.
void one_hertz(const std::filesystem::path& folder, int samples) {
  auto file = open_csv(folder, "one-hertz.csv");
  tell(file, "density,rate,contacts,kinetic_tests,swept_tests,more_percent,kinetic_pairs,swept_pairs\n");
  for (const double density : {0.01, 0.1}) {
    for (const double rate : {1.0, 2.0, 10.0, 60.0, 1000.0}) {
      const auto rows = measure({"kinetic-sap", "sap"}, {.density = density, .end_time = 10}, rate, samples, false);
      const Row& kinetic = rows[0];
      const Row& swept = rows[1];
      tell(file, "%g,%g,%.1f,%.1f,%.1f,%.1f,%.1f,%.1f\n", density, rate, kinetic.contacts, kinetic.tests, swept.tests,
           100 * (swept.tests / kinetic.tests - 1), kinetic.pairs, swept.pairs);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  const std::filesystem::path folder = argc > 2 ? argv[2] : ".";
  const int samples = argc > 3 ? std::atoi(argv[3]) : 5;
  try {
    if (samples < 1) throw std::runtime_error("SAMPLES must be at least 1");
    if (what == "bodies") return scalability(folder, samples), 0;
    if (what == "frequency") return frequency(folder, samples), 0;
    if (what == "one-hertz") return one_hertz(folder, samples), 0;
    std::fputs("usage: bench_methods bodies|frequency|one-hertz [DIRECTORY [SAMPLES]]\n", stderr);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_methods: %s\n", error.what());
    return 1;
  }
}
