// Meshes, orientations and motions that the tests and the benchmark of meshes use.
#pragma once

#include "collision/narrow_phase/relative_motion.hpp"
#include "collision/shapes/mesh.hpp"
#include "collision/shapes/shape.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace kds::collision::samples {

using Eigen::Vector3d;

/// The same numbers from a seed with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(engine_() % n); }
  Vector3d vector(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }
  Vector3d direction() {
    for (;;) {
      const Vector3d v = vector(1);
      if (v.squaredNorm() > 0.01 && v.squaredNorm() < 1) return v.normalized();
    }
  }
  Eigen::Quaterniond orientation() {
    const Vector3d axis = direction();
    return Eigen::Quaterniond(Eigen::AngleAxisd(uniform(0, 6.28), axis)).normalized();
  }

 private:
  std::mt19937_64 engine_;
};

/// A torus about z of 2 * around * across triangles; bump > 0 waves its surface.
inline std::shared_ptr<const Mesh> torus(std::uint32_t around, std::uint32_t across, double radius = 0.75,
                                         double thickness = 0.25, double bump = 0) {
  std::vector<Vector3d> vertices;
  std::vector<Mesh::Triangle> triangles;
  for (std::uint32_t i = 0; i < around; ++i) {
    const double u = 2 * std::numbers::pi * i / around;
    for (std::uint32_t j = 0; j < across; ++j) {
      const double v = 2 * std::numbers::pi * j / across;
      const double t = thickness * (1 + bump * std::sin(7 * u) * std::sin(3 * v));
      const double r = radius + t * std::cos(v);
      vertices.emplace_back(r * std::cos(u), r * std::sin(u), t * std::sin(v));
      const auto at = [&](std::uint32_t p, std::uint32_t q) { return (p % around) * across + q % across; };
      triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return std::make_shared<const Mesh>(std::move(vertices), std::move(triangles));
}

/// A box of 12 triangles, its vertices numbered as those of the solid box.
inline std::shared_ptr<const Mesh> cuboid(const Vector3d& half = Vector3d::Ones()) {
  std::vector<Vector3d> vertices;
  for (int i = 0; i < 8; ++i) {
    vertices.emplace_back((i & 1 ? 1 : -1) * half[0], (i & 2 ? 1 : -1) * half[1], (i & 4 ? 1 : -1) * half[2]);
  }
  std::vector<Mesh::Triangle> triangles{{0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}, {0, 1, 4}, {1, 5, 4},
                                        {2, 6, 3}, {3, 6, 7}, {0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}};
  return std::make_shared<const Mesh>(std::move(vertices), std::move(triangles));
}

/// A regular octahedron whose faces are split `levels` times and pushed out to the unit sphere.
inline std::shared_ptr<const Mesh> ball_mesh(int levels) {
  std::vector<Vector3d> vertices{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::vector<Mesh::Triangle> triangles{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                        {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::vector<std::pair<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto key = std::minmax(a, b);
      for (const auto& [edge, vertex] : middles) {
        if (edge == std::pair(key.first, key.second)) return vertex;
      }
      vertices.push_back((vertices[a] + vertices[b]).normalized());
      const auto added = static_cast<std::uint32_t>(vertices.size() - 1);
      middles.push_back({{key.first, key.second}, added});
      return added;
    };
    std::vector<Mesh::Triangle> finer;
    for (const auto& [a, b, c] : triangles) {
      const std::uint32_t ab = middle(a, b);
      const std::uint32_t bc = middle(b, c);
      const std::uint32_t ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    triangles = std::move(finer);
  }
  return std::make_shared<const Mesh>(std::move(vertices), std::move(triangles));
}

inline PlacedShape placed(std::shared_ptr<const Mesh> mesh, double scale = 1,
                          const Eigen::Quaterniond& orientation = Eigen::Quaterniond::Identity()) {
  return place(MeshShape{std::move(mesh), scale}, orientation);
}

/// A motion that brings b to a: from `distance` away, past the centre of a at most by `miss`, within about a second.
template <int Degree>
RelativeMotion<Degree> encounter(Random& random, double distance, double miss) {
  RelativeMotion<Degree> motion;
  motion.coefficients[0] = distance * random.direction();
  const double arrival = random.uniform(0.5, 1);
  if constexpr (Degree == 2) motion.coefficients[2] = distance * random.vector(1.5);
  Vector3d rest = miss * random.vector(0.6) - motion.coefficients[0];
  if constexpr (Degree == 2) rest -= arrival * arrival * motion.coefficients[2];
  for (int i = 2; Degree >= 3 && i <= Degree; ++i) {
    motion.coefficients[static_cast<std::size_t>(i)] = distance * random.vector(1.5);
    rest -= std::pow(arrival, i) * motion.coefficients[static_cast<std::size_t>(i)];
  }
  motion.coefficients[1] = rest / arrival;
  return motion;
}

/// A needle whose tip is its model's origin and whose body stretches along -z.
inline std::shared_ptr<const Mesh> needle() {
  return std::make_shared<const Mesh>(
      std::vector<Vector3d>{{0, 0, 0}, {0.1, 0, -1}, {-0.05, 0.09, -1}, {-0.05, -0.09, -1}},
      std::vector<Mesh::Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}});
}

}  // namespace kds::collision::samples
