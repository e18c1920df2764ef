// Bodies that lean on each other, in domains: the events are those of one world, bit for bit.
#include "tests/collision/parallel/changed_piles.hpp"
#include "tests/collision/parallel/piles.hpp"
#include "tests/collision/parallel/ties.hpp"

#include <catch2/catch.hpp>

#include <cstddef>
#include <cstdint>
#include <initializer_list>

namespace kds::collision::test_piles {
namespace {

using Eigen::Vector3d;
using tests::compare_piles;
using tests::compare_runs;
using tests::compare_seeds_changed;
using tests::Manner;
using tests::PileMaker;
using tests::Seen;
using tests::Staging;
using tests::TieMaker;

const Vector3d gravity(0, 0, -5);

/// A ball that others may come to rest on.
BodyDescription<2> soft_ball(const Vector3d& place, const Vector3d& velocity = Vector3d::Zero()) {
  auto ball = tests::ball<2>(0.5, place, velocity, gravity);
  ball.restitution = 0;
  return ball;
}

/// Rows of two to four balls that touch, all over a floor, and balls that roll against them.
void add_rows(World<2>& world) {
  world.add_body(tests::fixed_body<2>(Box{{60, 60, 1}}, tests::motion<2>({20, 10, -1})));
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 6; ++j) {
      const Vector3d foot(5.0 * i + 0.5 * (j % 3), 4.0 * j, 0.5);
      const Vector3d along = (i + j) % 2 == 0 ? Vector3d(1, 0, 0) : Vector3d(0, 1, 0);
      for (int k = 0; k < 2 + (i + j) % 3; ++k) world.add_body(soft_ball(foot + k * along));
      world.add_body(soft_ball(foot + Vector3d(-1.5, 1.5, 0), {1, -1, 0}));
    }
  }
}

/// Rows of five balls that have been pushed together, all across x = 20, and balls that roll against one end of each
/// from far away, some after they have struck another.
void add_struck_rows(World<2>& world) {
  world.add_body(tests::fixed_body<2>(Box{{90, 60, 1}}, tests::motion<2>({20, 20, -1})));
  for (int j = 0; j < 10; ++j) {
    const double y = 4.0 * j, middle = 20 + 0.37 * (j - 4.5), side = j % 2 == 0 ? 1 : -1;
    for (int k = -2; k <= 2; ++k) world.add_body(soft_ball({middle + k, y, 0.5}, {-0.05 * k, 0, 0}));
    const double far = 2.5 + 4 + 0.8 * j, speed = -5.0 - (j % 3);
    world.add_body(soft_ball({middle + side * far, y + 0.1 * (j % 4), 0.5}, {side * speed, 0, 0}));
    auto stone = soft_ball({middle + side * (far + 2), y + 0.3, 0.5}, {side * (speed - 3), 0, 0});
    stone.restitution = 1;
    if (j % 3 == 0) world.add_body(stone);
  }
  for (int i = -10; i <= 10; ++i) {
    for (const double y : {-4.0, 42.0}) world.add_body(soft_ball({20 + 4.0 * i, y, 0.5}));
  }
}

/// Blocks of balls that touch, five by five of them, so that several stand where four cells meet; balls strike each
/// from four sides, and most of them at the same instants.
void add_blocks(World<2>& world) {
  world.add_body(tests::fixed_body<2>(Box{{60, 60, 1}}, tests::motion<2>({0, 0, -1})));
  for (int i = -2; i <= 2; ++i) {
    for (int j = -2; j <= 2; ++j) {
      const Vector3d middle(6.0 * i, 6.0 * j, 0.5);
      for (const double x : {-0.5, 0.5}) {
        for (const double y : {-0.5, 0.5}) world.add_body(soft_ball(middle + Vector3d(x, y, 0)));
      }
      for (const double side : {-1.0, 1.0}) {
        const double speed = (i + j) % 2 == 0 ? 1 : 2, off = (i * j) % 3 == 0 ? 0.5 : 0.25;
        world.add_body(soft_ball(middle + side * Vector3d(2.5, off, 0), {-side * speed, 0, 0}));
        world.add_body(soft_ball(middle + side * Vector3d(off, -2.5, 0), {0, side * speed, 0}));
      }
    }
  }
}

/// The scene in domains with one thread and two, alone and by two processes.
Seen run_in_all_manners(const Staging<certificates::PointMotion<2>>& scene, double halo,
                        std::initializer_list<std::size_t> numbers_of_domains = {2, 3}) {
  Seen seen;
  for (const std::size_t domains : numbers_of_domains) {
    for (const std::size_t processes : {1u, 2u}) {
      Manner manner{.processes = processes, .polls = 2};
      manner.parallel.threads = domains % 2 + 1, manner.parallel.domains = domains;
      manner.parallel.halo = halo, manner.parallel.longest_window = 0.25;
      compare_runs(scene, manner, seen);
    }
  }
  return seen;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("Domains: bodies that lean on each other have the events of one world", "[parallel]",
                       ((int Degree), Degree), 1, 2) {
  Seen seen;
  compare_piles<Degree>(15, 32, 6, seen);
  INFO(seen.text());
  CHECK(seen.events > 500);
  CHECK(seen.divided > 5);
  CHECK(seen.windows > 30);
  CHECK(seen.corrected > 3);
  CHECK(seen.rests > 200);
}

TEST_CASE("Domains: rows of balls across borders are divided, and none of it is run as one world", "[parallel]") {
  const Seen seen = run_in_all_manners({tests::with_response(Response::elastic), add_rows, 2, "rows"}, 4);
  INFO(seen.text());
  CHECK(seen.tables == 4);
  CHECK(seen.windows > 20);
  CHECK(seen.rests >= 4 * 200);
}

TEST_CASE("Domains: rows of balls across a border are struck at their far ends", "[parallel]") {
  const WorldOptions options = tests::with_response(Response::elastic);
  Seen seen;
  for (const double halo : {1.0, 2.0}) {
    const Seen of_halo = run_in_all_manners({options, add_struck_rows, 3, "struck rows"}, halo);
    seen.windows += of_halo.windows, seen.corrected += of_halo.corrected, seen.tables += of_halo.tables;
    seen.rests += of_halo.rests, seen.whole += of_halo.whole, seen.failed += of_halo.failed;
  }
  INFO(seen.text());
  CHECK(seen.tables > 3);
  CHECK(seen.windows > 40);
  CHECK(seen.corrected > 3);
}

TEST_CASE("Domains: blocks of balls where four cells meet are struck from all sides at one time", "[parallel]") {
  const Seen seen = run_in_all_manners({tests::with_response(Response::elastic), add_blocks, 2, "blocks"}, 2, {4, 7});
  INFO(seen.text());
  CHECK(seen.tables == 4);
  CHECK(seen.windows > 20);
}

TEMPLATE_TEST_CASE_SIG("Domains: a listener that changes piles has the events of one world", "[parallel]",
                       ((int Degree), Degree), 1, 2) {
  Seen seen;
  const std::uint64_t asked = compare_seeds_changed<Degree, PileMaker<Degree>>(1, Degree == 1 ? 40 : 12, seen);
  INFO("changes " << asked << ", " << seen.text());
  CHECK(asked > 100);
  CHECK(seen.events > 2000);
  CHECK(seen.windows > 5);
  CHECK(seen.rests > 300);
}

TEST_CASE("Domains: bodies leave clusters before a span of these ends", "[parallel]") {
  Seen seen;
  for (const std::uint64_t seed : {42u, 294u}) compare_seeds_changed<2, TieMaker<2>>(seed, 1, seen);
  INFO(seen.text());
  CHECK(seen.events > 500);
  CHECK(seen.rests > 200);
}

TEST_CASE("Domains: islands that their owners cannot know wholly come back from several processes", "[parallel]") {
  Seen seen;
  for (const std::uint64_t seed : {17u, 24u}) {
    TieMaker<2> maker(seed);
    const auto scene = maker.scene();
    compare_runs(scene, maker.manner(8), seen);
  }
  INFO(seen.text());
  CHECK(seen.whole > 5);
  CHECK(seen.rests > 50);
}

}  // namespace kds::collision::test_piles
