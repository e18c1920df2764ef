// Certificates: polynomials of time that are >= 0 while a fact holds, and their exact signs.
#pragma once

#include "kds/arithmetic/ball.hpp"
#include "kds/arithmetic/compensated.hpp"
#include "kds/arithmetic/exact.hpp"
#include "kds/certificate_hooks.hpp"
#include "kds/certificate_reference.hpp"
#include "kds/hook_checks.hpp"
#include "kds/motion.hpp"
#include "kds/polynomial.hpp"
#include "kds/roots/failure_time_known_line.hpp"

#include <concepts>
#include <cstdint>
#include <limits>

namespace kds {

/// A fact about motions: f(t) >= 0 while it holds.
///
/// A certificate names its degree and gives f as a polynomial in (t - epoch), for any epoch, in any number type:
/// the same formula runs in doubles with an error bound, in double-doubles with an error bound, and exactly. A new
/// certificate is therefore a few lines:
///
///     struct Above {                                    // x stays above the line y = 3
///       static constexpr int degree = 2;
///       Motion<2> x;
///       template <class Number>
///       auto polynomial(double epoch) const { return about<Number>(x, epoch) - constant<Number>(3); }
///     };
///
/// Semantic laws: (1) f uses only ring operations on finite doubles, so that it is exact over Exact; (2) polynomial(e)
/// and polynomial(e') are the same function of t, for all finite e. Certificates that hold references, as most of
/// certificates/ do, must not outlive the motions.
///
/// Optional members by which a certificate saves work are in certificate_hooks.hpp.
template <class C>
concept Certificate = requires(const C& certificate, double epoch) {
  { C::degree } -> std::convertible_to<int>;
  { certificate.template polynomial<Exact>(epoch) } -> std::same_as<Polynomial<C::degree, Exact>>;
  { certificate.template polynomial<Ball<double>>(epoch) } -> std::same_as<Polynomial<C::degree, Ball<double>>>;
  {
    certificate.template polynomial<Ball<DoubleDouble>>(epoch)
    } -> std::same_as<Polynomial<C::degree, Ball<DoubleDouble>>>;
};

/// A constant as a polynomial of degree 0, for use in certificate formulas.
template <class Number>
Polynomial<0, Number> constant(double value) {
  Polynomial<0, Number> result;
  result.c[0] = Number(value);
  return result;
}

/// How often the cheaper rungs of the sign ladder did not decide. One set a thread; reset by assigning {}.
struct SignCounters {
  std::uint64_t extended = 0;  ///< signs that asked for double-doubles
  std::uint64_t exact = 0;     ///< signs that asked for exact arithmetic
  std::uint64_t searches = 0;  ///< failure times found by exact signs alone, since the quick methods did not decide
};
inline thread_local SignCounters sign_counters;

/// Sign of f (or its derivative number `derivative`) at t+, the instant after t: the sign of the first of f(t),
/// f'(t), f''(t)... that is not zero, and 0 only if all vanish. Exact. Precondition: t is finite, 0 <= derivative.
///
/// Three rungs: doubles with an error bound, double-doubles with an error bound, exact integers. f is written as a
/// polynomial about t, so its coefficients are its derivatives at t up to positive factors.
template <Certificate C>
int sign_after(const C& certificate, double t, int derivative = 0);

/// A certificate that is a polynomial about its own epoch, whose coefficients are doubles and taken as exact.
template <int Degree>
struct PolynomialCertificate {
  static constexpr int degree = Degree;
  Motion<Degree> value;

  template <class Number>
  Polynomial<Degree, Number> polynomial(double epoch) const {
    return about<Number>(value, epoch);
  }
  Ball<DoubleDouble> extended_value(double t) const {
    return compensated_value(value.position, two_sum(t, -value.start));
  }
  bool vanishes() const { return value.position == Polynomial<Degree>{}; }

  /// Answers for lines and parabolas.
  double quick_failure_time(double now, double horizon) const {
    if constexpr (Degree == 1 || Degree == 2) {
      const KnownParabola<false> p = parabola();
      if (Degree == 1 || p.a.high == 0) return quick_line_failure_time(p, now, horizon);
      return quick_parabola_failure_time<false>(p, now, horizon);
    }
    return std::numeric_limits<double>::quiet_NaN();
  }
  /// Answers for parabolas.
  double quick_failure_time_after_turn(double now, double horizon) const {
    if constexpr (Degree == 2) return quick_parabola_failure_time<true>(parabola(), now, horizon);
    return std::numeric_limits<double>::quiet_NaN();
  }

 private:
  KnownParabola<false> parabola() const {
    const auto& c = value.position.c;
    return {c[0], c[1], Degree == 2 ? c[c.size() - 1] : 0, 0, 0, value.start};
  }
};

/// f' as a certificate: holds while f does not decrease.
template <Certificate C>
requires(C::degree >= 1) struct DerivativeCertificate {
  static constexpr int degree = C::degree - 1;
  C certificate;

  template <class Number>
  Polynomial<degree, Number> polynomial(double epoch) const {
    return derivative(certificate.template polynomial<Number>(epoch));
  }
};

namespace detail {

/// Whether a hook says that f is zero throughout.
template <class C>
bool known_to_vanish(const C& certificate) {
  static_assert(RightHooks<C>::checked);
  if constexpr (TellsIfItVanishes<C>) {
    if (!certificate.vanishes()) return false;
    check_vanishes(certificate);
    return true;
  } else {
    return false;
  }
}

/// f(t) in double-doubles, with its error bound.
template <class C>
Ball<DoubleDouble> extended_value(const C& certificate, double t) {
  static_assert(RightHooks<C>::checked);
  if constexpr (GivesExtendedValue<C>) {
    const Ball<DoubleDouble> value = certificate.extended_value(t);
    if (value.radius < std::numeric_limits<double>::infinity()) {  // else out of its range
      check_extended_value(certificate, t, value);
      return value;
    }
  }
  return certificate.template polynomial<Ball<DoubleDouble>>(t).c[0];
}

template <int Degree>
int exact_sign_after(const CertificateReference<Degree>& certificate, double t, int derivative) {
  ++sign_counters.exact;
  const auto f = certificate.template polynomial<Exact>(t);
  for (std::size_t i = static_cast<std::size_t>(derivative); i <= Degree; ++i) {
    if (const int s = f.c[i].sign()) return s;
  }
  return 0;
}

/// Sign of the first coefficient from `derivative` on that is not known to be zero; 0 where it is not decided.
/// `all_zero` says that all are known to be zero.
template <int Degree, class T>
int certain_sign_after(const Polynomial<Degree, Ball<T>>& f, int derivative, bool& all_zero) {
  all_zero = false;
  for (std::size_t i = static_cast<std::size_t>(derivative); i <= Degree; ++i) {
    if (const int s = certain_sign(f.c[i])) return s;
    if (!f.c[i].is_zero()) return 0;
  }
  all_zero = true;
  return 0;
}

/// Skips the rung of doubles: for times that are roots up to rounding, where it cannot decide.
template <int Degree>
int extended_sign_after(const CertificateReference<Degree>& certificate, double t, int derivative) {
  if (known_to_vanish(certificate)) return 0;
  ++sign_counters.extended;
  bool zero = false;
  const auto f = certificate.template polynomial<Ball<DoubleDouble>>(t);
  const int s = certain_sign_after(f, derivative, zero);
  return s != 0 || zero ? s : exact_sign_after(certificate, t, derivative);
}

}  // namespace detail

template <Certificate C>
int sign_after(const C& certificate, double t, int derivative) {
  bool zero = false;
  const auto f = certificate.template polynomial<Ball<double>>(t);
  const int s = detail::certain_sign_after(f, derivative, zero);
  return s != 0 || zero ? s : detail::extended_sign_after(CertificateReference(certificate), t, derivative);
}

}  // namespace kds
