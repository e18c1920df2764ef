// Functions of time near one time: Taylor polynomials with bounds on all that they leave out.
#pragma once

#include "kds/arithmetic/ball.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace kds::detail {

/// f(m + rho x) for -1 <= x <= 1, up to a positive factor: the sum of (c_k +- error_k) x^k to the power Order, and of
/// higher powers those of which the coefficients are at most those of M(x) exp(theta x), where M is `majorant`.
///
/// Such a bound holds for polynomials times products of cosines and sines of w_1 x, w_2 x ... with theta = w_1 + w_2 +
/// ...: each coefficient of cos(w x) and sin(w x) is at most that of exp(w x), and products keep that.
template <int Degree, int Order>
struct TaylorModel {
  static constexpr std::size_t terms = std::size_t{Order} + 1;

  std::array<double, terms> c{}, error{};
  std::array<double, std::size_t{Degree} + 1> majorant{};
  double theta = 0;  ///< at most 1

  /// The sign that derivative number n has throughout [-1, 1]; 0 where that is not certain.
  int certain_sign(int n) const {
    const double value = c[at(n)];
    return factorial(n) * std::abs(value) > rest(n) * Ball<double>::slack ? (value > 0 ? 1 : -1) : 0;
  }

  /// At least the magnitude of derivative number n throughout [-1, 1].
  double size(int n) const { return (factorial(n) * std::abs(c[at(n)]) + rest(n)) * Ball<double>::slack; }

  /// At most the magnitude of derivative number n anywhere in [-1, 1]; negative where that is not known.
  double least_size(int n) const { return factorial(n) * std::abs(c[at(n)]) - rest(n) * Ball<double>::slack; }

  /// Whether nothing but more precise coefficients helps: no derivative is told from zero, in however small a part of
  /// [-1, 1]. As that shrinks, so do c_k and error_k, alike.
  bool blurred() const {
    for (int n = 0; n < Order; ++n) {
      if (std::abs(c[at(n)]) > 2 * error[at(n)]) return false;
    }
    return true;
  }

  /// Derivative number n of the polynomial, with the bound on what it is off by.
  ///
  /// Horner's rule rounds each term 2 Order times at most, and one rounding of x changes it by Order roundings: for
  /// orders up to 27, 2^-45 of all terms is more than that.
  Ball<double> derivative(int n, double x) const {
    double weight = factorial(Order) / factorial(Order - n);
    double value = 0;
    double bound = 0;
    for (int k = Order; k >= n; --k) {
      value = value * x + weight * c[at(k)];
      bound += weight * (error[at(k)] + 0x1p-45 * std::abs(c[at(k)]));
      if (k > n) weight *= (k - n) / static_cast<double>(k);
    }
    return {value, bound + tail(n)};
  }

 private:
  static_assert(Order >= 3 * Degree + 2);

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

  /// Of derivative number n < Order, what the powers above Order can add.
  ///
  /// The coefficient k of x^j exp(theta x) is theta^(k - j) / (k - j)!, and the derivative multiplies it by k! / (k -
  /// n)!. From one k > Order to the next it falls by (k + 1) / (k + 1 - n) theta / (k + 1 - j), which is at most (Order
  /// + 2) / 3 / (Order + 2 - Degree) <= 1/2: so the sum is at most twice its first term.
  double tail(int n) const {
    if (theta == 0) return 0;
    double weight = 2;  // (Order + 1)! / (Order + 1 - n)!, twice
    for (int k = 0; k < n; ++k) weight *= Order + 1 - k;
    double power = theta;  // theta^(Order + 1 - j) / (Order + 1 - j)!
    for (int k = 2; k <= Order + 1 - Degree; ++k) power *= theta / k;
    double sum = 0;
    for (int j = Degree; j >= 0; --j) {
      sum += majorant[at(j)] * power;
      power *= theta / (Order + 2 - j);
    }
    return weight * sum;
  }
};

}  // namespace kds::detail
