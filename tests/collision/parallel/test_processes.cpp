// Several processes that run the domains of one scene have the events of one world, bit for bit.
#include "collision/parallel/parallel_world.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/event_log.hpp"
#include "tests/collision/parallel/parallel_log.hpp"
#include "tests/collision/parallel/thread_processes.hpp"
#include "tests/collision/parallel/trials.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::collision::test_processes {
namespace {

using Eigen::Vector3d;
using tests::Event;
using tests::EventLog;
using tests::ParallelLog;
using tests::Random;
using tests::ThreadProcesses;
using tests::Trial;

/// What one process saw.
template <int Degree>
struct Outcome {
  std::vector<Event> events;
  ParallelCounters counters;
  MessageCounters messages;
  std::vector<certificates::PointMotion<Degree>> motions;
};

template <int Degree>
std::vector<Outcome<Degree>> run(const Trial<Degree>& trial, const ParallelOptions& parallel, std::size_t count,
                                 std::size_t polls) {
  std::vector<Outcome<Degree>> outcomes(count);
  ThreadProcesses(count).run([&](Processes& processes) {
    ParallelLog log;
    ParallelWorld<Degree> world(trial.options, parallel, &log, &processes);
    for (const auto& body : trial.scene.bodies) world.add_body(body);
    for (std::size_t poll = 1; poll <= polls; ++poll) {
      world.advance_to(poll == polls ? trial.scene.end_time
                                     : trial.scene.end_time * static_cast<double>(poll) / static_cast<double>(polls));
    }
    auto& mine = outcomes[processes.rank()];
    mine.events = log.events, mine.counters = world.counters(), mine.messages = world.messages();
    const auto& whole = world.whole();
    for (BodyId id = 0; id < trial.scene.bodies.size(); ++id) mine.motions.push_back(whole.motion(id));
  });
  return outcomes;
}

struct Seen {
  std::uint64_t events = 0, windows = 0, failed = 0, whole = 0, copies = 0, overlaps = 0, bytes = 0;
};

template <int Degree>
void compare(const Trial<Degree>& trial, const ParallelOptions& parallel, std::size_t count, std::size_t polls,
             Seen& seen) {
  INFO(trial.what << ", " << count << " processes, " << parallel.domains << " domains, halo " << parallel.halo
                  << ", longest window " << parallel.longest_window << ", polls " << polls);
  EventLog<Degree> right;
  World<Degree> world(trial.options, &right);
  for (const auto& body : trial.scene.bodies) world.add_body(body);
  world.advance_to(trial.scene.end_time);

  const auto outcomes = run(trial, parallel, count, polls);
  const std::size_t first = tests::first_difference(right.events, outcomes[0].events);
  INFO("events " << right.events.size() << " and " << outcomes[0].events.size() << ", the first that differs is "
                 << first);
  REQUIRE((first == right.events.size() && first == outcomes[0].events.size()));
  for (const auto& process : outcomes) {
    REQUIRE((&process == &outcomes[0] || process.events.empty()));
    REQUIRE(process.counters.contacts == world.counters().contacts);
    REQUIRE(process.counters.separations == world.counters().separations);
    REQUIRE(process.counters.overlaps == world.counters().overlaps);
    REQUIRE(process.counters.wall_contacts == world.counters().wall_contacts);
    REQUIRE(process.counters.windows == outcomes[0].counters.windows);
    for (BodyId id = 0; id < trial.scene.bodies.size(); ++id) REQUIRE(process.motions[id] == world.motion(id));
  }
  const auto& counters = outcomes[0].counters;
  seen.events += right.events.size(), seen.windows += counters.windows, seen.failed += counters.windows_failed;
  seen.whole += counters.stretches_whole, seen.copies += counters.copies_made, seen.overlaps += counters.overlaps;
  if (counters.windows > 0) REQUIRE(outcomes[0].messages.combinations > 0);
  for (const auto& process : outcomes) seen.bytes += process.messages.bytes;
}

/// How random scenes are run.
struct Ways {
  std::size_t least_domains = 2, most_domains = 8;
  std::size_t count = 0;  ///< of processes; 0: 2 to 5
};

template <int Degree>
void compare_seeds(std::uint64_t first, std::uint64_t count, const Ways& ways, Seen& seen) {
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const auto one = tests::trial<Degree>(seed);
    Random random(seed + 0x9e3779b97f4a7c15);
    ParallelOptions parallel;
    parallel.threads = 1 + random.below(2);
    parallel.domains = ways.least_domains + random.below(ways.most_domains - ways.least_domains + 1);
    parallel.halo = random.between(0.3, 4);
    if (random.one_in(2)) parallel.longest_window = random.between(0.01, 0.2);
    compare(one, parallel, ways.count > 0 ? ways.count : 2 + random.below(4), 1 + random.below(3), seen);
  }
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("Processes have the events of one world", "[parallel]", ((int Degree), Degree), 1, 2) {
  Seen seen;
  compare_seeds<Degree>(1, 40, {}, seen);
  INFO("events " << seen.events << ", windows " << seen.windows << ", failed " << seen.failed << ", stretches whole "
                 << seen.whole << ", copies " << seen.copies << ", overlaps " << seen.overlaps);
  CHECK(seen.windows > 40);
  CHECK(seen.failed > 1);
  CHECK(seen.copies > 100);
  CHECK(seen.overlaps > 20);
  CHECK(seen.bytes > 100 * seen.windows);
  CHECK(seen.events > 1500);
}

TEST_CASE("Processes: some of many domains each, and letters to those near by alone", "[parallel]") {
  Seen seen;
  for (const std::size_t count : {3u, 11u}) {
    compare(tests::lattice(5, 2), {.domains = 80, .halo = 0.5}, count, 2, seen);
    compare_seeds<1>(2001, 3, {.least_domains = 65, .most_domains = 150, .count = count}, seen);
    compare_seeds<2>(2001, 3, {.least_domains = 65, .most_domains = 150, .count = count}, seen);
  }
  INFO("events " << seen.events << ", windows " << seen.windows << ", failed " << seen.failed << ", stretches whole "
                 << seen.whole << ", copies " << seen.copies << ", overlaps " << seen.overlaps);
  CHECK(seen.windows > 100);
  CHECK(seen.copies > 1000);
}

namespace {

/// Balls in a long channel, that wander from domain to domain.
Trial<1> channel(std::size_t balls) {
  Random random(11);
  Trial<1> result;
  for (std::size_t i = 0; i < balls; ++i) {
    const Vector3d place(static_cast<double>(i) * 0.5, random.between(0, 2), random.between(0, 2));
    const Vector3d velocity(random.between(-4, 4), random.between(-1, 1), random.between(-1, 1));
    result.scene.bodies.push_back(tests::ball<1>(0.2, place, velocity));
  }
  result.options.response = Response::elastic;
  result.options.walls = Walls{Vector3d(-1, -1, -1), Vector3d(static_cast<double>(balls) * 0.5 + 1, 3, 3)};
  result.what = "channel";
  return result;
}

}  // namespace

TEST_CASE("Processes: bodies that change where a process does not know them, and come there later", "[parallel]") {
  auto gas = channel(120);
  gas.scene.end_time = 12;
  Seen seen;
  compare(gas, {.domains = 6, .halo = 1, .longest_window = 0.1}, 3, 1, seen);
  compare(gas, {.domains = 4, .halo = 2, .longest_window = 0.2}, 4, 1, seen);
  CHECK(seen.events > 1000);
  CHECK(seen.copies > 200);
  CHECK(seen.whole == 0);

  // Each process has two neighbours, and the first and the last one.
  const auto outcomes = run(gas, {.domains = 12, .halo = 1, .longest_window = 0.1}, 12, 1);
  for (std::size_t rank = 0; rank < 12; ++rank) {
    const auto& messages = outcomes[rank].messages;
    const std::uint64_t neighbours = rank == 0 || rank == 11 ? 1 : 2;
    INFO("rank " << rank << ": " << messages.letters << " letters in " << messages.exchanges << " exchanges");
    CHECK(messages.letters > messages.exchanges * neighbours / 4);
    // One more to process 0, of events; to all when the scene becomes one world, once.
    CHECK(messages.letters <= messages.exchanges * (neighbours + 1) + 11);
  }
}

TEST_CASE("Processes: 1, 2, 3, 4 and 8 have the same events, while bodies come from others", "[parallel]") {
  auto gas = channel(160);
  gas.scene.end_time = 12;
  const ParallelOptions parallel{.domains = 8, .halo = 1, .longest_window = 0.2};
  Seen seen;
  for (const std::size_t count : {2u, 3u, 4u, 8u}) compare(gas, parallel, count, 3, seen);
  CHECK(seen.windows > 4 * 20);
  CHECK(seen.whole == 0);

  // One has all domains. Of eight each has one, and tells of the bodies that it owns.
  EventLog<1> right;
  World<1> world(gas.options, &right);
  for (const auto& body : gas.scene.bodies) world.add_body(body);
  world.advance_to(gas.scene.end_time);
  CHECK(run(gas, parallel, 1, 3)[0].events == right.events);
  constexpr std::size_t polls = 6;
  std::vector<std::vector<std::size_t>> owners(polls, std::vector<std::size_t>(gas.scene.bodies.size(), 8));
  ThreadProcesses(8).run([&](Processes& processes) {
    ParallelWorld<1> divided(gas.options, parallel, nullptr, &processes);
    for (const auto& body : gas.scene.bodies) divided.add_body(body);
    for (std::size_t poll = 0; poll < polls; ++poll) {
      divided.advance_to(2.0 * static_cast<double>(poll + 1));
      for (BodyId id = 0; id < gas.scene.bodies.size(); ++id) {
        try {
          divided.motion(id);
          owners[poll][id] = processes.rank();
        } catch (const std::logic_error&) {  // it is another's
        }
      }
    }
  });
  std::size_t gone_over = 0;
  for (std::size_t id = 0; id < gas.scene.bodies.size(); ++id) {
    std::vector<std::size_t> of;
    for (const auto& at : owners) of.push_back(at[id]);
    REQUIRE(*std::max_element(of.begin(), of.end()) < 8);
    if (*std::max_element(of.begin(), of.end()) > *std::min_element(of.begin(), of.end()) + 1) ++gone_over;
  }
  CHECK(gone_over > 10);  // to the neighbour of the neighbour, and farther
}

TEST_CASE("Processes: bodies that come without having changed the motion of any that others know", "[parallel]") {
  // Some fly through a row of balls at rest: that they come is only told by how near they are.
  Trial<1> row;
  for (int i = 0; i < 60; ++i) row.scene.bodies.push_back(tests::ball<1>(0.5, Vector3d(2.5 * i, 0, 0)));
  for (const double speed : {1.0, 3.0, -2.0}) {
    row.scene.bodies.push_back(
        tests::ball<1>(0.5, Vector3d(speed > 0 ? -1 : 149, 0.5, 0.1 * speed), Vector3d(speed, 0, 0)));
  }
  row.scene.end_time = 150;
  row.options.response = Response::none;
  row.what = "row";
  Seen seen;
  for (const std::size_t count : {2u, 3u, 7u}) {
    compare(row, {.domains = 7, .halo = 0.5}, count, 1, seen);
    compare(row, {.domains = 7, .halo = 3}, count, 1, seen);
  }
  CHECK(seen.events > 1000);
  CHECK(seen.windows > 30);
}

TEST_CASE("Processes: bodies that have met elsewhere come to rest when they have gathered", "[parallel]") {
  // Pairs of balls that meet in the air, fall, and slide apart on the floor, slowly: only what has met another stops.
  Trial<2> falling;
  for (int i = 0; i < 40; ++i) {
    const int pair = i / 2;
    const double to_partner = i % 2 == 0 ? 1 : -1;
    auto ball = tests::ball<2>(0.2, Vector3d(pair - to_partner * 0.25, 0, 0.1 * (pair % 3)),
                               Vector3d(0.2 * to_partner, 0, 0), Vector3d(0, 0, -3));
    ball.restitution = 0.4;
    falling.scene.bodies.push_back(ball);
  }
  falling.scene.end_time = 6;
  falling.options.response = Response::elastic;
  falling.options.walls = Walls{Vector3d(-2, -1, -1), Vector3d(22, 1, 3)};
  falling.what = "falling pairs";
  Seen seen;
  compare(falling, {.domains = 6, .halo = 1, .longest_window = 0.1}, 3, 1, seen);
  CHECK(seen.windows > 0);
}

TEST_CASE("Processes: simultaneous contacts by the thousand, more processes than domains", "[parallel]") {
  Seen seen;
  for (const std::size_t count : {2u, 3u, 8u}) {
    compare(tests::lattice(8, 1.5), {.domains = 5, .halo = 1.5}, count, 2, seen);
  }
  CHECK(seen.events > 5000);
}

TEST_CASE("Processes: bodies are added, moved and removed, and the world saved, by all", "[parallel]") {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    INFO("seed " << seed);
    const auto one = tests::trial<1>(seed);
    const auto edit = [&](World<1>& world, int k) {
      const BodyId id = Random(seed + static_cast<std::uint64_t>(k)).below(one.scene.bodies.size());
      if (world.contains(id) && k % 2 == 0) world.remove_body(id);
      if (world.contains(id) && k % 2 == 1) {
        world.update_motion(id, tests::motion<1>(Vector3d(k, 1, 2), Vector3d(1, 0, k), Vector3d::Zero(), world.now()));
      }
      world.add_body(tests::body<1>(
          Sphere{0.4}, tests::motion<1>(Vector3d(1, k, 1), Vector3d(0, 1, 1), Vector3d::Zero(), world.now())));
    };
    EventLog<1> right;
    World<1> world(one.options, &right);
    for (const auto& body : one.scene.bodies) world.add_body(body);
    for (int k = 1; k <= 4; ++k) world.advance_to(0.3 * k), edit(world, k);
    const std::size_t before = right.events.size();
    world.advance_to(2);
    const std::vector<Event> later(right.events.begin() + static_cast<std::ptrdiff_t>(before), right.events.end());

    ThreadProcesses(3).run([&](Processes& processes) {
      ParallelLog log;
      ParallelWorld<1> divided(one.options, {.domains = 4, .halo = 1}, &log, &processes);
      for (const auto& body : one.scene.bodies) divided.add_body(body);
      for (int k = 1; k <= 4; ++k) {
        divided.advance_to(0.3 * k);
        edit(divided.whole(), k);
      }
      const Snapshot at = save(divided.whole());
      divided.advance_to(2);
      if (processes.rank() == 0 && log.events != right.events) throw std::runtime_error("the events differ");
      // Every process has the whole scene, and what is loaded from it goes on as it does.
      divided.whole().audit();
      EventLog<1> after;
      World<1> loaded(one.options, &after);
      restore(at, loaded);
      loaded.advance_to(2);
      if (after.events != later) throw std::runtime_error("the events of what was saved differ");
    });
  }
}

namespace {

std::string message(const std::function<void()>& call) {
  try {
    call();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("Processes: motions of bodies of other processes are refused", "[parallel]") {
  const auto one = tests::trial<1>(9);
  std::vector<std::size_t> refused(2);
  ThreadProcesses(2).run([&](Processes& processes) {
    ParallelWorld<1> divided(one.options, {.domains = 2, .halo = 1}, nullptr, &processes);
    for (const auto& body : one.scene.bodies) divided.add_body(body);
    divided.advance_to(0.5);
    if (divided.domains() != 2) throw std::runtime_error("it is not divided");
    // Not even where a process does not store it is a body taken for one that is not there.
    const std::string nowhere = message([&] { divided.motion(1000); });
    if (nowhere != "World: there is no body 1000 (generation 0 of slot 1000): it has never been there") {
      throw std::runtime_error(nowhere);
    }
    for (BodyId id = 0; id < one.scene.bodies.size(); ++id) {
      const std::string what = message([&] { divided.motion(id); });
      if (what == "ParallelWorld::motion: the body is owned by another process; whole() has all") {
        ++refused[processes.rank()];
      } else if (!what.empty()) {
        throw std::runtime_error(what);
      }
    }
  });
  CHECK(refused[0] > 0);
  CHECK(refused[1] > 0);
  CHECK(refused[0] + refused[1] == one.scene.bodies.size());
}

}  // namespace kds::collision::test_processes
