// Failure times: when a certificate first ceases to hold.
#pragma once

#include "kds/arithmetic/unrolled.hpp"
#include "kds/certificate.hpp"
#include "kds/certificate_reference.hpp"
#include "kds/roots/compiled_once.hpp"
#include "kds/roots/failure_time_isolated.hpp"
#include "kds/roots/failure_time_linear.hpp"
#include "kds/roots/failure_time_quadratic.hpp"

#include <cmath>
#include <type_traits>

namespace kds {

/// The first double t in [now, horizon] with sign_after(certificate, t) < 0, or `never`. Precondition: now is finite.
///
/// This is the library's definition of an event time. It has three consequences. Unless it is now itself, it is within
/// one ulp above the true root, and the enclosure is (previous double, t]. It is a function of certificate and now
/// alone: each solver, queue, broad phase and compiler gives the same bits. And when the clock stands at t the
/// certificate *has* failed, exactly, so an event never proves early.
///
/// `horizon` may be infinite; one before now makes the interval empty.
///
/// The ladder. Each rung answers where its error bounds make the answer certain, and leaves the rest to the next one;
/// so all give the same bits, and differ only in cost.
///
/// 1. The certificate knows (AnswersQuickly, certificate_hooks.hpp): its coefficients are doubles, or sums of two,
///    known without rounding, or nearly. Signs in doubles decide whether it fails within the horizon; a quotient or the
///    quadratic formula gives the root, and one value there, whose large parts are exact, gives the double. 7 to 15 ns.
///      line       quick_line_failure_time(), failure_time_known_line.hpp
///      parabola   quick_parabola_failure_time(), failure_time_known_parabola.hpp
///    Both also for the difference of two motions with starts of their own (certificates/order_parabola.hpp), and for
///    two lines side by side (certificates/order_together.hpp).
/// 2. The formula in doubles with error bounds (Ball<double>) about now decides whether there is a root and roughly
///    where; one value of it in double-doubles gives the double (root_rounding.hpp), with one exact sign where the root
///    may be a double itself. Any certificate. By the degree that the polynomial really has:
///      1          a quotient, failure_time_linear.hpp
///      2          the quadratic formula, failure_time_quadratic.hpp. 30 ns
///      3 and more the rule of Descartes and Halley's method, first_crossing.hpp and failure_time_isolated.hpp. 120 to
///                 300 ns up to degree 8
/// 3. Exact signs of f and its derivatives on the lattice of doubles (DerivativeIntervals, failure_time_by_signs.hpp):
///    certificates that touch zero, or nearly, and clustered roots. Needs no assumptions. 2 to 70 us, the most for
///    clustered roots of a high degree; counted by sign_counters.searches.
///
/// From degree 3 on, and in rung 3, the certificate is a CertificateReference (certificate_reference.hpp), so these are
/// compiled once for a degree. By instructions, calls cost 5 % more at degree 3 and 1 % at degree 8 than where they are
/// compiled for each certificate (callgrind, random polynomials); the narrow phase for splines, which has the most
/// kinds of certificates, is compiled in two thirds of the time.
///
/// What each special form gains: by how much the instruction count of a sorted list that runs for a second, or of a
/// loop over random polynomials, grows without it (callgrind; forms that gain less than 3 % are left out).
///      known line                               +118 % lists of parabolas that share their acceleration
///      its root, if that is a double            +133 % lines on a grid
///      known parabola                           +71 % lists, +46 % random parabolas
///      either, of two motions' own starts       +42 % lists of lines, +37 % of parabolas, +94 % that share it
///      signs before a start is moved (Order<1>) +16 % lists of lines with starts of their own
///      two lines side by side                   +14 % lists of lines with one start; 4 % less with starts of their own
///      quick answers after a turn               +10 to 22 % lists, except parabolas with starts of their own
///      line, of computed coefficients           +7 to 18 % random lines
///
/// enclosed_failure_time.hpp gives enclosures and a status, solver.hpp makes the solver of a structure exchangeable.
template <Certificate C>
double failure_time(const C& certificate, double now, double horizon = never);

/// The same where f is known to be positive just after now, which is a precondition: -f has failed there (two elements
/// that have just swapped), so that its sign, zero up to rounding, would need the expensive rungs.
///
/// Nothing is assumed about f before now: it need not have risen through zero just now, and even a line may still fail.
/// For -f may have been negative already when its certificate was made, and may be rising. (In a heap a child comes
/// under another parent, which it had passed within the same spacing of doubles.)
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

/// Whether all coefficients but the first are certainly not negative: f never falls. So certificates that are zero now
/// and rise, or stay zero, do not need the third rung.
template <int Degree>
bool never_falls(const Polynomial<Degree, Ball<double>>& p) {
  bool rises = true;
  // Infinity minus an infinite radius is a NaN, and so not certain.
  unrolled<Degree>([&](auto i) { rises = rises && p.c[i + 1].middle - p.c[i + 1].radius * Ball<double>::slack >= 0; });
  return rises;
}

/// p without its last coefficient, for polynomials where that is zero.
template <int Degree>
Polynomial<Degree - 1, Ball<double>> without_last(const Polynomial<Degree, Ball<double>>& p) {
  Polynomial<Degree - 1, Ball<double>> shorter;
  unrolled<Degree>([&](auto i) { shorter.c[i] = p.c[i]; });
  return shorter;
}

/// p is f about now, without the leading zeros that have been found so far. Precondition: f > 0 just after now.
template <class C, int Degree>
double failure_time_while_positive(const C& certificate, const Polynomial<Degree, Ball<double>>& p, double now,
                                   double horizon) {
  if constexpr (Degree == 0) {
    return never;
  } else if constexpr (C::degree > 2 && !std::is_same_v<C, CertificateReference<C::degree>>) {
    return failure_time_while_positive(CertificateReference(certificate), p, now, horizon);
  } else {
    // Motions of a formal degree often differ by one of a lower: bodies in a common gravity, say.
    if (p.c[Degree].is_zero()) return failure_time_while_positive(certificate, without_last(p), now, horizon);
    if (never_falls(p)) return never;
    if constexpr (Degree == 1) {
      if (certain_sign(p.c[1]) == 0 && extended_sign_after(CertificateReference(certificate), now, 1) >= 0)
        return never;
      return linear_failure_time(certificate, p, now, horizon);
    } else if constexpr (Degree == 2) {
      return quadratic_failure_time(certificate, p, now, horizon);
    } else {
      return isolated_failure_time(certificate, p, now, horizon);
    }
  }
}

/// Starts at the second rung. Precondition: now <= horizon.
template <class C>
double failure_time_of_formula(const C& certificate, double now, double horizon) {
  const auto p = certificate.template polynomial<Ball<double>>(now);
  int value = certain_sign(p.c[0]);
  if (value == 0) value = extended_sign_after(CertificateReference(certificate), now, 0);
  if (value < 0) return now;
  if (value == 0) return never;  // f vanishes identically
  return failure_time_while_positive(certificate, p, now, horizon);
}

/// A certificate without its hooks.
template <class C>
struct FormulaOnly {
  static constexpr int degree = C::degree;
  const C& certificate;

  template <class Number>
  Polynomial<degree, Number> polynomial(double epoch) const {
    return certificate.template polynomial<Number>(epoch);
  }
};

/// See hook_checks.hpp. Valid after a turn, too: the certificate is positive just after now, so failure_time() gives
/// the same.
template <Hook hook, class C>
void check_failure_time(const char* name, const C& certificate, double quick, double now, double horizon) {
  if (!is_to_be_checked<C, hook>()) return;
  const SignCounters counted = sign_counters;
  const FormulaOnly<C> formula{certificate};
  const double general = failure_time_of_formula(CertificateReference(formula), now, horizon);
  sign_counters = counted;
  require_same_time<C>(name, quick, general, now, horizon);
}

}  // namespace detail

template <Certificate C>
double failure_time(const C& certificate, double now, double horizon) {
  if (!(now <= horizon)) return never;
  static_assert(detail::RightHooks<C>::checked);
  if constexpr (AnswersQuickly<C>) {
    const double t = certificate.quick_failure_time(now, horizon);
    if (!std::isnan(t)) {
      detail::check_failure_time<detail::Hook::quick_failure_time>("quick_failure_time", certificate, t, now, horizon);
      return t;
    }
  }
  return detail::failure_time_of_formula(certificate, now, horizon);
}

template <Certificate C>
double failure_time_after_turn(const C& certificate, double now, double horizon) {
  if (!(now <= horizon)) return never;
  static_assert(detail::RightHooks<C>::checked);
  if constexpr (AnswersQuicklyAfterTurn<C>) {
    const double t = certificate.quick_failure_time_after_turn(now, horizon);
    if (__builtin_expect(!std::isnan(t), 1)) {
      detail::check_failure_time<detail::Hook::quick_failure_time_after_turn>("quick_failure_time_after_turn",
                                                                              certificate, t, now, horizon);
      return t;
    }
  }
  return detail::failure_time_while_positive(certificate, certificate.template polynomial<Ball<double>>(now), now,
                                             horizon);
}

KDS_COMPILED_ONCE_OF_ALL_DEGREES(extern template);

}  // namespace kds
