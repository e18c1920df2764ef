// Bodies that turn, in domains: the events are those of one world, bit for bit.
#include "tests/collision/parallel/bending_stagings.hpp"
#include "tests/collision/parallel/changed_piles.hpp"
#include "tests/collision/parallel/contact_laws.hpp"
#include "tests/collision/parallel/in_two.hpp"
#include "tests/collision/parallel/runs_in_turns.hpp"
#include "tests/collision/parallel/stagings.hpp"
#include "tests/collision_turning/parallel/turning_piles.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace kds::collision::test_turning_domains {
namespace {

using certificates::RigidMotion;
using Eigen::Vector3d;
using tests::compare_runs;
using tests::compare_seeds;
using tests::compare_stagings;
using tests::InTwo;
using tests::Manner;
using tests::Random;
using tests::Seen;
using tests::TurningPileMaker;
using tests::TurningRowMaker;

}  // namespace

TEMPLATE_TEST_CASE_SIG("Domains of bodies that turn have the events of one world", "[parallel]", ((int Degree), Degree),
                       1, 2) {
  Seen seen;
  compare_stagings<RigidMotion<Degree>>({{1, 24, 6}, {1001, 2, 100}}, seen);
  INFO(seen.text());
  CHECK(seen.events > 500);
  CHECK(seen.divided > 8);
  CHECK(seen.windows > 40);
  CHECK(seen.corrected > 5);
}

TEMPLATE_TEST_CASE_SIG("Domains of bodies that turn, and respond by a law, have the events of one world", "[parallel]",
                       ((int Degree), Degree), 1, 2) {
  Seen seen;
  tests::compare_laws<RigidMotion<Degree>>({{1, 24, 6}}, seen);
  INFO(seen.text());
  CHECK(seen.events > 500);
  CHECK(seen.divided > 8);
  CHECK(seen.corrected > 5);
}

TEMPLATE_TEST_CASE_SIG("Domains of bodies that turn, and meshes that bend, have the events of one world", "[parallel]",
                       ((int Degree), Degree), 1, 2) {
  Seen seen;
  tests::compare_bending_stagings<RigidMotion<Degree>>({{1, 20, 6}}, seen);
  INFO(seen.text());
  CHECK(seen.events > 500);
  CHECK(seen.divided > 5);
  CHECK(seen.corrected > 3);
}

TEST_CASE("Domain: copies of bodies that turn and lean on owned ones count where these come out of the cell",
          "[parallel]") {
  // A row at rest, with the border in its middle, is struck at its left end, moves to a stop on the right, and back.
  namespace rest = kds::tests::rest;
  WorldOptions options = tests::with_response(Response::elastic);
  options.shortest_flight = 0.03;
  const auto fill = [](TurningWorld<2>& world) {
    auto floor = rest::fixed(Box{{60, 60, 1}}, {0, 0, -1}), stop = rest::fixed(Box{{0.5, 3, 3}}, {5, 0, 3});
    floor.friction = 0, stop.restitution = 1;
    world.add_body(floor), world.add_body(stop);
    for (int i = 0; i < 4; ++i) {
      auto crate = rest::body(Box{{0.5, 0.5, 0.5}}, {i - 0.5, 0, 0.5});
      crate.friction = 0, crate.inertia = 0.2, crate.restitution = 0.9;
      world.add_body(crate);
    }
    auto stone = rest::body(Sphere{0.5}, {-6, 0, 0.55});
    stone.motion[0].path.coefficients[1] = Vector3d(8, 0, 0), stone.restitution = 0.9, stone.mass = 8;
    world.add_body(stone);
  };
  const double now = 0.375, until = 1.25;
  InTwo<RigidMotion<2>> two(options, fill, now, 20);
  TurningWorld<2> world(options);
  fill(world);
  world.advance_to(now);
  const BodyId last = 5;
  REQUIRE(rest::still(world, last));
  const double begun = two.outside_first(last);
  REQUIRE(begun > 1);
  CHECK(two.domain(0).report().divisible);
  CHECK(two.domain(0).report().begun_outside == Approx(begun));
  double farthest = 0;
  for (int step = 1; step <= 64; ++step) {
    world.advance_to(now + (until - now) * step / 64);
    farthest = std::max(farthest, two.outside_first(world.motion(last).path.position(world.now())));
  }
  REQUIRE(farthest > begun + 0.5);
  two.domain(0).run(until);
  REQUIRE(two.domain(0).report().divisible);
  CHECK(two.domain(0).report().overshoot >= farthest);

  // What an island reaches out of the cell takes up the halo.
  CHECK_FALSE(InTwo<RigidMotion<2>>(options, fill, now, begun + 1.8).domain(0).report().divisible);
}

TEST_CASE("Domains: rods that precess go from domain to domain", "[parallel]") {
  const auto fill = [](TurningWorld<1>& world) {
    Random random(5);
    for (int i = 0; i < 60; ++i) {
      TurningWorld<1>::Description rod{.shape = Box{{0.5, 0.125, 0.0625}}};
      const double x = random.between(-3, 3), y = random.between(-1, 1), z = random.between(-1, 1);
      RigidMotion<1> motion{{{Vector3d(0.75 * i, i % 3, 0), Vector3d(2 * x, y, z)}}};
      motion.angular_velocity = Vector3d(3 * y, 2 * z, 2 + x);
      rod.motion = {motion};
      world.add_body(rod);
    }
  };
  WorldOptions options = tests::with_response(Response::elastic);
  options.walls = Walls{Vector3d(-1, -1, -0.75), Vector3d(46, 3, 0.75)};
  Seen seen;
  for (const std::size_t processes : {1u, 3u}) {
    Manner manner{.processes = processes, .polls = 3};
    manner.parallel.threads = 2, manner.parallel.domains = 5, manner.parallel.halo = 1.5;
    compare_runs<RigidMotion<1>>({options, fill, 4, "rods"}, manner, seen);
  }
  INFO(seen.text());
  CHECK(seen.divided == 2);
  CHECK(seen.copies > 20);
  CHECK(seen.events > 100);
}

TEST_CASE("Domains: balls that turn fall and come to rest, and none of it is run as one world", "[parallel]") {
  const auto fill = [](TurningWorld<2>& world) {
    for (int i = 0; i < 40; ++i) {
      TurningWorld<2>::Description ball{.shape = Sphere{0.25}, .restitution = 0.3, .friction = 0.5};
      RigidMotion<2> motion;
      motion.path.coefficients = {Vector3d(i, 0, 0.5 + 0.03 * i), Vector3d::Zero(), Vector3d(0, 0, -5)};
      ball.motion = {motion};
      world.add_body(ball);
    }
    TurningWorld<2>::Description floor{.shape = HalfSpace{{0, 0, 1}}, .fixed = true, .friction = 0.5};
    floor.motion = {RigidMotion<2>{}};
    world.add_body(floor);
  };
  Seen seen;
  for (const std::size_t processes : {1u, 2u}) {
    Manner manner{.processes = processes, .polls = 2};
    manner.parallel.threads = 2, manner.parallel.domains = 4, manner.parallel.halo = 1;
    manner.parallel.longest_window = 0.1;
    compare_runs<RigidMotion<2>>({tests::with_response(Response::elastic), fill, 1, "falling"}, manner, seen);
  }
  INFO(seen.text());
  CHECK(seen.tables == 2);
  CHECK(seen.windows > 0);
  CHECK(seen.rests >= 80);
}

TEST_CASE("Domains: rows of crates come to rest across borders and are struck", "[parallel]") {
  WorldOptions options = tests::with_response(Response::elastic);
  options.shortest_flight = 0.01;
  Seen seen;
  for (const std::size_t processes : {1u, 2u}) {
    Manner manner{.processes = processes, .polls = 2};
    manner.parallel.threads = 1, manner.parallel.domains = processes + 1, manner.parallel.halo = 2.5;
    manner.parallel.longest_window = 0.25;
    compare_runs<RigidMotion<2>>({options, tests::add_struck_crates, 0.8, "crates"}, manner, seen);
  }
  INFO(seen.text());
  CHECK(seen.tables == 2);
  CHECK(seen.windows > 10);
  CHECK(seen.rests > 100);
}

TEST_CASE("Domains: piles of bodies that turn have the events of one world", "[parallel]") {
  Seen seen;
  compare_seeds<TurningPileMaker>("KDS_TURNING_PILE_SEEDS", {{20}, {25}}, seen);
  INFO(seen.text());
  CHECK(seen.events > 1000);
  CHECK(seen.corrected > 3);
  CHECK(seen.rests > 5);
}

TEST_CASE("Domains: rows of bodies that turn have the events of one world", "[parallel]") {
  Seen seen;
  compare_seeds<TurningRowMaker>("KDS_TURNING_ROW_SEEDS", {{1, 1}}, seen);
  INFO(seen.text());
  CHECK(seen.events > 100);
}

TEST_CASE("Domains: rows of bodies that turn go from one world to domains, to others, and back", "[parallel]") {
  Seen seen;
  tests::compare_seeds_in_turns<TurningRowMaker>("KDS_TURNING_TURN_SEEDS", {{1, 1}}, seen);
  CHECK(seen.events > 100);
}

TEST_CASE("Domains: a listener that changes piles of bodies that turn has the events of one world", "[parallel]") {
  Seen seen;
  // In the second a script takes a body away from one that it was about to lie on, and that is known elsewhere.
  const std::uint64_t asked = tests::compare_seeds_changed_by<TurningPileMaker>(
      "KDS_TURNING_CHANGE_SEEDS", {{1}, {2127, 1, 5}}, seen, tests::change_turning_pile);
  INFO("changes " << asked << ", " << seen.text());
  CHECK(asked > 20);
  CHECK(seen.rests > 5);
}

}  // namespace kds::collision::test_turning_domains
