// Parts of two bodies that turn, corners, lines and planes: how far they are apart, and where they are nearest.
#pragma once

#include "certificates/turning/pair_products.hpp"
#include "certificates/turning/rigid_motion.hpp"
#include "certificates/turning/turned_vector.hpp"
#include "kds/turning/turning_certificate.hpp"

#include <Eigen/Core>

#include <array>

namespace kds::certificates {

/// A formula of the products of two bodies (pair_products.hpp) that is to be >= 0. d leads from the point x of body a
/// to the point y of body b. What is of second order in what turns with a body has two harmonics.
///
/// `Formula`: `order`, of its polynomials in that of the motions; `harmonics`; `value(products)`.
template <int Degree, class Formula>
struct BetweenParts {
  static constexpr int degree = Formula::order * Degree;
  static constexpr int harmonics = Formula::harmonics;

  const RigidMotion<Degree>& a;
  const RigidMotion<Degree>& b;
  Eigen::Vector3d x, y;  ///< in the coordinates of their bodies
  Formula formula;

  std::array<Spin, 2> spins() const { return {a.spin(), b.spin()}; }

  template <class Number, int Order>
  TurningSum<Order, Number, harmonics> turning_sum(double epoch) const {
    return formula.value(SummedProducts<Number, Order, Degree>(a, x, b, y, epoch));
  }
  Ball<double> quick_value(double t) const { return formula.value(ProductsNow<Ball<double>>(a, x, b, y, t)); }
  Ball<DoubleDouble> extended_value(double t) const {
    return formula.value(ProductsNow<Ball<DoubleDouble>>(a, x, b, y, t));
  }
};

/// Points of one body, from which its vectors are made.
using EdgeEnds = std::array<Eigen::Vector3d, 2>;
using FaceCorners = std::array<Eigen::Vector3d, 3>;

namespace detail {

template <class Number>
VectorOf<Number> edge_vector(const EdgeEnds& edge) {
  return difference_of<Number>(edge[0], edge[1]);
}
template <class Number>
VectorOf<Number> face_normal(const FaceCorners& corners) {
  return cross(difference_of<Number>(corners[0], corners[1]), difference_of<Number>(corners[0], corners[2]));
}
/// The square of the sum of two radii, which is not rounded.
template <class Number>
Number squared_sum(const std::array<double, 2>& radii) {
  const Number sum = Number(radii[0]) + Number(radii[1]);
  return sum * sum;
}

}  // namespace detail

/// u . d >= 0: the point of b is on the side of x to which an edge of a leads.
struct PastEnd {
  static constexpr int order = 1, harmonics = 1;
  EdgeEnds edge;

  template <class Products>
  auto value(const Products& products) const {
    return products.of_a(detail::edge_vector<typename Products::Value>(edge));
  }
};

/// m . d >= 0, where m leads away from a face of a across the edge from its first corner to the next, in its plane.
struct AcrossSide {
  static constexpr int order = 1, harmonics = 1;
  FaceCorners face;

  template <class Products>
  auto value(const Products& products) const {
    using Number = typename Products::Value;
    return products.of_a(cross(detail::edge_vector<Number>({face[0], face[1]}), detail::face_normal<Number>(face)));
  }
};

/// n . d >= h + r: a point of b is above the plane of a half-space of a that is at the height h above x along n, and a
/// radius more. The sum is not rounded, and the radius counts as it is, whatever the length of n.
struct AbovePlane {
  static constexpr int order = 1, harmonics = 1;
  Eigen::Vector3d normal;
  double offset, radius;

  template <class Products>
  auto value(const Products& products) const {
    using Number = typename Products::Value;
    return products.difference(products.of_a(vector_of<Number>(normal)),
                               products.constant(Number(offset) + Number(radius)));
  }
};

/// d . d >= r^2: two points are no nearer than the sum of two radii.
struct PointsApart {
  static constexpr int order = 2, harmonics = 1;
  std::array<double, 2> radii;

  template <class Products>
  auto value(const Products& products) const {
    using Number = typename Products::Value;
    return products.difference(products.square(), products.constant(detail::squared_sum<Number>(radii)));
  }
};

/// (u . u) (d . d) - (u . d)^2 >= r^2 (u . u): a point of b is no nearer to the line of an edge of a through x.
struct LineApart {
  static constexpr int order = 2, harmonics = 2;
  EdgeEnds edge;
  std::array<double, 2> radii;

  template <class Products>
  auto value(const Products& products) const {
    using Number = typename Products::Value;
    const VectorOf<Number> u = detail::edge_vector<Number>(edge);
    const auto along = products.of_a(u);
    typename Products::Twice f{};
    products.add(f, products.constant(dot(u, u)),
                 products.difference(products.square(), products.constant(detail::squared_sum<Number>(radii))));
    products.subtract(f, along, along);
    return f;
  }
};

/// (u . u) (v . d) - (u . d) (u . v) >= 0: with n the perpendicular from the line of an edge u of a through x to y, n .
/// v >= 0: the edge v of b does not lead nearer to that line.
struct AwayFromLine {
  static constexpr int order = 1, harmonics = 2;
  EdgeEnds line, edge;

  template <class Products>
  auto value(const Products& products) const {
    using Number = typename Products::Value;
    const VectorOf<Number> u = detail::edge_vector<Number>(line), v = detail::edge_vector<Number>(edge);
    typename Products::Twice f{};
    products.add(f, products.constant(dot(u, u)), products.of_b(v));
    products.subtract(f, products.of_a(u), products.product(u, v));
    return f;
  }
};

/// (n . d)^2 >= r^2 (n . n): a point of b is no nearer to the plane of a face of a, with the normal n, that x is in.
struct PlaneApart {
  static constexpr int order = 2, harmonics = 2;
  FaceCorners face;
  std::array<double, 2> radii;

  template <class Products>
  auto value(const Products& products) const {
    using Number = typename Products::Value;
    const VectorOf<Number> n = detail::face_normal<Number>(face);
    const auto height = products.of_a(n);
    typename Products::Twice f{};
    products.add(f, height, height);
    products.subtract(f, products.constant(dot(n, n)), products.constant(detail::squared_sum<Number>(radii)));
    return f;
  }
};

/// ((u x v) . d)^2 >= r^2 |u x v|^2: the lines of an edge u of a through x and of an edge v of b through y are no
/// nearer to each other. |u x v|^2 = (u . u) (v . v) - (u . v)^2. Zero while they are parallel.
struct LinesApart {
  static constexpr int order = 2, harmonics = 2;
  EdgeEnds edge_a, edge_b;
  std::array<double, 2> radii;

  template <class Products>
  auto value(const Products& products) const {
    using Number = typename Products::Value;
    const VectorOf<Number> u = detail::edge_vector<Number>(edge_a), v = detail::edge_vector<Number>(edge_b);
    const auto volume = products.triple(u, v), along = products.product(u, v);
    const Number square = detail::squared_sum<Number>(radii);
    typename Products::Twice f{}, sine{};
    products.add(f, volume, volume);
    products.subtract(sine, products.constant(dot(u, u)), products.constant(dot(v, v)));
    products.add(sine, along, along);
    products.add_multiple(f, sine, square);
    return f;
  }
};

}  // namespace kds::certificates
