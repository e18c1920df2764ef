// What the certificates of two bodies that turn add up: products of their turned vectors, and the way between them.
#pragma once

#include "certificates/point_motion.hpp"
#include "certificates/turning/turned_vector.hpp"
#include "kds/arithmetic/exact.hpp"
#include "kds/arithmetic/plain_number.hpp"
#include "kds/polynomial.hpp"
#include "kds/turning/turning_sum.hpp"

#include <array>
#include <cstddef>
#include <limits>
#include <type_traits>

namespace kds::certificates {

/// b - a to an order at most the degree, about the epoch.
template <class Number, int Order, int Degree>
VectorOf<Polynomial<Order, Number>> way_between(const PointMotion<Degree>& a, const PointMotion<Degree>& b,
                                                double epoch) {
  static_assert(Order <= Degree);
  const auto whole = relative_motion<Number>(a, b, epoch);
  VectorOf<Polynomial<Order, Number>> way;
  for (std::size_t d = 0; d < 3; ++d) {
    for (std::size_t i = 0; i <= Order; ++i) way[d].c[i] = whole[d].c[i];
  }
  return way;
}

/// b - a at a time.
template <class Number, int Degree>
VectorOf<Number> way_at(const PointMotion<Degree>& a, const PointMotion<Degree>& b, double t) {
  const auto way = relative_motion<Number>(a, b, t);
  return {way[0].c[0], way[1].c[0], way[2].c[0]};
}

/// x . way.
template <class Number, int Order>
Polynomial<Order, Number> along(const VectorOf<Number>& x, const VectorOf<Polynomial<Order, Number>>& way) {
  Polynomial<Order, Number> sum;
  for (std::size_t i = 0; i <= Order; ++i) {
    sum.c[i] = x[0] * way[0].c[i] + x[1] * way[1].c[i] + x[2] * way[2].c[i];
  }
  return sum;
}

/// A number of one body's spin whose factors may change with time: the coefficients of 1, cos a, w sin a.
template <class Number, int Order>
using TurnedNumber = std::array<Polynomial<Order, Number>, 3>;

/// (R(t) m . way - offset) times the scale of the body (Turner).
template <int Order, class Number, int WayOrder>
TurnedNumber<Number, Order> seen_along(const Turner<Number>& turn, const VectorOf<Polynomial<WayOrder, Number>>& way,
                                       const VectorOf<Number>& m, const Number& offset) {
  static_assert(WayOrder <= Order);
  const TurnedVector<Number> turned = turn(m);
  TurnedNumber<Number, Order> result{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto sum = along(turned[i], way);
    for (std::size_t k = 0; k < sum.c.size(); ++k) result[i].c[k] = sum.c[k];
  }
  result[0].c[0] = result[0].c[0] - turn.scale() * offset;
  return result;
}

/// Adds the square of a number of one spin, up to the order that is kept, where both spins of the sum are that one.
template <int Order, class Number>
void add_square(TurningSum<Order, Number>& f, const TurnedNumber<Number, Order>& a) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      auto& sum = f.p[i][j];
      for (std::size_t n = 0; n <= Order; ++n) {
        for (std::size_t k = 0; k <= n; ++k) sum.c[n] = sum.c[n] + a[i].c[k] * a[j].c[n - k];
      }
    }
  }
}

/// Whether a part of a turned vector can be left out, as the cosine and the sine of a body that does not turn. Asked of
/// exact numbers alone: of others a product takes no longer than the question.
template <class Number>
bool adds_nothing(const VectorOf<Number>& part) {
  if constexpr (std::is_same_v<Number, Exact> || std::is_same_v<Number, PlainNumber>) {
    return part[0].is_zero() && part[1].is_zero() && part[2].is_zero();
  } else {
    return false;
  }
}

/// Adds a . b, of vectors that turn with the first and with the second spin.
template <int Order, class Number>
void add_product(TurningSum<Order, Number>& f, const TurnedVector<Number>& a, const TurnedVector<Number>& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (adds_nothing(a[i])) continue;
    for (std::size_t j = 0; j < 3; ++j) {
      if (!adds_nothing(b[j])) f.p[i][j].c[0] = f.p[i][j].c[0] + dot(a[i], b[j]);
    }
  }
}

/// A value in doubles that is off by `lengths` times `error`, where `lengths` bounds the product of two vectors and
/// `size` a third one. Besides, underflow of the turned vectors costs up to 2^-600, and products of the two others of
/// up to 2^200 make 2^-390 of it. Where they are longer nothing is said.
inline Ball<double> bounded_value(double value, double lengths, double size, double error) {
  const bool usual = lengths <= 0x1p100 && size <= 0x1p100;
  return {value, usual ? lengths * error + 0x1p-380 : std::numeric_limits<double>::infinity()};
}

}  // namespace kds::certificates
