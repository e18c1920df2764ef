// How deep surfaces that turn are in each other, and how far apart, by definition, in long doubles.
#pragma once

#include "certificates/turning/rigid_motion.hpp"
#include "collision/shapes/mesh.hpp"
#include "collision/shapes/shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace kds::tests {

class TurningMeshOracle {
 public:
  using Number = long double;
  using Vector = std::array<Number, 3>;
  using Triangle = std::array<Vector, 3>;

  /// The triangles of a mesh at t.
  template <int Degree>
  static std::vector<Triangle> placed(const certificates::RigidMotion<Degree>& motion,
                                      const collision::MeshShape& shape, double t) {
    std::vector<Triangle> triangles;
    for (const auto& indices : shape.mesh->triangles()) {
      Triangle triangle;
      for (std::size_t i = 0; i < 3; ++i) {
        const Eigen::Vector3d& v = shape.mesh->vertices()[indices[i]];
        triangle[i] = point(motion, {shape.scale * v[0], shape.scale * v[1], shape.scale * v[2]}, t);
      }
      triangles.push_back(triangle);
    }
    return triangles;
  }

  /// Where a point of a body is at t: q p q^-1 turned about W by a formula of its own, with half angles.
  template <int Degree>
  static Vector point(const certificates::RigidMotion<Degree>& motion, const Eigen::Vector3d& p, double t) {
    const Number elapsed = static_cast<Number>(t) - static_cast<Number>(motion.path.start);
    const auto& q = motion.orientation;
    Vector x{p[0], p[1], p[2]};
    x = rotated(q.w(), {q.x(), q.y(), q.z()}, x);
    const Vector w{motion.angular_velocity[0], motion.angular_velocity[1], motion.angular_velocity[2]};
    if (const Number rate = std::sqrt(dot(w, w)); rate > 0) {
      const Number sine = std::sin(rate * elapsed / 2) / rate;
      x = rotated(std::cos(rate * elapsed / 2), {w[0] * sine, w[1] * sine, w[2] * sine}, x);
    }
    for (std::size_t d = 0; d < 3; ++d) {
      Number path = 0;
      for (std::size_t k = Degree + 1; k-- > 0;) {
        path = path * elapsed + motion.path.coefficients[k][static_cast<Eigen::Index>(d)];
      }
      x[d] += path;
    }
    return x;
  }

  /// How far the most deeply piercing edge of either reaches through a triangle of the other, and is from its rim. Not
  /// above zero if none does.
  static Number depth(const std::vector<Triangle>& a, const std::vector<Triangle>& b) {
    Number deepest = -std::numeric_limits<Number>::infinity();
    for (const Triangle& x : a) {
      for (const Triangle& y : b) {
        for (std::size_t k = 0; k < 3; ++k) {
          deepest = std::max({deepest, pierces(x[k], x[(k + 1) % 3], y), pierces(y[k], y[(k + 1) % 3], x)});
        }
      }
    }
    return deepest;
  }

  /// The least distance of the triangles that do not pierce each other.
  static Number distance(const std::vector<Triangle>& a, const std::vector<Triangle>& b) {
    Number least = std::numeric_limits<Number>::infinity();
    for (const Triangle& x : a) {
      for (const Triangle& y : b) {
        for (std::size_t i = 0; i < 3; ++i) {
          least = std::min({least, distance(x[i], y), distance(y[i], x)});
          for (std::size_t k = 0; k < 3; ++k) {
            least = std::min(least, distance(x[i], x[(i + 1) % 3], y[k], y[(k + 1) % 3]));
          }
        }
      }
    }
    return least;
  }
  static Number distance(const Vector& p, const std::vector<Triangle>& triangles) {
    Number least = std::numeric_limits<Number>::infinity();
    for (const Triangle& x : triangles) least = std::min(least, distance(p, x));
    return least;
  }

 private:
  static Number dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
  static Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }
  static Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
  static Vector plus(const Vector& a, const Vector& b, Number f) {
    return {a[0] + f * b[0], a[1] + f * b[1], a[2] + f * b[2]};
  }
  static Number norm(const Vector& a) { return std::sqrt(dot(a, a)); }

  /// q x q^-1.
  static Vector rotated(Number w, const Vector& v, const Vector& x) {
    const Number n = w * w + dot(v, v);
    const Vector p = plus(cross(v, x), x, w);
    const Number along = dot(v, x);
    Vector y{};
    for (std::size_t d = 0; d < 3; ++d) y[d] = (w * p[d] + along * v[d] + cross(v, p)[d]) / n;
    return y;
  }

  static Number pierces(const Vector& p, const Vector& q, const Triangle& t) {
    Vector n = cross(minus(t[1], t[0]), minus(t[2], t[0]));
    n = plus({0, 0, 0}, n, 1 / norm(n));
    const Number at_p = dot(n, minus(p, t[0])), at_q = dot(n, minus(q, t[0]));
    if ((at_p > 0) == (at_q > 0) || at_p == at_q) return -std::min(std::abs(at_p), std::abs(at_q));
    const Vector x = plus(p, minus(q, p), at_p / (at_p - at_q));
    Number least = std::min(std::abs(at_p), std::abs(at_q));
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector e = minus(t[(k + 1) % 3], t[k]);
      least = std::min(least, dot(cross(n, e), minus(x, t[k])) / norm(e));
    }
    return least;
  }

  static Number distance(const Vector& p, const Triangle& t) {
    Vector n = cross(minus(t[1], t[0]), minus(t[2], t[0]));
    n = plus({0, 0, 0}, n, 1 / norm(n));
    bool inside = true;
    Number least = std::numeric_limits<Number>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector e = minus(t[(k + 1) % 3], t[k]), d = minus(p, t[k]);
      inside = inside && dot(cross(n, e), d) >= 0;
      const Number along = std::clamp(dot(d, e) / dot(e, e), Number(0), Number(1));
      least = std::min(least, norm(plus(d, e, -along)));
    }
    return inside ? std::abs(dot(n, minus(p, t[0]))) : least;
  }

  /// Of two segments, where the nearest points are inside of both: else ends are the nearest.
  static Number distance(const Vector& p0, const Vector& p1, const Vector& q0, const Vector& q1) {
    const Vector u = minus(p1, p0), v = minus(q1, q0), w = minus(p0, q0);
    const Number uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
    const Number determinant = uu * vv - uv * uv;
    if (determinant <= 1e-15L * uu * vv) return std::numeric_limits<Number>::infinity();
    const Number s = (uv * vw - vv * uw) / determinant, r = (uu * vw - uv * uw) / determinant;
    if (s < 0 || s > 1 || r < 0 || r > 1) return std::numeric_limits<Number>::infinity();
    return norm(plus(plus(w, u, s), v, -r));
  }
};

}  // namespace kds::tests
