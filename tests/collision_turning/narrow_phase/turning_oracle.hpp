// How far two bodies that turn are apart, by definition, in long doubles.
#pragma once

#include "certificates/turning/rigid_motion.hpp"
#include "collision/shapes/shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <variant>

namespace kds::tests {

class TurningOracle {
 public:
  using Number = long double;
  using Vector = std::array<Number, 3>;

  struct Pose {
    Vector centre;
    std::array<Vector, 3> axes;
  };

  template <int Degree>
  static Pose pose(const certificates::RigidMotion<Degree>& motion, double t) {
    const Number elapsed = static_cast<Number>(t) - static_cast<Number>(motion.path.start);
    Pose pose{};
    for (std::size_t d = 0; d < 3; ++d) {
      for (std::size_t k = Degree + 1; k-- > 0;) {
        pose.centre[d] = pose.centre[d] * elapsed + motion.path.coefficients[k][static_cast<Eigen::Index>(d)];
      }
    }
    const auto& q = motion.orientation;
    const Number w = q.w(), x = q.x(), y = q.y(), z = q.z();
    const Number n = w * w + x * x + y * y + z * z;
    pose.axes = {Vector{(w * w + x * x - y * y - z * z) / n, 2 * (x * y + w * z) / n, 2 * (x * z - w * y) / n},
                 Vector{2 * (x * y - w * z) / n, (w * w - x * x + y * y - z * z) / n, 2 * (y * z + w * x) / n},
                 Vector{2 * (x * z + w * y) / n, 2 * (y * z - w * x) / n, (w * w - x * x - y * y + z * z) / n}};
    const Vector spin{motion.angular_velocity[0], motion.angular_velocity[1], motion.angular_velocity[2]};
    const Number rate = std::sqrt(dot(spin, spin));
    if (rate == 0) return pose;
    const Vector k{spin[0] / rate, spin[1] / rate, spin[2] / rate};
    const Number cosine = std::cos(rate * elapsed), sine = std::sin(rate * elapsed);
    for (Vector& v : pose.axes) {
      const Vector side = cross(k, v);
      const Number along = dot(k, v) * (1 - cosine);
      for (std::size_t d = 0; d < 3; ++d) v[d] = v[d] * cosine + side[d] * sine + k[d] * along;
    }
    return pose;
  }

  template <int Degree>
  static Number gap(const certificates::RigidMotion<Degree>& a, const collision::Shape& shape_a,
                    const certificates::RigidMotion<Degree>& b, const collision::Shape& shape_b, double t) {
    const Pose pose_a = pose(a, t), pose_b = pose(b, t);
    const auto* const ball_a = std::get_if<collision::Sphere>(&shape_a);
    const auto* const ball_b = std::get_if<collision::Sphere>(&shape_b);
    if (ball_a) return ball_gap(pose_b, std::get<collision::Box>(shape_b), pose_a.centre, ball_a->radius);
    if (ball_b) return ball_gap(pose_a, std::get<collision::Box>(shape_a), pose_b.centre, ball_b->radius);
    return box_gap(pose_a, std::get<collision::Box>(shape_a), pose_b, std::get<collision::Box>(shape_b));
  }

 private:
  static Number dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
  static Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }

  static Number half(const collision::Box& box, std::size_t i) {
    return box.half_extents[static_cast<Eigen::Index>(i)];
  }

  /// Along the best of the 15 axes: negative where the boxes overlap.
  static Number box_gap(const Pose& a, const collision::Box& box_a, const Pose& b, const collision::Box& box_b) {
    const Vector way{b.centre[0] - a.centre[0], b.centre[1] - a.centre[1], b.centre[2] - a.centre[2]};
    Number widest = -std::numeric_limits<Number>::infinity();
    const auto along = [&](const Vector& n) {
      const Number length = std::sqrt(dot(n, n));
      if (length < 1e-9L) return;
      Number gap = std::abs(dot(n, way));
      for (std::size_t k = 0; k < 3; ++k) {
        gap -= half(box_a, k) * std::abs(dot(n, a.axes[k])) + half(box_b, k) * std::abs(dot(n, b.axes[k]));
      }
      widest = std::max(widest, gap / length);
    };
    for (std::size_t i = 0; i < 3; ++i) {
      along(a.axes[i]), along(b.axes[i]);
      for (std::size_t j = 0; j < 3; ++j) along(cross(a.axes[i], b.axes[j]));
    }
    return widest;
  }

  static Number ball_gap(const Pose& box, const collision::Box& shape, const Vector& centre, double radius) {
    const Vector way{centre[0] - box.centre[0], centre[1] - box.centre[1], centre[2] - box.centre[2]};
    Number square = 0, inside = -std::numeric_limits<Number>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
      const Number beyond = std::abs(dot(box.axes[k], way)) - half(shape, k);
      inside = std::max(inside, beyond);
      if (beyond > 0) square += beyond * beyond;
    }
    return (square > 0 ? std::sqrt(square) : inside) - radius;
  }
};

}  // namespace kds::tests
