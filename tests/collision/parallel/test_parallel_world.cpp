// A world in domains has the events of one world, bit for bit, whatever the domains and the windows.
#include "collision/parallel/parallel_world.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/event_log.hpp"
#include "tests/collision/parallel/compared_runs.hpp"
#include "tests/collision/parallel/parallel_log.hpp"
#include "tests/collision/parallel/trials.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::collision::test_parallel_world {
namespace {

using Eigen::Vector3d;
using tests::compare_runs;
using tests::Event;
using tests::EventLog;
using tests::lattice;
using tests::ParallelLog;
using tests::Random;
using tests::Seen;
using tests::Trial;
using tests::trial;

template <int Degree>
void compare(const Trial<Degree>& trial, const ParallelOptions& parallel, std::size_t polls, Seen& seen) {
  const auto fill = [&](World<Degree>& world) {
    for (const auto& body : trial.scene.bodies) world.add_body(body);
  };
  compare_runs<certificates::PointMotion<Degree>>({trial.options, fill, trial.scene.end_time, trial.what},
                                                  {.parallel = parallel, .polls = polls}, seen);
}

template <int Degree>
void compare_seeds(std::uint64_t first, std::uint64_t count, std::size_t least_domains, std::size_t most_domains,
                   Seen& seen) {
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const auto one = trial<Degree>(seed);
    Random random(seed + 0x9e3779b97f4a7c15);
    ParallelOptions parallel;
    parallel.threads = 1 + random.below(3);
    parallel.domains = least_domains + random.below(most_domains - least_domains + 1);
    const bool many = most_domains > 64;
    parallel.halo = random.between(0.3, many ? 1.5 : 4);
    if (many || random.one_in(3)) parallel.longest_window = random.between(0.01, 0.3);
    compare(one, parallel, 1 + random.below(4), seen);
  }
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("A world in domains has the events of one world", "[parallel]", ((int Degree), Degree), 1, 2) {
  Seen seen;
  compare_seeds<Degree>(1, 60, 2, 8, seen);
  INFO(seen.text());
  CHECK(seen.windows > 100);
  CHECK(seen.corrected > 25);
  CHECK(seen.events > 4000);
}

TEMPLATE_TEST_CASE_SIG("Several hundred domains have the events of one world", "[parallel]", ((int Degree), Degree), 1,
                       2) {
  Seen seen;
  compare_seeds<Degree>(1001, 15, 65, 400, seen);
  INFO(seen.text());
  CHECK(seen.windows > 30);
  CHECK(seen.corrected > 25);
  CHECK(seen.events > 500);
}

TEST_CASE("Domains: simultaneous contacts by the thousand", "[parallel]") {
  Seen seen;
  for (const std::size_t domains : {2u, 3u, 8u}) {
    compare(lattice(domains == 3 ? 9 : 7, 2), {.threads = 2, .domains = domains, .halo = 1}, 1, seen);
    compare(lattice(6, 1.5), {.threads = 2, .domains = domains, .halo = 1.5}, 3, seen);
  }
  compare(lattice(5, 2), {.threads = 2, .domains = 100, .halo = 0.5}, 1, seen);
  CHECK(seen.events > 7000);
}

TEST_CASE("Domains: cradles whose pulses go through all of them, touching and almost touching", "[parallel]") {
  for (const double gap : {0.0, 0x1p-20, 0.25}) {
    Trial<1> trial;
    for (int row = 0; row < 2; ++row) {
      for (int i = 0; i < 76; ++i) {
        const Vector3d place(i * (1 + gap), 3.0 * row, 0);
        const Vector3d velocity(i == 0 ? 1 : i == 75 ? -1 : 0, 0, 0);
        trial.scene.bodies.push_back(tests::ball<1>(0.5, i == 0 ? Vector3d(place - Vector3d(1 + row, 0, 0)) : place,
                                                    i == 75 ? Vector3d::Zero() : velocity));
      }
    }
    trial.scene.end_time = 20;
    trial.options.response = Response::elastic;
    trial.options.walls = Walls{Vector3d(-4, -1, -1), Vector3d(77 * (1 + gap), 7, 1)};
    trial.what = "cradles, gap " + std::to_string(gap);
    Seen seen;
    for (const std::size_t domains : {2u, 11u}) compare(trial, {.threads = 2, .domains = domains, .halo = 2}, 2, seen);
    CHECK(seen.events > 250);
  }
}

TEST_CASE("Domains: bodies larger than a domain, and some that are nowhere near", "[parallel]") {
  auto one = trial<1>(5);
  one.options.response = Response::elastic;
  auto large = tests::ball<1>(20, {40, 3, 3}, {-3, 0, 0});
  large.mass = 100;
  one.scene.bodies.push_back(large);
  one.scene.bodies.push_back(tests::ball<1>(0.5, {1e6, 0, 0}, {1, 0, 0}));
  auto floor = tests::box<1>({300, 300, 1}, {0, 0, -4});
  floor.fixed = true;
  one.scene.bodies.push_back(floor);
  Seen seen;
  for (const std::size_t domains : {2u, 5u, 100u}) compare(one, {.threads = 1, .domains = domains, .halo = 1}, 1, seen);
  CHECK(seen.events > 50);
}

namespace {

/// What callers do between two calls that run the world.
template <int Degree, class World>
void edit(World& world, Random& random, double now, std::size_t bodies) {
  for (int n = random.integer(1, 4); n > 0; --n) {
    const BodyId id = random.below(bodies);
    const Vector3d place(random.between(0, 6), random.between(0, 6), random.between(0, 6));
    const Vector3d velocity(random.between(-2, 2), random.between(-2, 2), random.between(-2, 2));
    const auto motion = tests::motion<Degree>(place, velocity, Vector3d::Zero(), now);
    const int what = random.integer(0, 3);
    if (what == 0) world.add_body(tests::body<Degree>(Sphere{0.4}, motion));
    if (!world.contains(id)) continue;
    if (what == 1) world.remove_body(id);
    if (what == 2) world.update_motion(id, motion);
    if (what == 3) world.set_restitution(id, 1);
  }
}

}  // namespace

TEST_CASE("Domains: bodies that are added, removed and moved between windows, and worlds saved there", "[parallel]") {
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const auto one = trial<1>(seed);
    EventLog<1> right;
    World<1> world(one.options, &right);
    ParallelLog log;
    ParallelWorld<1> divided(one.options, {.threads = 2, .domains = seed <= 12 ? 4u : 200u, .halo = 1}, &log);
    for (const auto& body : one.scene.bodies) world.add_body(body), divided.add_body(body);
    Random first(seed), second(seed);
    for (int k = 1; k <= 4; ++k) {
      const double t = 0.3 * k;
      world.advance_to(t), divided.advance_to(t);
      CHECK(divided.now() == t);
      edit<1>(world, first, t, one.scene.bodies.size());
      edit<1>(divided.whole(), second, t, one.scene.bodies.size());
      CHECK(divided.whole().now() == t);
      CHECK_NOTHROW(divided.whole().audit());
    }
    world.advance_to(1.5), divided.advance_to(1.5);
    // A world that is loaded from it goes on as it does.
    EventLog<1> later;
    World<1> loaded(one.options, &later);
    restore(save(divided.whole()), loaded);
    const std::size_t before = log.events.size();
    world.advance_to(2.5), divided.advance_to(2.5), loaded.advance_to(2.5);
    INFO("seed " << seed);
    REQUIRE(log.events == right.events);
    REQUIRE(later.events ==
            std::vector<Event>(log.events.begin() + static_cast<std::ptrdiff_t>(before), log.events.end()));
  }
}

TEST_CASE("Domains: what comes to rest, and what a listener throws, loses nothing", "[parallel]") {
  auto falling = trial<2>(3);
  for (auto& body : falling.scene.bodies) {
    body.restitution = 0;  // What meets leans on each other.
    for (auto& piece : body.motion) piece.coefficients[2] = {0, 0, -5};
  }
  falling.options.response = Response::elastic;
  falling.options.walls = Walls{Vector3d::Constant(-2), Vector3d::Constant(30)};
  falling.scene.end_time = 1.2;
  Seen seen;
  compare(falling, {.threads = 2, .domains = 8, .halo = 0.5}, 3, seen);  // Some islands reach through it.
  CHECK(seen.whole > 0);

  const auto one = trial<1>(9);
  EventLog<1> right;
  World<1> world(one.options, &right);
  ParallelLog log;
  ParallelWorld<1> divided(one.options, {.threads = 2, .domains = 3, .halo = 1}, &log);
  for (const auto& body : one.scene.bodies) world.add_body(body), divided.add_body(body);
  world.advance_to(1);
  log.then = [&](const Event&) {
    if (log.events.size() % 5 == 0) throw std::runtime_error("a listener's");
  };
  std::size_t thrown = 0;
  for (;;) {
    try {
      divided.advance_to(1);
      break;
    } catch (const std::runtime_error& error) {
      CHECK(error.what() == std::string("a listener's"));
      ++thrown;
    }
  }
  CHECK(thrown > 3);
  CHECK(log.events == right.events);
}

TEST_CASE("Domains: what they are asked wrongly is refused", "[parallel]") {
  const auto message = [](const auto& call) {
    try {
      call();
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto world = [](const ParallelOptions& options) { ParallelWorld<1> made(WorldOptions{}, options); };
  CHECK(message([&] { world({.domains = 65536}); }) == "ParallelOptions.domains: must be at most 65535");
  CHECK(message([&] { world({.halo = 0}); }) == "ParallelOptions.halo: must be > 0 and finite");
  CHECK(message([&] { world({.longest_window = -1}); }) == "ParallelOptions.longest_window: must be > 0");

  const auto one = trial<1>(9);
  ParallelLog log;
  ParallelWorld<1> divided(one.options, {.threads = 1, .domains = 2}, &log);
  for (const auto& body : one.scene.bodies) divided.add_body(body);
  std::string in_callback;
  log.then = [&](const Event&) {
    in_callback = message([&] { divided.whole(); }) + ", " + message([&] { divided.advance_to(9); });
  };
  divided.advance_to(1);
  CHECK(
      in_callback ==
      "ParallelWorld::whole: must not be called from within a callback, ParallelWorld::advance_to: must not be called "
      "from within a callback");
  CHECK(divided.domains() == 2);
  CHECK_THROWS_AS(divided.advance_to(0.5), std::invalid_argument);
  CHECK_THROWS_AS(divided.advance_to(never), std::invalid_argument);
  CHECK_THROWS_AS(divided.motion(1000), std::out_of_range);
  divided.whole().advance_to(2);
  CHECK(message([&] { divided.advance_to(3); }) ==
        "ParallelWorld::advance_to: the whole world has been advanced by itself");
}

}  // namespace kds::collision::test_parallel_world
