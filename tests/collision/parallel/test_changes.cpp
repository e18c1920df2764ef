// A listener that changes a scene in domains makes the events that it makes of one world, bit for bit.
#include "collision/parallel/parallel_world.hpp"
#include "tests/collision/event_log.hpp"
#include "tests/collision/parallel/compared_runs.hpp"
#include "tests/collision/parallel/parallel_log.hpp"
#include "tests/collision/parallel/thread_processes.hpp"
#include "tests/collision/parallel/trials.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::collision::test_changes {
namespace {

using Eigen::Vector3d;
using tests::Event;
using tests::EventLog;
using tests::ParallelLog;
using tests::Random;
using tests::WholeLog;

template <int Degree>
using Path = certificates::PointMotion<Degree>;

/// At the k-th event a body comes or goes, jumps, or is given another motion, or a timer is set.
template <int Degree>
void change(World<Degree>& world, std::uint64_t seed, std::size_t k, std::size_t bodies) {
  Random random(seed * 1000 + k);
  const BodyId id = random.below(bodies + 5);
  const Vector3d place(random.between(0, 6), random.between(0, 6), random.between(0, 6));
  const Vector3d velocity(random.between(-2, 2), random.between(-2, 2), random.between(-2, 2));
  auto motion = tests::motion<Degree>(place, velocity, Vector3d::Zero(), world.now());
  const int what = random.integer(0, 4);
  if (what == 0) world.add_body(tests::body<Degree>(Sphere{0.4}, motion));
  if (what == 1) world.set_timer(world.now() + random.between(0, 0.3));
  if (!world.contains(id)) return;
  if (what == 2) world.remove_body(id);
  if (what == 3) world.set_restitution(id, 1);
  if (what != 4) return;
  if (random.one_in(2)) motion.coefficients[0] = world.motion(id).position(world.now());
  world.update_motion(id, motion);
}

constexpr std::uint64_t bullet = 7;

/// Bullets go when they have hit something.
struct Hits final : ParallelListener {
  ParallelWorld<1>* world = nullptr;

  void contact(const PairEvent& event) override {
    if (event.user_data_a != bullet) return;
    world->change([id = event.a](World<1>& whole) { whole.remove_body(id); });
  }
};

}  // namespace

TEST_CASE("Domains: bullets that go when they have hit something", "[parallel]") {
  Hits hits;
  const WorldOptions options = tests::with_response(Response::elastic);
  ParallelWorld<1> world(options, {.threads = 1, .domains = 3, .halo = 1}, &hits);
  hits.world = &world;
  for (int i = 0; i < 20; ++i) {
    auto fired = tests::ball<1>(0.1, Vector3d(2 * i, 0, 0), Vector3d(0, 5 + 0.25 * (i % 3), 0));
    fired.user_data = bullet;
    world.add_body(fired);
  }
  for (int i = 0; i < 20; ++i) world.add_body(tests::ball<1>(0.5, Vector3d(2 * i, 4 + i % 2, 0), Vector3d::Zero()));
  world.advance_to(0.5);
  CHECK(world.size() == 40);
  world.advance_to(2);
  CHECK(world.size() == 20);
  CHECK(world.counters().contacts == 20);
  CHECK(world.counters().steps > 0);
}

TEMPLATE_TEST_CASE_SIG("Domains: a listener that changes the scene has the events of one world", "[parallel]",
                       ((int Degree), Degree), 1, 2) {
  std::uint64_t events = 0, asked = 0, steps = 0, cut = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const auto trial = tests::trial<Degree>(seed);
    const std::size_t bodies = trial.scene.bodies.size();
    const std::uint64_t one_in = seed % 3 == 0 ? 3 : 20;
    const auto changes_at = [=](std::size_t k) { return Random(seed + 77 * k).one_in(one_in); };
    WholeLog<Path<Degree>> right;
    World<Degree> one(trial.options, &right);
    for (const auto& body : trial.scene.bodies) one.add_body(body);
    one.set_timer(trial.scene.end_time / 3);
    right.then = [&](World<Degree>& world) {
      if (const std::size_t k = right.events.size(); changes_at(k)) change<Degree>(world, seed, k, bodies);
    };
    one.advance_to(trial.scene.end_time);

    Random random(seed);
    ParallelOptions parallel{.threads = 2, .domains = 2 + random.below(5), .halo = random.between(0.5, 3)};
    if (random.one_in(2)) parallel.longest_window = random.between(0.05, 0.3);
    tests::DividedLog log;
    ParallelWorld<Degree> divided(trial.options, parallel, &log);
    for (const auto& body : trial.scene.bodies) divided.add_body(body);
    divided.whole().set_timer(trial.scene.end_time / 3);
    log.then = [&](const Event&) {
      const std::size_t k = log.events.size();
      if (!changes_at(k)) return;
      ++asked;
      divided.change([=](World<Degree>& world) { change<Degree>(world, seed, k, bodies); });
    };
    const int polls = random.integer(1, 3);
    for (int poll = 1; poll < polls; ++poll) divided.advance_to(trial.scene.end_time * poll / polls);
    divided.advance_to(trial.scene.end_time);
    tests::require_same(right.events, log.events, trial.what);
    divided.whole().audit();
    const ParallelCounters counters = divided.counters();
    REQUIRE(counters.contacts == one.counters().contacts);
    REQUIRE(counters.separations == one.counters().separations);
    events += right.events.size(), steps += counters.steps, cut += counters.windows_failed;
  }
  INFO("events " << events << ", changes " << asked << ", steps " << steps << ", windows failed " << cut);
  CHECK(events > 2000);
  CHECK(asked > 150);
  CHECK(steps > 200);
  CHECK(cut > 60);
}

TEST_CASE("Domains: what goes wrong with changes", "[parallel]") {
  const auto trial = tests::trial<1>(9);
  const auto message = [](const auto& call) {
    try {
      call();
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  ParallelLog log;
  ParallelWorld<1> world(trial.options, {.threads = 1, .domains = 2}, &log);
  for (const auto& body : trial.scene.bodies) world.add_body(body);
  CHECK(message([&] { world.change([](World<1>&) {}); }) ==
        "ParallelWorld::change: must be called from within a callback; else whole()");

  // Two changes at an event, in their order; a change that throws has been asked for, and is not made again.
  std::vector<int> order;
  std::vector<double> times;
  log.then = [&](const Event& event) {
    if (log.events.size() != 4) return;
    times.push_back(event.contact.time);
    world.change([&](World<1>& whole) { order.push_back(1), times.push_back(whole.now()); });
    world.change([&](World<1>&) {
      order.push_back(2);
      throw std::runtime_error("a change's");
    });
  };
  CHECK(message([&] { world.advance_to(1); }) == "a change's");
  CHECK(world.now() == times.at(0));
  world.advance_to(1);
  CHECK(order == std::vector{1, 2});
  CHECK(times.at(1) == times.at(0));
  EventLog<1> right;
  World<1> one(trial.options, &right);
  for (const auto& body : trial.scene.bodies) one.add_body(body);
  one.advance_to(1);
  CHECK(log.events == right.events);

  // Only one of several processes is told of events.
  tests::ThreadProcesses(2).run([&](Processes& processes) {
    ParallelLog told;
    ParallelWorld<1> divided(trial.options, {.domains = 2}, &told, &processes);
    for (const auto& body : trial.scene.bodies) divided.add_body(body);
    std::string refused;
    told.then = [&](const Event&) { refused = message([&] { divided.change([](World<1>&) {}); }); };
    divided.advance_to(1);
    const std::string expected = "ParallelWorld::change: several processes run the scene, and this is called in one";
    if (processes.rank() == 0 && refused != expected) throw std::runtime_error(refused);
  });
}

}  // namespace kds::collision::test_changes
