// How fast the engine is: against other libraries, against its own methods, by size, by rate, in a gas, on floors, on
// large models, on compounds of many parts.
//
//     bench_speed DIRECTORY [--quick] [PART...]     all parts if none is named; they stand in the list below
//
// CSV into the directory; at the end the table of targets. Times are CPU seconds of the thread (of `threads` seconds
// that pass), of several ways in turn within one run, and all ways are checked to find the same contacts. Exits with 1
// where they do not. CELLS_SECONDS and SAMPLES in the environment: Settings::cells_seconds and samples.

#include "tests/benchmarks/csv_file.hpp"
#include "tests/benchmarks/speed/report.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace speed;

struct Part {
  const char* name;
  std::vector<Target> (*measure)(const Settings&);
};

const std::vector<Part> parts{
    {"peers", measure_peers},        {"arena", measure_arena},         {"rings", measure_rings},
    {"cells", measure_cells},        {"growth", measure_growth},       {"gas", measure_gas},
    {"floors", measure_floors},      {"models", measure_models},       {"threads", measure_threads},
    {"bodies", measure_bodies},      {"frequency", measure_frequency}, {"one-hertz", measure_one_hertz},
    {"compounds", measure_compounds}};

const Part& part(std::string_view name) {
  for (const Part& p : parts) {
    if (p.name == name) return p;
  }
  throw std::invalid_argument("there is no part " + std::string(name));
}

void tell_targets(const std::vector<Target>& targets, const Settings& settings) {
  if (targets.empty()) return;
  std::puts("\n== targets");
  auto file = kds::benchmarks::open_csv(settings.folder, "speed-targets.csv");
  kds::benchmarks::tell(file, "what,wanted,measured,unit,met\n");
  for (const Target& t : targets) {
    kds::benchmarks::tell(file, "%s,%s %g,%.3g,%s,%s\n", t.what.c_str(), t.relation == '>' ? ">=" : "<=", t.wanted,
                          t.measured, t.unit.c_str(), t.met() ? "yes" : "no");
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc < 2 || argv[1][0] == '-') {
      std::fputs("usage: bench_speed DIRECTORY [--quick] [PART...]\n", stderr);
      return 2;
    }
    Settings settings;
    settings.folder = argv[1];
    std::vector<Part> chosen;
    for (int i = 2; i < argc; ++i) {
      if (std::string_view(argv[i]) == "--quick") {
        settings.quick = true;
      } else {
        chosen.push_back(part(argv[i]));
      }
    }
    if (const char* seconds = std::getenv("CELLS_SECONDS")) settings.cells_seconds = std::atof(seconds);
    if (const char* samples = std::getenv("SAMPLES")) settings.samples = std::max(1, std::atoi(samples));
    if (settings.quick) settings.samples = 1;
    std::vector<Target> targets;
    for (const Part& p : chosen.empty() ? parts : chosen) {
      std::printf("\n== %s\n", p.name);
      for (Target& t : p.measure(settings)) targets.push_back(std::move(t));
    }
    tell_targets(targets, settings);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_speed: %s\n", error.what());
    return 1;
  }
}
