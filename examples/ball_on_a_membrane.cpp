// You learn: how a simulator gives a world the next step of a membrane, on which a ball bounces.
// How to run: build/dev/examples/ball_on_a_membrane
// What you see: t = 0.59544: the ball leaves f72 at 1.7619 m/s
#include "collision/shapes/mesh_script.hpp"
#include "collision/world.hpp"

#include <cmath>
#include <cstdint>
#include <iostream>
#include <memory>
#include <vector>

using namespace kds::collision;
using Eigen::Vector3d;
using Motion = kds::certificates::PointMotion<2>;

/// A square membrane, held at its rim: its heights obey the wave equation.
struct Membrane {
  static constexpr std::uint32_t n = 8;
  static constexpr double h = 1.0 / 64;  // s, of a step
  std::vector<Vector3d> positions;
  std::vector<double> speeds = std::vector<double>((n + 1) * (n + 1), 0.0);
  std::vector<Mesh::Triangle> triangles;

  Membrane() {
    for (std::uint32_t i = 0; i <= n; ++i) {
      for (std::uint32_t j = 0; j <= n; ++j) {
        const double x = 2.0 * i / n - 1, y = 2.0 * j / n - 1;
        positions.emplace_back(x, y, 0.5 * (1 - x * x) * (1 - y * y));  // it is pulled up, and let go
      }
    }
    for (std::uint32_t i = 0; i < n; ++i) {
      for (std::uint32_t j = 0; j < n; ++j) {
        const std::uint32_t a = i * (n + 1) + j, b = a + n + 1;
        triangles.push_back({a, b, b + 1});
        triangles.push_back({a, b + 1, a + 1});
      }
    }
  }

  void step() {
    const auto height = [&](std::size_t v) { return positions[v][2]; };
    for (std::size_t i = 1; i < n; ++i) {
      for (std::size_t v = i * (n + 1) + 1; v < i * (n + 1) + n; ++v) {
        const double bend = height(v - 1) + height(v + 1) + height(v - n - 1) + height(v + n + 1) - 4 * height(v);
        speeds[v] += 64 * bend * h;
      }
    }
    for (std::size_t v = 0; v < positions.size(); ++v) positions[v][2] += speeds[v] * h;
  }
};

struct Teller : WorldListener<2> {
  void contact(World<2>& world, const PairEvent& event) override {
    const double speed = world.motion(event.b).velocity(world.now())[2];
    std::cout << "t = " << std::round(event.contact.time * 1e5) / 1e5 << ": the ball leaves "
              << to_string(event.contact.feature_a) << " at " << std::round(speed * 1e4) / 1e4 << " m/s\n";
  }
};

int main() {
  Membrane membrane;
  Teller teller;
  World<2> world({.response = Response::elastic}, &teller);
  const Motion at_rest = Motion::line(Vector3d::Zero(), Vector3d::Zero());
  const BendingMesh shape{std::make_shared<const MeshScript>(std::vector<MeshScript::Keyframe>{{0, membrane.positions}},
                                                             membrane.triangles)};
  const BodyId sheet = world.add_body({.shape = shape, .motion = {at_rest}, .fixed = true, .restitution = 0.75});
  const Vector3d gravity(0, 0, -9.81);
  world.add_body(
      {.shape = Sphere{0.25}, .motion = {Motion::parabola(Vector3d(0.03, 0.02, 1.5), Vector3d::Zero(), gravity)}});
  while (world.now() < 3) {
    membrane.step();
    const double t1 = world.now() + Membrane::h;
    world.update_vertices(sheet, {{t1, membrane.positions}});
    world.advance_to(t1);
  }
}
