// Scenes of all that is divided, run as one world and in domains, which have to agree.
#pragma once

#include "collision/parallel/body_store.hpp"
#include "collision/parallel/parallel_world.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/parallel/parallel_log.hpp"
#include "tests/collision/parallel/seeds.hpp"
#include "tests/collision/parallel/states_in_parts.hpp"
#include "tests/collision/parallel/thread_processes.hpp"
#include "tests/collision/random_scenes.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace kds::collision::tests {

/// A scene: a function that adds the bodies to a world, and does what else callers do.
template <class Motion>
struct Staging {
  WorldOptions options;
  std::function<void(BasicWorld<Motion>&)> fill;
  double end_time = 1;
  std::string what;
};

/// The scene of some bodies, of which a few carry sensors, balls of this radius, and perhaps a timer.
template <class Motion>
Staging<Motion> stage(Random& random, std::uint64_t seed, const WorldOptions& options,
                      std::vector<BasicBodyDescription<Motion>> bodies, double sensor_radius, double end_time) {
  const std::size_t owners = bodies.size();
  for (BodyId owner = 0; owner < owners; ++owner) {
    if (!random.one_in(25)) continue;
    BasicBodyDescription<Motion> sensor{.shape = Sphere{sensor_radius}, .sensor = true};
    sensor.attached_to = owner;
    bodies.push_back(sensor);
  }
  const double timer = random.one_in(3) ? random.between(0, end_time) : -1;
  const std::string what = "seed " + std::to_string(seed) + ", " + std::to_string(bodies.size()) + " bodies";
  const auto fill = [bodies = std::move(bodies), timer](BasicWorld<Motion>& world) {
    for (const auto& description : bodies) world.add_body(description);
    if (timer >= 0) world.set_timer(timer);
  };
  return {options, fill, end_time, what};
}

/// How it is run in domains.
struct Manner {
  ParallelOptions parallel;
  std::size_t processes = 1;
  std::size_t polls = 1;  ///< calls of advance_to(); before the last the world is saved
};

/// In so many domains at most.
inline Manner random_manner(Random& random, std::size_t most_domains) {
  Manner manner;
  manner.parallel.threads = 1 + random.below(3);
  manner.parallel.domains = 2 + random.below(most_domains - 1);
  manner.parallel.halo = random.between(0.3, 4);
  if (random.one_in(3)) manner.parallel.longest_window = random.between(0.01, 0.3);
  manner.processes = random.one_in(3) ? 2 + random.below(3) : 1;
  manner.polls = 1 + random.below(4);
  return manner;
}

/// What the runs of a test did in all, so that it is seen that there was something to go wrong.
struct Seen {
  std::uint64_t events = 0, windows = 0, failed = 0, whole = 0, corrected = 0, copies = 0, divided = 0;
  std::uint64_t rests = 0;   ///< contacts that have begun or ceased to last
  std::uint64_t tables = 0;  ///< runs with such contacts, of which no stretch was run as one world

  void add(const ParallelCounters& of, const std::vector<Event>& log) {
    const auto is_rest = [](const Event& event) { return event.kind == Kind::rests || event.kind == Kind::wakes; };
    const auto resting = static_cast<std::uint64_t>(std::count_if(log.begin(), log.end(), is_rest));
    rests += resting, tables += resting > 0 && of.stretches_whole == 0;
    events += log.size(), windows += of.windows, failed += of.windows_failed, whole += of.stretches_whole;
    corrected += of.copies_corrected, copies += of.copies_made, divided += of.windows > 0;
  }
  std::string text() const {
    std::ostringstream out;
    out << "events " << events << ", windows " << windows << ", failed " << failed << ", stretches whole " << whole
        << ", copies " << copies << ", corrected " << corrected << ", runs with windows " << divided << ", rests "
        << rests << ", tables " << tables;
    return out.str();
  }
};

/// What a ParallelLog writes down, and what begins and ceases to rest.
struct DividedLog final : ParallelLog {
  void rests(const PairEvent& e) override { note({Kind::rests, e.a, e.b, e.contact}); }
  void wakes(const PairEvent& e) override { note({Kind::wakes, e.a, e.b, e.contact}); }
  void rests_at_wall(const WallEvent& e) override { note(about_wall(Kind::rests, e)); }
  void wakes_at_wall(const WallEvent& e) override { note(about_wall(Kind::wakes, e)); }
  void passes(const PairEvent& e) override { note({Kind::passes, e.a, e.b, e.contact}); }
  void rebound_suppressed_at_wall(const WallEvent& e) override { note(about_wall(Kind::rebound_suppressed, e)); }
};

inline void require_same(const std::vector<Event>& right, const std::vector<Event>& log, const std::string& what) {
  const std::size_t first = first_difference(right, log);
  if (first == right.size() && first == log.size()) return;
  std::ostringstream text;
  text << what << ": events " << right.size() << " and " << log.size() << ", the first that differs is " << first;
  for (std::size_t i = first - std::min<std::size_t>(first, 2); i < first; ++i) text << "\nboth: " << right[i];
  for (std::size_t i = first; i < std::min(first + 3, right.size()); ++i) text << "\nright: " << right[i];
  for (std::size_t i = first; i < std::min(first + 3, log.size()); ++i) text << "\nwrong: " << log[i];
  throw std::runtime_error(text.str());
}

/// Bodies have the motions of one world, and what rests of them, which decides later events, is the same, too.
template <class Motion>
void require_same_bodies(BasicWorld<Motion>& right, BasicWorld<Motion>& whole, const std::string& what) {
  const auto& rests = detail::EngineOf<Motion>::of(right).transfer();
  const auto& found = detail::EngineOf<Motion>::of(whole).transfer();
  for (BodyId id = 0; id < right.size(); ++id) {
    const auto of_body = [&](const char* it) { return what + ": " + it + " body " + std::to_string(id) + " differs"; };
    if (!(whole.motion(id) == right.motion(id))) throw std::runtime_error(of_body("the motion of"));
    if (!same_bits(found.resting(body_slot(id)), rests.resting(body_slot(id))))
      throw std::runtime_error(of_body("what rests of"));
  }
}

/// What goes on from a state in parts, by so many processes, has the motions and the last events of one world.
template <class Motion>
void require_goes_on(const Staging<Motion>& scene, const ParallelOptions& parallel, std::size_t count,
                     const StateInParts& state, const std::vector<Event>& later, BasicWorld<Motion>& right,
                     const std::string& what) {
  const auto blocks = state.blocks();
  const auto go_on = [&](Processes* processes) {
    const std::size_t rank = processes ? processes->rank() : 0;
    DividedLog log;
    BasicParallelWorld<Motion> world(scene.options, parallel, &log, processes);
    world.load_parts(state.rest, share_of(blocks, rank, count));
    if (world.size() != right.size()) throw std::runtime_error(what + ": bodies are missing");
    world.advance_to(scene.end_time);
    if (rank == 0) require_same(later, log.events, what);
    auto& whole = world.whole();
    whole.audit();
    require_same_bodies(right, whole, what);
  };
  if (count == 1) return go_on(nullptr);
  ThreadProcesses(count).run([&](Processes& processes) { go_on(&processes); });
}

/// Throws std::runtime_error, and says what differs, unless the events of the run in domains are those of one world,
/// and so are the motions at the end, and the later events of a world that is loaded from what was saved on the way,
/// and of other processes that go on from what was saved there in parts.
template <class Motion>
void compare_runs(const Staging<Motion>& scene, const Manner& manner, Seen& seen) {
  std::ostringstream how;
  how << scene.what << ", " << manner.processes << " processes, " << manner.parallel.threads << " threads, "
      << manner.parallel.domains << " domains, halo " << manner.parallel.halo << ", longest window "
      << manner.parallel.longest_window << ", polls " << manner.polls;
  const std::string what = how.str();
  WholeLog<Motion> right;
  BasicWorld<Motion> world(scene.options, &right);
  scene.fill(world);
  world.advance_to(scene.end_time);

  StateInParts state(manner.processes);
  std::size_t before = 0;  // events, when it was saved
  const auto run = [&](Processes* processes) {
    DividedLog log;
    BasicParallelWorld<Motion> divided(scene.options, manner.parallel, &log, processes);
    scene.fill(divided.whole());
    const std::size_t rank = processes ? processes->rank() : 0;
    for (std::size_t poll = 1; poll < manner.polls; ++poll) {
      divided.advance_to(scene.end_time * static_cast<double>(poll) / static_cast<double>(manner.polls));
      if (poll + 1 < manner.polls) continue;
      const std::size_t domains = divided.domains();
      state.save(divided, rank, 1 + right.events.size() % 40);
      if (rank == 0) before = log.events.size();
      if (divided.domains() != domains) throw std::runtime_error(what + ": it is one world to be saved");
      const Snapshot saved = save(divided);
      WholeLog<Motion> later;
      BasicWorld<Motion> loaded(scene.options, &later);
      restore(saved, loaded);
      loaded.audit();
      loaded.advance_to(scene.end_time);
      // Other processes than the first have not been told of what was before.
      std::vector<Event> all = log.events;
      if (rank > 0)
        all.assign(right.events.begin(), right.events.end() - static_cast<std::ptrdiff_t>(
                                                                  std::min(later.events.size(), right.events.size())));
      all.insert(all.end(), later.events.begin(), later.events.end());
      require_same(right.events, all, what + ", as it was saved");
    }
    divided.advance_to(scene.end_time);
    if (rank == 0) require_same(right.events, log.events, what);
    const ParallelCounters told = divided.counters();
    const WorldCounters counters = world.counters();
    if (told.contacts != counters.contacts || told.separations != counters.separations ||
        told.overlaps != counters.overlaps || told.wall_contacts != counters.wall_contacts) {
      throw std::runtime_error(what + ": the counts differ");
    }
    require_same_bodies(world, divided.whole(), what);
    if (rank == 0) seen.add(told, log.events);
  };
  if (manner.processes == 1) {
    run(nullptr);
  } else {
    ThreadProcesses(manner.processes).run([&](Processes& processes) { run(&processes); });
  }
  if (manner.polls == 1) return;
  const std::vector<Event> later(right.events.begin() + static_cast<std::ptrdiff_t>(before), right.events.end());
  const std::size_t others = 1 + (manner.processes + right.events.size()) % 4;
  require_goes_on(scene, manner.parallel, others, state, later, world,
                  what + ", gone on from by " + std::to_string(others));
}

/// Scenes that a maker makes of some seeds, each run in one manner; throws what compare_runs() throws. More by hand:
/// each_seed().
template <class Maker>
void compare_seeds(const char* variable, std::initializer_list<Seeds> seeds, Seen& seen) {
  each_seed(variable, seeds, [&](std::uint64_t seed, std::size_t most_domains) {
    Maker maker(seed);
    const auto scene = maker.scene();
    compare_runs(scene, maker.manner(most_domains), seen);
  });
}

}  // namespace kds::collision::tests
