// You learn: how a simulator of cloth asks in which of its steps the cloth meets a ball, or itself.
// How to run: build/dev/examples/cloth_on_a_ball
// What you see: step 6: at t = 0.80357 v40 of the sheet meets the ball at the height 0.5
#include "collision/deforming/deforming_mesh.hpp"
#include "collision/deforming/rigid_surface.hpp"
#include "collision/deforming/surface_contact.hpp"

#include <cmath>
#include <cstdint>
#include <iostream>
#include <vector>

using namespace kds::collision;
using Eigen::Vector3d;

int main() {
  // A square sheet at the height 2, of 8 x 8 squares.
  constexpr std::uint32_t n = 8;
  std::vector<Vector3d> positions;
  std::vector<Mesh::Triangle> triangles;
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t j = 0; j <= n; ++j) positions.emplace_back(2.0 * i / n - 1, 2.0 * j / n - 1, 2);
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t a = i * (n + 1) + j, b = a + n + 1;
      triangles.push_back({a, b, b + 1});
      triangles.push_back({a, b + 1, a + 1});
    }
  }
  DeformingMesh<1> cloth(positions, triangles);
  RigidSurface<1> ball(place(Sphere{0.5}, Eigen::Quaterniond::Identity()));
  const auto at_rest = kds::certificates::PointMotion<1>::line(Vector3d::Zero(), Vector3d::Zero());

  constexpr double h = 0.125;  // s, of a step
  for (int step = 0; step < 8; ++step) {
    // A simulator would say where the vertices are at the end of the step. Here they fall, the middle ahead.
    const double t1 = (step + 1) * h;
    for (Vector3d& p : positions) p[2] -= (4 - p.head<2>().squaredNorm()) * t1 * h;
    cloth.step_to(t1, positions);
    ball.move(at_rest, step * h, t1);
    if (const auto meets = first_contact(cloth.surface(), ball.surface())) {
      const auto& [time, point, normal, feature, of_ball] = meets->contact;
      std::cout << "step " << step << ": at t = " << std::round(time * 1e5) / 1e5 << " " << feature
                << " of the sheet meets the ball at the height " << std::round(point[2] * 1e5) / 1e5 << '\n';
      return 0;
    }
    if (first_self_contact(cloth.surface())) std::cout << "step " << step << ": the sheet meets itself\n";
  }
}
