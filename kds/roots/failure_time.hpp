// Failure times: when a certificate first ceases to hold.
#pragma once

#include "kds/arithmetic/unrolled.hpp"
#include "kds/certificate.hpp"
#include "kds/roots/failure_time_isolated.hpp"
#include "kds/roots/failure_time_lattice.hpp"
#include "kds/roots/failure_time_linear.hpp"
#include "kds/roots/failure_time_quadratic.hpp"

#include <cmath>

namespace kds {

/// The first double t in [now, horizon] with sign_after(certificate, t) < 0, or `never`. Precondition: now is finite.
///
/// This is the library's definition of an event time. It has three consequences. Unless it is now itself, it is within
/// one ulp above the true root, and the enclosure is (previous double, t]. It is a function of certificate and now
/// alone: each solver, queue, broad phase and compiler gives the same bits. And when the clock stands at t the
/// certificate *has* failed, exactly, so an event never proves early.
///
/// Method, in three steps; where a step does not decide, the next one that can does.
/// (1) Which root: signs of the coefficients about `now` alone; for a parabola that of the discriminant; above that the
///     rule of Descartes in Bernstein form (first_crossing()). In doubles, with error bounds.
/// (2) Which double: a closed form or a few steps of Halley's method in doubles, and there one value of f in
///     double-double, which places the root among the doubles (RootRounding). A root that is a double itself, or as
///     near to one as makes no difference to that value, asks for one exact sign.
/// (3) For certificates that touch zero, or nearly: exact signs of f and its derivatives (DerivativeIntervals).
///     Nothing is assumed about the roots: double and clustered ones cost more, never an error. sign_counters.searches
///     counts these.
///
/// Cost: from 7 ns (a line of known coefficients) through 15 (a parabola of such), 30 (degree 2) and 120 to 300
/// (degree 4 to 8) for an ordinary root; 2 to 70 us for the third step, most for clustered roots of a high degree.
/// `horizon` may be infinite; one before now makes the interval empty. enclosed_failure_time.hpp has results with
/// enclosure and status.
template <Certificate C>
double failure_time(const C& certificate, double now, double horizon = never);

/// The same where f is known to be positive just after now, which is a precondition: -f has failed there (two elements
/// that have just swapped), so that its sign, zero up to rounding, would ask for the expensive rungs.
///
/// What was before now is not asked: f need not have risen through zero just now, and even a line may fail yet. For a
/// certificate may have failed before it is made, and then -f may be falling already. (In a heap a child comes under
/// another parent, and had passed it within the same spacing of doubles.)
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
  Ball<DoubleDouble> extended_value(double t) const { return -detail::extended_value(certificate, t); }
  bool vanishes() const { return detail::known_to_vanish(certificate); }
};

/// The first double t in [now, horizon] with sign_after(certificate, t) > 0, or `never`.
template <Certificate C>
double recovery_time(const C& certificate, double now, double horizon = never) {
  return failure_time(Negated<C>{certificate}, now, horizon);
}

// ---------------------------------------------------------------------------------------------------------------

namespace detail {

/// Whether all coefficients but the first are certainly not negative: f never falls.
template <int Degree>
bool never_falls(const Polynomial<Degree, Ball<double>>& p) {
  bool rises = true;
  // An infinity less an infinite radius is no number, and so not certain.
  unrolled<Degree>([&](auto i) { rises = rises && p.c[i + 1].middle - p.c[i + 1].radius * Ball<double>::slack >= 0; });
  return rises;
}

/// p without its last coefficient, for polynomials of which that is zero.
template <int Degree>
Polynomial<Degree - 1, Ball<double>> without_last(const Polynomial<Degree, Ball<double>>& p) {
  Polynomial<Degree - 1, Ball<double>> shorter;
  unrolled<Degree>([&](auto i) { shorter.c[i] = p.c[i]; });
  return shorter;
}

/// p is f about now, without its leading zeros as far as they have been looked at. Precondition: f > 0 just after now.
template <class C, int Degree>
double failure_time_while_positive(const C& certificate, const Polynomial<Degree, Ball<double>>& p, double now,
                                   double horizon) {
  if constexpr (Degree == 0) {
    return never;
  } else {
    // Motions of a formal degree often differ by one of a lower: bodies in a common gravity, say.
    if (p.c[Degree].is_zero()) return failure_time_while_positive(certificate, without_last(p), now, horizon);
    if (never_falls(p)) return never;
    if constexpr (Degree == 1) {
      if (certain_sign(p.c[1]) == 0 && extended_sign_after(certificate, now, 1) >= 0) return never;
      return linear_failure_time(certificate, p, now, horizon);
    } else if constexpr (Degree == 2) {
      return quadratic_failure_time(certificate, p, now, horizon);
    } else {
      return isolated_failure_time(certificate, p, now, horizon);
    }
  }
}

}  // namespace detail

template <Certificate C>
double failure_time(const C& certificate, double now, double horizon) {
  if (!(now <= horizon)) return never;
  static_assert(detail::RightHooks<C>::checked);
  if constexpr (AnswersQuickly<C>) {
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
  static_assert(detail::RightHooks<C>::checked);
  if constexpr (AnswersQuicklyAfterTurn<C>) {
    const double t = certificate.quick_failure_time_after_turn(now, horizon);
    if (__builtin_expect(!std::isnan(t), 1)) return t;
  }
  return detail::failure_time_while_positive(certificate, certificate.template polynomial<Ball<double>>(now), now,
                                             horizon);
}

}  // namespace kds
