// Functions of time near one time: Taylor polynomials with bounds on all that they leave out.
#pragma once

#include "kds/arithmetic/ball.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace kds::detail {

/// f(m + rho x) for -1 <= x <= 1, up to a positive factor: the sum of (c_k +- error_k) x^k to the power Order, and what
/// is beyond that, of which the derivative number Order + 1 is bounded.
template <int Order>
struct TaylorModel {
  static constexpr int order = Order;

  std::array<double, std::size_t{Order} + 1> c{}, error{};
  double next = 0;  ///< at least the magnitude of derivative number Order + 1 throughout [-1, 1]

  /// The sign that derivative number n has throughout [-1, 1]; 0 where that is not certain.
  int certain_sign(int n) const {
    const double value = c[at(n)];
    return factorial(n) * std::abs(value) > rest(n) * Ball<double>::slack ? (value > 0 ? 1 : -1) : 0;
  }

  /// At least the magnitude of derivative number n throughout [-1, 1].
  double size(int n) const { return (factorial(n) * std::abs(c[at(n)]) + rest(n)) * Ball<double>::slack; }

  /// At most the magnitude of derivative number n anywhere in [-1, 1]; negative where that is not known.
  double least_size(int n) const { return factorial(n) * std::abs(c[at(n)]) - rest(n) * Ball<double>::slack; }

  /// Whether more precise coefficients are wanted: the errors of the derivatives at m are not small beside the greatest
  /// of these. Otherwise some derivative keeps its sign where [-1, 1] is small enough, unless lower ones outgrow it.
  bool blurred() const {
    constexpr double small = 0x1p-10;
    double greatest = 0;
    double unsure = 0;
    for (int n = 0; n <= Order; ++n) {
      greatest = std::max(greatest, factorial(n) * std::abs(c[at(n)]));
      unsure += factorial(n) * error[at(n)];
    }
    return !(unsure <= small * greatest);
  }

  /// Derivative number n of the polynomial, with the bound on what it is off by.
  ///
  /// Horner's rule rounds each term 2 Order times at most, its weight Order times, and one rounding of x changes it by
  /// Order roundings: 2^-53 of all terms each.
  Ball<double> derivative(int n, double x) const {
    double weight = factorial(Order) / factorial(Order - n);
    double value = 0;
    double bound = 0;
    for (int k = Order; k >= n; --k) {
      value = value * x + weight * c[at(k)];
      bound += weight * (error[at(k)] + roundings * std::abs(c[at(k)]));
      if (k > n) weight *= (k - n) / static_cast<double>(k);
    }
    return {value, bound + tail(n)};
  }

 private:
  static constexpr double roundings = std::max(0x1p-45, 4 * Order * 0x1p-53);
  static constexpr std::size_t at(int k) { return static_cast<std::size_t>(k); }
  static constexpr double factorial(int n) {
    double product = 1;
    for (int k = 2; k <= n; ++k) product *= k;
    return product;
  }

  /// Of derivative number n, what is not in its coefficient.
  double rest(int n) const {
    double weight = factorial(n);
    double sum = weight * error[at(n)] + tail(n);
    for (int k = n + 1; k <= Order; ++k) {
      weight *= k / static_cast<double>(k - n);
      sum += weight * (std::abs(c[at(k)]) + error[at(k)]);
    }
    return sum;
  }

  /// Of derivative number n, what is beyond the power Order: the remainder of Taylor's theorem.
  double tail(int n) const { return next / factorial(Order + 1 - n); }
};

/// At least the magnitude of derivative number n, throughout [-1, 1], of a function of which each coefficient is at
/// most that of M(x) exp(theta x), where M is `majorant`. Preconditions: theta <= 1, n >= Size.
///
/// Such a bound holds for polynomials times products of cosines and sines of w_1 x, w_2 x ... with theta = w_1 + w_2 +
/// ...: each coefficient of cos(w x) and sin(w x) is at most that of exp(w x), and products keep that. No derivative is
/// greater than that of the majorant at 1, for x^j exp(theta x) the sum of n! / (i! (n - i)!) j! / (j - i)! theta^(n -
/// i) over i <= j, times exp(theta) < 2.72.
template <std::size_t Size>
double derivative_bound(const std::array<double, Size>& majorant, double theta, int n) {
  std::array<double, Size> power;  // theta^(n - i)
  power[Size - 1] = 1;
  for (int k = 0; k <= n - static_cast<int>(Size); ++k) power[Size - 1] *= theta;
  for (std::size_t i = Size - 1; i > 0; --i) power[i - 1] = power[i] * theta;
  double sum = 0;
  for (std::size_t j = 0; j < Size; ++j) {
    double weight = 1;
    for (std::size_t i = 0; i <= j; ++i) {
      sum += majorant[j] * weight * power[i];
      weight *= (n - static_cast<double>(i)) / static_cast<double>(i + 1) * static_cast<double>(j - i);
    }
  }
  return 2.72 * sum * Ball<double>::slack;
}

}  // namespace kds::detail
