// Bodies that rest on fixed bodies and walls, in domains: the events are those of one world, bit for bit.
#include "tests/collision/parallel/tables.hpp"

#include <catch2/catch.hpp>

#include <cstddef>

namespace kds::collision::test_tables {
namespace {

using Eigen::Vector3d;
using tests::compare_runs;
using tests::compare_tables;
using tests::Manner;
using tests::Random;
using tests::Seen;
using tests::Staging;
using Path = certificates::PointMotion<2>;

const Vector3d gravity(0, 0, -5);

/// Balls that lie at this height, on places of a lattice, and move sideways; or somewhat above it.
void add_balls(World<2>& world, int side, double height, double above = 0) {
  Random random(3);
  for (int i = 0; i < side * side; ++i) {
    const double u = random.between(-3, 3), v = random.between(-3, 3);
    auto ball = tests::ball<2>(0.5, {2.0 * (i % side), 2.0 * (i / side), height + above + 0.5}, {u, v, 0}, gravity);
    ball.restitution = 0.75;
    world.add_body(ball);
  }
}

/// The scene in several manners; throws if the events are not those of one world.
Seen run_in_all_manners(const Staging<Path>& scene) {
  Seen seen;
  for (const std::size_t domains : {2u, 4u, 9u}) {
    for (const std::size_t processes : {1u, 3u}) {
      Manner manner{.processes = processes, .polls = 3};
      manner.parallel.threads = 2, manner.parallel.domains = domains, manner.parallel.halo = 1;
      compare_runs(scene, manner, seen);
    }
  }
  return seen;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("Domains: what rests on fixed bodies and walls has the events of one world", "[parallel]",
                       ((int Degree), Degree), 1, 2) {
  Seen seen;
  compare_tables<Degree>({{1, 60, 8}}, seen);
  INFO(seen.text());
  CHECK(seen.events > 5000);
  CHECK(seen.divided > 20);
  CHECK(seen.windows > 60);
  CHECK(seen.corrected > 20);
  CHECK(seen.rests > 500);
  CHECK(seen.tables > 5);
}

TEST_CASE("Domains: balls that roll about on a floor are divided, and none of it is run as one world", "[parallel]") {
  WorldOptions options = tests::with_response(Response::elastic);
  const auto on_a_box = [](World<2>& world) {
    world.add_body(tests::fixed_body<2>(Box{{40, 40, 1}}, tests::motion<2>({7, 7, -1})));
    add_balls(world, 8, 0);
  };
  Seen seen = run_in_all_manners({options, on_a_box, 2, "on a box"});
  INFO(seen.text());
  CHECK(seen.tables == 6);
  CHECK(seen.rests >= 6 * 64);

  // Some slide off the upper step, fall, and come to rest on the lower one.
  const auto on_steps = [](World<2>& world) {
    world.add_body(tests::fixed_body<2>(Box{{4, 40, 1}}, tests::motion<2>({3, 7, -1})));
    world.add_body(tests::fixed_body<2>(Box{{40, 40, 1}}, tests::motion<2>({47.5, 7, -2})));
    add_balls(world, 8, 0);
  };
  seen = run_in_all_manners({options, on_steps, 2, "on steps"});
  CHECK(seen.divided == 6);

  options.walls = Walls{Vector3d(-2, -2, 0), Vector3d(16, 16, 9), 0.5};
  seen = run_in_all_manners({options, [](World<2>& world) { add_balls(world, 8, 0); }, 3, "on a wall"});
  CHECK(seen.tables == 6);
}

TEST_CASE("Domains: balls that slide down a slope or a dome are divided, and none of it is run as one world",
          "[parallel]") {
  WorldOptions options = tests::with_response(Response::elastic);
  const auto on_a_slope = [](World<2>& world) {
    auto slope = tests::fixed_body<2>(Box{{60, 60, 1}}, tests::motion<2>({7, 7, -6}));
    slope.orientation = tests::unit_quaternion(1, 0.05, 0.1, 0);
    slope.restitution = 0;
    world.add_body(slope);
    add_balls(world, 8, 0, 1);
  };
  Seen seen = run_in_all_manners({options, on_a_slope, 3, "on a slope"});
  INFO(seen.text());
  CHECK(seen.tables == 6);
  CHECK(seen.rests >= 6 * 64);

  const auto on_a_dome = [](World<2>& world) {
    auto dome = tests::fixed_body<2>(Sphere{100}, tests::motion<2>({7, 7, -101}));
    dome.restitution = 0;
    world.add_body(dome);
    add_balls(world, 8, 0, 1);
  };
  seen = run_in_all_manners({options, on_a_dome, 3, "on a dome"});
  CHECK(seen.tables == 6);
  CHECK(seen.rests >= 6 * 64);
}

TEST_CASE("Domains: a lift that bounces off walls moves all that it carries at one time", "[parallel]") {
  WorldOptions options = tests::with_response(Response::elastic);
  options.walls = Walls{Vector3d(-30, -30, 0), Vector3d(40, 40, 30)};
  const auto fill = [](World<2>& world) {
    auto lift = tests::fixed_body<2>(Box{{9, 9, 1}}, tests::motion<2>({7, 7, 14}, {0, 0, -0.5}));
    world.add_body(lift);
    add_balls(world, 8, 15);
    for (int i = 0; i < 12; ++i) {  // What strikes the walls at the same times.
      world.add_body(tests::ball<2>(0.5, {-20, -20 + 4.0 * i, 14}, {0, 0, -0.5}));
    }
  };
  const Seen seen = run_in_all_manners({options, fill, 3, "a lift"});
  INFO(seen.text());
  CHECK(seen.divided == 6);
  CHECK(seen.rests >= 6 * 2 * 64);
}

TEST_CASE("Domains: balls slide off a floor that begins to move sideways under them", "[parallel]") {
  const auto fill = [](World<2>& world) {
    auto floor = tests::fixed_body<2>(Box{{6, 6, 1}}, tests::motion<2>({5, 5, -1}));
    floor.motion.push_back(tests::motion<2>({5, 5, -1}, {3, -2, 0}, Vector3d::Zero(), 0.25));
    world.add_body(floor);
    add_balls(world, 6, 0);
  };
  const Seen seen = run_in_all_manners({tests::with_response(Response::elastic), fill, 2, "a floor that moves"});
  INFO(seen.text());
  CHECK(seen.divided == 6);
  CHECK(seen.rests >= 6 * 2 * 18);
}

}  // namespace kds::collision::test_tables
