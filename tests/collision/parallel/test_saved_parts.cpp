// Scenes that are saved in parts, each process its own, and gone on from by other processes: the events are those of
// one world, bit for bit.
#include "collision/parallel/parallel_world.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/event_log.hpp"
#include "tests/collision/parallel/parallel_log.hpp"
#include "tests/collision/parallel/states_in_parts.hpp"
#include "tests/collision/parallel/thread_processes.hpp"
#include "tests/collision/parallel/trials.hpp"
#include "tests/support/damaged_bytes.hpp"
#include "tests/support/random_numbers.hpp"
#include "tests/support/throws.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
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
using tests::share_of;
using tests::StateInParts;
using tests::ThreadProcesses;
using tests::Trial;
using Blocks = std::vector<std::vector<char>>;

/// Work of several processes, or of one.
void run_by(std::size_t count, const std::function<void(Processes*, std::size_t rank)>& work) {
  if (count == 1) return work(nullptr, 0);
  ThreadProcesses(count).run([&](Processes& processes) { work(&processes, processes.rank()); });
}

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

namespace {

/// A scene of all that is divided, at 0.5: sensors that are attached, ignored pairs, scripts, bodies that enter later,
/// free slots, a timer.
struct Mixed {
  WorldOptions options = tests::with_response(Response::elastic);
  std::function<void(World<1>&)> fill = [](World<1>& world) {
    for (int i = 0; i < 12; ++i) {
      auto ball = tests::ball<1>(0.4, Vector3d(i, 0.1 * i, 0), Vector3d(i % 2 == 0 ? 1 : -1, 0, 0));
      if (i == 4) ball.motion.push_back(tests::motion<1>(Vector3d(4, 2, 0), Vector3d(0, -1, 0), Vector3d::Zero(), 1.5));
      if (i == 5) ball.motion.front().start = 1;
      if (i == 6) ball.shape = Box{{0.3, 0.4, 0.5}};
      if (i == 7) ball.sensor = true;
      world.add_body(ball);
    }
    for (const BodyId owner : {2u, 3u}) {
      BodyDescription<1> sensor{.shape = Sphere{0.8}, .sensor = true, .attached_to = owner};
      world.add_body(sensor);
    }
    world.ignore_pair(1, 2);
    world.ignore_pair(8, 9);
    world.remove_body(11);
    world.set_timer(0.75);
  };

  StateInParts saved(std::size_t count, std::size_t in_block) const {
    StateInParts state(count);
    run_by(count, [&](Processes* processes, std::size_t rank) {
      ParallelWorld<1> divided(options, {.threads = 1, .domains = 3, .halo = 0.5}, nullptr, processes);
      fill(divided.whole());
      divided.advance_to(0.5);
      if (divided.domains() != 3) throw std::runtime_error("it is not divided");
      state.save(divided, rank, in_block);
    });
    return state;
  }
};

/// A world that is to load; afterwards it must be as it was.
template <class Load>
std::string refusal(const Mixed& mixed, std::size_t count, const Load& load) {
  std::vector<std::string> messages(count);
  run_by(count, [&](Processes* processes, std::size_t rank) {
    ParallelWorld<1> world(mixed.options, {.threads = 1, .domains = 2, .halo = 0.5}, nullptr, processes);
    for (int i = 0; i < 4; ++i) world.add_body(tests::ball<1>(0.5, Vector3d(3 * i, 0, 0)));
    world.advance_to(0.25);
    try {
      load(world, rank);
    } catch (const std::runtime_error& error) {
      messages[rank] = error.what();
    }
    if (messages[rank].empty()) return;
    if (world.size() != 4 || world.now() != 0.25) throw std::logic_error("it is changed");
    world.advance_to(0.5);
    world.whole().audit();
  });
  const auto own = std::find_if(messages.begin(), messages.end(), [](const std::string& what) {
    return !what.empty() && what.find("another process") == std::string::npos;
  });
  const bool some = own != messages.end();
  for (const std::string& what : messages) CHECK(what.empty() != some);  // all refuse, or none
  return some ? *own : "";
}

}  // namespace

TEST_CASE("Saved parts: what is missing, there twice, or of another state is refused by all", "[parallel]") {
  const Mixed mixed;
  const StateInParts state = mixed.saved(2, 4);
  const Blocks blocks = state.blocks();
  REQUIRE(blocks.size() >= 4);
  for (const std::size_t count : {1u, 3u}) {
    const auto refusal_of = [&](const Snapshot& rest, const Blocks& given) {
      return refusal(mixed, count, [&](ParallelWorld<1>& world, std::size_t rank) {
        world.load_parts(rest, share_of(given, rank, count));
      });
    };
    CHECK(refusal_of(state.rest, blocks).empty());
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      Blocks wrong = blocks;
      wrong.erase(wrong.begin() + static_cast<std::ptrdiff_t>(i));
      const std::string what = refusal_of(state.rest, wrong);
      CHECK((what == "snapshot: the parts have not the bodies of the scene" ||
             (count == 1 && what == "snapshot: a pair overlaps of which a body is missing")));
      wrong = blocks;
      wrong.push_back(blocks[i]);
      CHECK_FALSE(refusal_of(state.rest, wrong).empty());
      wrong = blocks;
      wrong[i].pop_back();
      CHECK(refusal_of(state.rest, wrong) == "snapshot: it ends before its time");
      wrong = blocks;
      wrong[i].push_back(0);
      CHECK(refusal_of(state.rest, wrong) == "snapshot: there is more in a part than bodies");
    }
    Mixed other = mixed;
    other.options.walls = Walls{Vector3d::Constant(-100), Vector3d::Constant(100)};
    CHECK(refusal_of(other.saved(2, 4).rest, blocks) == "snapshot: it is of a world with other options: walls");
    const std::string thrown = refusal(mixed, count, [&](ParallelWorld<1>& world, std::size_t rank) {
      world.load_parts(state.rest, [&](std::vector<char>&) -> bool {
        if (rank == count - 1) throw std::runtime_error("cannot be read");
        return false;
      });
    });
    CHECK(thrown == "cannot be read");
  }
  World<1> alone(mixed.options);
  kds::tests::throws<std::runtime_error>([&] { restore(state.rest, alone); },
                                         "snapshot: it is of a scene in parts, and its bodies are in these");
}

TEST_CASE("Saved parts: a World's state is one with all bodies in the rest", "[parallel]") {
  const Mixed mixed;
  EventLog<1> right;
  World<1> world(mixed.options, &right);
  mixed.fill(world);
  world.advance_to(0.5);
  const Snapshot saved = save(world);
  const std::size_t before = right.events.size();
  world.advance_to(3);
  const std::vector<Event> later(right.events.begin() + static_cast<std::ptrdiff_t>(before), right.events.end());
  CHECK(later.size() > 5);
  for (const std::size_t count : {1u, 3u}) {
    run_by(count, [&](Processes* processes, std::size_t rank) {
      ParallelLog log;
      ParallelWorld<1> divided(mixed.options, {.threads = 1, .domains = 3, .halo = 0.5}, &log, processes);
      divided.load_parts(saved, {});
      StateInParts again(count);
      again.save(divided, rank, 1);
      divided.advance_to(3);
      if (rank > 0) return;
      EventLog<1> after;
      World<1> loaded(mixed.options, &after);
      restore(again.rest, loaded);
      loaded.advance_to(3);
      if (after.events != later) throw std::runtime_error("the events of what was saved again differ");
      if (log.events != later) throw std::runtime_error("the events differ");
    });
  }
  // And of one that is saved in parts: attachments, ignored pairs, free slots and timers are there again.
  // Those who have loaded it and save it again at once keep together what is attached.
  const StateInParts first = mixed.saved(3, 5);
  const Blocks first_blocks = first.blocks();
  StateInParts state(2);
  ThreadProcesses(2).run([&](Processes& processes) {
    ParallelWorld<1> divided(mixed.options, {.threads = 1, .domains = 3, .halo = 0.5}, nullptr, &processes);
    divided.load_parts(first.rest, share_of(first_blocks, processes.rank(), 2));
    state.save(divided, processes.rank(), 1);
  });
  const Blocks blocks = state.blocks();
  CHECK(blocks.size() == 11);
  ParallelWorld<1> alone(mixed.options, {.threads = 1, .domains = 1});
  alone.load_parts(state.rest, share_of(blocks, 0, 1));
  EventLog<1> log;
  World<1> loaded(mixed.options, &log);
  restore(save(alone.whole()), loaded);
  CHECK(loaded.add_body(tests::ball<1>(0.1, Vector3d(0, 50, 0))) == body_id(1, 11));
  loaded.advance_to(3);
  CHECK(log.events == later);
}

TEST_CASE("Saved parts: damaged anywhere they are refused, or a world comes of it", "[parallel][damaged]") {
  const Mixed mixed;
  const StateInParts state = mixed.saved(1, 6);
  const Blocks blocks = state.blocks();
  std::size_t refused = 0, accepted = 0;
  const auto load = [&](const Snapshot& rest, const Blocks& given) {
    ParallelWorld<1> world(mixed.options, {.threads = 1, .domains = 2, .halo = 0.5});
    try {
      world.load_parts(rest, share_of(given, 0, 1));
    } catch (const std::runtime_error& error) {
      ++refused;
      if (std::string(error.what()).find("snapshot: ") != 0) FAIL(error.what());
      CHECK(world.size() == 0);
      return;
    }
    ++accepted;
    try {
      world.whole().audit();
      world.advance_to(world.now() + 0.5);
      world.whole().audit();
    } catch (const std::exception&) {  // What it says of itself is right or wrong, but it must say it.
    }
  };
  for (const kds::tests::Damage& damage : kds::tests::all_damages()) {
    for (std::size_t at = 0; at < state.rest.bytes().size(); ++at) {
      INFO(damage.name << " at byte " << at << " of the rest");
      load(Snapshot(damage.of(state.rest.bytes(), at)), blocks);
    }
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      for (std::size_t at = 0; at < blocks[i].size(); ++at) {
        INFO(damage.name << " at byte " << at << " of block " << i);
        Blocks wrong = blocks;
        wrong[i] = damage.of(blocks[i], at);
        load(state.rest, wrong);
      }
    }
  }
  CHECK(refused > 1000);
  CHECK(accepted > 1000);
}

}  // namespace kds::collision::test_saved_parts
