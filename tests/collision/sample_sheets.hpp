// Square sheets of triangles: what bends in the tests and the benchmark.
#pragma once

#include "collision/shapes/mesh.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace kds::collision::samples {

/// 2 n n triangles in the plane z = 0, between -half and half. The vertex in row i, column j is i (n + 1) + j.
struct Sheet {
  std::vector<Eigen::Vector3d> positions;
  std::vector<Mesh::Triangle> triangles;

  explicit Sheet(std::uint32_t n, double half = 1) {
    for (std::uint32_t i = 0; i <= n; ++i) {
      for (std::uint32_t j = 0; j <= n; ++j)
        positions.emplace_back(half * (2.0 * i / n - 1), half * (2.0 * j / n - 1), 0);
    }
    for (std::uint32_t i = 0; i < n; ++i) {
      for (std::uint32_t j = 0; j < n; ++j) {
        const std::uint32_t a = i * (n + 1) + j, b = a + n + 1;
        triangles.push_back({a, b, b + 1});
        triangles.push_back({a, b + 1, a + 1});
      }
    }
  }

  std::vector<Eigen::Vector3d> moved(const Eigen::Vector3d& by) const {
    std::vector<Eigen::Vector3d> result = positions;
    for (Eigen::Vector3d& p : result) p += by;
    return result;
  }
};

}  // namespace kds::collision::samples
