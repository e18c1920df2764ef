// Rung 2: failure times of degree 3 and above, isolated and found in doubles, placed by one value in double-double.
#pragma once

#include "kds/roots/failure_time_by_signs.hpp"
#include "kds/roots/first_crossing.hpp"
#include "kds/roots/root_rounding.hpp"

#include <cmath>

namespace kds::detail {

/// A root of p in (lower, upper), where p falls, to most of its digits: Halley's method in doubles, kept in bounds by
/// bisection. Only a guess: nothing rests on it.
template <int Degree>
double refined_root(const Polynomial<Degree, Ball<double>>& p, double x, double lower, double upper) {
  for (int i = 0; i < 60; ++i) {
    double value = p.c[Degree].middle;
    double slope = 0;
    double bend = 0;  // half of f''
    for (std::size_t k = Degree; k-- > 0;) {
      bend = bend * x + slope;
      slope = slope * x + value;
      value = value * x + p.c[k].middle;
    }
    (value > 0 ? lower : upper) = x;
    const double step = value * slope / (slope * slope - value * bend);
    const double next = x - step;
    // Each step cubes the error: one more gives all the digits of a double, and this is that step.
    if (std::abs(step) <= 0x1p-17 * x) return next;
    x = next > lower && next < upper ? next : (upper < never ? 0.5 * (lower + upper) : 2 * x);
  }
  return x;
}

/// p is f about now, without its leading zeros. Precondition: f > 0 just after now.
template <int FormalDegree, int Degree>
double isolated_failure_time(const CertificateReference<FormalDegree>& certificate,
                             const Polynomial<Degree, Ball<double>>& p, double now, double horizon) {
  const Crossing crossing = first_crossing(p, (horizon - now) * (1 + 0x1p-50));
  if (crossing.status == Crossing::Status::none) return never;
  if (crossing.status == Crossing::Status::isolated) {
    const double x = refined_root(p, crossing.guess, crossing.after, crossing.before);
    const double t = RootRounding(certificate, now)(p, x, crossing.after, crossing.before);
    if (t <= horizon) return t;
    if (t > horizon) return never;
  }
  return failure_time_by_signs(certificate, now, horizon);
}

}  // namespace kds::detail
