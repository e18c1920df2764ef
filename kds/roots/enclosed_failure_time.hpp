// Failure times with a guaranteed enclosure and a status.
#pragma once

#include "kds/roots/failure_time.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kds {

/// How a failure time was computed, and what is certain of it.
enum class FailureStatus {
  holds,          ///< certified: the certificate does not fail within the horizon
  fails_at_once,  ///< certified: it has failed just after `now`
  root,           ///< certified: it fails at a root within the enclosure
  estimated       ///< a time from a solver that certifies nothing; the enclosure is all of [now, horizon]
};

/// A failure time and its guaranteed enclosure, in seconds.
struct FailureTime {
  double time = never;   ///< `never` if the certificate holds
  double lower = never;  ///< lower <= true root <= upper; `now` where it fails at once, `never` where it holds
  double upper = never;
  FailureStatus status = FailureStatus::holds;
};

/// failure_time() with its enclosure, which is the double before it and itself.
template <Certificate C>
FailureTime certified_failure_time(const C& certificate, double now, double horizon = never);

/// Whether and at which root the certificate fails is decided exactly, as by failure_time(), but the time is only near
/// that root: for callers that do not need the canonical double.
///
/// The result is `holds` or `fails_at_once` exactly when failure_time() gives `never` or `now`; where it is `root`, the
/// time and failure_time() both lie in [lower, next double above upper], and
///     upper - lower <= 2^-45 (upper - now) + 4 ulp(upper),
/// usually a tenth of that. Roots too ill conditioned for it are left to failure_time(), and so are degrees above 2,
/// for which the canonical double is a small part of the cost.
template <Certificate C>
FailureTime enclosed_failure_time(const C& certificate, double now, double horizon = never);

// ---------------------------------------------------------------------------------------------------------------

namespace detail {

/// The root that failure_time() would look for, of a line or a parabola, from doubles alone; undecided where these do
/// not suffice. `holds` is set where there is certainly none. Precondition: f > 0 just after now.
template <int Degree>
ApproximateRoot enclosed_root(const Polynomial<Degree, Ball<double>>& p, bool& holds) {
  if constexpr (Degree == 0) {
    holds = true;
  } else {
    if (p.c[Degree].is_zero()) return enclosed_root(without_last(p), holds);
    holds = never_falls(p);
    if (holds) return {never, undecided};
    if constexpr (Degree == 1) {
      if (certain_sign(p.c[1]) < 0) {
        return bounded_quotient(p.c[0].middle, p.c[0].radius, -p.c[1].middle, p.c[1].radius);
      }
    } else if constexpr (Degree == 2) {
      const Ball<double> d = discriminant(p);
      const int bend = certain_sign(p.c[2]);
      const int real = certain_sign(d);
      holds = bend > 0 && real < 0;
      if (bend != 0 && real > 0) return quadratic_root(p, d);
    }
  }
  return {never, undecided};
}

/// A failure time as failure_time() gives it, with its enclosure.
inline FailureTime certified(double t, double now) {
  if (t == never) return {};
  if (t == now) return {t, t, t, FailureStatus::fails_at_once};
  return {t, next_down(t), t, FailureStatus::root};
}

}  // namespace detail

template <Certificate C>
FailureTime certified_failure_time(const C& certificate, double now, double horizon) {
  return detail::certified(failure_time(certificate, now, horizon), now);
}

template <Certificate C>
FailureTime enclosed_failure_time(const C& certificate, double now, double horizon) {
  // Worst relative error of the time from now to the root.
  constexpr double enough = 0x1p-47;
  if (!(now <= horizon)) return {};
  if constexpr (C::degree > 2) return certified_failure_time(certificate, now, horizon);
  static_assert(detail::RightHooks<C>::checked);
  if constexpr (AnswersQuickly<C>) {
    const double t = certificate.quick_failure_time(now, horizon);
    if (!std::isnan(t)) return detail::certified(t, now);
  }
  const auto p = certificate.template polynomial<Ball<double>>(now);
  const int value = certain_sign(p.c[0]);
  if (value < 0) return {now, now, now, FailureStatus::fails_at_once};
  if (value > 0) {
    bool holds = false;
    const detail::ApproximateRoot root = detail::enclosed_root(p, holds);
    if (holds || root.x - root.error > (horizon - now) * (1 + 0x1p-50)) return {};
    const double time = now + root.x;
    // Roundings of the sum, of the radius and of the difference below: within one and a half units of 2^-52 |time|.
    const double radius = root.error + 0x1.8p-52 * std::abs(time);
    const double upper = time + radius;
    // The next double above must be within the horizon too, and f < 0 there: of course for a line. The root of a
    // parabola is known to 2^-47 only if its discriminant is at least (c1 / 128)^2, as that has a radius of 2^-52 c1^2;
    // so the second root is x / 64 farther, which is four doubles by the second condition.
    const bool fine = root.error <= enough * root.x && std::abs(time) * 0x1p-44 <= root.x;
    if (fine && upper < never && next_up(upper) <= horizon) {
      return {time, std::max(now, time - radius), upper, FailureStatus::root};
    }
  }
  return certified_failure_time(certificate, now, horizon);
}

}  // namespace kds
