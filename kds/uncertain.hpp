// Functions of time that are known up to a radius that grows: the arithmetic of samples, and the signs that follow.
#pragma once

#include "kds/certificate.hpp"
#include "kds/motion.hpp"
#include "kds/polynomial.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <utility>

namespace kds {

/// A function of time that lies within radius(t) of middle(t), from `since` on: what the formula of a certificate gives
/// when its arguments are samples (Bounded, BoundedAcceleration) in place of motions. Middle and radius are polynomials
/// in (t - epoch).
///
/// Laws: (1) the coefficients of `radius` about `since`, the time of the latest sample, are not negative, so that it
/// grows from then on. (2) Sums add radii; for a product |xy - ab| <= |a| s + |b| r + r s with |x - a| <= r, |y - b| <=
/// s, where |a(t)| <= |a_0| + |a_1| u + |a_2| u^2 ..., u = t - since, a_i being the coefficients of a about `since`.
/// (3) So all are polynomials that do not depend on the epoch, which must be the same for both operands.
template <int MiddleDegree, int RadiusDegree, class Number>
struct Uncertain {
  Polynomial<MiddleDegree, Number> middle{};
  Polynomial<RadiusDegree, Number> radius{};
  double epoch = 0;  ///< s
  double since = 0;  ///< s

  friend Uncertain operator-(const Uncertain& a) { return {-a.middle, a.radius, a.epoch, a.since}; }
};

namespace detail {
constexpr int greater_of(int a, int b) { return a < b ? b : a; }

/// A polynomial about the same epoch that is not less than |middle| from `since` on.
template <int M, int R, class Number>
Polynomial<M, Number> majorant(const Uncertain<M, R, Number>& a) {
  Polynomial<M, Number> bound = a.middle;
  if constexpr (M > 0) bound = taylor_shift<Number>(bound, difference<Number>(a.since, a.epoch));
  for (Number& c : bound.c) c = absolute(c);
  if constexpr (M > 0) bound = taylor_shift<Number>(bound, difference<Number>(a.epoch, a.since));
  return bound;
}
}  // namespace detail

template <int MA, int RA, int MB, int RB, class Number>
auto operator+(const Uncertain<MA, RA, Number>& a, const Uncertain<MB, RB, Number>& b) {
  return Uncertain<detail::greater_of(MA, MB), detail::greater_of(RA, RB), Number>{
      a.middle + b.middle, a.radius + b.radius, a.epoch, std::max(a.since, b.since)};
}
template <int MA, int RA, int MB, int RB, class Number>
auto operator-(const Uncertain<MA, RA, Number>& a, const Uncertain<MB, RB, Number>& b) {
  return a + (-b);
}
template <int MA, int RA, int MB, int RB, class Number>
auto operator*(const Uncertain<MA, RA, Number>& a, const Uncertain<MB, RB, Number>& b) {
  const auto radius = b.radius * detail::majorant(a) + a.radius * detail::majorant(b) + a.radius * b.radius;
  return Uncertain<MA + MB, decltype(radius)::degree, Number>{a.middle * b.middle, radius, a.epoch,
                                                              std::max(a.since, b.since)};
}
template <int M, int R, class Number>
auto square(const Uncertain<M, R, Number>& a) {
  return a * a;
}
template <int M, int R, class Number>
Uncertain<M, R, Number> operator*(const Uncertain<M, R, Number>& a, double factor) {
  return {a.middle * factor, a.radius * std::abs(factor), a.epoch, a.since};
}
/// With constants, as constant<Number>() gives them.
template <int M, int R, class Number>
Uncertain<M, R, Number> operator+(const Uncertain<M, R, Number>& a, const Polynomial<0, Number>& b) {
  return {a.middle + b, a.radius, a.epoch, a.since};
}
template <int M, int R, class Number>
Uncertain<M, R, Number> operator-(const Uncertain<M, R, Number>& a, const Polynomial<0, Number>& b) {
  return {a.middle - b, a.radius, a.epoch, a.since};
}

/// A certificate whose arguments are sampled values: it gives an Uncertain in place of a polynomial.
template <class C>
concept UncertainCertificate = requires(const C& certificate, double epoch) {
  { C::degree } -> std::convertible_to<int>;
  { certificate.template polynomial<Exact>(epoch).middle.c[0] } -> std::convertible_to<Exact>;
  { certificate.template polynomial<Exact>(epoch).radius.c[0] } -> std::convertible_to<Exact>;
};

/// Holds while an uncertain certificate cannot have failed, whatever its elements did since they were sampled: middle -
/// radius >= 0. So its failure time is never late; the looser the bounds, the earlier it is.
template <UncertainCertificate C>
struct Conservative {
  static constexpr int degree = C::degree;
  const C& certificate;

  template <class Number>
  Polynomial<degree, Number> polynomial(double epoch) const {
    const auto f = certificate.template polynomial<Number>(epoch);
    return Polynomial<degree, Number>{} + (f.middle - f.radius);
  }
};

/// The same fact about the samples themselves, at rest or moving on at their velocities.
template <UncertainCertificate C>
struct OfSamples {
  static constexpr int degree = decltype(std::declval<const C&>().template polynomial<Exact>(0.0).middle)::degree;
  const C& certificate;

  template <class Number>
  Polynomial<degree, Number> polynomial(double epoch) const {
    return certificate.template polynomial<Number>(epoch).middle;
  }
};

/// Sign of a certificate at t+, of an uncertain one that of its samples. Exact.
template <class C>
requires(Certificate<C> || UncertainCertificate<C>) int exact_sign(const C& certificate, double t) {
  if constexpr (Certificate<C>) {
    return sign_after(certificate, t);
  } else {
    return sign_after(OfSamples<C>{certificate}, t);
  }
}

}  // namespace kds
