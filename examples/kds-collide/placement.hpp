// Random places for balls, the same on every machine.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <unordered_map>
#include <vector>

namespace kds_collide {

/// Random numbers made with nothing but the engine, whose sequence the standard fixes, and operations that IEEE 754
/// rounds correctly: std::uniform_real_distribution, sin and cos differ from one library to the next.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in [0, 1): the upper 53 bits.
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * unit(); }

  /// [Marsaglia72], Choosing a point from the surface of a sphere, Ann. Math. Stat. 43.
  Eigen::Vector3d direction() {
    const auto [x, y, s] = disc();
    const double root = std::sqrt(1 - s);
    return {2 * x * root, 2 * y * root, 1 - 2 * s};
  }

  /// Uniform over rotations; the same paper, in four dimensions.
  Eigen::Quaterniond rotation() {
    const auto [x, y, s] = disc();
    const auto [z, w, t] = disc();
    const double root = std::sqrt((1 - s) / t);
    return {x, y, z * root, w * root};
  }

 private:
  /// A point of the unit disc other than its centre, and its squared distance from it.
  std::array<double, 3> disc() {
    for (;;) {
      const double x = uniform(-1, 1);
      const double y = uniform(-1, 1);
      const double s = x * x + y * y;
      if (s > 0 && s < 1) return {x, y, s};
    }
  }

  std::mt19937_64 engine_;
};

/// Bounding balls placed so far, in a grid of cells as wide as the largest ball.
class Placement {
 public:
  Placement(double side, double largest_radius) : cell_(2 * largest_radius) {
    cells_a_side_ = static_cast<std::int64_t>(side / cell_) + 1;
  }

  bool is_free(const Eigen::Vector3d& at, double radius) const {
    const auto home = cell_of(at);
    for (std::int64_t x = home[0] - 1; x <= home[0] + 1; ++x) {
      for (std::int64_t y = home[1] - 1; y <= home[1] + 1; ++y) {
        for (std::int64_t z = home[2] - 1; z <= home[2] + 1; ++z) {
          const auto found = cells_.find(key(x, y, z));
          if (found == cells_.end()) continue;
          for (const Ball& ball : found->second) {
            const double radii = ball.radius + radius;
            if ((ball.centre - at).squaredNorm() <= radii * radii) return false;
          }
        }
      }
    }
    return true;
  }

  void add(const Eigen::Vector3d& at, double radius) {
    const auto home = cell_of(at);
    cells_[key(home[0], home[1], home[2])].push_back({at, radius});
  }

 private:
  struct Ball {
    Eigen::Vector3d centre;
    double radius;
  };

  std::array<std::int64_t, 3> cell_of(const Eigen::Vector3d& at) const {
    return {static_cast<std::int64_t>(at[0] / cell_), static_cast<std::int64_t>(at[1] / cell_),
            static_cast<std::int64_t>(at[2] / cell_)};
  }
  std::int64_t key(std::int64_t x, std::int64_t y, std::int64_t z) const {
    return ((z + 1) * (cells_a_side_ + 2) + (y + 1)) * (cells_a_side_ + 2) + (x + 1);
  }

  double cell_;
  std::int64_t cells_a_side_;
  std::unordered_map<std::int64_t, std::vector<Ball>> cells_;
};

}  // namespace kds_collide
