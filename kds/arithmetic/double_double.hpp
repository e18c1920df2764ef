// Error-free transformations, and numbers of about 106 bits made of two doubles.
#pragma once

#include "kds/arithmetic/strict.hpp"

#include <cmath>

namespace kds {

/// An unevaluated sum high + low with |low| <= ulp(high) / 2: about 106 bits of precision, the range of double.
///
/// Paper: [Joldes17] (AccurateDWPlusDW, DWTimesDW, DWDivDW); relative errors are at most 2^-102 for every
/// operation here, barring overflow and underflow (the products of operands below 1e-140 may lose their low part;
/// `Ball` accounts for that).
/// Differs: the product of two doubles falls back to Dekker's splitting where the target has no fused
/// multiply-add, which gives the same two doubles for operands below 1e292.
struct DoubleDouble {
  double high = 0;
  double low = 0;

  constexpr DoubleDouble() = default;
  constexpr DoubleDouble(double value) : high(value) {}  // NOLINT(google-explicit-constructor): a double is exact
  constexpr DoubleDouble(double h, double l) : high(h), low(l) {}

  constexpr explicit operator double() const { return high; }
};

namespace detail {

/// a + b - sum, where sum is a + b rounded; of doubles, or of vectors of them, lane by lane.
template <class Number>
Number sum_error(Number a, Number b, Number sum) {
  const Number b_part = sum - a;
  const Number a_part = sum - b_part;
  return (a - a_part) + (b - b_part);
}

/// a b - product likewise, by Dekker's splitting.
template <class Number>
Number product_error(Number a, Number b, Number product) {
  constexpr double splitter = 134217729.0;  // 2^27 + 1
  const Number a_scaled = splitter * a;
  const Number a_high = a_scaled - (a_scaled - a);
  const Number a_low = a - a_high;
  const Number b_scaled = splitter * b;
  const Number b_high = b_scaled - (b_scaled - b);
  const Number b_low = b - b_high;
  return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
}

}  // namespace detail

/// a + b = high + low exactly [Knuth].
inline DoubleDouble two_sum(double a, double b) {
  const double sum = a + b;
  return {sum, detail::sum_error(a, b, sum)};
}

/// a + b = high + low exactly, for |a| >= |b| or a = 0 [Dekker71].
inline DoubleDouble fast_two_sum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// a b = high + low exactly, barring overflow and underflow.
inline DoubleDouble two_product(double a, double b) {
  const double product = a * b;
#if defined(__FMA__) || defined(FP_FAST_FMA)
  return {product, __builtin_fma(a, b, -product)};
#else
  return {product, detail::product_error(a, b, product)};
#endif
}

inline DoubleDouble operator-(const DoubleDouble& a) { return {-a.high, -a.low}; }

inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble high = two_sum(a.high, b.high);
  const DoubleDouble low = two_sum(a.low, b.low);
  const DoubleDouble sum = fast_two_sum(high.high, high.low + low.high);
  return fast_two_sum(sum.high, low.low + sum.low);
}

inline DoubleDouble operator+(const DoubleDouble& a, double b) {
  const DoubleDouble high = two_sum(a.high, b);
  return fast_two_sum(high.high, high.low + a.low);
}

inline DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + (-b); }
inline DoubleDouble operator-(const DoubleDouble& a, double b) { return a + (-b); }
inline DoubleDouble operator-(double a, const DoubleDouble& b) { return (-b) + a; }

inline DoubleDouble operator*(const DoubleDouble& a, double b) {
  const DoubleDouble product = two_product(a.high, b);
  return fast_two_sum(product.high, product.low + a.low * b);
}

inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble product = two_product(a.high, b.high);
  return fast_two_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
}

inline DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
  const double quotient = a.high / b.high;
  const DoubleDouble rest = a - b * quotient;
  return fast_two_sum(quotient, rest.high / b.high);
}

inline double magnitude(double a) { return std::abs(a); }
inline double magnitude(const DoubleDouble& a) { return std::abs(a.high); }

}  // namespace kds
