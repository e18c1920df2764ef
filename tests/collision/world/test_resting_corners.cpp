// Resting contacts where something is at its limit: grooves of meshes, collapses where nothing falls, large clocks, and
// bodies that go before they come to rest.
#include "collision/shapes/mesh.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/world/resting_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

namespace kds::collision::test_resting_corners {
namespace {

using namespace tests;
using Triangles = std::vector<Mesh::Triangle>;

struct Tally final : WorldListener<2> {
  void contact(World<2>&, const PairEvent&) override { ++contacts; }
  void passes(World<2>&, const PairEvent&) override { ++passed; }
  std::size_t contacts = 0;
  std::size_t passed = 0;
};

constexpr int sides = 12;
constexpr double pit_radius = 6;
constexpr double pit_height = 3;

/// A pyramid upside down, its tip at the origin.
std::shared_ptr<const Mesh> pit() {
  std::vector<Vector3d> vertices{Vector3d::Zero()};
  Triangles triangles;
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double turn = 2 * std::numbers::pi * i / sides;
    vertices.emplace_back(pit_radius * std::cos(turn), pit_radius * std::sin(turn), pit_height);
    triangles.push_back({0, 1 + i, 1 + (i + 1) % sides});
  }
  return std::make_shared<const Mesh>(std::move(vertices), std::move(triangles));
}

TEST_CASE("Resting: a ball that falls into a pit of any six faces meets them a few hundred times at most",
          "[degenerate]") {
  constexpr std::uint32_t faces = 6;
  std::vector<std::uint64_t> many;  // seeds
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Random random(seed);
    std::vector<Vector3d> vertices{{0, 0, -random.between(0.5, 1)}};
    Triangles triangles;
    for (std::uint32_t i = 0; i < faces; ++i) {
      const double turn = 2 * std::numbers::pi * i / faces;
      vertices.emplace_back(std::cos(turn), std::sin(turn), random.between(-0.1, 0.6));
      triangles.push_back({0, 1 + i, 1 + (i + 1) % faces});
    }
    Tally tally;
    World<2> world(elastic(BroadPhaseKind::automatic), &tally);
    world.add_body(fixed_body<2>(MeshShape{std::make_shared<const Mesh>(vertices, triangles)}, motion<2>({0, 0, 0})));
    const Vector3d place(random.between(-0.3, 0.3), random.between(-0.3, 0.3), 1);
    const double radius = random.between(0.05, 0.4);
    world.add_body(bouncy(ball<2>(radius, place, {0, 0, 0}, weight), random.between(0, 0.5)));
    for (int i = 1; i <= 20 && tally.contacts < 2500; ++i) world.advance_to(0.2 * i);
    world.audit();
    if (tally.contacts >= 2500) many.push_back(seed);
  }
  CHECK(many == std::vector<std::uint64_t>{});
}

TEST_CASE("Resting: balls slide from side to side of a pit that is a mesh, and meet each but once in a while",
          "[degenerate]") {
  constexpr double radius = 0.5;
  const auto mesh = pit();
  std::vector<Vector3d> normals;
  for (const Mesh::Triangle& t : mesh->triangles()) {
    normals.push_back(mesh->vertices()[t[1]].cross(mesh->vertices()[t[2]]).normalized());
  }
  for (int seed = 0; seed < 10; ++seed) {
    INFO("seed " << seed);
    Tally tally;
    World<2> world(elastic(BroadPhaseKind::automatic), &tally);
    world.add_body(fixed_body<2>(MeshShape{mesh, 1}, motion<2>({0, 0, 0})));
    world.add_body(bouncy(ball<2>(radius, {1.5, -1, 3}, {0.1 * seed, 0.5, 0}, weight), 0.3));
    world.add_body(bouncy(ball<2>(radius, {-1, 1, 3}, {0, -0.5, 0.1 * seed}, weight), 0.3));
    double deepest = 0;
    while (tally.contacts < 20'000 && world.step(20)) {
      for (const BodyId id : {BodyId{1}, BodyId{2}}) {
        const Vector3d place = world.motion(id).position(world.now());
        for (const Vector3d& normal : normals) deepest = std::max(deepest, radius - normal.dot(place));
      }
    }
    CHECK(deepest <= 1e-9 * radius);
    CHECK(tally.contacts < 20'000);
    CHECK(tally.passed == 0);
    world.audit();
  }
}

/// Squares with the side 1 in the plane z = 0, of two triangles each.
std::shared_ptr<const Mesh> sheet(std::uint32_t length, std::uint32_t width) {
  std::vector<Vector3d> vertices;
  Triangles triangles;
  for (std::uint32_t y = 0; y <= width; ++y) {
    for (std::uint32_t x = 0; x <= length; ++x) {
      vertices.emplace_back(x - 0.5 * length, y - 0.5 * width, 0);
      const std::uint32_t here = y * (length + 1) + x, below = here - length - 1;
      if (x == 0 || y == 0) continue;
      triangles.push_back({below - 1, below, here});
      triangles.push_back({below - 1, here, here - 1});
    }
  }
  return std::make_shared<const Mesh>(std::move(vertices), std::move(triangles));
}

TEST_CASE("Resting: a ball slides alone over the faces of a mesh as over a box, and off it", "[degenerate]") {
  const MeshShape mesh{sheet(40, 8)};
  for (const double tilt : {0.0, 0.02}) {
    INFO("tilt " << tilt);
    const Eigen::Quaterniond turned = unit_quaternion(std::cos(tilt), tilt / 4, std::sin(tilt), 0);
    const auto floor = [&](const Shape& shape, const Vector3d& at) {
      auto body = fixed_body<2>(shape, motion<2>(turned * at));
      body.orientation = turned;
      return body;
    };
    WorldOptions short_windows = elastic();
    short_windows.window = 0.03;
    World<2> on_box(elastic()), on_mesh(elastic()), loaded(elastic()), step_by_step(short_windows);
    on_box.add_body(floor(Box{{20, 4, 1}}, {0, 0, -1}));
    for (World<2>* world : {&on_mesh, &step_by_step}) world->add_body(floor(mesh, {0, 0, 0}));
    for (World<2>* world : {&on_box, &on_mesh, &step_by_step}) {
      const Vector3d start = turned * Vector3d(-18, -1.3, 0.6), velocity = turned * Vector3d(4, 0.3, 0);
      world->add_body(bouncy(ball<2>(0.5, start, velocity, weight), 0));
    }
    for (const double t : {1.0, 3.0, 5.0}) {
      on_box.advance_to(t), on_mesh.advance_to(t);
      CHECK(on_mesh.resting(0, 1));
      CHECK((on_mesh.motion(1).position(t) - on_box.motion(1).position(t)).norm() < 2e-5);
      CHECK((on_mesh.motion(1).velocity(t) - on_box.motion(1).velocity(t)).norm() < 2e-5);
      on_mesh.audit();
      if (t == 3) restore(save(on_mesh), loaded);
    }
    CHECK(on_mesh.counters().contacts == 1);  // no edge is met
    for (World<2>* world : {&on_mesh, &loaded, &step_by_step}) {
      world->advance_to(14);
      CHECK_FALSE(world->resting(0, 1));
      CHECK(world->motion(1).position(14)[2] < -2);
    }
    CHECK(on_mesh.motion(1) == loaded.motion(1));
    CHECK(on_mesh.motion(1) == step_by_step.motion(1));
  }
}

TEST_CASE("Resting: a chain of balls that collapses where nothing accelerates it passes nothing through",
          "[degenerate]") {
  Tally tally;
  World<2> world(elastic(BroadPhaseKind::automatic), &tally);
  const double masses[] = {0.125, 0.125, 0.1563425466632892, 0.125, 0.125, 0.01373323562172336, 0.125};
  const double places[] = {0, 1000, 2000, 3000, 4000, -1500, -2500};
  for (int i = 0; i < 7; ++i) {
    const double speed = i == 5 ? 1884.8217698749527 : i == 6 ? 2909.9173379356362 : 0;
    world.add_body(bouncy(ball<2>(500, {places[i], 500, 0}, {speed, 0, 0}, zero), 0.3, masses[i]));
  }
  world.advance_to(20);
  CHECK(tally.passed == 0);
  std::vector<double> found;
  for (const BodyId id : {6, 5, 0, 1, 2, 3, 4}) found.push_back(world.motion(id).position(20)[0]);
  for (std::size_t i = 1; i < found.size(); ++i) CHECK(found[i] - found[i - 1] >= 1000 * (1 - 1e-9));
  world.audit();
}

TEST_CASE("Resting: on a large clock bodies that met by some spacings of it too late lie still, and that is no defect",
          "[degenerate]") {
  WorldOptions options = elastic(BroadPhaseKind::automatic);
  options.start_time = 1e9;
  World<2> world(options);
  auto path = motion<2>({-1.7, 0, 0}, {7, 0, 0});
  path.start = 1e9;
  const BodyId a = world.add_body(bouncy(body<2>(Box{{1, 1, 1}}, path), 0));
  path = motion<2>({1.7, 0, 0});
  path.start = 1e9;
  const BodyId b = world.add_body(fixed_body<2>(Box{{1, 1, 1}}, path));
  while (world.step(1e9 + 5)) world.audit();
  world.audit();
  CHECK(world.resting(a, b));
}

TEST_CASE("Resting: a body goes that was to come to rest a little later, and the world is saved", "[degenerate]") {
  WorldOptions options = elastic(BroadPhaseKind::automatic);
  options.walls = Walls{Vector3d::Constant(-5), Vector3d::Constant(5), 0x1p-30};
  World<2> world(options);
  world.add_body(ball<2>(1, {-3, 0, -3}, {0, -3, 0}, zero));
  const BodyId goes =
      world.add_body(bouncy(body<2>(Box{{1, 1, 1}}, motion<2>({-2, -3, -2}, {0, 0, 0}, {-1, 0, 0})), 0.999));
  world.advance_to(2);
  world.remove_body(goes);
  World<2> loaded(options);
  restore(save(world), loaded);
  loaded.advance_to(3);
  world.advance_to(3);
  loaded.audit();
  CHECK(loaded.motion(0) == world.motion(0));
}

}  // namespace
}  // namespace kds::collision::test_resting_corners
