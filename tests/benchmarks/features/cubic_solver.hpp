// A contender: the roots of the coplanarity cubic in plain doubles, and a test of the place at each.
#pragma once

#include "tests/certificates/feature_queries.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

namespace kds::benchmarks {

/// Paper: [Provot97]. What is usually written: closed-form roots (trigonometric where there are three), barycentric
/// coordinates with a tolerance, coplanar motion left out. Fast, and the measure of what a guarantee costs.
class CubicSolver {
 public:
  static std::optional<double> first_contact(tests::Features kind, const std::array<Eigen::Vector3d, 4>& begin,
                                             const std::array<Eigen::Vector3d, 4>& end) {
    std::array<Eigen::Vector3d, 4> step;
    for (std::size_t k = 0; k < 4; ++k) step[k] = end[k] - begin[k];
    const Eigen::Vector3d a = begin[1] - begin[0], b = begin[2] - begin[0], c = begin[3] - begin[0];
    const Eigen::Vector3d u = step[1] - step[0], v = step[2] - step[0], w = step[3] - step[0];
    const Eigen::Vector3d ab = a.cross(b), uv = u.cross(v), mixed = a.cross(v) + u.cross(b);
    const std::array<double, 4> cubic{ab.dot(c), ab.dot(w) + mixed.dot(c), mixed.dot(w) + uv.dot(c), uv.dot(w)};
    std::array<double, 3> roots;
    roots.fill(std::numeric_limits<double>::infinity());
    solve(cubic, roots);
    if (roots[1] < roots[0]) std::swap(roots[0], roots[1]);
    if (roots[2] < roots[1]) std::swap(roots[1], roots[2]);
    if (roots[1] < roots[0]) std::swap(roots[0], roots[1]);
    for (const double t : roots) {
      if (!(t >= 0 && t <= 1)) continue;
      std::array<Eigen::Vector3d, 4> x;
      for (std::size_t k = 0; k < 4; ++k) x[k] = begin[k] + t * step[k];
      if (kind == tests::Features::vertex_face ? in_face(x) : on_edges(x)) return t;
    }
    return std::nullopt;
  }

 private:
  static constexpr double tolerance = 1e-6;  // of barycentric coordinates and edge parameters

  static void solve(const std::array<double, 4>& p, std::array<double, 3>& roots) {
    const auto& [d, c, b, a] = p;
    const double size = std::abs(a) + std::abs(b) + std::abs(c) + std::abs(d);
    if (std::abs(a) > 1e-14 * size) {
      const double p1 = b / a, q1 = c / a, r1 = d / a;
      const double q = (p1 * p1 - 3 * q1) / 9;
      const double r = (2 * p1 * p1 * p1 - 9 * p1 * q1 + 27 * r1) / 54;
      if (r * r < q * q * q) {
        const double angle = std::acos(std::clamp(r / std::sqrt(q * q * q), -1.0, 1.0));
        for (int i = 0; i < 3; ++i) {
          roots[static_cast<std::size_t>(i)] =
              -2 * std::sqrt(q) * std::cos((angle + 2 * std::numbers::pi * i) / 3) - p1 / 3;
        }
        return;
      }
      const double e = -std::copysign(std::cbrt(std::abs(r) + std::sqrt(r * r - q * q * q)), r);
      roots[0] = e + (e != 0 ? q / e : 0) - p1 / 3;
      return;
    }
    if (std::abs(b) > 1e-14 * size) {
      const double discriminant = c * c - 4 * b * d;
      if (discriminant < 0) return;
      const double s = -0.5 * (c + std::copysign(std::sqrt(discriminant), c));
      roots[0] = s / b;
      roots[1] = s != 0 ? d / s : roots[0];
      return;
    }
    if (std::abs(c) > 1e-14 * size) {
      roots[0] = -d / c;
    }
  }

  static bool in_face(const std::array<Eigen::Vector3d, 4>& x) {
    const Eigen::Vector3d u = x[2] - x[1], v = x[3] - x[1], w = x[0] - x[1];
    const Eigen::Vector3d n = u.cross(v);
    const double n2 = n.dot(n);
    const double s = n.dot(w.cross(v)) / n2;
    const double t = n.dot(u.cross(w)) / n2;
    return s >= -tolerance && t >= -tolerance && s + t <= 1 + tolerance;
  }

  static bool on_edges(const std::array<Eigen::Vector3d, 4>& x) {
    const Eigen::Vector3d u = x[1] - x[0], v = x[3] - x[2], w = x[2] - x[0];
    const Eigen::Vector3d n = u.cross(v);
    const double n2 = n.dot(n);
    const double s = n.dot(w.cross(v)) / n2;
    const double t = n.dot(w.cross(u)) / n2;
    return s >= -tolerance && s <= 1 + tolerance && t >= -tolerance && t <= 1 + tolerance;
  }
};

}  // namespace kds::benchmarks
