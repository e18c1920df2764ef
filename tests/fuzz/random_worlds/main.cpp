// Runs random scenarios of the world in many ways, all of which must give the same log, bit for bit.
//
// fuzz_random_worlds FIRST LAST     seeds FIRST ... LAST; prints those that differ, and where
// fuzz_random_worlds reduce SEED    makes its first difference smaller, and prints it as a program
// fuzz_random_worlds check          that a world whose shapes are slightly too large is found, and made small
//
// Exits with 1 if there is a difference, with 2 for wrong arguments, and with 3 where a scenario takes more than 1 500
// s of the processor. The environment variable KDS_FUZZ_SECONDS, if set, ends a run of seeds after that time.
#include "tests/fuzz/random_worlds/differences.hpp"
#include "tests/fuzz/random_worlds/print.hpp"
#include "tests/fuzz/random_worlds/reduce.hpp"
#include "tests/fuzz/watched_seed.hpp"

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <map>
#include <string>
#include <string_view>

namespace {

using namespace kds::fuzz;

constexpr int most_seconds_a_scenario = 1500;  // of the processor; the longest take 300: dozens of meshes in one place
constexpr double seconds_to_reduce = 40;

int run_seeds(std::uint64_t first, std::uint64_t last) {
  const auto begin = std::chrono::steady_clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(); };
  const double allowed = seconds_from("KDS_FUZZ_SECONDS", kds::never);
  std::map<std::string, std::uint64_t> kinds;
  std::uint64_t done = 0;
  std::uint64_t lines = 0;
  std::uint64_t differ = 0;
  for (std::uint64_t seed = first; seed <= last && seconds() < allowed; ++seed, ++done) {
    now_running = seed;
    set_alarm(most_seconds_a_scenario);
    const DrawnScenario drawn = make_scenario(seed);
    std::size_t events = 0;
    const auto found = differences(drawn, &events);
    lines += events;
    differ += !found.empty();
    for (const WayThatDiffers& each : found) {
      const std::string kind = kind_of(drawn.scenario, each);
      ++kinds[kind];
      std::printf("seed %llu: %s, line %zu: %s\n%s", static_cast<unsigned long long>(seed), each.way.name().c_str(),
                  each.difference.at, kind.c_str(), each.difference.text.c_str());
      std::fflush(stdout);
    }
  }
  set_alarm(0);
  for (const auto& [kind, count] : kinds)
    std::printf("%6llu %s\n", static_cast<unsigned long long>(count), kind.c_str());
  std::printf("%llu scenarios from seed %llu on, %.1f lines each, %.0f s, %.0f a second: %llu differ\n",
              static_cast<unsigned long long>(done), static_cast<unsigned long long>(first),
              done ? static_cast<double>(lines) / static_cast<double>(done) : 0.0, seconds(),
              static_cast<double>(done) / seconds(), static_cast<unsigned long long>(differ));
  return differ == 0 ? 0 : 1;
}

int reduce(std::uint64_t seed) {
  now_running = seed;
  const DrawnScenario drawn = make_scenario(seed);
  auto found = differences(drawn);
  if (found.empty()) {
    std::printf("seed %llu: no difference\n", static_cast<unsigned long long>(seed));
    return 0;
  }
  Way way = found.front().way;
  const Scenario scenario = reduced(drawn, way, seconds_to_reduce);
  print_program(scenario, way, found.front().difference);
  return 1;
}

/// Seeds of which the wrong world must be found in most, and then be made so small. Contacts of meshes and resting
/// bodies may take more; some scenarios have no contact.
int check() {
  constexpr std::uint64_t seeds = 7;
  constexpr std::size_t least_found = 5;
  constexpr std::size_t most_calls = 4;
  constexpr double seconds_to_reduce_one = 2;
  std::size_t found = 0;
  std::size_t small = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    now_running = seed;
    const DrawnScenario drawn = make_scenario(seed);
    Way wrong{.growth = 1 + 0x1p-30};
    if (!difference(drawn, wrong).any) continue;
    ++found;
    small += reduced(drawn, wrong, seconds_to_reduce_one).calls.size() <= most_calls;
  }
  std::printf("of %d wrong worlds %zu found, %zu of them made small\n", static_cast<int>(seeds), found, small);
  return found >= least_found && small >= found * 3 / 4 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  watch_seeds();
  const std::string_view command = argc >= 2 ? argv[1] : "";
  if (argc == 2 && command == "check") return check();
  if (argc == 3) {
    const auto last = number(argv[2]);
    if (command == "reduce" && last) return reduce(*last);
    if (const auto first = number(command); first && last) return run_seeds(*first, *last);
  }
  std::fprintf(stderr, "usage: fuzz_random_worlds FIRST LAST | reduce SEED | check\n");
  return 2;
}
