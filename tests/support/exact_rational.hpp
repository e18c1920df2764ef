// Exact rational numbers for tests whose inputs are doubles.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>

#include <cmath>
#include <compare>
#include <concepts>
#include <cstdint>
#include <optional>
#include <utility>

namespace oracle {

using Integer = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<>, boost::multiprecision::et_off>;

/// n 2^e / d with odd n (or zero) and odd, positive d, never reduced otherwise.
///
/// Sums and products of doubles keep d = 1, and the rotations of rational quaternions give few different d, so the
/// numbers stay small without a greatest common divisor, which is what takes the time in Boost's cpp_rational: an
/// operation here takes a tenth of it.
class Rational {
 public:
  Rational() = default;
  template <std::integral Number>
  Rational(Number value) : Rational(Integer(value)) {}         // NOLINT(google-explicit-constructor)
  Rational(Integer value) : n_(std::move(value)) { strip(); }  // NOLINT(google-explicit-constructor)
  Rational(const Integer& n, const Integer& d) : Rational(Rational(n) / Rational(d)) {}

  /// n 2^exponent.
  static Rational scaled(Integer n, int exponent) { return {std::move(n), 1, exponent}; }

  int sign() const { return n_.sign(); }

  /// The number is odd_numerator() 2^exponent() / odd_denominator().
  const Integer& odd_numerator() const { return n_; }
  const Integer& odd_denominator() const { return d_; }
  int exponent() const { return e_; }

  friend Rational operator-(Rational a) {
    a.n_ = -a.n_;
    return a;
  }
  friend Rational operator+(const Rational& a, const Rational& b) {
    if (a.n_.is_zero()) return b;
    if (b.n_.is_zero()) return a;
    if (a.e_ < b.e_) return b + a;
    const int shift = a.e_ - b.e_;
    if (a.d_ == b.d_) return Rational((a.n_ << shift) + b.n_, a.d_, b.e_);
    return Rational(((a.n_ * b.d_) << shift) + b.n_ * a.d_, a.d_ * b.d_, b.e_);
  }
  friend Rational operator-(const Rational& a, const Rational& b) { return a + -b; }
  friend Rational operator*(const Rational& a, const Rational& b) {
    return Rational(a.n_ * b.n_, a.d_ == 1 ? b.d_ : b.d_ == 1 ? a.d_ : Integer(a.d_ * b.d_), a.e_ + b.e_);
  }
  /// Precondition: b is not zero.
  friend Rational operator/(const Rational& a, const Rational& b) {
    const Integer n = a.n_ * b.d_;
    return Rational(b.n_ < 0 ? Integer(-n) : n, Integer(a.d_ * abs(b.n_)), a.e_ - b.e_);
  }
  Rational& operator+=(const Rational& b) { return *this = *this + b; }
  Rational& operator*=(const Rational& b) { return *this = *this * b; }
  Rational& operator/=(const Rational& b) { return *this = *this / b; }

  friend bool operator==(const Rational& a, const Rational& b) {
    if (a.d_ == b.d_) return a.e_ == b.e_ && a.n_ == b.n_;
    return (a - b).sign() == 0;
  }
  friend std::strong_ordering operator<=>(const Rational& a, const Rational& b) {
    if (a.sign() != b.sign()) return a.sign() <=> b.sign();
    return (a - b).sign() <=> 0;
  }

 private:
  Rational(Integer n, Integer d, int e) : n_(std::move(n)), d_(std::move(d)), e_(e) { strip(); }

  void strip() {
    if (n_.is_zero()) {
      d_ = 1;
      e_ = 0;
      return;
    }
    const bool negative = n_.sign() < 0;
    if (negative) n_.backend().negate();
    if (const auto twos = lsb(n_); twos != 0) {
      n_ >>= twos;
      e_ += static_cast<int>(twos);
    }
    if (negative) n_.backend().negate();
  }

  Integer n_ = 0;
  Integer d_ = 1;
  int e_ = 0;
};

inline Rational abs(const Rational& x) { return x.sign() < 0 ? -x : x; }
inline Rational square(const Rational& x) { return x * x; }

/// 2^exponent.
inline Rational power_of_two(int exponent) { return Rational::scaled(1, exponent); }

/// The exact value of a double. Precondition: finite.
inline Rational rational(double value) {
  if (value == 0) return {};
  int exponent = 0;
  const double fraction = std::frexp(value, &exponent);
  return Rational::scaled(static_cast<long long>(std::ldexp(fraction, 53)), exponent - 53);
}

/// The same for the end of a time; empty for infinity.
inline std::optional<Rational> time_end(double value) {
  return std::isinf(value) ? std::nullopt : std::optional<Rational>(rational(value));
}

/// A double next to the value, and the value itself if it is a double.
inline double approximate(const Rational& value) {
  if (value.sign() == 0) return 0;
  const Integer n = value.sign() < 0 ? Integer(-value.odd_numerator()) : value.odd_numerator();
  const Integer& d = value.odd_denominator();
  // 62 or 63 bits of quotient, the last of which says whether there are more; then one rounding.
  const int shift = 62 + static_cast<int>(msb(d)) - static_cast<int>(msb(n));
  const Integer dividend = shift >= 0 ? Integer(n << shift) : n;
  const Integer divisor = shift >= 0 ? d : Integer(d << -shift);
  Integer quotient;
  Integer rest;
  divide_qr(dividend, divisor, quotient, rest);
  const auto bits = quotient.convert_to<std::uint64_t>() | static_cast<std::uint64_t>(rest != 0);
  const double magnitude = std::ldexp(static_cast<double>(bits), value.exponent() - shift);
  return value.sign() < 0 ? -magnitude : magnitude;
}

}  // namespace oracle
