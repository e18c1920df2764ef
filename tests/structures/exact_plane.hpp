// Moving points of the plane: random ones, and what is exactly true of them at an instant.
#pragma once

#include "certificates/plane_motion.hpp"
#include "kds/framework/moving_set.hpp"
#include "tests/structures/random_values.hpp"
#include "tests/support/exact_algebra.hpp"

#include <array>
#include <cstddef>
#include <map>
#include <vector>

namespace kds::tests {

/// Points just after a time, exactly. Shares no code with the library.
class ExactPlane {
 public:
  template <int Degree>
  ExactPlane(const MovingSet<certificates::PlaneMotion<Degree>>& set, double now) : now_(oracle::rational(now)) {
    for (const Id id : set.ids()) {
      for (int d = 0; d < 2; ++d) {
        const auto axis = set[id].axis(d);
        points_[id][static_cast<std::size_t>(d)] =
            oracle::Polynomial::motion({axis.position.c.begin(), axis.position.c.end()}, axis.start);
      }
    }
  }
  int orientation(Id a, Id b, Id c) const {
    const auto u = from(a, b), v = from(a, c);
    return (u[0] * v[1] - u[1] * v[0]).sign_after(now_);
  }
  /// +1 if d is inside the circle through a, b, c, which turn left.
  int inside(Id a, Id b, Id c, Id d) const {
    const auto u = from(d, a), v = from(d, b), w = from(d, c);
    const auto lift = [](const Point& p) { return p[0] * p[0] + p[1] * p[1]; };
    const auto cross = [](const Point& p, const Point& q) { return p[0] * q[1] - p[1] * q[0]; };
    return (lift(u) * cross(v, w) + lift(v) * cross(w, u) + lift(w) * cross(u, v)).sign_after(now_);
  }
  /// Sign of |a - b|^2 - |c - d|^2.
  int compare_distances(Id a, Id b, Id c, Id d) const {
    const auto u = from(a, b), v = from(c, d);
    return (u[0] * u[0] + u[1] * u[1] - (v[0] * v[0] + v[1] * v[1])).sign_after(now_);
  }
  /// -1 if c is inside the disc that has a and b as ends of a diameter, 0 if it stays on its border.
  int outside_disc(Id a, Id b, Id c) const {
    const auto u = from(c, a), v = from(c, b);
    return (u[0] * v[0] + u[1] * v[1]).sign_after(now_);
  }
  /// Sign of 2 r - |a - b|.
  int compare_diameter(double r, Id a, Id b) const {
    return (oracle::Polynomial(4 * oracle::rational(r) * oracle::rational(r)) - squared_distance(a, b))
        .sign_after(now_);
  }
  /// Sign of r - the radius of the circle through a, b, c: by the law of sines at c. Precondition: these turn left.
  int compare_circle(double r, Id a, Id b, Id c) const {
    const auto u = from(c, a), v = from(c, b);
    const auto area = u[0] * v[1] - u[1] * v[0];  // |a - c| |b - c| times the sine
    const auto product = squared_distance(a, c) * squared_distance(b, c) * squared_distance(a, b);
    return (area * area * oracle::Polynomial(4 * oracle::rational(r) * oracle::rational(r)) - product).sign_after(now_);
  }
  bool same(Id a, Id b) const {
    const auto u = from(a, b);
    return u[0].sign_after(now_) == 0 && u[1].sign_after(now_) == 0;
  }
  std::vector<Id> ids() const {
    std::vector<Id> result;
    for (const auto& [id, point] : points_) result.push_back(id);
    return result;
  }

 private:
  using Point = std::array<oracle::Polynomial, 2>;
  oracle::Polynomial squared_distance(Id a, Id b) const {
    const auto u = from(a, b);
    return u[0] * u[0] + u[1] * u[1];
  }
  Point from(Id a, Id b) const { return {points_.at(b)[0] - points_.at(a)[0], points_.at(b)[1] - points_.at(a)[1]}; }
  std::map<Id, Point> points_;
  oracle::Rational now_;
};

}  // namespace kds::tests
