// Replays in domains: how a scene is divided is drawn from a seed, which is part of the name of the way.
#pragma once

#include "collision/parallel/parallel_world.hpp"
#include "tests/collision/parallel/compared_runs.hpp"
#include "tests/replay/event_hash.hpp"
#include "tests/replay/replay.hpp"
#include "tests/support/random_numbers.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::replay {

/// A random division: few domains or many, thin halos and thick ones, windows as long as they can be and shorter ones.
struct Division {
  explicit Division(std::uint64_t seed) {
    kds::tests::Random random(seed);
    parallel.threads = 1 + random.below(2);
    parallel.domains = random.one_in(4) ? 10 + random.below(30) : 2 + random.below(7);
    parallel.halo = random.between(0.3, 4);
    if (!random.one_in(3)) parallel.longest_window = std::exp2(-random.between(1, 8));
    calls = 1 + random.below(3);
    char text[128];
    std::snprintf(text, sizeof text, "division-%llu:domains-%zu:halo-%.3g:windows-%.3g:calls-%zu",
                  static_cast<unsigned long long>(seed), parallel.domains, parallel.halo, parallel.longest_window,
                  calls);
    name = text;
  }

  collision::ParallelOptions parallel;
  std::size_t calls = 1;  ///< of advance_to()
  std::string name;
};

/// `KDS_DIVISION_SEEDS="FIRST LAST"` in the environment: these; otherwise so many, others for each scene.
inline std::vector<Division> divisions(const std::string& scene, std::uint64_t count) {
  std::uint64_t first = 0;
  for (const char c : scene) first = (31 * first + static_cast<unsigned char>(c)) % 100000;
  std::uint64_t last = first + count - 1;
  if (const char* const seeds = std::getenv("KDS_DIVISION_SEEDS")) std::istringstream(seeds) >> first >> last;
  std::vector<Division> result;
  for (std::uint64_t seed = first; seed <= last; ++seed) result.emplace_back(seed);
  return result;
}

/// A scene that is run as one world and in domains.
template <class Motion>
struct Undivided {
  collision::WorldOptions options;
  double end_time = 1;
  std::function<void(collision::BasicWorld<Motion>&)> fill;   ///< adds the bodies
  std::function<std::vector<collision::tests::Event>()> run;  ///< the events as one world
  bool (*untold)(const collision::tests::Event&) = nullptr;   ///< which kinds are not written down of both
  bool surely_divided = false;                                ///< some steps are run in domains
};

template <class Motion>
std::vector<collision::tests::Event> run_in_domains(const Undivided<Motion>& scene, const Division& division) {
  collision::tests::DividedLog log;
  collision::WorldOptions options = scene.options;
  options.report_pairs = false;  // What reports them runs as one world.
  collision::BasicParallelWorld<Motion> world(options, division.parallel, &log);
  scene.fill(world.whole());
  for (std::size_t call = 1; call <= division.calls; ++call) {
    const double part = static_cast<double>(call) / static_cast<double>(division.calls);
    world.advance_to(options.start_time + (call < division.calls ? scene.end_time * part : scene.end_time));
  }
  if (scene.surely_divided && world.counters().steps == 0) {
    throw std::runtime_error("a scene was not divided: " + division.name);
  }
  std::erase_if(log.events, scene.untold);
  std::erase_if(log.events, collision::tests::is_about_wall);
  std::erase_if(log.events, [](const auto& event) { return event.kind == collision::tests::Kind::passes; });
  return log.events;
}

/// Adds the ways to run a scene in domains. What is hashed are the events of one world, each that is told in domains
/// too as it was told there: so the hash is that of the one world if, and only if, the events are the same in the same
/// order.
template <class Motion>
void add_divisions(Replay& replay, std::uint64_t count, const Undivided<Motion>& scene) {
  for (const Division& division : divisions(replay.name, count)) {
    replay.ways.push_back({division.name, [=](EventHash& hash) {
                             const auto divided = run_in_domains(scene, division);
                             std::size_t next = 0;
                             for (const auto& event : scene.run()) {
                               if (scene.untold(event)) {
                                 hash.event(event);
                               } else if (next < divided.size()) {
                                 hash.event(divided[next++]);
                               }
                             }
                             for (; next < divided.size(); ++next) hash.event(divided[next]);
                           }});
  }
}

}  // namespace kds::replay
