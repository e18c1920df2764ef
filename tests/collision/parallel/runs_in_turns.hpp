// Scenes that go from one world to domains, from domains to others, and back, each time by what is saved of them.
#pragma once

#include "tests/collision/parallel/compared_runs.hpp"

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <sstream>
#include <string>
#include <vector>

namespace kds::collision::tests {

/// A state of a scene, and what has been told until then.
struct Turn {
  Snapshot whole{};  ///< of all of it, or of what is not in blocks
  std::vector<std::vector<char>> blocks{};
  bool in_parts = false;
  std::vector<Event> told{};
};

/// Runs a scene up to a time, from the beginning if `from` is null, in domains if there are options for these, and
/// saves it, in parts or not.
template <class Motion>
Turn take_turn(const Staging<Motion>& scene, const Turn* from, double until, const ParallelOptions* parallel,
               std::size_t bodies_in_block) {
  Turn turn{.in_parts = parallel && bodies_in_block > 0};
  if (from) turn.told = from->told;
  if (!parallel) {
    WholeLog<Motion> log;
    BasicWorld<Motion> world(scene.options, &log);
    from ? restore(from->whole, world) : scene.fill(world);
    world.advance_to(until);
    world.audit();
    turn.told.insert(turn.told.end(), log.events.begin(), log.events.end());
    turn.whole = save(world);
    return turn;
  }
  DividedLog log;
  BasicParallelWorld<Motion> divided(scene.options, *parallel, &log);
  if (!from) scene.fill(divided.whole());
  if (from && from->in_parts) divided.load_parts(from->whole, share_of(from->blocks, 0, 1));
  if (from && !from->in_parts) restore(from->whole, divided);
  divided.advance_to(until);
  turn.told.insert(turn.told.end(), log.events.begin(), log.events.end());
  if (turn.in_parts) {
    const auto keep = [&](std::vector<char> block) { turn.blocks.push_back(std::move(block)); };
    turn.whole = divided.save_parts(keep, bodies_in_block);
    divided.whole().audit();
  } else {
    turn.whole = save(divided);
  }
  return turn;
}

/// Throws std::runtime_error unless a scene that is run by several worlds in turn, some in domains, each of which goes
/// on from what the one before has saved, has the events of one world, and its state in the end.
template <class Motion>
void compare_turns(const Staging<Motion>& scene, std::uint64_t seed, std::size_t most_domains, Seen& seen) {
  WholeLog<Motion> right;
  BasicWorld<Motion> world(scene.options, &right);
  scene.fill(world);
  Random random(seed);
  std::ostringstream what;
  what << scene.what << ", in turn";
  Turn last;
  const int turns = random.integer(2, 6);
  for (int i = 1; i <= turns; ++i) {
    const double until = scene.end_time * i / turns;
    ParallelOptions parallel;
    parallel.threads = 1 + random.below(3);
    parallel.domains = 2 + random.below(most_domains - 1);
    parallel.halo = random.between(1, 4);
    if (random.one_in(3)) parallel.longest_window = random.between(0.01, 0.3);
    // What follows a state in parts is divided, since one world needs all of it.
    const bool divided = last.in_parts || random.one_in(2);
    const std::size_t in_block = i < turns && random.one_in(2) ? 1 + random.below(20) : 0;
    what << ", " << (divided ? parallel.domains : 1) << (divided && in_block > 0 ? " saved in parts" : "");
    last = take_turn(scene, i > 1 ? &last : nullptr, until, divided ? &parallel : nullptr, in_block);
    world.advance_to(until);
    require_same(right.events, last.told, what.str());
  }
  BasicWorld<Motion> loaded(scene.options);
  restore(last.whole, loaded);
  require_same_bodies(world, loaded, what.str());
  seen.events += right.events.size();
}

/// Of some seeds; more by hand: each_seed().
template <class Maker>
void compare_seeds_in_turns(const char* variable, std::initializer_list<Seeds> seeds, Seen& seen) {
  each_seed(variable, seeds, [&](std::uint64_t seed, std::size_t most_domains) {
    Maker maker(seed);
    compare_turns(maker.scene(), seed, most_domains, seen);
  });
}

}  // namespace kds::collision::tests
