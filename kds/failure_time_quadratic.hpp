// The failure time of a parabola.
#pragma once

#include "kds/failure_time_derivatives.hpp"
#include "kds/failure_time_rounding.hpp"

#include <cmath>
#include <limits>

namespace kds::detail {

/// By exact signs. Precondition: f > 0 just after now.
template <class C>
double quadratic_failure_time_by_signs(const C& certificate, const Polynomial<2, Ball<double>>& p, double now, double horizon) {
  const auto by_derivatives = [&] { return DerivativeIntervals<C>(certificate, now, horizon).first_negative(); };
  const int bend = certain_sign(p.c[2]);
  const int rate = certain_sign(p.c[1]);
  if (bend > 0 && rate > 0) return never;
  const Ball<double> discriminant = p.c[1] * p.c[1] - p.c[0] * p.c[2] * 4.0;
  const int real = certain_sign(discriminant);
  if (bend > 0 && real < 0) return never;
  if (bend == 0 || (bend > 0 && (rate == 0 || real == 0)) || !(discriminant.middle < never)) {
    return by_derivatives();
  }
  const double c0 = p.c[0].middle;
  const double c1 = p.c[1].middle;
  const double c2 = p.c[2].middle;
  const double root = std::sqrt(discriminant.middle > 0 ? discriminant.middle : 0.0);
  if (bend > 0) {  // Falls, then rises: the smaller root, which lies before the vertex.
    const double guess = now + 2 * c0 / (root - c1);
    double above = now - c1 / (2 * c2);
    if (above > horizon) {
      if (guess * (1 - 0x1p-30) > horizon && now + (guess - now) * (1 - 0x1p-30) > horizon && sign_after(certificate, horizon) > 0) {
        return never;
      }
      above = horizon;
    }
    if (above < never && sign_after(certificate, above) < 0) {
      return LatticeCrossing<C>(certificate, 0)(now, above, -1, guess);
    }
    if (above == horizon && horizon < never) {
      // Positive at the horizon, which is before the vertex: falling all the way, so positive throughout.
      if (sign_after(certificate, horizon, 1) < 0) return never;
    }
    return by_derivatives();
  }
  // Concave and positive now: one crossing ahead.
  const double tau = c1 >= 0 ? (c1 + root) / (-2 * c2) : 2 * c0 / (root - c1);
  if (horizon < never && sign_after(certificate, horizon) > 0) return never;
  const double above = horizon < never ? horizon : std::numeric_limits<double>::max();
  if (horizon == never && !(now + tau < 0x1p900) && sign_after(certificate, above) >= 0) return never;
  return LatticeCrossing<C>(certificate, 0)(now, above, -1, now + tau);
}

/// A root of a parabola in doubles, and a bound on its relative error (2^-10 at most); a NaN where there is no such bound.
struct QuadraticRoot {
  double x;
  double error;
};

/// Where a parabola that is positive just after 0 turns from + to -: 2 c0 / (sqrt(D) - c1), or, to the same effect,
/// (c1 + sqrt(D)) / (-2 c2), of which one is free of cancellation. D is certainly positive, so that is the only such turn.
///
/// Error bound, with u = 2^-53. Let D be known to +-d with d <= 2^-12 D; its root is then known to 0.51 d / sqrt(D) + u
/// sqrt(D). The sum S of that and |c1| (known to +-r1) has no cancellation, so its relative error is at most
/// (0.51 d / sqrt(D) + r1) / S + 3 u; the quotient adds the relative error of c0 (or c2) and 2 u. Each part is at most
/// 2^-11 or so, which the factor 1.01 turns from a bound on S and on c0 into one on the quotient.
inline QuadraticRoot quadratic_root(const Polynomial<2, Ball<double>>& p, const Ball<double>& discriminant) {
  const double root = std::sqrt(discriminant.middle);
  const bool rising = p.c[1].middle > 0;
  const double sum = std::abs(p.c[1].middle) + root;
  const Ball<double>& other = rising ? p.c[2] : p.c[0];
  const double x = rising ? sum / (-2 * other.middle) : 2 * other.middle / sum;
  const double inaccuracy = discriminant.radius / discriminant.middle;
  const double error = 1.01 * ((0.51 * inaccuracy * root + p.c[1].radius) / sum +
                               other.radius / std::abs(other.middle) + 6 * 0x1p-53);
  // Below 2^-900 underflow could add to the errors.
  const bool in_range = x > 0x1p-900 && x < 0x1p900 && std::abs(other.middle) > 0x1p-900 && sum > 0x1p-900;
  if (!(inaccuracy <= 0x1p-12 && error <= 0x1p-10 && in_range)) return {x, undecided};
  return {x, error};
}

/// p is f about now. Precondition: f > 0 just after now.
///
/// The closed form gives the root to a few digits at least, which settles most pairs that meet beyond the horizon; one
/// value in double-double then places it among the doubles. Parabolas that nearly touch zero are left to exact signs.
template <class C>
double quadratic_failure_time(const C& certificate, const Polynomial<2, Ball<double>>& p, double now, double horizon) {
  const int bend = certain_sign(p.c[2]);
  if (bend > 0 && certain_sign(p.c[1]) > 0) return never;
  const Ball<double> discriminant = p.c[1] * p.c[1] - p.c[0] * p.c[2] * 4.0;
  const int real = certain_sign(discriminant);
  if (bend > 0 && real < 0) return never;
  if (bend != 0 && real > 0) {
    const QuadraticRoot root = quadratic_root(p, discriminant);
    if (root.error < 1) {
      if (root.x * (1 - root.error) > (horizon - now) * (1 + 0x1p-50)) return never;
      const double t = RootRounding<C>(certificate, now)(p, root.x, 0.0, never);
      if (t <= horizon) return t;
      if (t > horizon) return never;
    }
  }
  ++sign_counters.searches;
  return quadratic_failure_time_by_signs(certificate, p, now, horizon);
}

}  // namespace kds::detail
