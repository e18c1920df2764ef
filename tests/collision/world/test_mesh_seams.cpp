// Bodies that slide over meshes whose faces lie in one plane: as over a box with the same upper face.
#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/mesh.hpp"
#include "kds/framework/snapshot.hpp"
#include "tests/collision/world/resting_scenes.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

namespace kds::collision::test_mesh_seams {
namespace {

using namespace tests;

constexpr std::uint32_t squares = 24;
constexpr double half = 12;  // of the floor's side
constexpr double up = 0.5;   // of each slider's centre over the floor

/// How the vertices of a flat sheet come to be.
enum class Made { exactly, rounded, by_its_body };

Eigen::Quaterniond tilt() { return unit_quaternion(1, 0.1, 0.2, 0.05); }

/// Squares of two triangles each in the plane z = 0.
std::shared_ptr<const Mesh> sheet(const Eigen::Matrix3d& turn) {
  std::vector<Vector3d> vertices;
  std::vector<Mesh::Triangle> triangles;
  for (std::uint32_t y = 0; y <= squares; ++y) {
    for (std::uint32_t x = 0; x <= squares; ++x) {
      vertices.push_back(turn * Vector3d(x - half, y - half, 0));
      if (x == 0 || y == 0) continue;
      const std::uint32_t here = y * (squares + 1) + x, below = here - squares - 1;
      triangles.push_back({below - 1, below, here});
      triangles.push_back({below - 1, here, here - 1});
    }
  }
  return std::make_shared<const Mesh>(std::move(vertices), std::move(triangles));
}

ConvexHull prism() {
  std::vector<Vector3d> points;
  for (const double z : {-up, up}) {
    for (const auto& [x, y] : {std::array{0.6, 0.1}, {0.2, 0.6}, {-0.5, 0.4}, {-0.4, -0.5}, {0.3, -0.6}}) {
      points.emplace_back(x, y, z);
    }
  }
  return {std::make_shared<const Polytope>(points)};
}

struct Slider {
  Shape shape;
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

std::vector<Slider> sliders() {
  return {{Sphere{up}},
          {Box{{0.4, 0.3, up}}, unit_quaternion(1, 0, 0, 0.2)},
          {Capsule{0.3, 0.2}},
          {Capsule{up, 0.4}, unit_quaternion(1, 0, 1, 0)},
          {prism()}};
}

template <int Degree>
struct Tally final : WorldListener<Degree> {
  void contact(World<Degree>&, const PairEvent&) override { ++contacts; }
  std::size_t contacts = 0;
};

template <int Degree>
void fill(World<Degree>& world, bool on_mesh, Made made, const Slider& slider, const Vector3d& velocity) {
  const Eigen::Quaterniond turned = made == Made::exactly ? Eigen::Quaterniond::Identity() : tilt();
  const Eigen::Matrix3d turn = turned.toRotationMatrix();
  auto floor = fixed_body<Degree>(Box{{half, half, 1}}, motion<Degree>(turn * Vector3d(0, 0, -1)));
  floor.orientation = turned;
  if (on_mesh) {
    floor.shape = MeshShape{sheet(made == Made::rounded ? turn : Eigen::Matrix3d::Identity())};
    floor.motion = {motion<Degree>({0, 0, 0})};
    if (made == Made::rounded) floor.orientation = Eigen::Quaterniond::Identity();
  }
  floor.restitution = 0;
  world.add_body(floor);
  auto path = motion<Degree>(turn * Vector3d(-10, -9, up + 0.01), turn * (velocity + Vector3d(0, 0, -0.05)));
  if constexpr (Degree >= 2) path.coefficients[2] = turn * weight;
  auto body = bouncy(tests::body<Degree>(slider.shape, path), 0);
  body.orientation = turned * slider.orientation;
  world.add_body(body);
}

TEMPLATE_TEST_CASE_SIG("Seams: what slides over a flat mesh meets it once, and moves as on a box", "[degenerate]",
                       ((int Degree), Degree), 1, 2) {
  // Across squares and their diagonals; along edges, from vertex to vertex; along diagonals.
  const std::array velocities{Vector3d(3, 1.7, 0), Vector3d(3, 0, 0), Vector3d(2, 2, 0)};
  for (const Made made : {Made::exactly, Made::rounded, Made::by_its_body}) {
    for (const Slider& slider : sliders()) {
      for (const Vector3d& velocity : velocities) {
        INFO("made " << static_cast<int>(made) << ", shape " << slider.shape.index() << ", to " << velocity[0] << ", "
                     << velocity[1]);
        Tally<Degree> tally;
        World<Degree> on_box(elastic(BroadPhaseKind::automatic));
        World<Degree> on_mesh(elastic(BroadPhaseKind::automatic), &tally);
        fill(on_box, false, made, slider, velocity);
        fill(on_mesh, true, made, slider, velocity);
        on_box.advance_to(5), on_mesh.advance_to(5);
        CHECK(tally.contacts == 1);
        CHECK(on_mesh.resting(0, 1));
        // The contact is early by the gap, some 1e-13 here; an edge is struck along a normal that is off by the way to
        // it.
        CHECK((on_mesh.motion(1).position(5) - on_box.motion(1).position(5)).norm() < 1e-9);
        CHECK((on_mesh.motion(1).velocity(5) - on_box.motion(1).velocity(5)).norm() < 1e-10);
        on_mesh.audit();
      }
    }
  }
}

TEST_CASE("Seams: windows and snapshots make no difference", "[degenerate]") {
  for (const Slider& slider : sliders()) {
    INFO("shape " << slider.shape.index());
    WorldOptions short_windows = elastic(BroadPhaseKind::automatic);
    short_windows.window = 0.07;
    World<2> world(elastic(BroadPhaseKind::automatic)), loaded(elastic(BroadPhaseKind::automatic));
    World<2> step_by_step(short_windows);
    for (World<2>* each : {&world, &step_by_step}) fill(*each, true, Made::rounded, slider, {3, 0.7, 0});
    world.advance_to(2);
    restore(save(world), loaded);
    for (int i = 1; i <= 90; ++i) step_by_step.advance_to(0.1 * i);
    for (World<2>* each : {&world, &loaded}) each->advance_to(9);
    CHECK_FALSE(world.resting(0, 1));  // it has slid off
    CHECK(loaded.motion(1) == world.motion(1));
    CHECK(step_by_step.motion(1).restarted(9) == world.motion(1).restarted(9));
  }
}

TEST_CASE("Seams: balls that strike each other on a flat mesh do so as on a box", "[degenerate]") {
  std::array<std::size_t, 2> contacts{};
  for (const bool on_mesh : {false, true}) {
    Tally<2> tally;
    World<2> world(elastic(BroadPhaseKind::automatic), &tally);
    fill(world, on_mesh, Made::exactly, sliders().front(), {3, 0.4, 0});
    for (int i = 0; i < 12; ++i) {
      const Vector3d place(-8.0 + 1.3 * i, -8.5 + 0.37 * (i % 5), up + 0.02 * (i % 3));
      world.add_body(bouncy(ball<2>(up, place, {0, 0.1 * (i % 4), 0}, weight), 0.9));
    }
    world.advance_to(6);
    world.audit();
    contacts[on_mesh] = tally.contacts;
  }
  CHECK(contacts[0] > 20);
  CHECK(contacts[1] == contacts[0]);
}

TEST_CASE("Seams: a box is stopped by a wall of the mesh that it slides on, and by nothing before", "[degenerate]") {
  const Mesh flat = *sheet(Eigen::Matrix3d::Identity());
  std::vector<Vector3d> vertices(flat.vertices().begin(), flat.vertices().end());
  std::vector<Mesh::Triangle> triangles(flat.triangles().begin(), flat.triangles().end());
  const auto first = static_cast<std::uint32_t>(vertices.size());
  for (const auto& [y, z] : {std::array{-half, 0.0}, {half, 0.0}, {half, 2.0}, {-half, 2.0}})
    vertices.emplace_back(5, y, z);
  triangles.push_back({first, first + 1, first + 2});
  triangles.push_back({first, first + 2, first + 3});
  World<2> world(elastic(BroadPhaseKind::automatic));
  fill(world, true, Made::exactly, {Box{{0.4, 0.3, up}}}, {3, 0, 0});
  world.remove_body(0);
  auto floor = fixed_body<2>(MeshShape{std::make_shared<const Mesh>(vertices, triangles)}, motion<2>({0, 0, 0}));
  floor.restitution = 0;
  world.add_body(floor);
  world.advance_to(4);
  CHECK(world.motion(1).position(4)[0] == Approx(-10 + 3 * 4));
  world.advance_to(6);
  CHECK(world.motion(1).position(6)[0] == Approx(5 - 0.4).epsilon(1e-9));
  CHECK(world.motion(1).velocity(6).norm() < 1e-12);
  world.audit();
}

}  // namespace
}  // namespace kds::collision::test_mesh_seams
