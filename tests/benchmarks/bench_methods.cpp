// CPU seconds per simulated second of the three methods: [Paper] Figures 7 and 8.
//
//     bench_methods bodies    [DIRECTORY [SAMPLES]]   n = 100 ... 1 000 rings at 1 000 Hz       -> bodies.csv
//     bench_methods frequency [DIRECTORY [SAMPLES]]   f = 10 ... 2 000 Hz, 1 000 rings, by work -> frequency.csv
//
// Rings of 64 triangles at 1 % density, one simulated second, elastic; each figure is the mean over the samples, which
// are scenes of different seeds, run one method after the other so that a change of the machine's pace hits all alike.
// Every sample checks that the methods made the same contacts; it stops where they did not.

#include "examples/kds-collide/generator.hpp"
#include "examples/kds-collide/run.hpp"
#include "examples/kds-collide/scene_reader.hpp"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace kds_collide;
using kds::collision::Work;

Scene make_scene(std::size_t bodies, std::uint64_t seed) {
  GeneratorOptions options;
  options.bodies = bodies;
  options.seed = seed;
  const GeneratedScene generated = generate_scene(options);
  const auto folder = std::filesystem::temp_directory_path() / ("kds-bench-" + std::to_string(seed));
  std::filesystem::create_directories(folder);
  for (const auto& mesh : generated.meshes) std::ofstream(folder / mesh.name) << mesh.text;
  Scene scene = parse_scene(generated.json, folder / "scene.json");
  std::filesystem::remove_all(folder);
  return scene;
}

/// The times of all contacts, to compare methods by.
struct ContactTimes final : EventSink {
  std::vector<double> times;
  void on_event(const Event& event) override { times.push_back(event.time); }
};

struct Row {
  double setup = 0, run = 0, contacts = 0, tests = 0, swaps = 0;
  double update = 0, sort = 0, prune = 0, test = 0;
};

/// Runs all methods on the same samples; rows in the order of the methods.
std::vector<Row> measure(const std::vector<std::string>& methods, std::size_t bodies, double rate, int samples,
                         bool profile) {
  std::vector<Row> rows(methods.size());
  for (int sample = 0; sample < samples; ++sample) {
    const Scene scene = make_scene(bodies, 1000 + static_cast<std::uint64_t>(sample));
    std::vector<double> expected;
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
      row.swaps += share * static_cast<double>(result.swaps);
      row.update += share * result.profile.seconds(Work::update);
      row.sort += share * result.profile.seconds(Work::sort);
      row.prune += share * result.profile.seconds(Work::prune);
      row.test += share * result.profile.seconds(Work::test);
    }
  }
  return rows;
}

std::ofstream open_csv(const std::filesystem::path& folder, const char* name) {
  std::filesystem::create_directories(folder);
  std::ofstream file(folder / name);
  if (!file) throw std::runtime_error("cannot write " + (folder / name).string());
  return file;
}

/// One line to the file and to the terminal.
void tell(std::ofstream& file, const char* format, auto... values) {
  char line[512];
  std::snprintf(line, sizeof line, format, values...);
  file << line << std::flush;
  std::fputs(line, stdout);
}

void scalability(const std::filesystem::path& folder, int samples) {
  const std::vector<std::string> methods{"kinetic-sap", "sap", "all-pairs"};
  auto file = open_csv(folder, "bodies.csv");
  tell(file, "bodies,method,cpu_per_sim_second,setup_cpu,contacts,pair_tests,swaps\n");
  for (std::size_t n = 100; n <= 1000; n += 100) {
    const auto rows = measure(methods, n, 1000, samples, false);
    for (std::size_t m = 0; m < methods.size(); ++m) {
      const Row& r = rows[m];
      tell(file, "%zu,%s,%.6f,%.6f,%.1f,%.1f,%.1f\n", n, methods[m].c_str(), r.setup + r.run, r.setup, r.contacts,
           r.tests, r.swaps);
    }
  }
}

void frequency(const std::filesystem::path& folder, int samples) {
  const std::vector<std::string> methods{"kinetic-sap", "sap"};
  auto file = open_csv(folder, "frequency.csv");
  tell(file, "rate,method,cpu_per_sim_second,update,sort,prune,test\n");
  for (const double rate : {10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0}) {
    const auto plain = measure(methods, 1000, rate, samples, false);
    const auto split = measure(methods, 1000, rate, samples, true);
    for (std::size_t m = 0; m < methods.size(); ++m) {
      const Row& r = split[m];
      tell(file, "%g,%s,%.6f,%.6f,%.6f,%.6f,%.6f\n", rate, methods[m].c_str(), plain[m].setup + plain[m].run, r.update,
           r.sort, r.prune, r.test);
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
    std::fputs("usage: bench_methods bodies|frequency [DIRECTORY [SAMPLES]]\n", stderr);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_methods: %s\n", error.what());
    return 1;
  }
}
