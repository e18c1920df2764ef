#include "examples/kds-collide/model_meshes.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace kds_collide {

using namespace kds::io;

namespace {

using Eigen::Vector3d;

/// Coordinates of models are written with nine digits after the point: sin and cos may differ in their last bit
/// between machines, the rounded values do not.
constexpr double model_digits = 1e9;

/// Triangles of a grid of vertices closed in both directions, two for each cell.
std::vector<std::array<std::uint32_t, 3>> torus_triangles(std::uint32_t around, std::uint32_t across) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const std::uint32_t next_i = (i + 1) % around;
      const std::uint32_t next_j = (j + 1) % across;
      const std::array<std::uint32_t, 4> quad{i * across + j, next_i * across + j, next_i * across + next_j,
                                              i * across + next_j};
      triangles.push_back({quad[0], quad[1], quad[2]});
      triangles.push_back({quad[0], quad[2], quad[3]});
    }
  }
  return triangles;
}

/// A surface closed in both directions, from a function of two angles; scaled to a bounding radius of 1.
MeshData closed_surface(std::uint32_t around, std::uint32_t across,
                        const std::function<Vector3d(double, double)>& point) {
  constexpr double turn = 2 * std::numbers::pi;
  MeshData mesh;
  double radius = 0;
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      mesh.vertices.push_back(point(turn * i / around, turn * j / across));
      radius = std::max(radius, mesh.vertices.back().norm());
    }
  }
  for (Vector3d& v : mesh.vertices) {
    v /= radius;
    for (int d = 0; d < 3; ++d) v[d] = std::round(v[d] * model_digits) / model_digits;
  }
  mesh.triangles = torus_triangles(around, across);
  return mesh;
}

}  // namespace

MeshData ring_mesh() {
  // Eight sections of four corners: cosines of 45 degrees only, so that every machine has the same bits.
  const double r = std::sqrt(0.5);
  const std::array<std::array<double, 2>, 8> circle{
      {{1, 0}, {r, r}, {0, 1}, {-r, r}, {-1, 0}, {-r, -r}, {0, -1}, {r, -r}}};
  constexpr double ring = 0.75;
  constexpr double tube = 0.25;
  MeshData mesh;
  for (const auto& [c, s] : circle) {
    for (std::size_t corner = 0; corner < 8; corner += 2) {
      const double away = ring + tube * circle[corner][0];
      mesh.vertices.emplace_back(away * c, away * s, tube * circle[corner][1]);
    }
  }
  mesh.triangles = torus_triangles(8, 4);
  return mesh;
}

MeshData knot_mesh() {
  const auto centre = [](double u) {
    const double r = 2 + std::cos(3 * u);
    return Vector3d(r * std::cos(2 * u), r * std::sin(2 * u), -std::sin(3 * u));
  };
  return closed_surface(200, 16, [&](double u, double v) {
    const Vector3d forward = (centre(u + 1e-4) - centre(u - 1e-4)).normalized();
    // The torus that carries the knot gives a frame that closes on itself.
    const Vector3d core(2 * std::cos(2 * u), 2 * std::sin(2 * u), 0);
    const Vector3d outward = centre(u) - core;
    const Vector3d side = (outward - forward * forward.dot(outward)).normalized();
    return Vector3d(centre(u) + 0.42 * (side * std::cos(v) + side.cross(forward) * std::sin(v)));
  });
}

MeshData bumpy_torus_mesh() {
  return closed_surface(96, 34, [](double u, double v) {
    const double tube = 0.42 + 0.07 * std::sin(7 * u) * std::cos(3 * v);
    const double r = 1 + tube * std::cos(v);
    return Vector3d(r * std::cos(u), r * std::sin(u), tube * std::sin(v));
  });
}

}  // namespace kds_collide
