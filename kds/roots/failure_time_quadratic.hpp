// Rung 2: the failure time of a parabola.
#pragma once

#include "kds/roots/failure_time_by_signs.hpp"
#include "kds/roots/root_rounding.hpp"

#include <cmath>

namespace kds::detail {

/// c1^2 - 4 c0 c2. Error bound, with u = 2^-53: the two products and the difference are known to u of themselves,
/// together at most 2 u (|c1^2| + |4 c0 c2|), and to what the radii make of them; underflow takes less than 2^-1020.
inline Ball<double> discriminant(const Polynomial<2, Ball<double>>& p) {
  const auto& [c0, c1, c2] = p.c;
  const double square = c1.middle * c1.middle;
  const double product = 4 * (c0.middle * c2.middle);
  const double radius = (2 * std::abs(c1.middle) + c1.radius) * c1.radius +
                        4 * (std::abs(c0.middle) * c2.radius + (std::abs(c2.middle) + c2.radius) * c0.radius);
  return {square - product, radius + 0x1p-52 * (square + std::abs(product)) + 0x1p-1020};
}

/// A root in doubles, and a bound on its error; a NaN where there is no good bound.
struct ApproximateRoot {
  double x;
  double error;
};

/// N / M with N known to +-n and M to +-m. With m / M <= 2^-8 the error is at most (n + |x| m) / (M - m), plus the
/// roundings of the inverse and of the product, 2^-52 |x|; the factor 1.01 covers M - m in place of M and what the
/// bound itself loses. Outside 2^+-900 the result is a NaN, so that underflow plays no part.
inline ApproximateRoot bounded_quotient(double numerator, double n, double denominator, double m) {
  const double inverse = 1 / denominator;
  const double x = numerator * inverse;
  const double error = 1.01 * (n + x * m) * std::abs(inverse) + 0x1p-51 * x;
  const bool good = m * std::abs(inverse) <= 0x1p-8 && error <= 0x1p-10 * x && x > 0x1p-900 && x < 0x1p900 &&
                    std::abs(inverse) < 0x1p900 && std::abs(numerator) > 0x1p-900;
  return {x, good ? error : undecided};
}

/// Where a parabola that is positive just after 0 turns from + to -: 2 c0 / (sqrt(D) - c1), or, to the same effect,
/// (c1 + sqrt(D)) / (-2 c2), of which one is free of cancellation. D is certainly positive, so that is the only such
/// turn.
///
/// Error bound. Let D be known to +-d with d <= D / 8; its root is known to 0.52 d / sqrt(D), and 2^-53 for its
/// rounding. The sum S of that and |c1| (known to +-r1) has no cancellation: it is known to 0.52 d / sqrt(D) + r1 +
/// 2^-52 S.
inline ApproximateRoot quadratic_root(const Polynomial<2, Ball<double>>& p, const Ball<double>& discriminant) {
  if (!(discriminant.radius <= 0.125 * discriminant.middle)) return {never, undecided};
  const auto& [c0, c1, c2] = p.c;
  const double root = std::sqrt(discriminant.middle);
  const double sum = std::abs(c1.middle) + root;
  const double error = (0.52 * discriminant.radius / root + c1.radius) * Ball<double>::slack + 0x1p-52 * sum;
  if (c1.middle > 0) return bounded_quotient(sum, error, -2 * c2.middle, 2 * c2.radius);
  return bounded_quotient(2 * c0.middle, 2 * c0.radius, sum, error);
}

/// p is f about now. Precondition: f > 0 just after now.
///
/// The closed form gives the root to a few digits at least, which decides most pairs that meet beyond the horizon; one
/// value in double-double then places it among the doubles. Parabolas that nearly touch zero are left to exact signs.
template <class C>
double quadratic_failure_time(const C& certificate, const Polynomial<2, Ball<double>>& p, double now, double horizon) {
  const int bend = certain_sign(p.c[2]);
  if (bend > 0 && certain_sign(p.c[1]) > 0) return never;
  const Ball<double> d = discriminant(p);
  const int real = certain_sign(d);
  if (bend > 0 && real < 0) return never;
  if (bend != 0 && real > 0) {
    const ApproximateRoot root = quadratic_root(p, d);
    if (root.error < never) {
      if (root.x - root.error > (horizon - now) * (1 + 0x1p-50)) return never;
      const double t = RootRounding<C>(certificate, now)(p, root.x, 0.0, never);
      if (t <= horizon) return t;
      if (t > horizon) return never;
    }
  }
  return failure_time_by_signs(CertificateReference(certificate), now, horizon);
}

}  // namespace kds::detail
