// A value together with a bound on its error: the filter of the sign ladder.
#pragma once

#include "kds/arithmetic/double_double.hpp"

#include <cmath>

namespace kds {

/// Unit of rounding error charged per operation, relative to the result.
template <class T>
inline constexpr double rounding_unit = 0x1p-52;
template <>
inline constexpr double rounding_unit<DoubleDouble> = 0x1p-101;

/// The real number meant lies within `radius` of `middle`.
///
/// Error bound. With u the relative error of one operation (2^-53 for double, 2^-102 for DoubleDouble) the radii of
/// a sum and a product are at most
///     r(a + b) = r(a) + r(b) + u |a + b|
///     r(a b)   = |a| r(b) + |b| r(a) + r(a) r(b) + u |a b|  (+ underflow, where the product is tiny).
/// They are computed in doubles with 2 u in place of u, which pays for evaluating |a + b| in place of the exact sum;
/// the roundings of the radius itself are relative errors of 2^-53 each, at most a few hundred of them, so the true
/// bound is below radius * (1 + 2^-40). `certain_sign` demands that much. An overflow leaves an infinity or a NaN, for
/// which no comparison holds, so that the sign is undecided too. A radius of zero means that the value is exact: the
/// differences of equal coefficients (a common gravity) are known to be zero, and cost no exact arithmetic.
template <class T>
struct Ball {
  T middle{};
  double radius = 0;

  /// Least normal double: exceeds what a product can lose by underflow, in either number type...
  static constexpr double underflow = 0x1p-1022;
  /// ... which it cannot do unless it is smaller than this.
  static constexpr double tiny = 0x1p-900;
  /// Pays for the roundings made while radii were added up.
  static constexpr double slack = 1 + 0x1p-40;

  constexpr Ball() = default;
  constexpr Ball(double exact) : middle(exact) {}  // NOLINT(google-explicit-constructor): a double is exact
  constexpr Ball(T m, double r) : middle(m), radius(r) {}

  friend Ball operator-(const Ball& a) { return {-a.middle, a.radius}; }
  friend Ball operator+(const Ball& a, const Ball& b) {
    const T sum = a.middle + b.middle;
    return {sum, a.radius + b.radius + rounding_unit<T> * magnitude(sum)};
  }
  friend Ball operator-(const Ball& a, const Ball& b) {
    const T difference = a.middle - b.middle;
    return {difference, a.radius + b.radius + rounding_unit<T> * magnitude(difference)};
  }
  friend Ball operator+(const Ball& a, double b) {
    const T sum = a.middle + b;
    return {sum, a.radius + rounding_unit<T> * magnitude(sum)};
  }
  friend Ball operator-(const Ball& a, double b) { return a + (-b); }
  // Whether compilers inline this by themselves depends on what else a file has. Where it always is, in-circle tests of
  // lines and of parabolas take 6 % fewer instructions, and failure times of random parabolas 2 % more (callgrind).
  [[gnu::always_inline]] friend Ball operator*(const Ball& a, const Ball& b) {
    const T product = a.middle * b.middle;
    double bound = magnitude(a.middle) * b.radius + magnitude(b.middle) * a.radius + a.radius * b.radius +
                   rounding_unit<T> * magnitude(product);
    if (magnitude(product) < tiny && !a.is_zero() && !b.is_zero()) bound += underflow;
    return {product, bound};
  }
  friend Ball operator*(const Ball& a, double b) {
    const T product = a.middle * b;
    double bound = std::abs(b) * a.radius + rounding_unit<T> * magnitude(product);
    if (magnitude(product) < tiny && !a.is_zero() && b != 0) bound += underflow;
    return {product, bound};
  }

  /// Known to be zero exactly.
  bool is_zero() const { return magnitude(middle) == 0 && radius == 0; }
};

/// | |x| - |middle| | <= radius, so the radius stays whether or not the sign is certain.
template <class T>
Ball<T> absolute(const Ball<T>& a) {
  return static_cast<double>(a.middle) < 0 ? -a : a;
}

/// -1 or +1 where the ball excludes zero, 0 where it does not (the value is zero, or undecided).
template <class T>
int certain_sign(const Ball<T>& a) {
  const double bound = a.radius * Ball<T>::slack;
  const double value = static_cast<double>(a.middle);
  return value > bound ? 1 : (-value > bound ? -1 : 0);
}

}  // namespace kds
