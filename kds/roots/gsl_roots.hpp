// Failure times through the GNU Scientific Library: plain doubles, for comparison. Target kds::gsl.
#pragma once

#include "kds/arithmetic/ball.hpp"
#include "kds/certificate.hpp"
#include "kds/roots/enclosed_failure_time.hpp"

#include <array>
#include <span>

namespace kds {

/// The least x in [0, end] just after which c[0] + c[1] x + c[2] x^2 + ... is negative, in plain doubles; `never` if
/// there seems to be none.
///
/// Method: all roots at once. Degree 1 and 2: gsl_poly_solve_quadratic; degree 3: gsl_poly_solve_cubic; above: the
/// eigenvalues of the companion matrix (gsl_poly_complex_solve). The signs of the polynomial half way between roots
/// say at which of them it turns negative, so no root need be told from a nearly real one.
///
/// What it does not promise. Nothing is certified: a simple, well separated root comes out to a few ulps, a root of
/// multiplicity m to about 2^(-53/m) of its size (1e-8 for a double root, 1e-5 for a triple one), and two crossings
/// closer than that may be missed or made up. A start up to rounding on a root may be taken for either side. Leading
/// coefficients so small that dividing by them overflows are dropped, and with them the roots far out.
///
/// Throws std::invalid_argument for a coefficient that is not finite, and std::runtime_error where the eigenvalues do
/// not converge. For that the GSL's error handler, which is one for the whole program, is off during the call: threads
/// that call this at once may leave it off.
double gsl_first_negative(std::span<const double> c, double end = never);

/// What failure_time() means, through gsl_first_negative(): the certificate is written about `now` in doubles and its
/// answer added to `now`. Same call, same meaning, none of the guarantees: the result is near the failure time, on
/// either side of it. Throws as gsl_first_negative() does, also where the coefficients overflow.
template <Certificate C>
double gsl_failure_time(const C& certificate, double now, double horizon = never) {
  if (!(now <= horizon)) return never;
  const auto p = certificate.template polynomial<Ball<double>>(now);
  std::array<double, C::degree + 1> c;
  for (std::size_t i = 0; i <= C::degree; ++i) c[i] = p.c[i].middle;
  const double t = now + gsl_first_negative(c, horizon - now);
  return t <= horizon ? t : never;
}

/// The same with a status, which is `estimated`: the enclosure is [now, horizon] whatever the time, since a crossing
/// may have been missed or made up. (In an empty interval the certificate certainly holds.)
template <Certificate C>
FailureTime gsl_estimated_failure_time(const C& certificate, double now, double horizon = never) {
  if (!(now <= horizon)) return {};
  return {gsl_failure_time(certificate, now, horizon), now, horizon, FailureStatus::estimated};
}

/// The same as a FailureTimeSolver, for structures: Kinetic<Rule, Listener, DefaultEventQueue, GslSolver>.
struct GslSolver {
  static constexpr bool certified = false;

  template <Certificate C>
  double operator()(const C& certificate, double now, double horizon = never) const {
    return gsl_failure_time(certificate, now, horizon);
  }
};

}  // namespace kds
