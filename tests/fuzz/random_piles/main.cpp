// Runs random scenes in which bodies fall, pile up and come to rest, and measures what must never be: bodies in each
// other or outside of what holds them, energy that grows, runs that stall.
//
// fuzz_random_piles FIRST LAST     seeds FIRST ... LAST; prints those that are wrong: what, when, by how much
// fuzz_random_piles show SEED      the bodies of a scene, and what is measured
// fuzz_random_piles reduce SEED WHAT [LEAST]  fewer bodies in which WHAT ("overlap", say) is wrong, by as much as LEAST
// fuzz_random_piles only KIND FIRST LAST     only scenes of a kind ("hopper", say)
//
// Exits with 1 if something is wrong, with 2 for wrong arguments, and with 3 where a single step takes more than 100 s
// of the processor. Environment: KDS_FUZZ_SECONDS ends a run of seeds after that time; KDS_FUZZ_SCENE_SECONDS is how
// much of the processor a scene may take before that counts as a stall (20).
#include "tests/fuzz/random_piles/make_scene.hpp"
#include "tests/fuzz/random_piles/measure.hpp"
#include "tests/fuzz/random_piles/reduce.hpp"
#include "tests/fuzz/watched_seed.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <map>
#include <string>
#include <string_view>

namespace {

using namespace kds::piles;
using kds::fuzz::now_running, kds::fuzz::number, kds::fuzz::seconds_from, kds::fuzz::set_alarm, kds::fuzz::watch_seeds;

/// Every so many seeds events are compared with those of other broad phases and of a world that was saved and loaded.
constexpr std::uint64_t compared_every = 20;
constexpr int most_seconds_a_step = 100;  // of the processor, added to what a scene may take

struct Tally {
  std::uint64_t scenes = 0, wrong = 0, events = 0, most_events = 0, resting = 0;
  double overlap = 0, energy = 0, seconds = 0;
  std::map<std::string, std::uint64_t> findings{};
};

/// Below this part of the energy at the start bodies count as resting.
constexpr double resting_energy = 1e-12;

void add(Tally& tally, const Result& result) {
  ++tally.scenes;
  tally.wrong += !result.findings.empty();
  tally.events += result.events;
  tally.most_events = std::max(tally.most_events, result.events);
  tally.resting += result.kinetic < resting_energy;
  tally.overlap = std::max(tally.overlap, result.overlap);
  tally.energy = std::max(tally.energy, result.energy);
  tally.seconds += result.seconds;
  for (const Finding& finding : result.findings) ++tally.findings[finding.what];
}

void print(const char* name, const Tally& tally) {
  std::printf("%-18s %6llu %6llu %9.0f %9llu %8.1f %9.1e %9.1e %5.0f%%  ", name,
              static_cast<unsigned long long>(tally.scenes), static_cast<unsigned long long>(tally.wrong),
              static_cast<double>(tally.events) / static_cast<double>(std::max<std::uint64_t>(tally.scenes, 1)),
              static_cast<unsigned long long>(tally.most_events), tally.seconds, tally.overlap, tally.energy,
              100 * static_cast<double>(tally.resting) / static_cast<double>(std::max<std::uint64_t>(tally.scenes, 1)));
  for (const auto& [what, count] : tally.findings) {
    std::printf(" %s: %llu", what.c_str(), static_cast<unsigned long long>(count));
  }
  std::puts("");
}

std::size_t free_bodies(const Scene& scene) {
  return static_cast<std::size_t>(
      std::count_if(scene.bodies.begin(), scene.bodies.end(), [](const Description& body) { return !body.fixed; }));
}

void print_findings(std::uint64_t seed, const Scene& scene, const Result& result) {
  const double e = scene.bodies.empty() ? 1 : scene.bodies.front().restitution;
  for (const Finding& finding : result.findings) {
    std::printf("seed %llu (%s, %zu bodies, %zu fixed, e = %g): %s from t = %.17g, worst %.3g; %s\n",
                static_cast<unsigned long long>(seed), scene.kind.c_str(), free_bodies(scene),
                scene.bodies.size() - free_bodies(scene), e, finding.what.c_str(), finding.first, finding.worst,
                finding.text.c_str());
  }
  std::fflush(stdout);
}

Budget budget() { return {.seconds = seconds_from("KDS_FUZZ_SCENE_SECONDS", Budget{}.seconds)}; }

Result run_seed(std::uint64_t seed, const Scene& scene) {
  now_running = seed;
  const Budget allowed = budget();
  set_alarm(most_seconds_a_step + static_cast<int>(allowed.seconds));
  Result result = measure(scene, allowed);
  const bool ended = std::none_of(result.findings.begin(), result.findings.end(),
                                  [](const Finding& f) { return f.what == "stall" || f.what == "throws"; });
  if (seed % compared_every == 0 && ended) {
    set_alarm(most_seconds_a_step + 10 * static_cast<int>(allowed.seconds));
    compare_ways(scene, allowed, result);
  }
  set_alarm(0);
  return result;
}

int run_seeds(std::uint64_t first, std::uint64_t last, std::string_view kind) {
  const auto begin = std::chrono::steady_clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(); };
  const double allowed = seconds_from("KDS_FUZZ_SECONDS", std::numeric_limits<double>::infinity());
  std::map<std::string, Tally> kinds;
  Tally all;
  for (std::uint64_t seed = first; seed <= last && seconds() < allowed; ++seed) {
    const Scene scene = make_scene(seed);
    if (!kind.empty() && scene.kind != kind) continue;
    const Result result = run_seed(seed, scene);
    print_findings(seed, scene, result);
    add(kinds[scene.kind], result);
    add(all, result);
  }
  std::puts("kind               scenes  wrong    events      most    CPU s   overlap    energy  rest");
  for (const auto& [name, tally] : kinds) print(name.c_str(), tally);
  print("all", all);
  return all.wrong == 0 ? 0 : 1;
}

int show(std::uint64_t seed) {
  const Scene scene = make_scene(seed);
  print_scene(scene);
  const Result result = run_seed(seed, scene);
  print_findings(seed, scene, result);
  Tally tally;
  add(tally, result);
  print(scene.kind.c_str(), tally);
  return result.findings.empty() ? 0 : 1;
}

/// Fewer bodies in which the same is wrong, by as much as `least`.
int reduce(std::uint64_t seed, const std::string& what, double least) {
  now_running = seed;
  Budget allowed = budget();
  allowed.sought = what;
  allowed.least = least;
  const auto smaller = reduced(make_scene(seed), allowed);
  if (!smaller) {
    std::printf("seed %llu: no %s of %g\n", static_cast<unsigned long long>(seed), what.c_str(), least);
    return 0;
  }
  print_scene(*smaller);
  print_findings(seed, *smaller, measure(*smaller, budget()));
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  watch_seeds();
  const std::string_view command = argc >= 2 ? argv[1] : "";
  if (argc == 3) {
    const auto last = number(argv[2]);
    if (command == "show" && last) return show(*last);
    if (const auto first = number(command); first && last) return run_seeds(*first, *last, "");
  }
  if ((argc == 4 || argc == 5) && command == "reduce") {
    if (const auto seed = number(argv[2])) return reduce(*seed, argv[3], argc == 5 ? std::strtod(argv[4], nullptr) : 0);
  }
  if (argc == 5 && command == "only") {
    const auto first = number(argv[3]), last = number(argv[4]);
    if (first && last) return run_seeds(*first, *last, argv[2]);
  }
  std::fprintf(stderr,
               "usage: fuzz_random_piles FIRST LAST | show SEED | reduce SEED WHAT [LEAST] | only KIND FIRST LAST\n");
  return 2;
}
