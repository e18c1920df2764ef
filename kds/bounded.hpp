// Values of which only a sample and a bound on the speed are known: the black-box model of motion.
#pragma once

#include "kds/certificate.hpp"
#include "kds/polynomial.hpp"

#include <cmath>
#include <concepts>

namespace kds {

/// A value that was at `position` at time `start` and has moved at most at `speed` since: whatever it did, it lies in
/// position +- speed (t - start). Papers: [Kahan91]; [deBerg11], the black-box model.
struct Bounded {
  static constexpr int degree = 1;
  static constexpr bool sampled = true;

  double position = 0;  ///< length
  double speed = 0;     ///< length/s, >= 0
  double start = 0;     ///< s, when the sample was taken

  friend bool operator==(const Bounded&, const Bounded&) = default;
};

inline bool is_finite(const Bounded& value) {
  return std::isfinite(value.position) && std::isfinite(value.start) && value.speed >= 0 && std::isfinite(value.speed);
}

/// A function of time of which is known that it lies within radius(t) of `middle`: what the formula of a certificate
/// gives when it is fed with Bounded values in place of motions.
///
/// Law: the coefficients of `radius` about the latest sample are not negative, so that it grows. Sums add radii; for a
/// product |xy - ab| <= |a| s + |b| r + r s with |x - a| <= r, |y - b| <= s. These are identities between polynomials,
/// so that the bound is the same function of time about every epoch.
template <int Degree, class Number>
struct Uncertain {
  Number middle{};
  Polynomial<Degree, Number> radius{};

  friend Uncertain operator-(const Uncertain& a) { return {-a.middle, a.radius}; }
};

namespace detail {
inline Exact absolute(const Exact& a) { return a.sign() < 0 ? -a : a; }
template <class T>
Ball<T> absolute(const Ball<T>& a) {
  return static_cast<double>(a.middle) < 0 ? -a : a;
}

/// Every coefficient times a number.
template <int Degree, class Number>
Polynomial<Degree, Number> times(const Polynomial<Degree, Number>& p, const Number& factor) {
  Polynomial<Degree, Number> product;
  for (std::size_t i = 0; i <= Degree; ++i) product.c[i] = p.c[i] * factor;
  return product;
}
}  // namespace detail

template <int DegreeA, int DegreeB, class Number>
auto operator+(const Uncertain<DegreeA, Number>& a, const Uncertain<DegreeB, Number>& b) {
  return Uncertain<(DegreeA < DegreeB ? DegreeB : DegreeA), Number>{a.middle + b.middle, a.radius + b.radius};
}
template <int DegreeA, int DegreeB, class Number>
auto operator-(const Uncertain<DegreeA, Number>& a, const Uncertain<DegreeB, Number>& b) {
  return a + (-b);
}
template <int DegreeA, int DegreeB, class Number>
Uncertain<DegreeA + DegreeB, Number> operator*(const Uncertain<DegreeA, Number>& a,
                                               const Uncertain<DegreeB, Number>& b) {
  return {a.middle * b.middle, detail::times(b.radius, detail::absolute(a.middle)) +
                                   detail::times(a.radius, detail::absolute(b.middle)) + a.radius * b.radius};
}
template <int Degree, class Number>
Uncertain<2 * Degree, Number> square(const Uncertain<Degree, Number>& a) {
  return a * a;
}
template <int Degree, class Number>
Uncertain<Degree, Number> operator*(const Uncertain<Degree, Number>& a, double factor) {
  return {a.middle * factor, a.radius * std::abs(factor)};
}
/// With constants, as constant<Number>() gives them.
template <int Degree, class Number>
Uncertain<Degree, Number> operator+(const Uncertain<Degree, Number>& a, const Polynomial<0, Number>& b) {
  return {a.middle + b.c[0], a.radius};
}
template <int Degree, class Number>
Uncertain<Degree, Number> operator-(const Uncertain<Degree, Number>& a, const Polynomial<0, Number>& b) {
  return {a.middle - b.c[0], a.radius};
}

template <class Number>
Uncertain<1, Number> about(const Bounded& value, double epoch) {
  Uncertain<1, Number> result;
  result.middle = Number(value.position);
  result.radius.c[0] = difference<Number>(epoch, value.start) * Number(value.speed);
  result.radius.c[1] = Number(value.speed);
  return result;
}

template <class Number>
Uncertain<1, Number> difference_about(const Bounded& a, const Bounded& b, double epoch) {
  return about<Number>(a, epoch) - about<Number>(b, epoch);
}

/// A certificate whose formula was fed with sampled values: it gives an Uncertain in place of a polynomial.
template <class C>
concept UncertainCertificate = requires(const C& certificate, double epoch) {
  { C::degree } -> std::convertible_to<int>;
  { certificate.template polynomial<Exact>(epoch).middle } -> std::convertible_to<Exact>;
  { certificate.template polynomial<Exact>(epoch).radius.c[0] } -> std::convertible_to<Exact>;
};

/// Holds while an uncertain certificate cannot have failed, whatever its elements did since they were sampled: middle -
/// radius >= 0. So its failure time is never late; how early it is, is what the bounds on the speeds cost.
template <UncertainCertificate C>
struct Conservative {
  static constexpr int degree = C::degree;
  const C& certificate;

  template <class Number>
  Polynomial<degree, Number> polynomial(double epoch) const {
    const auto f = certificate.template polynomial<Number>(epoch);
    Polynomial<0, Number> middle;
    middle.c[0] = f.middle;
    return Polynomial<degree, Number>{} + (middle - f.radius);
  }
};

/// The same fact about the samples, which stand still: of degree 0.
template <UncertainCertificate C>
struct OfSamples {
  static constexpr int degree = 0;
  const C& certificate;

  template <class Number>
  Polynomial<0, Number> polynomial(double epoch) const {
    Polynomial<0, Number> middle;
    middle.c[0] = certificate.template polynomial<Number>(epoch).middle;
    return middle;
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
