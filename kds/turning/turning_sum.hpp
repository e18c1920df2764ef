// Functions of time that two spins make: sums of polynomials times sines and cosines.
#pragma once

#include "kds/polynomial.hpp"
#include "kds/turning/spin.hpp"

#include <array>
#include <cstddef>

namespace kds {

/// f(t) = sum over i, j in {0, 1, 2} of p[i][j](t) A_i(t) B_j(t), where (A_0, A_1, A_2) = (1, cos a, w sin a) for the
/// first spin, with its angle a and its rate w, and B the same for the second. The p are polynomials in (t - epoch).
///
/// It is the real form of a sum of polynomials times exp(i (k a + l b)) with k, l in {-1, 0, 1}: whatever is linear in
/// what turns with the one spin and in what turns with the other. With the rate beside the sine the coefficients of
/// motions given by doubles are sums of products of doubles, so that they are exact over Exact, and so are those of all
/// derivatives: A_1' = -A_2, A_2' = w^2 A_1.
template <int Degree, class Number>
struct TurningSum {
  static constexpr int degree = Degree;
  using Coefficient = Polynomial<Degree, Number>;

  std::array<std::array<Coefficient, 3>, 3> p;
};

/// f at the epoch, where the turns are those given.
template <int Degree, class Number, class Value>
Value value_at_epoch(const TurningSum<Degree, Number>& f, const Turn<Value>& a, const Turn<Value>& b) {
  const auto row = [&b](const auto& p) {
    return Value(p[0].c[0]) + b.cosine * Value(p[1].c[0]) + b.rate_sine * Value(p[2].c[0]);
  };
  return row(f.p[0]) + a.cosine * row(f.p[1]) + a.rate_sine * row(f.p[2]);
}

/// f' as a sum of the same kind; the squares of the rates are those of the two spins.
template <int Degree, class Number>
TurningSum<Degree, Number> derivative(const TurningSum<Degree, Number>& f, const Number& squared_rate_a,
                                      const Number& squared_rate_b) {
  using Coefficient = typename TurningSum<Degree, Number>::Coefficient;
  const auto times = [](const Coefficient& p, const Number& factor) {
    Coefficient result;
    for (std::size_t i = 0; i <= Degree; ++i) result.c[i] = p.c[i] * factor;
    return result;
  };
  TurningSum<Degree, Number> result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      Coefficient& sum = result.p[i][j];
      if constexpr (Degree > 0) sum = sum + derivative(f.p[i][j]);
      if (i == 1) sum = sum + times(f.p[2][j], squared_rate_a);
      if (i == 2) sum = sum - f.p[1][j];
      if (j == 1) sum = sum + times(f.p[i][2], squared_rate_b);
      if (j == 2) sum = sum - f.p[i][1];
    }
  }
  return result;
}

}  // namespace kds
