// Each of several processes adds and stores a part of the bodies: the events are those of one world, bit for bit.
#include "collision/parallel/parallel_world.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/deforming/folded_strip.hpp"
#include "tests/collision/event_log.hpp"
#include "tests/collision/parallel/parallel_log.hpp"
#include "tests/collision/parallel/thread_processes.hpp"
#include "tests/collision/parallel/trials.hpp"
#include "tests/support/random_numbers.hpp"
#include "tests/support/throws.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::collision::test_shares {
namespace {

using Eigen::Vector3d;
using tests::Event;
using tests::EventLog;
using tests::ParallelLog;
using tests::Random;
using tests::ThreadProcesses;
using tests::Trial;

/// Gives a process its share of some bodies: those from one of `ends` to the next.
template <int Degree>
void add_share(ParallelWorld<Degree>& world, const std::vector<BodyDescription<Degree>>& bodies,
               const std::vector<std::size_t>& ends, std::size_t rank) {
  const std::size_t first = rank == 0 ? 0 : ends[rank - 1];
  world.add_shares(ends[rank] - first, [&](std::size_t i) { return bodies[first + i]; });
}

std::vector<std::size_t> even_ends(std::size_t bodies, std::size_t processes) {
  std::vector<std::size_t> ends;
  for (std::size_t rank = 1; rank <= processes; ++rank) ends.push_back(bodies * rank / processes);
  return ends;
}

/// One that bends, and meets itself from 2.5 s on.
template <int Degree>
BodyDescription<Degree> folded_strip(const WorldOptions& options) {
  const Vector3d velocity(0, options.walls ? 0 : 0.25, 0);
  auto strip = tests::fixed_body<Degree>(tests::Fold().shape(), tests::motion<Degree>({2, 2, 2}, velocity));
  strip.self_contacts = true;
  strip.fixed = options.response != Response::none;
  return strip;
}

struct Seen {
  std::uint64_t events = 0, windows = 0, whole = 0, copies = 0, divisions = 0;
};

template <int Degree>
void compare(const Trial<Degree>& trial, const ParallelOptions& parallel, const std::vector<std::size_t>& ends,
             bool asks_at_once, Seen& seen) {
  EventLog<Degree> right;
  World<Degree> world(trial.options, &right);
  for (const auto& body : trial.scene.bodies) world.add_body(body);
  world.advance_to(trial.scene.end_time);
  ThreadProcesses(ends.size()).run([&](Processes& processes) {
    ParallelLog log;
    ParallelWorld<Degree> divided(trial.options, parallel, &log, &processes);
    add_share(divided, trial.scene.bodies, ends, processes.rank());
    if (divided.size() != trial.scene.bodies.size()) throw std::runtime_error("the number of bodies is wrong");
    if (asks_at_once) divided.whole().audit();
    divided.advance_to(trial.scene.end_time / 2);
    const Snapshot half = save(divided);
    divided.advance_to(trial.scene.end_time);
    const auto events = divided.counters();
    for (BodyId id = 0; id < world.size(); ++id) {
      if (!(divided.whole().motion(id) == world.motion(id))) throw std::runtime_error("a motion differs");
    }
    EventLog<Degree> later;
    World<Degree> loaded(trial.options, &later);
    restore(half, loaded);
    loaded.audit();
    loaded.advance_to(trial.scene.end_time);
    if (later.events.size() > right.events.size() ||
        !std::equal(later.events.rbegin(), later.events.rend(), right.events.rbegin())) {
      throw std::runtime_error("what was saved goes on in another way");
    }
    if (processes.rank() > 0) return;
    if (log.events != right.events) throw std::runtime_error("the events differ");
    seen.events += log.events.size(), seen.windows += events.windows, seen.whole += events.stretches_whole;
    seen.copies += events.copies_made, seen.divisions += events.divisions;
  });
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("Shares: processes that add some bodies each have the events of one world", "[parallel]",
                       ((int Degree), Degree), 1, 2) {
  Seen seen;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    auto one = tests::trial<Degree>(seed);
    if (seed % 5 == 0) one.scene.bodies.insert(one.scene.bodies.begin() + seed % 7, folded_strip<Degree>(one.options));
    Random random(seed + 77);
    const std::size_t processes = 1 + random.below(5);
    std::vector<std::size_t> ends;
    for (std::size_t i = 1; i < processes; ++i) ends.push_back(random.below(one.scene.bodies.size() + 1));
    ends.push_back(one.scene.bodies.size());
    std::sort(ends.begin(), ends.end());
    ParallelOptions parallel;
    parallel.domains = 1 + random.below(9);
    parallel.halo = random.between(0.3, 4);
    if (random.one_in(2)) parallel.longest_window = random.between(0.01, 0.2);
    INFO(one.what << ", " << processes << " processes, " << parallel.domains << " domains");
    compare(one, parallel, ends, random.one_in(4), seen);
  }
  INFO("events " << seen.events << ", windows " << seen.windows << ", stretches whole " << seen.whole << ", copies "
                 << seen.copies << ", divisions " << seen.divisions);
  CHECK(seen.events > 1000);
  CHECK(seen.windows > 30);
  CHECK(seen.whole > 5);
  CHECK(seen.copies > 50);
}

TEST_CASE("Shares: a process stores what its domains know, and less the more processes there are", "[parallel]") {
  const auto gas = tests::lattice(16, 3);
  const std::size_t all = gas.scene.bodies.size();
  std::map<std::size_t, std::size_t> most;
  for (const std::size_t count : {1u, 2u, 4u, 8u}) {
    std::vector<std::size_t> stored(count);
    ThreadProcesses(count).run([&](Processes& processes) {
      ParallelWorld<1> divided(gas.options, {.threads = 1, .domains = 8, .halo = 0.5}, nullptr, &processes);
      add_share(divided, gas.scene.bodies, even_ends(all, count), processes.rank());
      std::size_t& here = stored[processes.rank()];
      if (divided.stored() != (count == 1 ? all : all / count))
        throw std::runtime_error("shares are not what they are");
      for (int k = 1; k <= 4; ++k) {
        divided.advance_to(k);
        here = std::max(here, divided.stored());
      }
      if (divided.counters().stretches_whole > 0) throw std::runtime_error("it is one world for a while");
    });
    most[count] = *std::max_element(stored.begin(), stored.end());
  }
  INFO("of " << all << ": " << most[1] << ", " << most[2] << ", " << most[4] << ", " << most[8]);
  CHECK(most[1] == all);
  CHECK(most[2] < 0.7 * static_cast<double>(all));
  CHECK(most[4] < 0.5 * static_cast<double>(all));
  CHECK(most[8] < 0.35 * static_cast<double>(all));
}

TEST_CASE("Shares: bodies that have left for good are not stored any more", "[parallel]") {
  const auto gas = tests::lattice(8, 3);
  ThreadProcesses(6).run([&](Processes& processes) {
    // One domain each: what a process stores is what its domain knows in the next step.
    ParallelWorld<1> divided(gas.options, {.threads = 1, .domains = 6, .halo = 0.5, .longest_window = 0.25}, nullptr,
                             &processes);
    add_share(divided, gas.scene.bodies, even_ends(gas.scene.bodies.size(), 6), processes.rank());
    Team team(&processes);
    int compared = 0;
    for (int k = 1; k <= 40; ++k) {
      divided.advance_to(k);
      if (divided.domains() == 1) continue;  // It is one world for a stretch.
      std::array<std::uint64_t, 1> stored{divided.stored()};
      team.combine(stored, {});
      const ParallelCounters before = divided.counters();
      divided.advance_to(k + 0x1p-20);
      const ParallelCounters after = divided.counters();
      if (after.steps != before.steps + 1) throw std::runtime_error("it is not one step");
      if (after.bodies_known - before.bodies_known != stored[0]) throw std::runtime_error("others are stored");
      ++compared;
    }
    if (compared < 30) throw std::runtime_error("it is one world too often");
    if (divided.counters().copies_made < 1000) throw std::runtime_error("bodies do not wander");
  });
}

namespace {

/// Hands on the user data of events.
struct DataLog final : ParallelListener {
  std::vector<std::uint64_t> data;
  void contact(const PairEvent& e) override { data.push_back(e.user_data_a), data.push_back(e.user_data_b); }
  void wall(const WallEvent& e) override { data.push_back(e.user_data); }
};

}  // namespace

TEST_CASE("Shares: process 0 is told of the data of bodies that it does not store", "[parallel]") {
  auto gas = tests::lattice(6, 1.5);
  for (std::size_t i = 0; i < gas.scene.bodies.size(); ++i) gas.scene.bodies[i].user_data = 1000 + i;
  std::vector<std::uint64_t> right, told;
  {
    DataLog log;
    ParallelWorld<1> alone(gas.options, {.threads = 1, .domains = 1}, &log);
    for (const auto& body : gas.scene.bodies) alone.add_body(body);
    alone.advance_to(gas.scene.end_time);
    right = log.data;
  }
  ThreadProcesses(4).run([&](Processes& processes) {
    DataLog log;
    ParallelWorld<1> divided(gas.options, {.domains = 4, .halo = 0.5}, &log, &processes);
    add_share(divided, gas.scene.bodies, even_ends(gas.scene.bodies.size(), 4), processes.rank());
    divided.advance_to(gas.scene.end_time);
    if (processes.rank() == 0) told = log.data;
  });
  CHECK(right.size() > 100);
  CHECK(std::find(right.begin(), right.end(), 1000 + gas.scene.bodies.size() - 1) != right.end());
  CHECK(told == right);
}

TEST_CASE("Shares: what only all processes can add is refused, by the number of the body", "[parallel]") {
  const auto refuses = [](const BodyDescription<1>& last, const std::string& what) {
    ParallelWorld<1> alone({}, {.domains = 2});
    const auto body = [&](std::size_t i) {
      return i == 2 ? last : tests::ball<1>(0.5, Vector3d(3.0 * static_cast<double>(i), 0, 0));
    };
    kds::tests::throws([&] { alone.add_shares(4, body); }, "ParallelWorld::add_shares: body 2: " + what);
  };
  auto boxed = tests::ball<1>(0.5, Vector3d::Zero());
  boxed.box = [](double, const auto&) { return KineticBox<1>{}; };
  refuses(boxed, "has a box function: add_body() in all processes");
  refuses({.shape = Sphere{1}, .sensor = true, .attached_to = 0},
          "is attached to another: add_body() in all processes");
}

TEST_CASE("Shares: they come first, and once", "[parallel]") {
  ParallelWorld<1> alone({}, {.domains = 2});
  const auto ball = [](std::size_t i) { return tests::ball<1>(0.5, Vector3d(3.0 * static_cast<double>(i), 0, 0)); };
  alone.add_shares(3, ball);
  CHECK(alone.size() == 3);
  CHECK(alone.stored() == 3);
  CHECK_THROWS_WITH(alone.add_shares(1, ball), "ParallelWorld::add_shares: there are bodies already");
}

}  // namespace kds::collision::test_shares
