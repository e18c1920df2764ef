// A point away from the difference of two convex polytopes, and from the parts of its surface.
#pragma once

#include "certificates/point_motion.hpp"
#include "certificates/zonotope_separation.hpp"
#include "kds/certificate.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace kds::certificates {

/// Points of a body, turned by a matrix: the products as they are, without a rounding.
struct TurnedPoints {
  Eigen::Matrix3d turn;
  std::span<const Eigen::Vector3d> points;

  template <class Number>
  detail::Triple<Number> operator()(std::size_t i) const {
    return turned(detail::numbers<Number>(points[i]));
  }
  template <class Number>
  detail::Triple<Number> turned(const detail::Triple<Number>& v) const {
    const auto row = [&](Eigen::Index i) { return v[0] * turn(i, 0) + v[1] * turn(i, 1) + v[2] * turn(i, 2); };
    return {row(0), row(1), row(2)};
  }
};

/// A way between two points of body a, or of body b, as an edge of the difference A - B of the two.
struct DifferenceEdge {
  bool of_b;
  std::uint32_t from, to;
};

/// The difference A - B of the hulls of the points of two bodies: as bodies a and b keep their orientation, they
/// penetrate while the place of b seen from a is inside of it.
struct HullDifference {
  TurnedPoints a, b;

  /// The point of the difference that a point of each makes.
  template <class Number>
  detail::Triple<Number> point(const std::array<std::uint32_t, 2>& of) const {
    const auto x = a.template operator()<Number>(of[0]);
    const auto y = b.template operator()<Number>(of[1]);
    return {x[0] - y[0], x[1] - y[1], x[2] - y[2]};
  }
  template <class Number>
  detail::Triple<Number> direction(const DifferenceEdge& edge) const {
    const TurnedPoints& body = edge.of_b ? b : a;
    const Eigen::Vector3d& from = body.points[edge.of_b ? edge.to : edge.from];
    const Eigen::Vector3d& to = body.points[edge.of_b ? edge.from : edge.to];
    return body.turned(detail::Triple<Number>{difference<Number>(to[0], from[0]), difference<Number>(to[1], from[1]),
                                              difference<Number>(to[2], from[2])});
  }
  template <class Number>
  detail::Triple<Number> normal(const std::array<DifferenceEdge, 2>& edges) const {
    return detail::cross_product(direction<Number>(edges[0]), direction<Number>(edges[1]));
  }
  /// b - a as seen from a point of the difference.
  template <class Number, int Degree>
  detail::Triple<Polynomial<Degree, Number>> from(const std::array<std::uint32_t, 2>& point_of,
                                                  const PointMotion<Degree>& a_path, const PointMotion<Degree>& b_path,
                                                  double epoch) const {
    auto x = relative_motion<Number>(a_path, b_path, epoch);
    const auto origin = point<Number>(point_of);
    for (std::size_t d = 0; d < 3; ++d) x[d].c[0] = x[d].c[0] - origin[d];
    return x;
  }
};

/// n . (b - a) >= the greatest n . p of the difference, with n the product of two of its edges: the point b - a is
/// outside, beyond the plane across n that touches it. `farthest`: points of a, and points of b, of which one is the
/// farthest along n, and against n.
template <int PathDegree>
struct DifferencePlane {
  static constexpr int degree = PathDegree;
  const PointMotion<PathDegree>& a;
  const PointMotion<PathDegree>& b;
  const HullDifference& hulls;
  std::array<DifferenceEdge, 2> edges;
  std::array<std::span<const std::uint32_t>, 2> farthest;

  template <class Number>
  Polynomial<degree, Number> polynomial(double epoch) const {
    using namespace detail;
    const auto n = hulls.normal<Number>(edges);
    const auto greatest = [](const auto& values, const auto& height) {
      Number most = height(values[0]);
      for (std::size_t i = 1; i < values.size(); ++i) {
        const Number other = height(values[i]);
        most = (most + other + absolute(most - other)) * 0.5;
      }
      return most;
    };
    const Number of_a = greatest(
        farthest[0], [&](std::uint32_t i) { return inner_product(n, hulls.a.template operator()<Number>(i)); });
    const Number of_b = greatest(farthest[1], [&](std::uint32_t i) {
      return Number(0.0) - inner_product(n, hulls.b.template operator()<Number>(i));
    });
    Polynomial<degree, Number> f = inner_product(constants(n), relative_motion<Number>(a, b, epoch));
    f.c[0] = f.c[0] - (of_a + of_b);
    return f;
  }
};

/// A part of the surface of a difference: a point, a segment or a face, by its dimension: where it is, and the edges
/// that span it.
struct DifferencePart {
  int dimension;
  std::array<std::uint32_t, 2> point;
  std::array<DifferenceEdge, 2> edges;
};

/// The point b - a is not nearer than the sum of two radii to the point, line or plane that a part spans. Degree 2 for
/// linear, 4 for quadratic paths.
template <int PathDegree>
struct PartDistance {
  static constexpr int degree = 2 * PathDegree;
  const PointMotion<PathDegree>& a;
  const PointMotion<PathDegree>& b;
  const HullDifference& hulls;
  DifferencePart part;
  std::array<double, 2> radii;

  template <class Number>
  Polynomial<degree, Number> polynomial(double epoch) const {
    const auto direction = [&](std::size_t k) { return hulls.direction<Number>(part.edges[k]); };
    return detail::distance_beyond(hulls.from<Number>(part.point, a, b, epoch), part.dimension, direction,
                                   Number(radii[0]) + radii[1]);
  }
};

/// A side of a part: m . x >= 0 with x = b - a as seen from a point. For a side of a segment m is the edge; for one of
/// a face, which lies to the left of the edge seen from where its normal n points to, m = edge x n.
struct DifferenceSide {
  std::array<std::uint32_t, 2> point;
  DifferenceEdge edge;
  bool of_face;
  std::array<DifferenceEdge, 2> normal;

  template <class Number>
  detail::Triple<Number> outward(const HullDifference& hulls) const {
    const auto u = hulls.direction<Number>(edge);
    return of_face ? detail::cross_product(u, hulls.normal<Number>(normal)) : u;
  }
};

/// The point b - a is beyond a side of a part.
template <int PathDegree>
struct BeyondSide {
  static constexpr int degree = PathDegree;
  const PointMotion<PathDegree>& a;
  const PointMotion<PathDegree>& b;
  const HullDifference& hulls;
  DifferenceSide side;

  template <class Number>
  Polynomial<degree, Number> polynomial(double epoch) const {
    using namespace detail;
    return inner_product(constants(side.template outward<Number>(hulls)), hulls.from<Number>(side.point, a, b, epoch));
  }
};

}  // namespace kds::certificates
