// Scripts, bodies that enter later, attached sensors, ignored pairs, timers and large bodies that others do not move,
// in domains: the events are those of one world, bit for bit.
#include "tests/collision/parallel/stagings.hpp"
#include "tests/collision/parallel/trials.hpp"

#include <catch2/catch.hpp>

#include <cstddef>
#include <vector>

namespace kds::collision::test_stagings {
namespace {

using Eigen::Vector3d;
using tests::compare_runs;
using tests::compare_stagings;
using tests::Manner;
using tests::Seen;
using tests::Staging;
template <int Degree>
using Path = certificates::PointMotion<Degree>;

/// Balls on the places of a lattice in [0, side), that move at random.
void add_balls(World<1>& world, int side) {
  tests::Random random(3);
  for (int i = 0; i < side * side * side; ++i) {
    const double x = random.between(-1, 1), y = random.between(-1, 1), z = random.between(-1, 1);
    world.add_body(tests::ball<1>(0.2, Vector3d(i % side, i / side % side, i / side / side), Vector3d(x, y, z)));
  }
}

/// The scene in several manners; throws if the events are not those of one world.
Seen run_in_all_manners(const Staging<Path<1>>& scene) {
  Seen seen;
  for (const std::size_t domains : {2u, 5u, 16u}) {
    for (const std::size_t processes : {1u, 3u, 7u}) {
      Manner manner{.processes = processes, .polls = 3};
      manner.parallel.threads = 2, manner.parallel.domains = domains, manner.parallel.halo = 1;
      compare_runs(scene, manner, seen);
    }
  }
  return seen;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("Domains and scripts, sensors, ignored pairs, timers: the events of one world", "[parallel]",
                       ((int Degree), Degree), 1, 2) {
  Seen seen;
  compare_stagings<Path<Degree>>({{1, 30, 8}, {1001, 3, 150}}, seen);
  INFO(seen.text());
  CHECK(seen.events > 2000);
  CHECK(seen.divided > 12);
  CHECK(seen.windows > 75);
  CHECK(seen.corrected > 25);
}

TEST_CASE("Domains: pistons that go to and fro, and bounce off walls, are known everywhere", "[parallel]") {
  const auto fill = [](World<1>& world) {
    add_balls(world, 7);
    auto piston = tests::body<1>(Box{{0.25, 8, 8}}, tests::motion<1>({-2, 3, 3}, {1, 0, 0}));
    piston.motion.push_back(tests::motion<1>({0, 3, 3}, {-1, 0, 0}, Vector3d::Zero(), 2));
    piston.motion.push_back(tests::motion<1>({-1, 3, 3}, {0.5, 0, 0}, Vector3d::Zero(), 3));
    piston.fixed = true;
    world.add_body(piston);
    auto sphere = tests::body<1>(Sphere{1.5}, tests::motion<1>({3, 3, 3}, {2, 1, 0}));
    sphere.fixed = true;
    const BodyId id = world.add_body(sphere);
    world.add_body({.shape = Sphere{1.75}, .sensor = true, .attached_to = id});
  };
  WorldOptions options = tests::with_response(Response::elastic);
  options.walls = Walls{Vector3d(-12, -12, -12), Vector3d(12, 12, 12)};
  Seen seen = run_in_all_manners({options, fill, 4, "pistons"});
  INFO(seen.text());
  CHECK(seen.divided == 9);
  CHECK(seen.windows > 20);
  CHECK(seen.events > 1000);

  // A wall that only the sphere meets, again and again.
  options.walls = Walls{Vector3d(-12, 0.5, -12), Vector3d(12, 5, 12)};
  seen = run_in_all_manners({options, fill, 3, "a sphere between walls"});
  CHECK(seen.divided == 9);
}

TEST_CASE("Domains: bodies that enter one by one at one place, and are ignored by their neighbours", "[parallel]") {
  const auto fill = [](World<1>& world) {
    add_balls(world, 6);
    std::vector<BodyId> entering;
    for (int i = 0; i < 24; ++i) {
      auto ball = tests::ball<1>(0.3, {2.5, 2.5, 2.5}, {1, 0.25 * (i % 5), -0.5});
      ball.motion[0].start = 0.125 * i;
      entering.push_back(world.add_body(ball));
      for (BodyId other = 0; other < 100; other += 7) world.ignore_pair(entering.back(), other);
      if (i % 2 == 1) world.ignore_pair(entering[entering.size() - 2], entering.back());
      if (i % 3 == 0) {
        world.add_body({.shape = Sphere{0.75}, .sensor = true, .attached_to = entering.back()});
      }
    }
    world.set_timer(1);
  };
  const Seen seen = run_in_all_manners({tests::with_response(Response::elastic), fill, 4, "an inlet"});
  INFO(seen.text());
  CHECK(seen.divided == 9);
  CHECK(seen.windows > 30);
  CHECK(seen.events > 1000);
}

}  // namespace kds::collision::test_stagings
