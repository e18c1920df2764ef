// Snapshots that have been damaged, everywhere and in several ways: they are refused, or give a world that runs.
#include "collision/shapes/compound.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/random_scenes.hpp"
#include "tests/support/damaged_bytes.hpp"

#include <catch2/catch.hpp>

#include <chrono>
#include <cstddef>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::collision::test_damaged_snapshot {
namespace {

using namespace tests;

/// So long a single damaged snapshot may take, in s; most take some 0.1 ms, and what is beyond this does not end.
constexpr double most_seconds = 20;
/// How far a damaged world is run.
constexpr int most_steps = 40;

struct Outcome {
  std::size_t refused = 0, accepted = 0;
};

/// Audits, runs, saves and looks at a world that has been loaded. What it says of itself is right or wrong, but it
/// must say it.
template <int Degree>
void use(World<Degree>& world) {
  const auto audit = [&] {
    try {
      world.audit();
    } catch (const std::exception&) {
    }
  };
  audit();
  try {
    for (int i = 0; i < most_steps && world.step(world.now() + 1); ++i) audit();
    save(world);
    if (world.contains(0)) world.remove_body(0);
    world.add_body(ball<Degree>(0.5, {0.1, 0.2, 0.3}));
    for (int i = 0; i < most_steps && world.step(world.now() + 1); ++i) {
    }
  } catch (const std::exception&) {
  }
  for (BodySlot slot = 0; slot < 100; ++slot) {
    for (const BodyId id : {body_id(0, slot), body_id(1, slot)}) {
      if (world.contains(id)) world.free_motion(id);
    }
  }
}

template <int Degree>
void damage_everywhere(const Snapshot& snapshot, const WorldOptions& options, Outcome& outcome) {
  using Clock = std::chrono::steady_clock;
  World<Degree> kept(options);
  restore(snapshot, kept);
  const Snapshot before = save(kept);
  for (const kds::tests::Damage& damage : kds::tests::all_damages()) {
    for (std::size_t at = 0; at < snapshot.bytes().size(); ++at) {
      const std::vector<char> bytes = damage.of(snapshot.bytes(), at);
      if (bytes == snapshot.bytes()) continue;
      INFO(damage.name << " at byte " << at << " of " << bytes.size());
      const auto begun = Clock::now();
      World<Degree> world(options);
      std::string refusal;
      try {
        restore(Snapshot(bytes), world);
        ++outcome.accepted;
      } catch (const std::runtime_error& error) {
        refusal = error.what();
        ++outcome.refused;
      }
      if (refusal.empty()) {
        use(world);
      } else {
        if (refusal.find("snapshot: ") != 0) FAIL(refusal);
        if (at % 16 == 0) {
          CHECK_THROWS_AS(restore(Snapshot(bytes), kept), std::runtime_error);
          CHECK(save(kept) == before);
        }
      }
      const double seconds = std::chrono::duration<double>(Clock::now() - begun).count();
      if (seconds > most_seconds) FAIL("it took " << seconds << " s");
    }
  }
  CHECK(save(kept) == before);
}

/// Also what is cut off anywhere.
template <int Degree>
void damage(World<Degree>& world, const WorldOptions& options) {
  const Snapshot snapshot = save(world);
  Outcome outcome;
  damage_everywhere<Degree>(snapshot, options, outcome);
  CHECK(outcome.refused > 100);
  CHECK(outcome.accepted > 100);
  World<Degree> empty(options);
  for (std::size_t size = 0; size < snapshot.bytes().size(); size += 7) {
    const std::vector<char> cut(snapshot.bytes().begin(), snapshot.bytes().begin() + static_cast<std::ptrdiff_t>(size));
    CHECK_THROWS_AS(restore(Snapshot(cut), empty), std::runtime_error);
  }
  CHECK(empty.size() == 0);
}

TEST_CASE("damaged: balls between walls", "[world][snapshot][damaged]") {
  WorldOptions options = with_response(Response::elastic);
  options.walls = Walls{Vector3d::Constant(-4), Vector3d::Constant(4)};
  World<1> world(options);
  for (int i = 0; i < 4; ++i) world.add_body(ball<1>(1, {1.9 * i - 3, 0, 0}, {-1, 0.25 * i, 0}));
  world.add_body(ball<1>(0.5, {0, 3, 0}));
  world.advance_to(0.5);
  world.remove_body(1);
  damage(world, options);
}

TEST_CASE("damaged: boxes that pass through each other, reports that are still to be made",
          "[world][snapshot][damaged]") {
  WorldOptions options;
  options.report_pairs = true;
  World<1> world(options);
  for (int i = 0; i < 4; ++i) {
    auto one = box<1>({1, 0.5, 0.75}, {1.5 * i, 0.1 * i, 0}, {0.1 * i, 0, 0});
    if (i % 2 == 1) one.orientation = Eigen::Quaterniond(1, 0.5, 0.25, i).normalized();
    world.add_body(one);
  }
  world.add_body(ball<1>(1, {2, 0, 0}));
  world.advance_to(0.25);
  REQUIRE(world.touching(0, 1));
  world.update_motion(1, motion<1>({50, 0, 0}));  // it separates
  world.remove_body(4);
  world.add_body(ball<1>(1, {3, 0, 0}));
  damage(world, options);
}

TEST_CASE("damaged: meshes", "[world][snapshot][damaged]") {
  const WorldOptions options = with_response(Response::elastic);
  World<1> world(options);
  world.add_body(body<1>(MeshShape{tetrahedron(), 1}, motion<1>({0, 0, 0}, {1, 0, 0})));
  world.add_body(body<1>(MeshShape{tetrahedron(), 0.5}, motion<1>({4, 0, 0}, {-1, 0, 0})));
  world.add_body(ball<1>(1, {0, 4, 0}, {0, -1, 0}));
  world.advance_to(0.5);
  damage(world, options);
}

TEST_CASE("damaged: hulls", "[world][snapshot][damaged]") {
  const WorldOptions options = with_response(Response::elastic);
  World<1> world(options);
  for (int i = 0; i < 2; ++i) {
    auto one = body<1>(convex_hull({{0.5, 0, 0}, {-0.5, 0, 0.25}, {0, 0.5, 0}, {0, 0, 0.5 * (i + 1)}}),
                       motion<1>({1.5 * i, 0.1 * i, 0}, {1.0 - i, 0, 0}));
    if (i > 0) one.orientation = Eigen::Quaterniond(1, 0.5, 0.25, i).normalized();
    world.add_body(one);
  }
  world.advance_to(0.25);
  damage(world, options);
}

TEST_CASE("damaged: compounds", "[world][snapshot][damaged]") {
  const WorldOptions options = with_response(Response::elastic);
  World<1> world(options);
  const std::vector<CompoundPart> parts{{Box{{0.25, 0.5, 0.25}}, {0.5, 0, 0}}, {MeshShape{tetrahedron(), 0.25}}};
  auto one = body<1>(compound(parts), motion<1>(zero, {1, 0, 0}));
  one.orientation = Eigen::Quaterniond(1, 0.5, 0.25, 1).normalized();
  world.add_body(one);
  world.add_body(ball<1>(0.5, {1.5, 0.1, 0}));
  world.advance_to(0.25);
  damage(world, options);
}

TEST_CASE("damaged: capsules", "[world][snapshot][damaged]") {
  const WorldOptions options = with_response(Response::elastic);
  World<1> world(options);
  for (int i = 0; i < 3; ++i) {
    auto one = body<1>(Capsule{0.5, 0.25 * (i + 1)}, motion<1>({1.5 * i, 0.1 * i, 0}, {1.0 - i, 0, 0}));
    if (i > 0) one.orientation = Eigen::Quaterniond(1, 0.5, 0.25, i).normalized();
    world.add_body(one);
  }
  world.advance_to(0.25);
  damage(world, options);
}

TEST_CASE("damaged: a heap at rest", "[world][snapshot][damaged]") {
  WorldOptions options = with_response(Response::elastic);
  options.walls = Walls{Vector3d(-1, -1, 0), Vector3d(1, 1, 9)};
  options.walls->restitution = 0;
  World<2> world(options);
  for (int i = 0; i < 3; ++i) {
    auto one = ball<2>(0.4, Vector3d(0, 0, 0.5 + i), zero, Vector3d(0, 0, -5));
    one.restitution = 0;
    world.add_body(one);
  }
  world.advance_to(4);
  REQUIRE(world.resting_at_wall(0, 4));
  REQUIRE(world.resting(0, 1));
  auto pushed = world.free_motion(2).restarted(world.now());
  pushed.coefficients[1] = Vector3d(0.5, 0, 0);
  world.update_motion(2, pushed);  // what holds it is to be looked at
  damage(world, options);
}

TEST_CASE("damaged: what rests on a fixed body, a sensor that is attached, timers", "[world][snapshot][damaged]") {
  const WorldOptions options = with_response(Response::elastic);
  World<2> world(options);
  auto lies = box<2>({0.5, 0.25, 0.25}, {0, 0, 0.25}, zero);
  lies.motion[0].coefficients[2] = Vector3d(0, 0, -1);
  lies.restitution = 0;
  const BodyId crate = world.add_body(lies);
  auto floor = body<2>(HalfSpace{Vector3d(0, 0, 1), 0}, motion<2>(zero));
  floor.fixed = true;
  const BodyId below = world.add_body(floor);
  world.add_body({.shape = Sphere{2}, .sensor = true, .attached_to = crate});
  world.add_body(ball<2>(0.25, {3, 0, 1}, {-1, 0, 0}, {0, 0, -1}));
  world.set_timer(5);
  world.advance_to(1);
  REQUIRE(world.resting(crate, below));
  damage(world, options);
}

TEST_CASE("damaged: scripts and bodies still to come", "[world][snapshot][damaged]") {
  const WorldOptions options = with_response(Response::callback);
  World<2> world(options);
  auto scripted = ball<2>(1, {0, 0, 0}, {1, 0, 0});
  scripted.motion.push_back(motion<2>({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 1));
  scripted.motion.push_back(motion<2>({1, 2, 0}, {0, 1, 0}, {0, 0, 1}, 3));
  world.add_body(scripted);
  auto later = box<2>({1, 1, 1}, {4, 0, 0});
  later.motion[0].start = 2;
  world.add_body(later);
  world.add_body(ball<2>(1, {1.5, 0, 0}, {1, 0, 0}));
  world.advance_to(0.5);
  world.add_body(ball<2>(1, {9, 0, 0}));
  damage(world, options);
}

}  // namespace
}  // namespace kds::collision::test_damaged_snapshot
