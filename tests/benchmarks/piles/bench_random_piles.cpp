// Random scenes of piles (those of fuzz_random_piles, docs/testing.md) by kind: this engine, exact, beside Bullet's
// rigid bodies at 240 frames a second, without friction and rotation.
//
//     bench_random_piles [DIRECTORY [FIRST LAST [SECONDS]]]
//
// By default build/bench, 1 1000, 20; writes random_piles.csv. 20 s of each seed from FIRST to LAST are simulated.
//
// Overlap is the deepest of two bodies, or of a body and a wall, in parts of the smaller bounding radius; energy what
// was gained for good, in parts of that at the start, where no fixed body moves. At rest: the kinetic energy at the end
// is below 1e-12 of the energy at the start. Escaped: a centre was beyond a wall, or a radius outside of a crate.
// Unfinished: would take more than SECONDS of the processor, or failed. This engine is measured at every event, and its
// time taken in a run that is not measured; Bullet is measured every 0.05 s, which is left out of its time.
//
// "small on Earth" are scenes of any kind for whose bodies 240 frames are too few; for those left out Bullet has
// nothing alike. "all" is without both. What is wrong here goes to the standard error.
#include "collision/world.hpp"
#include "tests/benchmarks/csv_file.hpp"
#include "tests/benchmarks/piles/random_groups.hpp"
#include "tests/benchmarks/piles/random_in_bullet.hpp"
#include "tests/benchmarks/thread_time.hpp"
#include "tests/fuzz/random_piles/make_scene.hpp"
#include "tests/fuzz/random_piles/measure.hpp"
#include "tests/fuzz/watched_seed.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace {

using namespace kds::piles;
using kds::benchmarks::tell, kds::benchmarks::thread_seconds, kds::fuzz::number;

constexpr double resting_energy = 1e-12;
constexpr double deep_in_frames = 1e-2;
constexpr double look_at_clock = 0.2;  ///< s of the wall clock between looks at how much time is used
/// A step cannot be interrupted: one that takes so many seconds of the processor ends the program.
constexpr int most_seconds_a_step = 100;

/// The scenes of one row.
struct Tally {
  std::uintmax_t over_limit = 0, over_deep = 0, at_rest = 0, escaped = 0, unfinished = 0;
  std::uintmax_t seed_of_overlap = 0, seed_of_energy = 0;
  double energy = 0, seconds = 0;
  bool has_energy = false;
  std::vector<double> overlaps{};

  void add(std::uintmax_t seed, const Scene& scene, const Result& result) {
    if (overlaps.empty() || result.overlap > *std::max_element(overlaps.begin(), overlaps.end())) {
      seed_of_overlap = seed;
    }
    overlaps.push_back(result.overlap);
    over_limit += result.overlap > deepest_overlap;
    over_deep += result.overlap > deep_in_frames;
    if (!scene.driven() && (!has_energy || result.energy > energy)) {
      energy = result.energy;
      seed_of_energy = seed;
      has_energy = true;
    }
    const bool finished = result.reached >= scene.seconds;
    unfinished += !finished;
    at_rest += finished && result.kinetic < resting_energy;
    escaped += std::any_of(result.findings.begin(), result.findings.end(),
                           [](const Finding& finding) { return finding.what == "outside" && finding.worst > 1; });
    seconds += result.seconds;
  }
};

void row(std::ofstream& csv, const std::string& name, const char* engine, Tally tally) {
  const auto middle = tally.overlaps.begin() + static_cast<std::ptrdiff_t>(tally.overlaps.size() / 2);
  std::nth_element(tally.overlaps.begin(), middle, tally.overlaps.end());
  const double median = *middle;
  const double deepest = *std::max_element(tally.overlaps.begin(), tally.overlaps.end());
  char energy[80] = ",";
  if (tally.has_energy) std::snprintf(energy, sizeof energy, "%.1e,%ju", tally.energy, tally.seed_of_energy);
  tell(csv, "%s,%s,%zu,%.1e,%ju,%.1e,%ju,%ju,%s,%ju,%ju,%ju,%.2f\n", name.c_str(), engine, tally.overlaps.size(),
       deepest, tally.seed_of_overlap, median, tally.over_limit, tally.over_deep, energy, tally.at_rest, tally.escaped,
       tally.unfinished, tally.seconds);
}

/// Of a run without listener, up to so many seconds of the processor.
void take_time(const Scene& scene, double most_seconds, Result& result) {
  const double begin = thread_seconds();
  kds::collision::World<2> world({.response = kds::collision::Response::elastic, .walls = scene.walls});
  try {
    for (const Description& body : scene.bodies) world.add_body(body);
    while (thread_seconds() - begin < most_seconds && !world.advance_for(look_at_clock, scene.seconds)) {
    }
  } catch (const std::exception&) {  // which has been told by measure()
  }
  result.reached = world.now();
  result.seconds = thread_seconds() - begin;
}

Result run_here(std::uintmax_t seed, const Scene& scene, double most_seconds) {
  kds::fuzz::now_running = seed;
  kds::fuzz::set_alarm(most_seconds_a_step + static_cast<int>(3 * most_seconds));
  // Measuring takes time of its own.
  Result result = measure(scene, {.steps = std::numeric_limits<std::uint64_t>::max(), .seconds = 2 * most_seconds});
  take_time(scene, most_seconds, result);
  kds::fuzz::set_alarm(0);
  for (const Finding& finding : result.findings) {
    std::fprintf(stderr, "seed %ju (%s): %s from t = %g, worst %.3g; %s\n", seed, scene.kind.c_str(),
                 finding.what.c_str(), finding.first, finding.worst, finding.text.c_str());
  }
  return result;
}

struct Pair {
  Tally here{}, bullet{};
};

void print(std::ofstream& csv, const std::string& name, const Pair& pair) {
  row(csv, name, "kds", pair.here);
  if (!pair.bullet.overlaps.empty()) row(csv, name, "Bullet", pair.bullet);
}

void run(std::ofstream& csv, std::uint64_t first, std::uint64_t last, double most_seconds) {
  std::map<std::string, Pair> groups;
  Pair all;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    const Scene scene = make_scene(seed);
    const std::string group = group_of(scene);
    std::vector<Pair*> rows{&groups[group]};
    if (group == scene.kind) rows.push_back(&all);
    const Result here = run_here(seed, scene, most_seconds);
    for (Pair* const pair : rows) pair->here.add(seed, scene, here);
#ifdef KDS_PEER_BULLET
    if (left_out(scene)) continue;
    const Result bullet = run_in_bullet(scene, most_seconds);
    for (Pair* const pair : rows) pair->bullet.add(seed, scene, bullet);
#endif
  }
  tell(csv,
       "kind,engine,scenes,deepest_overlap,its_seed,median_overlap,scenes_over_1e-9,scenes_over_1e-2,"
       "greatest_gain_of_energy,its_seed,at_rest,escaped,unfinished,cpu_s\n");
  for (const auto& [name, pair] : groups) print(csv, name, pair);
  if (!all.here.overlaps.empty()) print(csv, "all", all);
}

}  // namespace

int main(int argc, char** argv) try {
  const std::filesystem::path folder = argc > 1 ? argv[1] : "build/bench";
  const auto first = number(argc > 3 ? argv[2] : "1");
  const auto last = number(argc > 3 ? argv[3] : "1000");
  const double most_seconds = argc > 4 ? std::atof(argv[4]) : 20;
  if (argc == 3 || argc > 5 || !first || !last || *first > *last || !(most_seconds > 0)) {
    return std::fputs("usage: bench_random_piles [DIRECTORY [FIRST LAST [SECONDS]]]\n", stderr), 2;
  }
  kds::fuzz::watch_seeds();
  std::ofstream csv = kds::benchmarks::open_csv(folder, "random_piles.csv");
  run(csv, *first, *last, most_seconds);
} catch (const std::exception& failure) {
  std::fprintf(stderr, "bench_random_piles: %s\n", failure.what());
  return 1;
}
