// Scenes that are saved in parts, each process its own, and gone on from by other processes: the events are those of
// one world, bit for bit.
#include "collision/parallel/parallel_world.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/event_log.hpp"
#include "tests/collision/parallel/parallel_log.hpp"
#include "tests/collision/parallel/states_in_parts.hpp"
#include "tests/collision/parallel/thread_processes.hpp"
#include "tests/collision/parallel/trials.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::collision::test_saved_parts {
namespace {

using Eigen::Vector3d;
using tests::Event;
using tests::EventLog;
using tests::ParallelLog;
using tests::Random;
using tests::run_by;
using tests::share_of;
using tests::StateInParts;
using tests::ThreadProcesses;
using tests::Trial;
using Blocks = std::vector<std::vector<char>>;

template <int Degree>
void add_share(ParallelWorld<Degree>& world, const std::vector<BodyDescription<Degree>>& bodies, std::size_t rank,
               std::size_t count) {
  const std::size_t first = bodies.size() * rank / count, last = bodies.size() * (rank + 1) / count;
  world.add_shares(last - first, [&](std::size_t i) { return bodies[first + i]; });
}

struct Seen {
  std::uint64_t events = 0, in_parts = 0, whole = 0, blocks = 0;
};

/// Runs a scene in several legs, each by other processes and domains, which go on from what the leg before has saved.
template <int Degree>
void run_in_legs(const Trial<Degree>& trial, std::uint64_t seed, Seen& seen) {
  EventLog<Degree> right;
  World<Degree> world(trial.options, &right);
  for (const auto& body : trial.scene.bodies) world.add_body(body);
  world.advance_to(trial.scene.end_time);

  Random random(seed);
  constexpr int legs = 4;
  std::vector<Event> told;
  StateInParts last(1);
  for (int leg = 0; leg < legs; ++leg) {
    const std::size_t count = 1 + random.below(4), in_block = 1 + random.below(60);
    ParallelOptions parallel;
    parallel.threads = 1, parallel.domains = 1 + random.below(9), parallel.halo = random.between(0.3, 4);
    if (random.one_in(2)) parallel.longest_window = random.between(0.01, 0.2);
    const bool at_once = random.one_in(6);
    StateInParts next(count);
    const Blocks blocks = last.blocks();
    run_by(count, [&](Processes* processes, std::size_t rank) {
      ParallelLog log;
      ParallelWorld<Degree> divided(trial.options, parallel, &log, processes);
      if (leg == 0) {
        add_share(divided, trial.scene.bodies, rank, count);
      } else {
        divided.load_parts(last.rest, share_of(blocks, rank, count));
      }
      if (divided.size() != world.size()) throw std::runtime_error("bodies are missing");
      if (!at_once || leg + 1 == legs) divided.advance_to(trial.scene.end_time * (leg + 1) / legs);
      next.save(divided, rank, in_block);
      // It goes on as if it had not been saved, and as what is loaded.
      if (rank == 0) told.insert(told.end(), log.events.begin(), log.events.end());
      const std::size_t before = log.events.size();
      divided.advance_to(trial.scene.end_time);
      if (rank > 0) return;
      std::vector<Event> all(told);
      all.insert(all.end(), log.events.begin() + static_cast<std::ptrdiff_t>(before), log.events.end());
      if (all != right.events) throw std::runtime_error("the events of leg " + std::to_string(leg) + " differ");
    });
    last = next;
    ++(last.blocks().empty() ? seen.whole : seen.in_parts);
    seen.blocks += last.blocks().size();
  }
  seen.events += told.size();
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("Saved parts: legs of a run, each by other processes, have the events of one world",
                       "[parallel]", ((int Degree), Degree), 1, 2) {
  Seen seen;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const auto one = tests::trial<Degree>(seed);
    INFO(one.what);
    REQUIRE_NOTHROW(run_in_legs(one, seed + 501, seen));
  }
  INFO("events " << seen.events << ", states in parts " << seen.in_parts << ", whole " << seen.whole << ", blocks "
                 << seen.blocks);
  CHECK(seen.events > 2000);
  CHECK(seen.in_parts > 80);
  CHECK(seen.whole > 5);
  CHECK(seen.blocks > 500);
}

TEST_CASE("Saved parts: nobody has all bodies, before and after", "[parallel]") {
  const auto gas = tests::lattice(12, 3);
  const std::size_t all = gas.scene.bodies.size();
  const ParallelOptions parallel{.threads = 1, .domains = 8, .halo = 0.5};
  StateInParts state(4);
  ThreadProcesses(4).run([&](Processes& processes) {
    ParallelWorld<1> divided(gas.options, parallel, nullptr, &processes);
    add_share(divided, gas.scene.bodies, processes.rank(), 4);
    divided.advance_to(1);
    const auto before = divided.counters();
    state.save(divided, processes.rank(), 100);
    if (divided.stored() > all / 2 || divided.domains() != 8) throw std::runtime_error("it is one world to be saved");
    divided.advance_to(1.001);
    const auto after = divided.counters();
    if (after.divisions != before.divisions) throw std::runtime_error("it is divided anew");
  });
  const Blocks blocks = state.blocks();
  CHECK(blocks.size() >= all / 100);
  CHECK(state.rest.bytes().size() < 1000);
  ThreadProcesses(3).run([&](Processes& processes) {
    ParallelWorld<1> divided(gas.options, parallel, nullptr, &processes);
    divided.load_parts(state.rest, share_of(blocks, processes.rank(), 3));
    for (const double t : {1.0, 1.5, 2.0}) {
      if (divided.stored() > 0.6 * static_cast<double>(all)) throw std::runtime_error("a process has too much");
      divided.advance_to(t);
    }
    if (divided.counters().stretches_whole > 0) throw std::runtime_error("it is one world for a while");
  });
}

TEST_CASE("Saved parts: pairs that stand and overlap do so later where nobody who answers for one knows both",
          "[parallel]") {
  // Four domains that meet in a corner, and large fixed balls at the borders, each known to two of them.
  Trial<1> trial;
  for (int i = 0; i < 20; ++i) {
    for (int k = 0; k < 20; ++k) {
      const Vector3d place(2 * i - 19, 2 * k - 19, 50);
      trial.scene.bodies.push_back(tests::ball<1>(0.1, place, Vector3d(0.01 * (i % 3 - 1), 0.01 * (k % 5 - 2), 0)));
    }
  }
  const BodyId first_fixed = trial.scene.bodies.size();
  for (const Vector3d& place : {Vector3d(0, 12, 0), Vector3d(12, 0, 0), Vector3d(0, -12, 0), Vector3d(-12, 0, 0)}) {
    auto fixed = tests::ball<1>(10, place);
    fixed.fixed = true;
    trial.scene.bodies.push_back(fixed);
  }
  const auto touching = [&](ParallelWorld<1>& world) {
    std::size_t count = 0;
    for (BodyId first = first_fixed; first < trial.scene.bodies.size(); ++first) {
      for (BodyId second = first + 1; second < trial.scene.bodies.size(); ++second) {
        count += world.whole().touching(first, second) ? 1 : 0;
      }
    }
    return count;
  };
  const ParallelOptions parallel{.threads = 1, .domains = 4, .halo = 0.4};
  StateInParts state(4);
  ThreadProcesses(4).run([&](Processes& processes) {
    ParallelWorld<1> divided(trial.options, parallel, nullptr, &processes);
    add_share(divided, trial.scene.bodies, processes.rank(), 4);
    divided.advance_to(0.5);
    state.save(divided, processes.rank(), 50);
  });
  const Blocks blocks = state.blocks();
  ParallelWorld<1> alone(trial.options, parallel);
  alone.load_parts(state.rest, share_of(blocks, 0, 1));
  const std::size_t right = touching(alone);
  CHECK(right == 4);
  ThreadProcesses(3).run([&](Processes& processes) {
    ParallelWorld<1> divided(trial.options, parallel, nullptr, &processes);
    divided.load_parts(state.rest, share_of(blocks, processes.rank(), 3));
    divided.advance_to(0.75);
    if (divided.domains() != 4) throw std::runtime_error("it is not divided");
    if (touching(divided) != right) throw std::runtime_error("a pair does not overlap any more");
  });
}

TEST_CASE("Saved parts: sensors that are attached to large bodies which move by themselves", "[parallel]") {
  auto gas = tests::lattice(8, 4);
  gas.options.walls.reset();
  gas.options.response = Response::none;
  gas.scene.end_time = 5;
  for (int k = 0; k < 3; ++k) {
    auto paddle = tests::ball<1>(1.5, Vector3d(-4, 8 * k, 14), Vector3d(2 + k, 0, 0));
    paddle.fixed = true;
    paddle.motion.push_back(tests::motion<1>(Vector3d(2 + 3 * k, 8 * k, 14), Vector3d(-3, 0, 0), Vector3d::Zero(), 3));
    gas.scene.bodies.push_back(paddle);
  }
  const auto fill = [&](World<1>& world) {
    for (const auto& body : gas.scene.bodies) world.add_body(body);
    for (const BodyId owner : {512u, 513u, 514u}) {
      for (const double radius : {2.5, 0.3}) {
        world.add_body({.shape = Sphere{radius}, .sensor = true, .attached_to = owner});
      }
    }
  };
  EventLog<1> right;
  World<1> world(gas.options, &right);
  fill(world);
  world.advance_to(gas.scene.end_time);
  const ParallelOptions parallel{.threads = 1, .domains = 4, .halo = 0.4, .longest_window = 0.1};
  StateInParts state(2);
  std::vector<Event> before;
  ThreadProcesses(2).run([&](Processes& processes) {
    ParallelLog log;
    ParallelWorld<1> divided(gas.options, parallel, &log, &processes);
    fill(divided.whole());
    divided.advance_to(1);
    state.save(divided, processes.rank(), 30);
    if (processes.rank() == 0) before = log.events;
  });
  const Blocks blocks = state.blocks();
  CHECK(blocks.size() > 10);
  ThreadProcesses(3).run([&](Processes& processes) {
    ParallelLog log;
    ParallelWorld<1> divided(gas.options, parallel, &log, &processes);
    divided.load_parts(state.rest, share_of(blocks, processes.rank(), 3));
    divided.advance_to(gas.scene.end_time);
    if (processes.rank() > 0) return;
    std::vector<Event> all(before);
    all.insert(all.end(), log.events.begin(), log.events.end());
    if (all != right.events) throw std::runtime_error("the events differ");
    if (divided.counters().windows < 10) throw std::runtime_error("it is one world too often");
  });
  CHECK(right.events.size() > before.size() + 100);
}

}  // namespace kds::collision::test_saved_parts
