// A ball beyond sides of a box that turns.
#pragma once

#include "certificates/turning/rigid_motion.hpp"
#include "certificates/turning/turned_vector.hpp"
#include "certificates/turning/turning_terms.hpp"
#include "kds/polynomial.hpp"
#include "kds/turning/turning_certificate.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace kds::certificates {

/// Sides of a box, by its axes: -1 or 1 names one of the two across an axis, 0 none. One is a face, two are an edge,
/// three a corner.
using BoxSides = std::array<int, 3>;

namespace detail {

/// Spins and path of the pair, of which only the box turns.
template <int Degree>
struct BallAndBox {
  const PointMotion<Degree>& ball;  ///< the path of the centre
  const RigidMotion<Degree>& box;   ///< about its centre
  Eigen::Vector3d half_extents;

  /// Products of two turned numbers of the box are terms in its spin, taken twice.
  std::array<Spin, 2> spins() const { return {box.spin(), box.spin()}; }

  template <class Number, int Order>
  auto way(double epoch) const {
    return way_between<Number, std::min(Order, Degree)>(box.path, ball, epoch);
  }

  /// How far the centre of the ball is beyond one side, times the scale of the box.
  template <class Number, int Order, class Way>
  TurnedNumber<Number, Order> beyond_side(const Turner<Number>& turn, const Way& way, std::size_t axis,
                                          int side) const {
    VectorOf<Number> outward{Number(0.0), Number(0.0), Number(0.0)};
    outward[axis] = Number(static_cast<double>(side));
    return seen_along<Order>(turn, way, outward, Number(half_extents[static_cast<Eigen::Index>(axis)]));
  }
};

}  // namespace detail

/// side * (R(t) e_axis) . (c(t) - o(t)) >= half extent: the centre c of a ball is beyond the plane of one side of a
/// box, or in it. Times the scale of the box.
template <int Degree>
struct CentreBeyondSide : detail::BallAndBox<Degree> {
  static constexpr int degree = Degree;
  std::size_t axis;
  int side;  ///< -1 or 1

  template <class Number, int Order>
  TurningSum<Order, Number> turning_sum(double epoch) const {
    const auto beyond = this->template beyond_side<Number, Order>(Turner<Number>(this->box),
                                                                  this->template way<Number, Order>(epoch), axis, side);
    TurningSum<Order, Number> f{};
    for (std::size_t i = 0; i < 3; ++i) f.p[i][0] = beyond[i];
    return f;
  }
};

/// The sum over the sides named of (how far the centre is beyond it)^2 >= radius^2, times the square of the scale of
/// the box. While the centre is beyond each of them the ball is then outside of the box.
template <int Degree>
struct BallBeyondSides : detail::BallAndBox<Degree> {
  static constexpr int degree = 2 * Degree;
  double radius;
  BoxSides sides;

  template <class Number, int Order>
  TurningSum<Order, Number> turning_sum(double epoch) const {
    const Turner<Number> turn(this->box);
    const auto way = this->template way<Number, Order>(epoch);
    TurningSum<Order, Number> f{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (sides[axis] == 0) continue;
      add_square(f, this->template beyond_side<Number, Order>(turn, way, axis, sides[axis]));
    }
    const Number scaled_radius = turn.scale() * Number(radius);
    f.p[0][0].c[0] = f.p[0][0].c[0] - scaled_radius * scaled_radius;
    return f;
  }
};

}  // namespace kds::certificates
