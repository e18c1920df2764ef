// Bodies that turn, in domains: the events are those of one world, bit for bit.
#include "tests/collision/parallel/bending_stagings.hpp"
#include "tests/collision/parallel/changed_piles.hpp"
#include "tests/collision/parallel/contact_laws.hpp"
#include "tests/collision/parallel/stagings.hpp"
#include "tests/collision_turning/parallel/turning_piles.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace kds::collision::test_turning_domains {
namespace {

using certificates::RigidMotion;
using Eigen::Vector3d;
using tests::compare_changed_by;
using tests::compare_runs;
using tests::compare_seeds;
using tests::compare_stagings;
using tests::Manner;
using tests::Random;
using tests::Seen;
using tests::TurningPileMaker;

}  // namespace

TEMPLATE_TEST_CASE_SIG("Domains of bodies that turn have the events of one world", "[parallel]", ((int Degree), Degree),
                       1, 2) {
  Seen seen;
  compare_stagings<RigidMotion<Degree>>(1, 24, 6, seen);
  compare_stagings<RigidMotion<Degree>>(1001, 2, 100, seen);
  INFO(seen.text());
  CHECK(seen.events > 500);
  CHECK(seen.divided > 8);
  CHECK(seen.windows > 40);
  CHECK(seen.corrected > 5);
}

TEMPLATE_TEST_CASE_SIG("Domains of bodies that turn, and respond by a law, have the events of one world", "[parallel]",
                       ((int Degree), Degree), 1, 2) {
  Seen seen;
  tests::compare_laws<RigidMotion<Degree>>(1, 24, 6, seen);
  INFO(seen.text());
  CHECK(seen.events > 500);
  CHECK(seen.divided > 8);
  CHECK(seen.corrected > 5);
}

TEMPLATE_TEST_CASE_SIG("Domains of bodies that turn, and meshes that bend, have the events of one world", "[parallel]",
                       ((int Degree), Degree), 1, 2) {
  Seen seen;
  tests::compare_bending_stagings<RigidMotion<Degree>>(1, 20, 6, seen);
  INFO(seen.text());
  CHECK(seen.events > 500);
  CHECK(seen.divided > 5);
  CHECK(seen.corrected > 3);
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
  for (const std::uint64_t seed : {20u, 25u})
    compare_seeds<TurningPileMaker>("KDS_TURNING_PILE_SEEDS", seed, 1, 8, seen);
  INFO(seen.text());
  CHECK(seen.events > 1000);
  CHECK(seen.corrected > 3);
  CHECK(seen.rests > 5);
}

TEST_CASE("Domains: a listener that changes piles of bodies that turn has the events of one world", "[parallel]") {
  Seen seen;
  std::uint64_t asked = 0;
  // In the second a script takes a body away from one that it was about to lie on, and that is known elsewhere.
  for (const auto& [seed, domains] : {std::pair<std::uint64_t, std::size_t>(1, 8), {2127, 5}}) {
    TurningPileMaker maker(seed);
    const auto scene = maker.scene();
    asked += compare_changed_by(scene, maker.manner(domains), seed, seen, tests::change_turning_pile);
  }
  INFO("changes " << asked << ", " << seen.text());
  CHECK(asked > 20);
  CHECK(seen.rests > 5);
}

}  // namespace kds::collision::test_turning_domains
