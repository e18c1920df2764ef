// When two meshes on straight paths touch, in exact rational arithmetic, and how far apart they are at a time.
#pragma once

#include "collision/shapes/mesh.hpp"
#include "collision/world.hpp"
#include "tests/support/exact_oracle.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace accuracy {

using oracle::Rational;
using Real = long double;

inline Real real(const Rational& x) {
  const double high = oracle::approximate(x);
  return static_cast<Real>(high) + static_cast<Real>(oracle::approximate(x - oracle::rational(high)));
}

template <class Number>
using Triple = std::array<Number, 3>;
template <class Number>
using Corners = std::array<Triple<Number>, 3>;

template <class Number>
Number dot(const Triple<Number>& a, const Triple<Number>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class Number>
Triple<Number> minus(const Triple<Number>& a, const Triple<Number>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class Number>
Triple<Number> cross(const Triple<Number>& a, const Triple<Number>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Triple<Real> real(const Triple<Rational>& v) { return {real(v[0]), real(v[1]), real(v[2])}; }

/// Both normals, all products of edges, and for triangles in parallel planes the normals of edges in their planes.
template <class Number>
std::vector<Triple<Number>> separating_axes(const Corners<Number>& a, const Corners<Number>& b) {
  std::vector<Triple<Number>> axes;
  const auto edge = [](const Corners<Number>& t, std::size_t i) { return minus(t[(i + 1) % 3], t[i]); };
  const auto add = [&](const Triple<Number>& axis) {
    if (axis[0] != Number(0) || axis[1] != Number(0) || axis[2] != Number(0)) axes.push_back(axis);
  };
  const auto normal_a = cross(edge(a, 0), edge(a, 1));
  const auto normal_b = cross(edge(b, 0), edge(b, 1));
  add(normal_a);
  add(normal_b);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) add(cross(edge(a, i), edge(b, j)));
    add(cross(normal_a, edge(a, i)));
    add(cross(normal_b, edge(b, i)));
  }
  return axes;
}

template <class Number>
struct Range {
  Number low, high;
};
template <class Number>
Range<Number> project(const Corners<Number>& t, const Triple<Number>& axis) {
  Range<Number> range{dot(t[0], axis), dot(t[0], axis)};
  for (std::size_t i = 1; i < 3; ++i) {
    const Number x = dot(t[i], axis);
    if (x < range.low) range.low = x;
    if (range.high < x) range.high = x;
  }
  return range;
}

/// The first tau >= 0 at which a and b, displaced by offset + tau velocity, have a point in common; empty if there is
/// none.
template <class Number>
std::optional<Number> first_touch(const Corners<Number>& a, const Corners<Number>& b, const Triple<Number>& offset,
                                  const Triple<Number>& velocity) {
  Number enter = 0;
  std::optional<Number> leave;
  for (const auto& axis : separating_axes(a, b)) {
    const auto of_a = project(a, axis);
    auto of_b = project(b, axis);
    const Number shift = dot(offset, axis);
    const Number speed = dot(velocity, axis);
    const Number below = of_a.high - of_b.low - shift;   // tau speed <= below
    const Number above = of_a.low - of_b.high - shift;   // tau speed >= above
    if (speed == Number(0)) {
      if (below < Number(0) || Number(0) < above) return std::nullopt;
      continue;
    }
    const bool rising = Number(0) < speed;
    const Number first = (rising ? above : below) / speed;
    const Number last = (rising ? below : above) / speed;
    if (enter < first) enter = first;
    if (!leave || last < *leave) leave = last;
    if (*leave < enter) return std::nullopt;
  }
  return enter;
}

/// The widest gap along an axis; < 0 where they cross.
inline Real separation(const Corners<Real>& a, const Corners<Real>& b, const Triple<Real>& offset) {
  Real widest = -std::numeric_limits<Real>::infinity();
  for (const auto& axis : separating_axes(a, b)) {
    const Real length = std::sqrt(dot(axis, axis));
    if (!(length > 0)) continue;
    const auto of_a = project(a, axis);
    const auto of_b = project(b, axis);
    const Real shift = dot(offset, axis);
    widest = std::max({widest, (of_b.low + shift - of_a.high) / length, (of_a.low - of_b.high - shift) / length});
  }
  return widest;
}

/// A mesh as its quaternion means it, exactly.
class ExactMesh {
 public:
  template <int Degree>
  explicit ExactMesh(const kds::collision::BodyDescription<Degree>& body) {
    const auto& [mesh, scale] = std::get<kds::collision::MeshShape>(body.shape);
    const auto& q = body.orientation;
    const auto rotation = oracle::rotation({q.w(), q.x(), q.y(), q.z()});
    std::vector<Triple<Rational>> vertices;
    for (const auto& v : mesh->vertices()) {
      const Triple<Rational> scaled{oracle::rational(v[0]) * oracle::rational(scale),
                                    oracle::rational(v[1]) * oracle::rational(scale),
                                    oracle::rational(v[2]) * oracle::rational(scale)};
      vertices.push_back({dot(rotation[0], scaled), dot(rotation[1], scaled), dot(rotation[2], scaled)});
    }
    for (const auto& [i, j, k] : mesh->triangles()) {
      exact.push_back({vertices[i], vertices[j], vertices[k]});
      approximate.push_back({real(vertices[i]), real(vertices[j]), real(vertices[k])});
    }
  }

  std::vector<Corners<Rational>> exact;
  std::vector<Corners<Real>> approximate;
};

/// Centre of b less centre of a at a time.
template <int Degree>
Triple<Rational> exact_offset(const kds::certificates::PointMotion<Degree>& a,
                              const kds::certificates::PointMotion<Degree>& b, const Rational& t) {
  const auto place = [&](const kds::certificates::PointMotion<Degree>& m, int d) {
    const Rational tau = t - oracle::rational(m.start);
    Rational x = oracle::rational(m.coefficients[Degree][d]);
    for (int i = Degree; i-- > 0;) x = x * tau + oracle::rational(m.coefficients[static_cast<std::size_t>(i)][d]);
    return x;
  };
  return {place(b, 0) - place(a, 0), place(b, 1) - place(a, 1), place(b, 2) - place(a, 2)};
}

/// The exact first time from `begin` on at which two meshes touch; empty if they never do. All pairs of triangles are
/// looked at in long doubles, and those that touch first, or nearly so, exactly.
inline std::optional<Rational> first_touch(const ExactMesh& a, const ExactMesh& b,
                                           const kds::certificates::PointMotion<1>& motion_a,
                                           const kds::certificates::PointMotion<1>& motion_b, double begin) {
  const auto offset = exact_offset(motion_a, motion_b, oracle::rational(begin));
  Triple<Rational> velocity;
  for (int d = 0; d < 3; ++d) {
    velocity[static_cast<std::size_t>(d)] =
        oracle::rational(motion_b.coefficients[1][d]) - oracle::rational(motion_a.coefficients[1][d]);
  }
  const auto real_offset = real(offset);
  const auto real_velocity = real(velocity);
  struct Candidate {
    std::size_t i, j;
    Real tau;
  };
  std::vector<Candidate> candidates;
  Real best = std::numeric_limits<Real>::infinity();
  for (std::size_t i = 0; i < a.exact.size(); ++i) {
    for (std::size_t j = 0; j < b.exact.size(); ++j) {
      const auto tau = first_touch(a.approximate[i], b.approximate[j], real_offset, real_velocity);
      if (!tau) continue;
      candidates.push_back({i, j, *tau});
      best = std::min(best, *tau);
    }
  }
  std::optional<Rational> first;
  for (const Candidate& c : candidates) {
    if (c.tau > best * (1 + 1e-9L)) continue;
    const auto tau = first_touch(a.exact[c.i], b.exact[c.j], offset, velocity);
    if (tau && (!first || *tau < *first)) first = tau;
  }
  if (first) first = *first + oracle::rational(begin);
  return first;
}

/// The least separation of two triangles at t; < 0 where the surfaces cross.
template <int Degree>
Real separation(const ExactMesh& a, const ExactMesh& b, const kds::certificates::PointMotion<Degree>& motion_a,
                const kds::certificates::PointMotion<Degree>& motion_b, double t) {
  const auto offset = real(exact_offset(motion_a, motion_b, oracle::rational(t)));
  Real least = std::numeric_limits<Real>::infinity();
  for (const auto& of_a : a.approximate) {
    for (const auto& of_b : b.approximate) least = std::min(least, separation(of_a, of_b, offset));
  }
  return least;
}

}  // namespace accuracy
