// Random velocities of a gas at a temperature, the same bits on every system.
#pragma once

#include <Eigen/Core>

#include <cmath>
#include <cstdint>

namespace kds::collision {

/// Draws velocities by Maxwell's distribution. Only + - * / and sqrt are used, each of which is rounded in one way:
/// the logarithms and the distributions of the standard library differ between systems.
///
/// Numbers are those of SplitMix64 [Steele14]; exponential ones are made by comparisons alone [vonNeumann51]; normal
/// ones have an exponential half square of the length and a direction that is uniform on the circle.
class ThermalVelocities {
 public:
  explicit ThermalVelocities(std::uint64_t seed) : state_(seed) {}

  /// In [0, 1).
  double uniform() { return double(next() >> 11) * 0x1p-53; }

  /// Of mean 1: the length of the first run of falling numbers is odd with the probability exp(-x), x being its first
  /// number; each run of even length before adds 1.
  double exponential() {
    for (double whole = 0;; ++whole) {
      const double first = uniform();
      bool odd = true;
      for (double last = first, next = uniform(); next < last; next = uniform()) {
        last = next;
        odd = !odd;
      }
      if (odd) return whole + first;
    }
  }

  /// Two independent normal numbers of variance 1.
  Eigen::Vector2d normal_pair() {
    for (;;) {
      const double x = 2 * uniform() - 1;
      const double y = 2 * uniform() - 1;
      const Eigen::Vector2d p(x, y);
      const double square = p[0] * p[0] + p[1] * p[1];
      if (square > 0 && square < 1) return p * std::sqrt(2 * exponential() / square);
    }
  }

  /// In the midst of a gas. `variance` of each component: temperature over mass, speed^2.
  Eigen::Vector3d inside(double variance) {
    const Eigen::Vector2d first = normal_pair();
    return std::sqrt(variance) * Eigen::Vector3d(first[0], first[1], normal_pair()[0]);
  }

  /// Of what comes through a plane across an axis: faster bodies come more often, so the component along the axis has a
  /// density in proportion to v exp(-v^2 / (2 variance)). `direction`: +1 or -1 along the axis.
  Eigen::Vector3d through_plane(int axis, double direction, double variance) {
    Eigen::Vector3d v;
    v[axis] = direction * std::sqrt(2 * exponential());
    const Eigen::Vector2d along = normal_pair();
    v[(axis + 1) % 3] = along[0];
    v[(axis + 2) % 3] = along[1];
    return std::sqrt(variance) * v;
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(state_);
  }

 private:
  std::uint64_t next() {
    std::uint64_t x = state_ += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
  }

  std::uint64_t state_;
};

}  // namespace kds::collision
