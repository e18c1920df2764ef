// Exact arithmetic while doubles suffice.
#pragma once

#include "kds/arithmetic/double_double.hpp"
#include "kds/motion.hpp"

#include <cmath>

namespace kds {

/// A double, and whether it is exactly what it stands for. What is made of it by + - * is exact while no operation
/// rounds, and where an exact zero is a factor, whatever the other is. So it tells at a tenth of the cost of Exact, and
/// less, that a sum of products is zero, where that follows from factors that are zero and from short numbers: as of
/// boxes along the axes that lie on each other. And it tells that a b - b a is zero, whatever digits a and b have, as
/// in the product of two parallel vectors.
class PlainNumber {
 public:
  PlainNumber() = default;
  /// Precondition: finite.
  PlainNumber(double value) : value_(value) {}  // NOLINT(google-explicit-constructor): a double is exact

  /// Known to be zero; false says nothing.
  bool is_zero() const { return exact_ && value_ == 0; }

  friend PlainNumber operator-(const PlainNumber& a) { return {-a.value_, a.exact_}; }
  /// The error of a sum is exact, and not a number where the sum overflows.
  friend PlainNumber operator+(const PlainNumber& a, const PlainNumber& b) {
    const DoubleDouble sum = two_sum(a.value_, b.value_);
    return {sum.high, a.exact_ && b.exact_ && sum.low == 0};
  }
  friend PlainNumber operator-(const PlainNumber& a, const PlainNumber& b) { return a + -b; }
  /// The error of a product is exact if it cannot underflow.
  friend PlainNumber operator*(const PlainNumber& a, const PlainNumber& b) {
    if (a.is_zero() || b.is_zero()) return {};
    const DoubleDouble product = two_product(a.value_, b.value_);
    const bool in_range = std::abs(product.high) >= 0x1p-900;
    return {product.high, a.exact_ && b.exact_ && in_range && product.low == 0};
  }

  /// a b - c d.
  friend PlainNumber difference_of_products(const PlainNumber& a, const PlainNumber& b, const PlainNumber& c,
                                            const PlainNumber& d) {
    if (same(a, c) && same(b, d)) return {};
    if (same(a, d) && same(b, c)) return {};
    return a * b - c * d;
  }

 private:
  static bool same(const PlainNumber& a, const PlainNumber& b) { return a.exact_ && b.exact_ && a.value_ == b.value_; }

  PlainNumber(double value, bool exact) : value_(value), exact_(exact) {}

  double value_ = 0;
  bool exact_ = true;
};

template <>
inline PlainNumber difference<PlainNumber>(double a, double b) {
  return PlainNumber(a) - PlainNumber(b);
}

}  // namespace kds
