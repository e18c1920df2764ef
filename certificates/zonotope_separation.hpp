// A point away from a zonotope, a sum of segments, and from the parts of its surface.
#pragma once

#include "certificates/plane_separation.hpp"
#include "certificates/point_motion.hpp"
#include "kds/certificate.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace kds::certificates {

/// The segment from -length * direction to length * direction: the exact product, without a rounding. Preconditions:
/// length > 0, and the direction is not zero.
struct Generator {
  Eigen::Vector3d direction;
  double length;
};

/// The greatest number of segments: the sum of a box and a segment has four.
inline constexpr std::size_t most_generators = 4;
using Generators = std::span<const Generator>;

/// A cell of a zonotope: a vertex, a segment or a parallelogram, in which each generator is at one of its ends, except
/// up to two that sweep it.
struct ZonotopeCell {
  std::array<std::int8_t, most_generators> end{};  ///< -1 or 1; 0 for those that sweep the cell
  std::array<std::uint8_t, 2> swept{};             ///< the generators that sweep it
  std::uint8_t dimension = 0;                      ///< how many sweep it
};

namespace detail {

template <class T>
using Triple = std::array<T, 3>;

template <class Number>
Triple<Number> numbers(const Eigen::Vector3d& v) {
  return {Number(v[0]), Number(v[1]), Number(v[2])};
}
template <class X, class Y>
auto cross_product(const Triple<X>& x, const Triple<Y>& y) {
  using Product = decltype(x[0] * y[0]);
  return Triple<Product>{x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
}
template <class X, class Y>
auto inner_product(const Triple<X>& x, const Triple<Y>& y) {
  return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}

/// Products of polynomials and numbers, as those of polynomials.
template <class Number>
Triple<Polynomial<0, Number>> constants(const Triple<Number>& v) {
  Triple<Polynomial<0, Number>> result;
  for (std::size_t d = 0; d < 3; ++d) result[d].c[0] = v[d];
  return result;
}

/// b - a as seen from the centre of the cell.
template <class Number, int Degree>
Triple<Polynomial<Degree, Number>> from_cell(const PointMotion<Degree>& a, const PointMotion<Degree>& b,
                                             Generators generators, const ZonotopeCell& cell, double epoch) {
  auto x = relative_motion<Number>(a, b, epoch);
  for (std::size_t k = 0; k < generators.size(); ++k) {
    if (cell.end[k] == 0) continue;
    for (std::size_t d = 0; d < 3; ++d) {
      const double direction = generators[k].direction[static_cast<Eigen::Index>(d)];
      const Number part = Number(direction) * Number(generators[k].length);
      x[d].c[0] = cell.end[k] > 0 ? x[d].c[0] - part : x[d].c[0] + part;
    }
  }
  return x;
}

/// Positive if x is farther than r from the origin (dimension 0), from the line through it along u (1), or from the
/// plane through it that u and v span (2), with n = u x v:
///
///     x^2 - r^2,    (u x x)^2 - r^2 u^2,    (n . x)^2 - r^2 n^2
template <int Degree, class Number, class Direction>
Polynomial<2 * Degree, Number> distance_beyond(const Triple<Polynomial<Degree, Number>>& x, int dimension,
                                               const Direction& direction, const Number& radius) {
  const Number radius_square = radius * radius;
  Polynomial<2 * Degree, Number> f;
  if (dimension == 0) {
    f = square(x[0]) + square(x[1]) + square(x[2]);
    f.c[0] = f.c[0] - radius_square;
    return f;
  }
  const Triple<Number> u = direction(0);
  if (dimension == 1) {
    const auto w = cross_product(constants(u), x);
    f = square(w[0]) + square(w[1]) + square(w[2]);
    f.c[0] = f.c[0] - radius_square * inner_product(u, u);
  } else {
    const auto n = cross_product(u, direction(1));
    f = square(inner_product(constants(n), x));
    f.c[0] = f.c[0] - radius_square * inner_product(n, n);
  }
  return f;
}

}  // namespace detail

/// The point b - a is not nearer than the sum of two radii to the point, line or plane that a cell spans. Degree 2 for
/// linear, 4 for quadratic paths.
template <int PathDegree>
struct CellDistance {
  static constexpr int degree = 2 * PathDegree;
  const PointMotion<PathDegree>& a;
  const PointMotion<PathDegree>& b;
  Generators generators;
  ZonotopeCell cell;
  std::array<double, 2> radii;

  template <class Number>
  Polynomial<degree, Number> polynomial(double epoch) const {
    const auto x = detail::from_cell<Number>(a, b, generators, cell, epoch);
    const auto direction = [&](std::size_t k) { return detail::numbers<Number>(generators[cell.swept[k]].direction); };
    return detail::distance_beyond(x, cell.dimension, direction, Number(radii[0]) + radii[1]);
  }
};

/// The point b - a is beyond one end of the segment that a cell is, or of one of the two that sweep it, measured along
/// the direction that is perpendicular to the other one in the plane of both.
///
/// With x from the cell's centre and l the length of the generator u: side u . x >= l u^2; or with m = (u x v) x v,
/// whose product with u is -(u x v)^2, side m . x >= l (u x v)^2.
template <int PathDegree>
struct CellSide {
  static constexpr int degree = PathDegree;
  const PointMotion<PathDegree>& a;
  const PointMotion<PathDegree>& b;
  Generators generators;
  ZonotopeCell cell;
  std::size_t along;  ///< index in `swept`
  double side;        ///< +1 or -1

  template <class Number>
  Polynomial<degree, Number> polynomial(double epoch) const {
    const auto x = detail::from_cell<Number>(a, b, generators, cell, epoch);
    const Generator& swept = generators[cell.swept[along]];
    const auto u = detail::numbers<Number>(swept.direction);
    auto axis = u;
    Number square = detail::inner_product(u, u);
    if (cell.dimension == 2) {
      const auto v = detail::numbers<Number>(generators[cell.swept[1 - along]].direction);
      const auto n = detail::cross_product(u, v);
      axis = detail::cross_product(n, v);
      square = detail::inner_product(n, n);
    }
    Polynomial<degree, Number> f = detail::inner_product(detail::constants(axis), x) * side;
    f.c[0] = f.c[0] - square * Number(swept.length);
    return f;
  }
};

/// side n . (b - a) >= sum of length |n . direction| over all generators, with n the product of the directions of two:
/// the point b - a is outside of the zonotope, beyond the face that these two span.
template <int PathDegree>
struct ZonotopeSide {
  static constexpr int degree = PathDegree;
  const PointMotion<PathDegree>& a;
  const PointMotion<PathDegree>& b;
  Generators generators;
  std::array<std::uint8_t, 2> face;
  double side;  ///< +1 or -1

  template <class Number>
  Polynomial<degree, Number> polynomial(double epoch) const {
    const auto n = detail::cross_product(detail::numbers<Number>(generators[face[0]].direction),
                                         detail::numbers<Number>(generators[face[1]].direction));
    Polynomial<degree, Number> f =
        detail::inner_product(detail::constants(n), relative_motion<Number>(a, b, epoch)) * side;
    for (const Generator& each : generators) {
      const Number along = detail::inner_product(n, detail::numbers<Number>(each.direction));
      f.c[0] = f.c[0] - absolute(along) * Number(each.length);
    }
    return f;
  }
};

}  // namespace kds::certificates
