// Balls that pile up between walls: they come to rest, and neither sink into each other nor gain energy nor stall.
#include "tests/collision/world/resting_scenes.hpp"

#include "kds/framework/snapshot.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstddef>
#include <random>
#include <vector>

namespace kds::collision::test_clusters {
namespace {

using namespace tests;

constexpr double gravity = 9.81;
constexpr double deepest_overlap = 1e-9;  // of the smaller radius
/// What a contact may lift its bodies by, and what a span's parabola may differ from the way that it stands for, as a
/// part of the energy that a scene begins with (docs/resting.md).
constexpr double energy_gain = 5e-5;

struct Pile {
  std::size_t balls;
  double width, depth;  ///< of the room between the walls
  double restitution;
};

WorldOptions options_of(const Pile& pile, BroadPhaseKind method = BroadPhaseKind::automatic) {
  WorldOptions options = elastic(method);
  options.rate = method == BroadPhaseKind::sap ? 16 : 0;
  options.walls = Walls{Vector3d::Zero(), Vector3d(pile.width, 1000, pile.depth), pile.restitution};
  return options;
}

void drop(World<2>& world, const Pile& pile, unsigned seed) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  const auto a_row = std::max(std::size_t{1}, static_cast<std::size_t>(pile.width));
  for (std::size_t i = 0; i < pile.balls; ++i) {
    const double radius = between(.25, .4);
    const double x = .5 + static_cast<double>(i % a_row) + between(-.05, .05);
    const double z = pile.depth / 2 + (pile.depth - .8) * between(-.4, .4);
    const Vector3d place(x, 3 + static_cast<double>(i / a_row), z);
    const Vector3d velocity(between(-2, 2), 0, 0);
    world.add_body(bouncy(body<2>(Sphere{radius}, motion<2>(place, velocity, {0, -gravity / 2, 0})), pile.restitution,
                          radius * radius * radius));
  }
}

double radius_of(const World<2>& world, BodyId id) { return world.shape(id).bounding_radius; }

double kinetic_energy(const World<2>& world) {
  double sum = 0;
  for (BodyId id = 0; id < world.size(); ++id) {
    sum += .5 * world.mass(id) * world.motion(id).velocity(world.now()).squaredNorm();
  }
  return sum;
}

double energy(const World<2>& world) {
  double sum = kinetic_energy(world);
  for (BodyId id = 0; id < world.size(); ++id) {
    sum += world.mass(id) * gravity * world.motion(id).position(world.now())[1];
  }
  return sum;
}

/// Of two balls, as a part of the radius of the smaller.
double deepest(const World<2>& world) {
  double result = 0;
  for (BodyId a = 0; a < world.size(); ++a) {
    for (BodyId b = a + 1; b < world.size(); ++b) {
      const double sum_of_radii = radius_of(world, a) + radius_of(world, b);
      const double apart = (world.motion(a).position(world.now()) - world.motion(b).position(world.now())).norm();
      result = std::max(result, (sum_of_radii - apart) / std::min(radius_of(world, a), radius_of(world, b)));
    }
  }
  return result;
}

/// Far more than any of these scenes needs (the largest: 40 000).
constexpr std::size_t most_steps = 400'000;

void check_comes_to_rest(const Pile& pile, unsigned seed, double seconds) {
  INFO("seed " << seed << ", restitution " << pile.restitution << ", " << pile.balls << " balls");
  World<2> world(options_of(pile));
  drop(world, pile, seed);
  const double begun_with = energy(world);
  double least = begun_with;
  double overlap = 0;
  double gained = 0;
  std::size_t steps = 0;
  while (steps < most_steps && world.step(seconds)) {
    ++steps;
    overlap = std::max(overlap, deepest(world));
    gained = std::max(gained, energy(world) - least);
    least = std::min(least, energy(world));
  }
  CHECK(steps < most_steps);
  CHECK(overlap <= deepest_overlap);
  CHECK(gained <= energy_gain * begun_with);
  CHECK(kinetic_energy(world) <= 1e-12 * begun_with);
  world.audit();
}

TEST_CASE("Clusters: three and four balls in a narrow box come to rest", "[degenerate]") {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    check_comes_to_rest({3, 2, 1.2, .6}, seed, 40);
    check_comes_to_rest({3, 1, 1.2, .6}, seed, 40);
    check_comes_to_rest({4, 2, 1.2, .6}, seed, 40);
  }
}

TEST_CASE("Clusters: balls that lose all, most or little of their speed come to rest", "[degenerate]") {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    for (const double restitution : {0.0, .3, .9}) check_comes_to_rest({4, 2, 1.2, restitution}, seed, 60);
  }
}

TEST_CASE("Clusters: twenty balls come to rest", "[degenerate]") {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    check_comes_to_rest({20, 6, 1.2, .6}, seed, 40);
    check_comes_to_rest({20, 3, 3, .6}, seed, 40);
  }
}

TEST_CASE("Clusters: perfectly elastic balls keep their energy") {
  const Pile pile{4, 2, 1.2, 1};
  for (unsigned seed = 1; seed <= 10; ++seed) {
    World<2> world(options_of(pile));
    drop(world, pile, seed);
    const double begun_with = energy(world);
    world.advance_to(20);
    CHECK(std::abs(energy(world) - begun_with) <= 1e-11 * begun_with);
  }
}

TEST_CASE("Clusters: what happens does not depend on the broad phase, windows, or saving and loading") {
  const Pile pile{12, 3, 1.2, .5};
  for (unsigned seed = 1; seed <= 4; ++seed) {
    INFO("seed " << seed);
    EventLog<2> expected;
    {
      World<2> world(options_of(pile), &expected);
      drop(world, pile, seed);
      world.advance_to(6);
    }
    REQUIRE(expected.events.size() > 100);
    for (const auto method : all_methods) {
      for (const double window : {never, .37, 1e-3}) {
        if (window == 1e-3 && method != BroadPhaseKind::all_pairs) continue;
        WorldOptions options = options_of(pile, method);
        options.window = window;
        EventLog<2> log;
        World<2> world(options, &log);
        drop(world, pile, seed);
        world.advance_to(6);
        const bool same = log.events == expected.events;
        CHECK(same);
      }
    }
    EventLog<2> log;
    Snapshot saved;
    {
      World<2> world(options_of(pile), &log);
      drop(world, pile, seed);
      world.advance_to(2.5);
      saved = save(world);
    }
    World<2> world(options_of(pile), &log);
    restore(saved, world);
    world.advance_to(6);
    const bool same = log.events == expected.events;
    CHECK(same);
  }
}

TEST_CASE("Clusters: a pile at rest costs nothing, and wakes when it is pushed or loses its support") {
  const Pile pile{8, 2, 1.2, .4};
  World<2> world(options_of(pile));
  drop(world, pile, 1);
  world.advance_to(40);
  REQUIRE(kinetic_energy(world) == 0);
  const auto before = world.counters();
  world.advance_to(1e6);
  CHECK(world.counters().motion_updates == before.motion_updates);
  CHECK(world.counters().pair_tests == before.pair_tests);

  BodyId lowest = 0;
  for (BodyId id = 0; id < world.size(); ++id) {
    if (world.motion(id).position(world.now())[1] < world.motion(lowest).position(world.now())[1]) lowest = id;
  }
  world.remove_body(lowest);
  world.advance_to(1e6 + .2);
  double speed = 0;
  for (BodyId id = 0; id < 8; ++id) {
    if (world.contains(id)) speed = std::max(speed, world.motion(id).velocity(world.now()).norm());
  }
  CHECK(speed > 0);
  world.advance_to(1e6 + 40);
  for (BodyId id = 0; id < 8; ++id) {
    if (world.contains(id)) CHECK(world.motion(id).velocity(world.now()).isZero(0));
  }
}

TEST_CASE("Clusters: bodies that exactly fill a box stay where they are", "[degenerate]") {
  WorldOptions options = elastic();
  options.walls = Walls{Vector3d::Zero(), Vector3d(3, 1000, 3), .8};
  World<2> world(options);
  for (int i = 0; i < 9; ++i) {
    world.add_body(bouncy(body<2>(Sphere{.5}, motion<2>({.5 + i / 3, .5, .5 + i % 3}, {0, 0, 0}, {0, -gravity / 2, 0})),
                          .8, i % 2 == 0 ? 1e-3 : 1.0));
  }
  world.add_body(bouncy(body<2>(Sphere{.5}, motion<2>({1, 3, 1}, {0, 0, 0}, {0, -gravity / 2, 0})), .8, 30));
  const double begun_with = energy(world);
  std::size_t steps = 0;
  while (++steps < most_steps && world.step(40)) CHECK(deepest(world) <= deepest_overlap);
  CHECK(steps < most_steps);
  CHECK(energy(world) <= begun_with);
  CHECK(kinetic_energy(world) <= 1e-12 * begun_with);
}

}  // namespace
}  // namespace kds::collision::test_clusters
