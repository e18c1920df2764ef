// What a world answers about what is near: the same whatever the broad phase, and at any moment.
#include "collision/world.hpp"
#include "tests/support/random_numbers.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

namespace kds::collision::test_near {
namespace {

using Eigen::Vector3d;
using kds::tests::Random;
using Ids = std::vector<BodyId>;

constexpr double infinity = std::numeric_limits<double>::infinity();

template <int Degree>
Ids near(const World<Degree>& world, const Vector3d& min, const Vector3d& max) {
  Ids named;
  world.visit_overlapping(min, max, [&](BodyId id) { named.push_back(id); });
  return named;
}

template <int Degree>
certificates::PointMotion<Degree> path(const Vector3d& at, const Vector3d& velocity, double start) {
  certificates::PointMotion<Degree> motion{};
  for (auto& coefficient : motion.coefficients) coefficient.setZero();
  motion.coefficients[0] = at;
  motion.coefficients[1] = velocity;
  motion.start = start;
  return motion;
}

template <int Degree>
BodyDescription<Degree> ball(double radius, const Vector3d& at, const Vector3d& velocity, double start = 0) {
  BodyDescription<Degree> body;
  body.shape = Sphere{radius};
  body.motion = {path<Degree>(at, velocity, start)};
  return body;
}

/// Brute force: balls whose boxes meet this one by more than rounding, or that touch it as far as rounding tells.
template <int Degree>
void require_right(const World<Degree>& world, const Ids& added, const Vector3d& min, const Vector3d& max,
                   std::size_t& met) {
  const Ids named = near(world, min, max);
  REQUIRE(std::is_sorted(named.begin(), named.end()));
  REQUIRE(std::adjacent_find(named.begin(), named.end()) == named.end());
  constexpr double rounding = 1e-12;
  for (const BodyId id : added) {
    if (!world.contains(id)) continue;
    const Vector3d at = world.motion(id).position(world.now());
    const double radius = world.shape(id).bounding_radius;
    const double gap =
        (min.array() - (at.array() + radius)).max(at.array() - radius - max.array()).maxCoeff();  // on some axis
    const bool is_named = std::binary_search(named.begin(), named.end(), id);
    INFO("body " << id << " at " << world.now() << ", gap " << gap);
    if (gap <= -rounding) REQUIRE(is_named);
    if (gap > rounding) REQUIRE(!is_named);
    met += is_named;
  }
}

std::vector<WorldOptions> all_ways() {
  std::vector<WorldOptions> ways;
  for (const NamedBroadPhase& way : broad_phases) {
    WorldOptions options;
    options.broad_phase = way.kind;
    options.rate = way.kind == BroadPhaseKind::sap ? 3 : 0;
    options.response = Response::elastic;
    options.walls = Walls{Vector3d::Zero(), Vector3d::Constant(10)};
    ways.push_back(options);
    options.window = 0.4;
    ways.push_back(options);
  }
  return ways;
}

/// The answers to random questions in a random run, the same questions and the same run for every way.
template <int Degree>
std::vector<Ids> answers(const WorldOptions& options, std::uint64_t seed, std::size_t& met) {
  Random random(seed);
  World<Degree> world(options);
  const auto place = [&] { return Vector3d(random.between(1, 9), random.between(1, 9), random.between(1, 9)); };
  const auto speed = [&] { return Vector3d(random.between(-2, 2), random.between(-2, 2), random.between(-2, 2)); };
  std::vector<Ids> all;
  Ids added;
  const auto ask = [&] {
    const Vector3d corner = place() - Vector3d::Constant(1);
    const Vector3d size = random.one_in(4) ? Vector3d::Constant(infinity) : Vector3d(place() / 3);
    require_right(world, added, corner, corner + size, met);
    all.push_back(near(world, corner, corner + size));
    KineticBox<Degree> box =
        box_around<Degree>(path<Degree>(place(), speed(), world.now()), -size.cwiseMin(1), Vector3d::Ones());
    Ids swept;
    world.visit_swept(box, world.now() + random.between(0, 1), [&](BodyId id) { swept.push_back(id); });
    all.push_back(swept);
  };
  for (int round = 0; round < 60; ++round) {
    ask();
    const auto dice = random.below(6);
    if (dice < 3 || world.size() < 4) {
      auto body = ball<Degree>(random.between(0.1, 0.5), place(), speed(), world.now());
      if (random.one_in(4)) body.collides_with = 0;  // then it is in no broad phase
      added.push_back(world.add_body(body));
      ask();  // before it has entered
    } else {
      std::size_t which = random.below(added.size());
      while (!world.contains(added[which])) which = (which + 1) % added.size();
      const BodyId id = added[which];
      if (dice == 3) {
        world.remove_body(id);
      } else {
        const Vector3d at = random.one_in(2) ? place() : world.motion(id).position(world.now());
        world.update_motion(id, path<Degree>(at, speed(), world.now()));
      }
      ask();
    }
    if (random.one_in(3)) {
      const bool frames_without_end = options.broad_phase == BroadPhaseKind::sap && options.window == never;
      if (!frames_without_end) world.next_time();  // which looks ahead
      ask();
    }
    world.advance_to(world.now() + random.between(0, 0.3));
  }
  return all;
}

TEMPLATE_TEST_CASE_SIG("A world names what is near, whatever its broad phase", "[world]", ((int Degree), Degree), 1,
                       2) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    std::size_t met = 0;
    std::vector<Ids> expected;
    for (const WorldOptions& options : all_ways()) {
      INFO("degree " << Degree << ", seed " << seed << ", broad phase " << static_cast<int>(options.broad_phase)
                     << ", window " << options.window);
      const auto all = answers<Degree>(options, seed, met);
      if (expected.empty()) expected = all;
      CHECK(all == expected);
    }
    CHECK(met > 500);
  }
}

TEST_CASE("Bodies touch a box from outside, enter at once and later, and collide with nothing", "[world]") {
  for (const WorldOptions& options : all_ways()) {
    INFO("broad phase " << static_cast<int>(options.broad_phase) << ", window " << options.window);
    WorldOptions without_walls = options;
    without_walls.walls.reset();
    World<1> world(without_walls);
    CHECK(near(world, Vector3d::Constant(-infinity), Vector3d::Constant(infinity)).empty());
    world.add_body(ball<1>(1, {0, 0, 0}, {0, 0, 0}));
    world.add_body(ball<1>(1, {5, 0, 0}, {0, 0, 0}, 2));  // enters later
    auto ghost = ball<1>(1, {0, 5, 0}, {0, 0, 0});
    ghost.category = 0;
    world.add_body(ghost);
    const Vector3d low = Vector3d::Constant(-9), high = Vector3d::Constant(9);
    CHECK(near(world, low, high) == Ids{0, 2});
    CHECK(near(world, {1, 0, 0}, {1, 0, 0}) == Ids{0});
    CHECK(near(world, {1 + 1e-9, 0, 0}, {2, 0, 0}).empty());
    world.advance_to(1);
    CHECK(near(world, low, high) == Ids{0, 2});
    world.advance_to(2);
    CHECK(near(world, low, high) == Ids{0, 1, 2});
    world.remove_body(0);
    CHECK(near(world, low, high) == Ids{1, 2});
  }
}

TEST_CASE("Questions that make no sense are refused", "[world]") {
  World<1> world(WorldOptions{});
  world.add_body(ball<1>(1, {0, 0, 0}, {0, 0, 0}));
  world.advance_to(1);
  const auto visit = [](BodyId) {};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(world.visit_overlapping({1, 0, 0}, {0, 1, 1}, visit), std::invalid_argument);
  CHECK_THROWS_AS(world.visit_overlapping({nan, 0, 0}, {0, 1, 1}, visit), std::invalid_argument);
  const auto box = box_around<1>(path<1>({0, 0, 0}, {0, 0, 0}, 1), -Vector3d::Ones(), Vector3d::Ones());
  CHECK_THROWS_AS(world.visit_swept(box, 0.5, visit), std::invalid_argument);
  CHECK_THROWS_AS(world.visit_swept(box, infinity, visit), std::invalid_argument);
  auto endless = box;
  endless.max.coefficients[1][0] = infinity;
  CHECK_THROWS_AS(world.visit_swept(endless, 2, visit), std::invalid_argument);
}

/// Asks in callbacks, and removes what it is told of.
struct Asker final : WorldListener<1> {
  std::size_t contacts = 0;

  void contact(World<1>& world, const PairEvent& event) override {
    ++contacts;
    const Vector3d at = world.motion(event.a).position(world.now());
    const Ids named = near(world, at, at);
    CHECK(std::binary_search(named.begin(), named.end(), event.a));
    world.visit_overlapping(at, at, [&](BodyId id) { world.remove_body(id); });
    CHECK(near(world, at, at).empty());
  }
};

TEST_CASE("Callbacks may ask, and visitors may change the world", "[world]") {
  for (const WorldOptions& options : all_ways()) {
    INFO("broad phase " << static_cast<int>(options.broad_phase) << ", window " << options.window);
    Asker asker;
    World<1> world(options, &asker);
    Random random(3);
    for (int i = 0; i < 70; ++i) {
      world.add_body(ball<1>(0.4, {1 + 2.0 * (i % 4), 1 + 2.0 * (i / 4 % 4), 1 + 1.6 * (i / 16)},
                             {random.between(-2, 2), random.between(-2, 2), random.between(-2, 2)}));
    }
    world.advance_to(6);
    CHECK(asker.contacts > 10);
    CHECK(world.size() + asker.contacts <= 70);
  }
}

}  // namespace
}  // namespace kds::collision::test_near
