// Failure times: when a certificate first ceases to hold.
#pragma once

#include "kds/certificate.hpp"
#include "kds/failure_time_isolated.hpp"
#include "kds/failure_time_lattice.hpp"
#include "kds/failure_time_linear.hpp"
#include "kds/failure_time_quadratic.hpp"

#include <cmath>

namespace kds {

/// The first double t in [now, horizon] with sign_after(certificate, t) < 0, or `never`.
///
/// This is the library's definition of an event time. It has three consequences. It is within one ulp above the true
/// root, and the enclosure is (previous double, t]. It is a function of the certificate alone: every solver, queue,
/// broad phase and compiler gives the same bits. And when the clock stands at t the certificate *has* failed,
/// exactly, so an event never proves early.
///
/// Method: closed forms in double-double for degrees 1 and 2, verified by exact signs on both sides; for higher
/// degrees the sign changes of the derivatives, from the linear one up, cut [now, horizon] into intervals on which
/// f is monotone, and in each a safeguarded Newton iteration finds the double at which the exact sign turns. Nothing
/// is assumed about the roots: double and clustered ones cost more, never an error.
///
/// Cost: O(degree^2) sign evaluations; most certificates are decided by signs alone. `horizon` may be infinite.
template <Certificate C>
double failure_time(const C& certificate, double now, double horizon = never);

/// The same where f has just turned from - to + at now (two elements that have just swapped): its sign there, which
/// is zero up to rounding and would ask for the expensive rungs, is known. A line has no second failure.
template <Certificate C>
double failure_time_after_turn(const C& certificate, double now, double horizon = never);

/// f with its sign turned: "fails" when f turns positive.
template <Certificate C>
struct Negated {
  static constexpr int degree = C::degree;
  const C& certificate;

  template <class Number>
  Polynomial<degree, Number> polynomial(double epoch) const {
    return -certificate.template polynomial<Number>(epoch);
  }
  bool vanishes() const { return detail::known_to_vanish(certificate); }
};

/// The first double t in [now, horizon] with sign_after(certificate, t) > 0, or `never`.
template <Certificate C>
double recovery_time(const C& certificate, double now, double horizon = never) {
  return failure_time(Negated<C>{certificate}, now, horizon);
}

// ---------------------------------------------------------------------------------------------------------------

namespace detail {

/// The first coefficients of a polynomial whose others are zero.
template <int Lower, int Degree, class Scalar>
Polynomial<Lower, Scalar> truncated(const Polynomial<Degree, Scalar>& p) {
  Polynomial<Lower, Scalar> result;
  for (std::size_t i = 0; i <= Lower; ++i) result.c[i] = p.c[i];
  return result;
}

/// p is f about now. Precondition: f > 0 just after now.
template <class C>
double failure_time_while_positive(const C& certificate, const Polynomial<C::degree, Ball<double>>& p, double now,
                                   double horizon) {
  // Where all higher coefficients are certainly not negative, f never falls.
  int falling = C::degree;
  while (falling > 0) {
    const auto& c = p.c[static_cast<std::size_t>(falling)];
    if (!(c.middle >= c.radius * Ball<double>::slack)) break;
    --falling;
  }
  if (falling == 0) return never;
  // Motions of a formal degree often differ by one of a lower: bodies in a common gravity, say.
  int degree = C::degree;
  while (p.c[static_cast<std::size_t>(degree)].is_zero()) --degree;
  if constexpr (C::degree >= 1) {
    if (degree == 1) {
      if (certain_sign(p.c[1]) == 0 && extended_sign_after(certificate, now, 1) >= 0) return never;
      return linear_failure_time(certificate, truncated<1>(p), now, horizon);
    }
  }
  if constexpr (C::degree >= 2) {
    if (degree == 2) return quadratic_failure_time(certificate, truncated<2>(p), now, horizon);
  }
  if constexpr (C::degree >= 3) {
    return isolated_failure_time(certificate, p, now, horizon);
  }
  return never;
}

}  // namespace detail

template <Certificate C>
double failure_time(const C& certificate, double now, double horizon) {
  if (!(now <= horizon)) return never;
  if constexpr (requires { certificate.quick_failure_time(now, horizon); }) {
    const double t = certificate.quick_failure_time(now, horizon);
    if (!std::isnan(t)) return t;
  }
  const auto p = certificate.template polynomial<Ball<double>>(now);
  int value = certain_sign(p.c[0]);
  if (value == 0) value = detail::extended_sign_after(certificate, now, 0);
  if (value < 0) return now;
  if (value == 0) return never;  // f vanishes identically
  return detail::failure_time_while_positive(certificate, p, now, horizon);
}

template <Certificate C>
double failure_time_after_turn(const C& certificate, double now, double horizon) {
  if (!(now <= horizon)) return never;
  if constexpr (C::degree <= 1) {
    return never;  // A line that is positive just after a zero has risen through it.
  } else {
    return detail::failure_time_while_positive(certificate, certificate.template polynomial<Ball<double>>(now), now,
                                               horizon);
  }
}

}  // namespace kds
