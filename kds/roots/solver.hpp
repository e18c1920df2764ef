// The part of a structure that finds failure times: it can be exchanged.
#pragma once

#include "kds/certificate.hpp"
#include "kds/roots/failure_time.hpp"

#include <concepts>

namespace kds {

/// Finds failure times for a Schedule.
///
/// Semantic laws: solver(f, now, horizon) means what failure_time() means. If `certified`, it gives the same bits. If
/// not, it may say anything: too early, too late, `never` for a root that is there, even a NaN; the schedule checks it
/// with exact signs (see Schedule for what is then promised, and what is not).
template <class S>
concept FailureTimeSolver = std::default_initializable<S> &&
    requires(const S& solver, const PolynomialCertificate<2>& f, double t) {
  { S::certified } -> std::convertible_to<bool>;
  { solver(f, t, t) } -> std::same_as<double>;
};

/// `double after_turn(const C& certificate, double now, double horizon) const`: optional, with the meaning of
/// failure_time_after_turn(): for a certificate that is positive just after now. Without it the solver is called as for
/// any other. A member after_turn() that cannot be called so does not compile.
template <class S, class C>
concept AnswersAfterTurn = requires(const S& solver, const C& certificate, double t) {
  { solver.after_turn(certificate, t, t) } -> std::same_as<double>;
};

namespace detail {
KDS_MEMBER_NAMED(NamesAfterTurn, after_turn);
}

/// failure_time() as a function object: the default.
struct CertifiedSolver {
  static constexpr bool certified = true;

  template <Certificate C>
  double operator()(const C& certificate, double now, double horizon) const {
    return failure_time(certificate, now, horizon);
  }

  template <Certificate C>
  double after_turn(const C& certificate, double now, double horizon) const {
    return failure_time_after_turn(certificate, now, horizon);
  }
};

}  // namespace kds
