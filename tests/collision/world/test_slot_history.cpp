// What happens does not depend on which slots bodies have, but only on the order in which they are added.
#include "collision/world.hpp"
#include "tests/collision/event_log.hpp"
#include "tests/collision/random_scenes.hpp"
#include "tests/collision/world/resting_scenes.hpp"
#include "tests/collision/world/slot_histories.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace kds::collision::test_slot_history {
namespace {

using namespace tests;

using certificates::PointMotion;
using kds::tests::ComingAndGoing;
using kds::tests::first_difference;
using kds::tests::Random;
using kds::tests::SlotHistory;

template <int Degree>
using Scene = ComingAndGoing<PointMotion<Degree>>;
template <class Description>
using Bodies = std::vector<Description>;

/// All broad phases but that by frames, whose world is that of all-pairs, and slower.
std::vector<BroadPhaseKind> methods() {
  std::vector<BroadPhaseKind> all(all_methods.begin(), all_methods.end());
  std::erase(all, BroadPhaseKind::sap);
  return all;
}

template <class Description>
void shuffle(Random& random, Bodies<Description>& bodies) {
  for (std::size_t i = bodies.size(); i > 1; --i) std::swap(bodies[i - 1], bodies[random.below(i)]);
}

/// Which of the first bodies go, and that others come later.
template <int Degree>
void let_some_go(Random& random, Scene<Degree>& scene) {
  shuffle(random, scene.first);
  for (std::size_t i = 0; i < scene.first.size(); ++i) {
    if (random.one_in(4)) scene.gone.push_back(i);
  }
}

/// Balls on a lattice with velocities of few values, so that many meet at one time, also three and more; sensors, balls
/// that ignore others, and some that begin to move otherwise at one time.
template <int Degree>
Scene<Degree> lattice(Random& random) {
  Scene<Degree> scene;
  const auto velocity = [&] {
    const auto one = [&] { return random.integer(-1, 1); };
    return Vector3d(one(), one(), one());
  };
  const auto fill = [&](std::vector<BodyDescription<Degree>>& bodies, double start, double offset) {
    for (int cell = 0; cell < 27; ++cell) {
      if (random.one_in(4)) continue;
      const Vector3d at = 2 * Vector3d(cell % 3, cell / 3 % 3, cell / 9) + Vector3d::Constant(offset);
      auto body = ball<Degree>(0.5, at, velocity());
      body.motion[0].start = start;
      if (random.one_in(6)) body.shape = Box{{0.5, 0.5, 0.5}};
      if (random.one_in(5)) body.mass = 2;
      if (random.one_in(8)) body.fixed = true, body.motion[0] = motion<Degree>(at, zero, zero, start);
      if (random.one_in(8)) body.sensor = true;
      if (random.one_in(8)) body.collides_with = random.one_in(2) ? 0u : ~1u;
      if (random.one_in(6))
        body.motion.push_back(motion<Degree>(body.motion[0].position(start + 0.5), velocity(), zero, start + 0.5));
      bodies.push_back(body);
    }
  };
  scene.middle = 1.25, scene.end = 4;
  fill(scene.first, 0, 0);
  let_some_go<Degree>(random, scene);
  fill(scene.later, scene.middle, 0.25);
  shuffle(random, scene.later);
  return scene;
}

/// Balls and boxes that fall in equal heaps: on the floor, on each other, and into grooves between balls.
Scene<2> heaps(Random& random) {
  Scene<2> scene;
  const double restitution = random.one_in(3) ? 0 : 0.5;
  const auto heap = [&](std::vector<BodyDescription<2>>& bodies, const Vector3d& at, double start) {
    const auto add = [&](BodyDescription<2> body) {
      body.motion[0].start = start;
      bodies.push_back(bouncy(body, restitution));
    };
    const bool round = random.one_in(2);
    for (const double x : {-1.0, 1.0}) {
      for (const double y : {-1.0, 1.0}) {
        const Vector3d place = at + Vector3d(x, y, 1);
        add(round ? ball<2>(1, place, zero, weight) : box<2>({1, 1, 1}, place, zero, weight));
      }
    }
    if (random.one_in(2)) add(ball<2>(1, at + Vector3d(0, 0, 4), zero, weight));
    if (random.one_in(2)) add(ball<2>(1, at + Vector3d(-3, 0, 1.5), {2, 0, 0}, weight));
  };
  for (const double x : {-8.0, 8.0}) heap(scene.first, {x, 0, 0.25}, 0);
  scene.first.push_back(floor_box());
  scene.middle = 1.5, scene.end = 4;
  let_some_go<2>(random, scene);
  std::erase_if(scene.gone, [&](std::size_t i) { return scene.first[i].fixed; });
  for (const double y : {-8.0, 8.0}) heap(scene.later, {0, y, 0.25}, scene.middle);
  shuffle(random, scene.later);
  return scene;
}

template <int Degree, class Make>
void compare(std::uint64_t seeds, WorldOptions options, const Make& make, const std::vector<std::string>& happens) {
  std::map<std::string, std::size_t> counts;
  std::size_t out_of_order = 0, others = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    for (const BroadPhaseKind method : methods()) {
      CAPTURE(seed, static_cast<int>(method));
      options.broad_phase = method;
      Random random(seed);
      const Scene<Degree> scene = make(random);
      const SlotHistory<PointMotion<Degree>> plain(scene, options, nullptr), other(scene, options, &random);
      REQUIRE(first_difference(plain.told.lines, other.told.lines) == "");
      for (const auto& [what, count] : plain.told.counts) counts[what] += count;
      out_of_order += other.out_of_order();
      ++others;
    }
  }
  CHECK(out_of_order > 3 * others);
  for (const std::string& what : happens) {
    CAPTURE(what);
    CHECK(counts[what] > seeds);
  }
}

TEMPLATE_TEST_CASE_SIG("Slots: bodies of a lattice do the same at the same times, whichever slots they have",
                       "[world][slots]", ((int Degree), Degree), 1, 2) {
  for (const Response response : {Response::none, Response::elastic}) {
    CAPTURE(static_cast<int>(response));
    WorldOptions options{.response = response};
    options.walls = Walls{{-2, -2, -2}, {6, 6, 6}, 1};
    options.report_pairs = options.report_pieces = true;
    compare<Degree>(5, options, lattice<Degree>, {"contact", "separation", "overlap", "wall", "pair began", "piece"});
  }
}

TEST_CASE("Slots: heaps come to rest and are struck in the same way, whichever slots their bodies have",
          "[world][slots]") {
  WorldOptions options{.response = Response::elastic};
  options.walls = Walls{{-20, -20, -2}, {20, 20, 20}, 0.5};
  compare<2>(8, options, heaps, {"contact", "rests", "wakes", "moved", "suppressed"});
}

}  // namespace
}  // namespace kds::collision::test_slot_history
