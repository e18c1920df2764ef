// The failure time of a line.
#pragma once

#include "kds/roots/failure_time_lattice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kds::detail {

/// f > 0 just after now, linear and falling; p is f about now. The first double not before the root.
///
/// A root in doubles, then one Newton step from it with f evaluated in double-double: the step is small, so a double
/// division gives it to a few units of 2^-53, and the root is start + step to well beyond the precision of start.
template <class C>
double linear_failure_time(const C& certificate, const Polynomial<1, Ball<double>>& p, double now, double horizon) {
  const double steepest = std::abs(p.c[1].middle) + p.c[1].radius;
  // Cheap and safe rejection: the root is not before now + lower.
  const double lower = (p.c[0].middle - p.c[0].radius) / steepest;
  if (now + lower * (1 - 0x1p-40) > horizon) return never;
  const double start = std::max(now, now + p.c[0].middle / -p.c[1].middle);
  // A slope that vanishes in doubles may still bring a root among them.
  if (!(start < never)) return first_past_linear_root(certificate, now, std::numeric_limits<double>::max(), horizon);
  ++sign_counters.extended;
  const auto f = certificate.template polynomial<Ball<DoubleDouble>>(start);
  const double value = f.c[0].middle.high;
  const double slope = f.c[1].middle.high;
  const double step = value / -slope;
  const DoubleDouble root = two_sum(start, step);
  // |step| 2^-50 covers the quotient and the two numbers' low parts; twice the rest is the error of f at start, and
  // exceeds |step| where the slope is not known to half of itself.
  const double error =
      (0x1p-50 * std::abs(value) + 2 * (f.c[0].radius + std::abs(step) * f.c[1].radius)) / std::abs(slope) +
      Ball<double>::underflow;
  double t = root.high;
  if (root.low > error) {
    t = next_up(t);
  } else if (!(root.low < -error)) {
    // The root is t up to rounding, or the numbers are out of the range of these bounds: find it by exact signs.
    if (!(t > now)) t = next_up(now);
    return first_past_linear_root(certificate, now, t, horizon);
  }
  return t <= horizon ? t : never;
}

}  // namespace kds::detail
