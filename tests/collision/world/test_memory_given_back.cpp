// Of bodies that have gone, memory is given back; the events and the ids of the others are as if it were kept.
#include "collision/world.hpp"
#include "tests/collision/event_log.hpp"
#include "tests/support/random_numbers.hpp"
#include "tests/support/sanitized.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstddef>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace kds::collision::test_memory_given_back {
namespace {

using Eigen::Vector3d;
using kds::tests::Random;
using tests::EventLog;

/// Bytes that are allocated, where that can be asked.
std::size_t allocated() {
#ifdef __GLIBC__
  const auto now = mallinfo2();
  return now.uordblks + now.hblkhd;
#else
  return 0;
#endif
}

/// Balls in a box, by 2 to a distance of neighbours or so.
void add_gas(World<1>& world, int balls, Random& random) {
  const double side = std::cbrt(balls);
  for (int i = 0; i < balls; ++i) {
    const double x = random.between(0, side), y = random.between(0, side), z = random.between(0, side);
    const double u = random.between(-1, 1), v = random.between(-1, 1), w = random.between(-1, 1);
    world.add_body(tests::ball<1>(0.25, Vector3d(x, y, z), Vector3d(u, v, w)));
  }
}

WorldOptions in_a_box(int balls) {
  WorldOptions options;
  options.response = Response::elastic;
  options.walls = Walls{Vector3d::Constant(-1), Vector3d::Constant(std::cbrt(balls) + 1)};
  return options;
}

/// Whether `keeps` says so, a world of such bodies keeps its memory: callers have asked for it.
struct Run {
  EventLog<1> log;
  World<1> world;
  std::vector<BodyId> ids;

  Run(int balls, bool keeps) : world(in_a_box(balls), &log) {
    if (keeps) world.reserve(static_cast<std::size_t>(balls));
  }
};

/// Adds balls, lets nine in ten go, some by callbacks, adds some, and so on.
void come_and_go(Run& run, int balls, std::uint64_t seed) {
  Random random(seed);
  World<1>& world = run.world;
  for (int round = 0; round < 3; ++round) {
    add_gas(world, round == 0 ? balls : balls / 4, random);
    world.advance_to(world.now() + 0.2);
    std::vector<BodyId> there;
    world.visit_bodies([&](BodyId id) { there.push_back(id); });
    for (const BodyId id : there) {
      if (random.one_in(10)) continue;
      world.remove_body(id);
      if (random.one_in(1000)) world.advance_to(world.now() + 1e-3);
    }
    world.advance_to(world.now() + 0.2);
    world.audit();
    for (int i = 0; i < 5; ++i) {
      run.ids.push_back(world.add_body(tests::ball<1>(0.25, Vector3d(i, 1, 1), Vector3d(0, 0, 1))));
    }
    world.advance_to(world.now() + 0.2);
    world.audit();
  }
}

}  // namespace

TEST_CASE("memory: what cells, pairs and events took is given back when bodies go") {
  constexpr int balls = 20'000;
  const std::size_t before = allocated();
  World<1> world(in_a_box(balls));
  Random random(7);
  add_gas(world, balls, random);
  world.advance_to(0.3);
  const std::size_t full = allocated() - before;
  for (BodyId id = 0; id < balls; ++id) {
    if (id % 10 != 3) world.remove_body(id);
  }
  const std::size_t removed = allocated() - before;
  world.advance_to(0.3 + 1e-9);
  const std::size_t rest = allocated() - before;
  world.audit();
  CHECK(world.size() == balls / 10);
  if (KDS_SANITIZED != 0 || before == 0) return;  // nobody tells what is allocated
  constexpr std::size_t by_slot = 300;            // bytes
  constexpr std::size_t by_body = 1000;
  INFO("bytes: " << full << ", then " << removed << ", " << rest);
  CHECK(full > balls * (by_slot + 200));
  CHECK(rest < balls * by_slot + world.size() * by_body);
  // All may go, and come again.
  for (BodyId id = 3; id < balls; id += 10) world.remove_body(id);
  world.advance_to(0.4);
  CHECK(allocated() - before < balls * by_slot);
  CHECK(body_slot(world.add_body(tests::ball<1>(0.25, Vector3d(1, 1, 1)))) == balls - 7);
}

TEST_CASE("memory: events and ids do not depend on whether it is given back") {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    INFO("seed " << seed);
    Run gives_back(6000, false), keeps(6000, true);
    come_and_go(gives_back, 6000, seed);
    come_and_go(keeps, 6000, seed);
    CHECK(gives_back.log.events.size() > 1000);
    CHECK(gives_back.log.events == keeps.log.events);
    CHECK(gives_back.ids == keeps.ids);
  }
}

}  // namespace kds::collision::test_memory_given_back
