// Moving points of a plane that repeats itself, and what is exactly true of them; the check of their triangulation.
#pragma once

#include "certificates/plane_motion.hpp"
#include "kds/simulator.hpp"
#include "structures/periodic_delaunay.hpp"
#include "tests/support/exact_algebra.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace kds::tests {

/// Points just after a time, and their copies, exactly. Shares no code with the library.
class ExactTorus {
 public:
  struct Copy {
    Id id;
    std::int64_t along, up;  ///< displaced by so many periods
  };

  template <int Degree>
  ExactTorus(const MovingSet<certificates::PlaneMotion<Degree>>& set, const std::array<double, 2>& periods, double now)
      : periods_{oracle::rational(periods[0]), oracle::rational(periods[1])}, now_(oracle::rational(now)) {
    for (const Id id : set.ids()) {
      for (int d = 0; d < 2; ++d) {
        const auto axis = set[id].axis(d);
        auto& path = paths_[id][static_cast<std::size_t>(d)];
        path = oracle::Polynomial::motion({axis.position.c.begin(), axis.position.c.end()}, axis.start);
        places_[id][static_cast<std::size_t>(d)] = path(now_);
      }
    }
    const double width = periods[0], height = periods[1], diagonal = std::hypot(width, height);
    reach_ = {static_cast<int>(diagonal / width) + 2, static_cast<int>(diagonal / height) + 2};
  }

  /// Twice the area of a triangle.
  oracle::Polynomial area(const std::array<Copy, 3>& corners) const {
    const auto u = from(corners[0], corners[1]), v = from(corners[0], corners[2]);
    return u[0] * v[1] - u[1] * v[0];
  }
  /// Twice the area of the rectangle.
  oracle::Polynomial whole_area() const { return oracle::Polynomial(2 * periods_[0] * periods_[1]); }
  int sign(const oracle::Polynomial& p) const { return p.sign_after(now_); }

  /// How many copies of points are inside the circle through three that turn left. Such a circle that has no point
  /// inside is at most as wide as a rectangle's diagonal, so only copies within a diagonal of a corner are looked at.
  int inside(const std::array<Copy, 3>& corners) const {
    int count = 0;
    for (const auto& [id, path] : paths_) {
      for (Copy copy : copies_near(id, corners[0].id)) {
        copy.along += corners[0].along, copy.up += corners[0].up;
        count += is_inside(corners, copy);
      }
    }
    return count;
  }
  /// Whether two points stay in one place, up to periods.
  bool same(Id a, Id b) const {
    const Copy here{a, copies_between(a, b, 0), copies_between(a, b, 1)};
    const auto apart = from(here, {b, 0, 0});
    return sign(apart[0]) == 0 && sign(apart[1]) == 0;
  }
  std::vector<Id> ids() const {
    std::vector<Id> result;
    for (const auto& [id, path] : paths_) result.push_back(id);
    return result;
  }
  /// Sign of |b - a|^2 - |d - c|^2.
  int compare_distances(const Copy& a, const Copy& b, const Copy& c, const Copy& d) const {
    const auto u = from(a, b), v = from(c, d);
    return sign(u[0] * u[0] + u[1] * u[1] - (v[0] * v[0] + v[1] * v[1]));
  }
  /// All copies of a point that may be within a rectangle's diagonal of another, which no empty circle is wider than.
  std::vector<Copy> copies_near(Id id, Id other) const {
    std::vector<Copy> copies;
    for (int i = -reach_[0]; i <= reach_[0]; ++i) {
      for (int j = -reach_[1]; j <= reach_[1]; ++j) {
        copies.push_back({id, copies_between(id, other, 0) + i, copies_between(id, other, 1) + j});
      }
    }
    return copies;
  }
  /// -1 if c is inside the disc that has a and b as ends of a diameter, 0 if it stays on its border.
  int outside_disc(const Copy& a, const Copy& b, const Copy& c) const {
    const auto near = [](const auto& u, const auto& v) { return u[0] * v[0] + u[1] * v[1]; };
    const auto p = about_from(c, a), q = about_from(c, b);
    const double value = near(p, q);  // off by less than 10 roundings of the product of the lengths
    if (std::abs(value) > 1e-14 * std::hypot(p[0], p[1]) * std::hypot(q[0], q[1])) return value > 0 ? 1 : -1;
    return sign(near(from(c, a), from(c, b)));
  }
  /// Sign of 2 r - |a - b|.
  int compare_diameter(double r, const Copy& a, const Copy& b) const {
    return sign(oracle::Polynomial(4 * oracle::rational(r) * oracle::rational(r)) - square(from(a, b)));
  }
  /// Sign of r - the radius of the circle through a, b, c: by the law of sines.
  int compare_circle(double r, const std::array<Copy, 3>& c) const {
    const auto doubled = area(c);
    const auto product = square(from(c[0], c[1])) * square(from(c[1], c[2])) * square(from(c[2], c[0]));
    return sign(doubled * doubled * oracle::Polynomial(4 * oracle::rational(r) * oracle::rational(r)) - product);
  }
  /// The copy of a point that is the nearest to another: along each axis it is not farther than half a period, so it is
  /// the one that is found by rounding, or next to that.
  Copy nearest_copy(Id id, Id other) const {
    const Copy to{other, 0, 0}, rounded{id, copies_between(id, other, 0), copies_between(id, other, 1)};
    Copy nearest = rounded;
    for (int i = -1; i <= 1; ++i) {
      for (int j = -1; j <= 1; ++j) {
        const Copy copy{id, rounded.along + i, rounded.up + j};
        if (compare_distances(copy, to, nearest, to) < 0) nearest = copy;
      }
    }
    return nearest;
  }

 private:
  using Vector = std::array<oracle::Polynomial, 2>;

  /// Periods from a point to another, rounded.
  std::int64_t copies_between(Id id, Id other, std::size_t axis) const {
    const oracle::Rational apart = (places_.at(other)[axis] - places_.at(id)[axis]) / periods_[axis];
    return static_cast<std::int64_t>(std::nearbyint(oracle::approximate(apart)));
  }
  static std::int64_t offset(const Copy& copy, std::size_t axis) { return axis == 0 ? copy.along : copy.up; }
  Vector from(const Copy& a, const Copy& b) const {
    Vector result;
    for (const std::size_t d : {std::size_t{0}, std::size_t{1}}) {
      result[d] = paths_.at(b.id)[d] - paths_.at(a.id)[d] +
                  oracle::Polynomial(oracle::Rational(offset(b, d) - offset(a, d)) * periods_[d]);
    }
    return result;
  }
  static oracle::Polynomial square(const Vector& u) { return u[0] * u[0] + u[1] * u[1]; }
  std::array<double, 2> about_from(const Copy& a, const Copy& b) const {
    std::array<double, 2> result{};
    for (const std::size_t d : {std::size_t{0}, std::size_t{1}}) {
      result[d] = oracle::approximate(places_.at(b.id)[d] - places_.at(a.id)[d] +
                                      oracle::Rational(offset(b, d) - offset(a, d)) * periods_[d]);
    }
    return result;
  }
  template <class V>
  static auto in_circle(const V& u, const V& v, const V& w) {
    const auto lift = [](const V& p) { return p[0] * p[0] + p[1] * p[1]; };
    const auto cross = [](const V& p, const V& q) { return p[0] * q[1] - p[1] * q[0]; };
    return lift(u) * cross(v, w) + lift(v) * cross(w, u) + lift(w) * cross(u, v);
  }
  bool is_inside(const std::array<Copy, 3>& c, const Copy& d) const {
    const auto u = about_from(d, c[0]), v = about_from(d, c[1]), w = about_from(d, c[2]);
    const double length = std::max({std::hypot(u[0], u[1]), std::hypot(v[0], v[1]), std::hypot(w[0], w[1])});
    const double value = in_circle(u, v, w);  // off by less than 100 roundings of length^4
    if (std::abs(value) > 1e-13 * length * length * length * length) return value > 0;
    return sign(in_circle(from(d, c[0]), from(d, c[1]), from(d, c[2]))) > 0;
  }

  std::map<Id, Vector> paths_;
  std::map<Id, std::array<oracle::Rational, 2>> places_;
  std::array<oracle::Rational, 2> periods_;
  oracle::Rational now_;
  std::array<int, 2> reach_{};
};

inline ExactTorus::Copy exact_copy(const structures::VertexCopy& vertex) {
  return {vertex.id, vertex.offset.x, vertex.offset.y};
}

/// Every triangle turns left, no copy of a point is inside its circle, and together they are as large as the rectangle;
/// points without a vertex are where one is.
template <int Degree>
int check_periodic(const structures::PeriodicDelaunayRule<certificates::PlaneMotion<Degree>>& rule,
                   const MovingSet<certificates::PlaneMotion<Degree>>& set, double now) {
  const ExactTorus torus(set, rule.periods(), now);
  const structures::PeriodicMesh& mesh = rule.mesh();
  int wrong = 0;
  std::size_t vertices = 0, triangles = 0;
  for (const Id id : torus.ids()) {
    vertices += mesh.contains(id);
    wrong += rule.vertex(id) != id && !torus.same(id, rule.vertex(id));
    wrong += mesh.contains(id) != (rule.vertex(id) == id);
  }
  oracle::Polynomial area;
  for (std::uint32_t t = 0; t < mesh.end_triangle(); ++t) {
    if (!mesh.in_use(t)) continue;
    ++triangles;
    const auto corners = mesh.corners(3 * t);
    const std::array copies{exact_copy(corners[0]), exact_copy(corners[1]), exact_copy(corners[2])};
    const auto twice = torus.area(copies);
    wrong += torus.sign(twice) <= 0;
    wrong += torus.inside(copies);
    area = area + twice;
  }
  wrong += triangles != 2 * vertices;
  if (triangles > 0) wrong += torus.sign(area - torus.whole_area()) != 0;
  return wrong;
}

}  // namespace kds::tests
