// Rung 2: failure times of degree 3 and above, isolated and found in doubles, placed by one value in double-double.
#pragma once

#include "kds/roots/failure_time_by_signs.hpp"
#include "kds/roots/first_crossing.hpp"
#include "kds/roots/root_rounding.hpp"

#include <algorithm>
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

/// The failure time that follows from f about an epoch, a time up to which f is known not to be negative, and just
/// after which it is positive; a NaN where doubles do not decide. `after` is then how much longer it is known.
template <int FormalDegree, int Degree>
double failure_time_about(const CertificateReference<FormalDegree>& certificate,
                          const Polynomial<Degree, Ball<double>>& f, double epoch, double horizon, double& after) {
  const Crossing crossing = first_crossing(f, (horizon - epoch) * (1 + 0x1p-50));
  if (crossing.status == Crossing::Status::none) return never;
  if (crossing.status == Crossing::Status::isolated) {
    const double x = refined_root(f, crossing.guess, crossing.after, crossing.before);
    const double t = RootRounding(certificate, epoch)(f, x, crossing.after, crossing.before);
    if (t <= horizon) return t;
    if (t > horizon) return never;
    after = 0;
    return undecided;
  }
  after = crossing.after;
  return undecided;
}

/// Where f about now does not decide, mostly because it has roots of very different sizes, f is looked at again from
/// the time up to which it is known not to be negative: about a later time the near roots are not among the far ones.
/// In a Delaunay triangulation of cubics (degree 12) one failure time in sixty needs that, and none needs exact signs.
template <int Degree, int FormalDegree>
[[gnu::noinline, gnu::cold]] double failure_time_from_later(const CertificateReference<FormalDegree>& certificate,
                                                            double now, double horizon, double after) {
  double epoch = now;
  for (int i = 0; i < 2; ++i) {
    // The sum may be rounded up; the difference is exact but for a rounding of its own.
    const double later = epoch + after * (1 - 0x1p-20);
    if (!(later > epoch && later - epoch <= after * (1 - 0x1p-40) && later < horizon)) break;
    const auto p = certificate.template polynomial<Ball<double>>(later);
    if (certain_sign(p.c[0]) <= 0) break;
    Polynomial<Degree, Ball<double>> f;
    std::copy_n(p.c.begin(), f.c.size(), f.c.begin());  // The others are zero about any time.
    const double t = failure_time_about(certificate, f, later, horizon, after);
    if (t == t) return t;
    epoch = later;
  }
  return failure_time_by_signs(certificate, now, horizon);
}

/// p is f about now, without its leading zeros. Precondition: f > 0 just after now.
template <int FormalDegree, int Degree>
double isolated_failure_time(const CertificateReference<FormalDegree>& certificate,
                             const Polynomial<Degree, Ball<double>>& p, double now, double horizon) {
  double after = 0;
  const double t = failure_time_about(certificate, p, now, horizon, after);
  return t == t ? t : failure_time_from_later<Degree>(certificate, now, horizon, after);
}

}  // namespace kds::detail
