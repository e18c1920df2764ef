// Rung 2: the failure time of a line.
#pragma once

#include "kds/roots/failure_time_by_signs.hpp"
#include "kds/roots/root_rounding.hpp"

#include <algorithm>
#include <cmath>

namespace kds::detail {

/// p is f about now, linear. Preconditions: f > 0 just after now, and falls.
///
/// A root in doubles, then one Newton step from it with f evaluated in double-double: the step is small, so a double
/// division gives it to a few units of 2^-53, and the root is start + step to well beyond the precision of start. It is
/// what RootRounding does, with fewer conditions to check.
template <class C>
double linear_failure_time(const C& certificate, const Polynomial<1, Ball<double>>& p, double now, double horizon) {
  const double steepest = std::abs(p.c[1].middle) + p.c[1].radius;
  // Cheap and safe rejection: the root is not before now + lower.
  const double lower = (p.c[0].middle - p.c[0].radius) / steepest;
  if (now + lower * (1 - 0x1p-40) > horizon) return never;
  const double start = std::max(now, now + p.c[0].middle / -p.c[1].middle);
  if (start < never) {  // else the slope vanishes in doubles
    ++sign_counters.extended;
    const auto f = certificate.template polynomial<Ball<DoubleDouble>>(start);
    const double value = f.c[0].middle.high;
    const double slope = f.c[1].middle.high;
    const double step = value / -slope;
    const DoubleDouble root = two_sum(start, step);
    // |step| 2^-50 covers the quotient and the two numbers' low parts; twice the rest is the error of f at start, if
    // the slope is known to half of itself.
    const double error =
        (0x1p-50 * std::abs(value) + 2 * (f.c[0].radius + std::abs(step) * f.c[1].radius)) / std::abs(slope) +
        Ball<double>::underflow;
    if (f.c[1].radius <= 0.5 * std::abs(slope)) {
      const double t = first_double_not_before(certificate, root, error);
      if (t <= horizon) return t;
      if (t > horizon) return never;
    }
  }
  return failure_time_by_signs(CertificateReference(certificate), now, horizon);
}

}  // namespace kds::detail
