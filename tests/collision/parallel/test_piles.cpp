// Bodies that lean on each other, in domains: the events are those of one world, bit for bit.
#include "tests/collision/parallel/piles.hpp"

#include <catch2/catch.hpp>

#include <cstddef>

namespace kds::collision::test_piles {
namespace {

using Eigen::Vector3d;
using tests::compare_piles;
using tests::compare_runs;
using tests::Manner;
using tests::Seen;

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

}  // namespace

TEMPLATE_TEST_CASE_SIG("Domains: bodies that lean on each other have the events of one world", "[parallel]",
                       ((int Degree), Degree), 1, 2) {
  Seen seen;
  compare_piles<Degree>(1, 40, 6, seen);
  INFO(seen.text());
  CHECK(seen.events > 2000);
  CHECK(seen.divided > 15);
  CHECK(seen.windows > 60);
  CHECK(seen.corrected > 10);
  CHECK(seen.rests > 500);
}

TEST_CASE("Domains: rows of balls across borders are divided, and none of it is run as one world", "[parallel]") {
  Seen seen;
  for (const std::size_t domains : {2u, 3u}) {
    for (const std::size_t processes : {1u, 2u}) {
      Manner manner{.processes = processes, .polls = 2};
      manner.parallel.threads = 2, manner.parallel.domains = domains, manner.parallel.halo = 4;
      compare_runs({tests::with_response(Response::elastic), add_rows, 2, "rows"}, manner, seen);
    }
  }
  INFO(seen.text());
  CHECK(seen.tables == 4);
  CHECK(seen.rests >= 4 * 200);
}

}  // namespace kds::collision::test_piles
