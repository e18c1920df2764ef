#include "kds/arithmetic/exact.hpp"

#include <boost/multiprecision/cpp_int.hpp>

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <new>
#include <utility>

namespace kds {

// Without expression templates: they would save nothing in operations of one step.
struct Exact::Mantissa {
  using Integer =
      boost::multiprecision::number<boost::multiprecision::cpp_int_backend<>, boost::multiprecision::et_off>;
  Integer integer = 0;
};

Exact::Mantissa& Exact::mantissa() { return *std::launder(reinterpret_cast<Mantissa*>(place_)); }
const Exact::Mantissa& Exact::mantissa() const { return *std::launder(reinterpret_cast<const Mantissa*>(place_)); }

Exact::Exact() {
  static_assert(sizeof(Mantissa) <= sizeof place_ && alignof(Mantissa) <= alignof(std::max_align_t));
  new (place_) Mantissa;
}

Exact::Exact(double value) : Exact() {
  if (value == 0) return;
  int exponent = 0;
  const double fraction = std::frexp(value, &exponent);
  // Without its last zeros: products of short numbers stay short, and need no memory of their own.
  const auto digits = static_cast<std::int64_t>(std::ldexp(fraction, 53));
  const int zeros = std::countr_zero(static_cast<std::uint64_t>(digits));
  mantissa().integer = digits / (std::int64_t{1} << zeros);
  exponent_ = exponent - 53 + zeros;
}

Exact::Exact(Mantissa&& mantissa, int exponent) : exponent_(mantissa.integer.is_zero() ? 0 : exponent) {
  new (place_) Mantissa(std::move(mantissa));
}

Exact::Exact(const Exact& other) : exponent_(other.exponent_) { new (place_) Mantissa(other.mantissa()); }
Exact::Exact(Exact&& other) noexcept : exponent_(other.exponent_) {
  new (place_) Mantissa(std::move(other.mantissa()));
}
Exact& Exact::operator=(const Exact& other) {
  mantissa() = other.mantissa();
  exponent_ = other.exponent_;
  return *this;
}
Exact& Exact::operator=(Exact&& other) noexcept {
  mantissa() = std::move(other.mantissa());
  exponent_ = other.exponent_;
  return *this;
}
Exact::~Exact() { mantissa().~Mantissa(); }

int Exact::sign() const { return mantissa().integer.sign(); }

double Exact::approximate() const {
  const auto& integer = mantissa().integer;
  if (integer.is_zero()) return 0;
  // Magnitudes are shifted, not negative numbers: Boost 1.74 loses the sign of those whose last 64 bits are a one.
  const Mantissa::Integer size = boost::multiprecision::abs(integer);
  const auto bits = static_cast<int>(boost::multiprecision::msb(size));
  const int excess = bits > 62 ? bits - 62 : 0;
  const std::int64_t leading = integer.sign() > 0 ? static_cast<std::int64_t>(size >> excess)
                                                  : -1 - static_cast<std::int64_t>((size - 1) >> excess);
  return std::ldexp(static_cast<double>(leading), exponent_ + excess);
}

int Exact::magnitude_bits() const {
  const auto& integer = mantissa().integer;
  if (integer.is_zero()) return 0;
  return static_cast<int>(boost::multiprecision::msb(boost::multiprecision::abs(integer))) + 1 + exponent_;
}

Exact operator-(const Exact& a) { return {Exact::Mantissa{-a.mantissa().integer}, a.exponent_}; }

Exact operator+(const Exact& a, const Exact& b) {
  const auto& x = a.mantissa().integer;
  const auto& y = b.mantissa().integer;
  if (x.is_zero()) return b;
  if (y.is_zero()) return a;
  if (a.exponent_ < b.exponent_) return b + a;
  return {Exact::Mantissa{(x << (a.exponent_ - b.exponent_)) + y}, b.exponent_};
}

Exact operator-(const Exact& a, const Exact& b) { return a + (-b); }

Exact operator*(const Exact& a, const Exact& b) {
  if (a.is_zero() || b.is_zero()) return {};
  return {Exact::Mantissa{a.mantissa().integer * b.mantissa().integer}, a.exponent_ + b.exponent_};
}

Exact scaled(const Exact& a, int exponent) {
  Exact result = a;
  if (a.sign() != 0) result.exponent_ += exponent;
  return result;
}

// Quotients of integers are truncated towards zero; right shifts act on magnitudes, so they truncate the same way.
Exact truncated(const Exact& a, int bits) {
  const int excess = -bits - a.exponent_;
  if (excess <= 0 || a.sign() == 0) return a;
  if (a.sign() < 0) return -truncated(-a, bits);
  return {Exact::Mantissa{a.mantissa().integer >> excess}, -bits};
}

Exact truncated_quotient(const Exact& a, const Exact& b, int bits) {
  const int shift = a.exponent_ - b.exponent_ + bits;
  const auto& x = a.mantissa().integer;
  const auto& y = b.mantissa().integer;
  if (shift >= 0) return {Exact::Mantissa{(x << shift) / y}, -bits};
  return {Exact::Mantissa{x / (y << -shift)}, -bits};
}

Exact truncated_square_root(const Exact& a, int bits) {
  const int shift = a.exponent_ + 2 * bits;
  const auto& x = a.mantissa().integer;
  return {
      Exact::Mantissa{sqrt(shift >= 0 ? Exact::Mantissa{x << shift}.integer : Exact::Mantissa{x >> -shift}.integer)},
      -bits};
}

}  // namespace kds
