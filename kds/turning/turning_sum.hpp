// Functions of time that two spins make: sums of polynomials times sines and cosines.
#pragma once

#include "kds/polynomial.hpp"
#include "kds/turning/spin.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace kds {

/// f(t) = sum over i, j of p[i][j](t) A_i(t) B_j(t), where A = (1, cos a, w sin a, cos 2 a, w sin 2 a ...), up to the
/// multiple Harmonics of the angle a, for the first spin with its rate w, and B the same for the second. The p are
/// polynomials in (t - epoch).
///
/// It is the real form of a sum of polynomials times exp(i (k a + l b)) with |k|, |l| <= Harmonics. Harmonics = 1:
/// whatever is linear in what turns with the one spin and in what turns with the other; 2: squares and products of two
/// of these. With the rate beside the sine the coefficients of motions given by doubles are sums of products of
/// doubles, so that they are exact over Exact, and so are those of all derivatives: (cos k a)' = -k (w sin k a), (w sin
/// k a)' = k w^2 cos k a.
template <int Degree, class Number, int Harmonics = 1>
struct TurningSum {
  static constexpr int degree = Degree;
  static constexpr int harmonics = Harmonics;
  /// How many functions of each spin: 1, and a cosine and a sine of each multiple of the angle.
  static constexpr std::size_t size = 2 * Harmonics + 1;
  using Coefficient = Polynomial<Degree, Number>;

  std::array<std::array<Coefficient, size>, size> p;
};

/// The multiple of the angle in A_i.
constexpr std::size_t multiple_of(std::size_t i) { return (i + 1) / 2; }
/// Whether A_i is a sine.
constexpr bool is_sine(std::size_t i) { return i > 0 && i % 2 == 0; }

/// A_1, A_2 ... of a turn, by the rule of the cosine of sums of angles.
template <int Harmonics, class Value>
auto harmonics_of_turn(const SpinAngle<Value>& a) {
  std::array<Value, 2 * std::size_t{Harmonics}> factors;
  factors[0] = a.cosine;
  factors[1] = a.rate_sine;
  if constexpr (Harmonics > 1) {
    const Value twice = a.cosine + a.cosine;
    factors[2] = twice * a.cosine + Value(-1.0);
    factors[3] = twice * a.rate_sine;
    for (std::size_t i = 4; i < factors.size(); ++i) factors[i] = twice * factors[i - 2] + -factors[i - 4];
  }
  return factors;
}

/// f at the epoch, where the turns are those given.
template <int Degree, class Number, int Harmonics, class Value>
Value value_at_epoch(const TurningSum<Degree, Number, Harmonics>& f, const SpinAngle<Value>& a,
                     const SpinAngle<Value>& b) {
  const auto of_a = harmonics_of_turn<Harmonics>(a);
  const auto of_b = harmonics_of_turn<Harmonics>(b);
  const auto row = [&of_b](const auto& p) {
    Value sum(p[0].c[0]);
    for (std::size_t j = 0; j < of_b.size(); ++j) sum = sum + of_b[j] * Value(p[j + 1].c[0]);
    return sum;
  };
  Value sum = row(f.p[0]);
  for (std::size_t i = 0; i < of_a.size(); ++i) sum = sum + of_a[i] * row(f.p[i + 1]);
  return sum;
}

/// f' as a sum of the same kind; the squares of the rates are those of the two spins.
template <int Degree, class Number, int Harmonics>
TurningSum<Degree, Number, Harmonics> derivative(const TurningSum<Degree, Number, Harmonics>& f,
                                                 const Number& squared_rate_a, const Number& squared_rate_b) {
  using Coefficient = typename TurningSum<Degree, Number, Harmonics>::Coefficient;
  constexpr std::size_t size = TurningSum<Degree, Number, Harmonics>::size;
  const auto times = [](const Coefficient& p, const Number& factor) {
    Coefficient result;
    for (std::size_t i = 0; i <= Degree; ++i) result.c[i] = p.c[i] * factor;
    return result;
  };
  const auto multiple = [&times](const Coefficient& p, std::size_t k) {
    return k == 1 ? p : times(p, Number(static_cast<double>(k)));
  };
  TurningSum<Degree, Number, Harmonics> result;
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j) {
      Coefficient& sum = result.p[i][j];
      if constexpr (Degree > 0) sum = sum + derivative(f.p[i][j]);
      if (i > 0) {
        sum = is_sine(i) ? sum - multiple(f.p[i - 1][j], multiple_of(i))
                         : sum + times(multiple(f.p[i + 1][j], multiple_of(i)), squared_rate_a);
      }
      if (j > 0) {
        sum = is_sine(j) ? sum - multiple(f.p[i][j - 1], multiple_of(j))
                         : sum + times(multiple(f.p[i][j + 1], multiple_of(j)), squared_rate_b);
      }
    }
  }
  return result;
}

namespace detail {

/// Zero for certain: what does not turn has no sines, and many products are spared.
template <class Number>
bool is_known_zero(const Number& x) {
  if constexpr (requires { x.is_zero(); }) {
    return x.is_zero();
  } else {
    return x == Number(0.0);
  }
}

/// A_i A_j = factor (A_first + sign A_second), times w^2 where both are sines; the sign is -1, 0 or 1.
struct HarmonicProduct {
  double factor;
  std::size_t first, second;
  int sign;
};
constexpr HarmonicProduct harmonic_product(std::size_t i, std::size_t j) {
  if (i == 0 || j == 0) return {1, i + j, 0, 0};
  const std::size_t k = multiple_of(i), l = multiple_of(j);
  const std::size_t sum = k + l, apart = k > l ? k - l : l - k;
  const auto cosine = [](std::size_t n) { return n == 0 ? std::size_t{0} : 2 * n - 1; };
  if (is_sine(i) == is_sine(j)) return {0.5, cosine(apart), cosine(sum), is_sine(i) ? -1 : 1};
  // sin k cos l = (sin (k + l) + sin (k - l)) / 2, where the sine has the greater multiple or not.
  const bool positive = (is_sine(i) ? k : l) > (is_sine(i) ? l : k);
  return {0.5, 2 * sum, 2 * apart, apart == 0 ? 0 : (positive ? 1 : -1)};
}

template <class Number, std::size_t Size>
bool is_known_zero(const std::array<Number, Size>& numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](const Number& x) { return is_known_zero(x); });
}

template <int Degree, class Number>
void add_signed(Polynomial<Degree, Number>& to, const Polynomial<Degree, Number>& p, int sign) {
  if (sign != 0) to = sign > 0 ? to + p : to - p;
}

}  // namespace detail

/// Adds f g up to the order that is kept. Halves are exact. Of a square, where f and g are one object, each product of
/// two different terms is made once.
template <int Order, int OrderF, int OrderG, class Number, int Harmonics, int OfF, int OfG>
void add_product(TurningSum<Order, Number, Harmonics>& sum, const TurningSum<OrderF, Number, OfF>& f,
                 const TurningSum<OrderG, Number, OfG>& g, const Number& squared_rate_a, const Number& squared_rate_b) {
  static_assert(OfF + OfG <= Harmonics);
  const bool square = static_cast<const void*>(&f) == static_cast<const void*>(&g);
  for (std::size_t at_f = 0; at_f < f.size * f.size; ++at_f) {
    const std::size_t i = at_f / f.size, j = at_f % f.size;
    if (detail::is_known_zero(f.p[i][j].c)) continue;
    for (std::size_t at_g = square ? at_f : 0; at_g < g.size * g.size; ++at_g) {
      const std::size_t k = at_g / g.size, l = at_g % g.size;
      if (detail::is_known_zero(g.p[k][l].c)) continue;
      Polynomial<Order, Number> product;
      for (std::size_t n = 0; n <= Order; ++n) {
        for (std::size_t m = n > OrderG ? n - OrderG : 0; m <= std::min<std::size_t>(n, OrderF); ++m) {
          if (detail::is_known_zero(f.p[i][j].c[m]) || detail::is_known_zero(g.p[k][l].c[n - m])) continue;
          product.c[n] = product.c[n] + f.p[i][j].c[m] * g.p[k][l].c[n - m];
        }
      }
      const detail::HarmonicProduct of_a = detail::harmonic_product(i, k), of_b = detail::harmonic_product(j, l);
      Number factor(of_a.factor * of_b.factor * (square && at_g != at_f ? 2 : 1));
      if (is_sine(i) && is_sine(k)) factor = factor * squared_rate_a;
      if (is_sine(j) && is_sine(l)) factor = factor * squared_rate_b;
      for (Number& x : product.c) x = x * factor;
      detail::add_signed(sum.p[of_a.first][of_b.first], product, 1);
      detail::add_signed(sum.p[of_a.first][of_b.second], product, of_b.sign);
      detail::add_signed(sum.p[of_a.second][of_b.first], product, of_a.sign);
      detail::add_signed(sum.p[of_a.second][of_b.second], product, of_a.sign * of_b.sign);
    }
  }
}

}  // namespace kds
