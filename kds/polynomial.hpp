// Polynomials in one variable with a degree known at compile time.
#pragma once

#include "kds/arithmetic/unrolled.hpp"

#include <array>
#include <cstddef>

namespace kds {

/// c[0] + c[1] x + ... + c[Degree] x^Degree. The degree is an upper bound: leading coefficients may be zero.
///
/// `Scalar` is any number type the library computes with: `double`, `DoubleDouble`, `Ball<T>` (a value with a bound
/// on its error) or `Exact`. Formulas written once over Polynomial therefore run on every rung of the sign ladder.
template <int Degree, class Scalar = double>
struct Polynomial {
  static_assert(Degree >= 0);
  static constexpr int degree = Degree;

  std::array<Scalar, std::size_t{Degree} + 1> c{};  ///< coefficients, constant first

  /// The value at x, by Horner's rule.
  template <class Argument>
  constexpr auto operator()(const Argument& x) const {
    using Value = decltype(c[0] * x + c[0]);
    Value value(c[Degree]);
    for (int i = Degree - 1; i >= 0; --i) value = value * x + c[static_cast<std::size_t>(i)];
    return value;
  }

  friend constexpr bool operator==(const Polynomial&, const Polynomial&) = default;
};

/// The derivative with respect to x.
template <int Degree, class Scalar>
  requires(Degree >= 1)
constexpr Polynomial<Degree - 1, Scalar> derivative(const Polynomial<Degree, Scalar>& p) {
  Polynomial<Degree - 1, Scalar> result;
  for (int i = 1; i <= Degree; ++i) {
    result.c[static_cast<std::size_t>(i - 1)] = p.c[static_cast<std::size_t>(i)] * static_cast<double>(i);
  }
  return result;
}

template <int DegreeA, int DegreeB, class Scalar>
constexpr auto operator+(const Polynomial<DegreeA, Scalar>& a, const Polynomial<DegreeB, Scalar>& b) {
  if constexpr (DegreeA < DegreeB) {
    return b + a;
  } else {
    Polynomial<DegreeA, Scalar> sum = a;
    for (std::size_t i = 0; i <= DegreeB; ++i) sum.c[i] = a.c[i] + b.c[i];
    return sum;
  }
}

template <int Degree, class Scalar>
constexpr Polynomial<Degree, Scalar> operator-(const Polynomial<Degree, Scalar>& a) {
  Polynomial<Degree, Scalar> negated;
  for (std::size_t i = 0; i <= Degree; ++i) negated.c[i] = -a.c[i];
  return negated;
}

template <int DegreeA, int DegreeB, class Scalar>
constexpr auto operator-(const Polynomial<DegreeA, Scalar>& a, const Polynomial<DegreeB, Scalar>& b) {
  constexpr int degree = DegreeA < DegreeB ? DegreeB : DegreeA;
  Polynomial<degree, Scalar> difference;
  for (std::size_t i = 0; i <= degree; ++i) {
    if (i <= DegreeA && i <= DegreeB) {
      difference.c[i] = a.c[i] - b.c[i];
    } else {
      difference.c[i] = i <= DegreeA ? a.c[i] : -b.c[i];
    }
  }
  return difference;
}

template <int DegreeA, int DegreeB, class Scalar>
constexpr Polynomial<DegreeA + DegreeB, Scalar> operator*(const Polynomial<DegreeA, Scalar>& a,
                                                         const Polynomial<DegreeB, Scalar>& b) {
  Polynomial<DegreeA + DegreeB, Scalar> product;
  for (std::size_t i = 0; i <= DegreeA; ++i) {
    for (std::size_t j = 0; j <= DegreeB; ++j) product.c[i + j] = product.c[i + j] + a.c[i] * b.c[j];
  }
  return product;
}

/// p^2, with each product of two different coefficients computed once.
template <int Degree, class Scalar>
constexpr Polynomial<2 * Degree, Scalar> square(const Polynomial<Degree, Scalar>& p) {
  Polynomial<2 * Degree, Scalar> result;
  unrolled<2 * Degree + 1>([&](auto number) {
    constexpr std::size_t k = number;
    constexpr std::size_t first = k > Degree ? k - Degree : 0;
    constexpr bool even = k % 2 == 0;
    Scalar sum = even ? p.c[k / 2] * p.c[k / 2] : p.c[first] * p.c[k - first] * 2.0;
    unrolled<(k + 1) / 2 - first>([&](auto i) {
      if constexpr (even || i > 0) sum = sum + p.c[first + i] * p.c[k - first - i] * 2.0;
    });
    result.c[k] = sum;
  });
  return result;
}

/// Every coefficient times a double, which is taken as exact.
template <int Degree, class Scalar>
constexpr Polynomial<Degree, Scalar> operator*(const Polynomial<Degree, Scalar>& a, double factor) {
  Polynomial<Degree, Scalar> product;
  for (std::size_t i = 0; i <= Degree; ++i) product.c[i] = a.c[i] * factor;
  return product;
}

}  // namespace kds
