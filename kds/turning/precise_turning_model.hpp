// Taylor's series of sums of sines and cosines about a time, as precisely as it takes.
#pragma once

#include "kds/arithmetic/enclosure.hpp"
#include "kds/arithmetic/power_of_two.hpp"
#include "kds/turning/taylor_model.hpp"
#include "kds/turning/turning_certificate.hpp"
#include "kds/turning/turning_expansion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <type_traits>

namespace kds::detail {

/// f solves a linear differential equation of this order with constant coefficients, for it is a sum of so many
/// solutions of one: powers of t up to the degree, times nine products of cosines and sines, of two harmonics 25. So of
/// f and its derivatives below this one not all are zero at any time, unless f is zero throughout.
template <class C>
inline constexpr int turning_dimension = (2 * harmonics_of<C> + 1) * (2 * harmonics_of<C> + 1) * (C::degree + 1);

/// The order of models with all of these derivatives, which decide in the end; and one with those that are enough to
/// leave 2^-65 of the terms over a radian, 2^-128 over an eighth of it: that takes a tenth of the time.
template <class C>
inline constexpr int whole_order = turning_dimension<C> - 1;
template <class C>
inline constexpr int usual_order = std::min(whole_order<C>, 20);

/// side * f about m with the unit of time 2^exponent: Number is Ball<DoubleDouble>; or it is Exact, for exact
/// coefficients and sines to so many bits. Preconditions: the rates times 2^exponent and the harmonics add up to at
/// most 1; f is not zero throughout.
///
/// All derivatives are computed as such, and rounded to doubles in the end. For numbers of any size: what is exact is
/// multiplied by a power of two before (the model is that of f up to this factor); double-doubles leave units of time
/// beyond 2^+-200 to that, and their radii tell what else is too much for them.
///
/// The terms of f may cancel to any degree, at all times, and then bounds by their magnitudes say nothing. But where N
/// = turning_dimension derivatives are known the equation bounds f^(N) by the derivatives d_k below it. Its roots are
/// at most theta, the sum of the rates times the unit and the harmonics, in magnitude, so its coefficients are at most
/// those of (x + theta)^N, and |f^(N)| is at most q = (1 + theta)^N - 1 times Y, the greatest of |f|, |f'| ... |f^(N -
/// 1)|. So Y grows by exp(max(1, q) |x|) at most, and for theta <= 1 / N, where q < e - 1, |f^(N)| is below 6 q max
/// |d_k|.
///
/// Cost: 0.05 ms in double-doubles, some milliseconds exactly with all derivatives, for degree 2 and one harmonic.
template <class Number, int Order, class C>
TaylorModel<Order> precise_turning_model(const C& certificate, int side, double m, int exponent, int bits = 0);

// ---------------------------------------------------------------------------------------------------------------

inline Ball<DoubleDouble> times_power_of_two(const Ball<DoubleDouble>& a, int exponent) {
  return a * power_of_two(exponent);
}
inline Exact times_power_of_two(const Exact& a, int exponent) { return scaled(a, exponent); }
inline Enclosure times_power_of_two(const Enclosure& a, int exponent) {
  return {scaled(a.middle, exponent), scaled(a.radius, exponent)};
}

/// a 2^-scale in doubles. approximate() is next to the number, or off by 2^-1074.
inline Ball<double> in_doubles(const Ball<DoubleDouble>& a, int) {
  return {a.middle.high, a.radius + std::abs(a.middle.low)};
}
inline Ball<double> in_doubles(const Enclosure& a, int scale) {
  const double middle = scaled(a.middle, -scale).approximate();
  const double radius = scaled(a.radius, -scale).approximate();
  return {middle, radius * Ball<double>::slack + 0x1p-50 * std::abs(middle) + 0x1p-1000};
}

/// The scale that brings numbers below 1: the least n with all of them below 2^n.
template <std::size_t Size>
int scale_of(const std::array<Ball<DoubleDouble>, Size>&) {
  return 0;
}
template <std::size_t Size>
int scale_of(const std::array<Enclosure, Size>& numbers) {
  int scale = std::numeric_limits<int>::min();
  for (const Enclosure& x : numbers) {
    if (x.middle.sign() != 0) scale = std::max(scale, x.middle.magnitude_bits());
  }
  return scale == std::numeric_limits<int>::min() ? 0 : scale;
}

/// A spin at a time, with a unit of time 2^exponent.
template <class Number>
struct SpinInUnits {
  using Value = std::conditional_t<std::is_same_v<Number, Exact>, Enclosure, Number>;

  SpinInUnits(const Spin& spin, double t, int exponent, int bits)
      : squared_rate(times_power_of_two(spin.template squared_rate<Number>(), 2 * exponent)) {
    if constexpr (std::is_same_v<Number, Exact>) {
      turn = spin.enclosed_turn(t, bits);
    } else {
      turn = spin.template turn<Number>(t);
    }
    turn.rate_sine = times_power_of_two(turn.rate_sine, exponent);
    if (!spin.still()) angle = std::ldexp(rate_bound(spin), exponent) + 0x1p-1000;
  }

  Number squared_rate;
  SpinAngle<Value> turn;
  double angle = 0;  ///< at least that of the unit of time
};

template <class Number, int Order, class C>
TaylorModel<Order> precise_turning_model(const C& certificate, int side, double m, int exponent, int bits) {
  TaylorModel<Order> model;
  if (!std::is_same_v<Number, Exact> && std::abs(exponent) > 200) {
    model.error.fill(std::numeric_limits<double>::infinity());
    return model;
  }
  const std::array<Spin, 2> spins = certificate.spins();
  const SpinInUnits<Number> a(spins[0], m, exponent, bits);
  const SpinInUnits<Number> b(spins[1], m, exponent, bits);
  const double theta = harmonics_of<C> * (a.angle + b.angle) * Ball<double>::slack;

  auto f = certificate.template turning_sum<Number, C::degree>(m);
  using Value = typename SpinInUnits<Number>::Value;
  std::array<Value, C::degree + 1> majorant{};
  for (std::size_t i = 0; i < f.size; ++i) {
    for (std::size_t j = 0; j < f.size; ++j) {
      const int sines = is_sine(i) + is_sine(j);
      const Number bound = Number(is_sine(i) ? a.angle : 1) * Number(is_sine(j) ? b.angle : 1);
      for (std::size_t k = 0; k <= C::degree; ++k) {
        Number& c = f.p[i][j].c[k];
        c = times_power_of_two(c, exponent * (static_cast<int>(k) - sines));
        majorant[k] = majorant[k] + Value(absolute(c) * bound);
      }
    }
  }
  constexpr std::size_t dimension = Order + 1;
  std::array<Value, dimension> derivatives;
  for (std::size_t k = 0;; ++k) {
    derivatives[k] = value_at_epoch(f, a.turn, b.turn);
    if (k == dimension - 1) break;
    f = derivative(f, a.squared_rate, b.squared_rate);
  }

  const int scale = scale_of(derivatives);
  double greatest = 0;
  double reciprocal = side;  // side / k!, rounded k times
  for (std::size_t k = 0; k < dimension; ++k) {
    const Ball<double> d = in_doubles(derivatives[k], scale);
    greatest = std::max(greatest, std::abs(d.middle) + d.radius);
    const Ball<double> c = d * Ball<double>(reciprocal, 0x1p-52 * static_cast<double>(k) * std::abs(reciprocal));
    model.c[k] = c.middle;
    model.error[k] = c.radius * Ball<double>::slack;
    reciprocal /= static_cast<double>(k + 1);
  }
  if (theta == 0) return model;
  std::array<double, C::degree + 1> sizes;
  for (std::size_t k = 0; k <= C::degree; ++k) {
    const Ball<double> size = in_doubles(majorant[k], scale);
    sizes[k] = std::abs(size.middle) + size.radius;
  }
  model.next = derivative_bound(sizes, theta, Order + 1);
  if (Order + 1 == turning_dimension<C> && theta * dimension <= 1) {
    const double q = std::expm1(dimension * std::log1p(theta)) * (1 + 0x1p-40);
    const double by_equation = 6 * q * greatest * Ball<double>::slack;
    if (!(model.next <= by_equation)) model.next = by_equation;
  }
  return model;
}

}  // namespace kds::detail
