// Contender: the closed forms of the textbooks, degree 1 to 4, in plain doubles.
#pragma once

#include "tests/benchmarks/roots/contenders/selection.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

namespace bench_roots {

/// Degree 1 and 2: -c0 / c1 and (-b - sqrt(b^2 - 4 a c)) / (2 a), which is the falling root whatever the sign of a.
/// Degree 3: Cardano's formula, three real roots by cosines, as in [Press07] section 5.6. Degree 4: Ferrari's, two
/// quadratic factors by way of a resolvent cubic.
struct ClosedForm {
  static constexpr const char* name = "closed form";
  static constexpr bool certified = false;
  static constexpr int least_degree = 1;
  static constexpr int greatest_degree = 4;

  template <int Degree>
  static double first_negative(const kds::Polynomial<Degree>& p, double horizon) {
    if (const auto known = answered_by_signs(p)) return *known;
    return solve(p, horizon);
  }

  /// All real roots of a cubic whose leading coefficient is not 0; or the one, and the real part of the other two.
  static RealRoots<3> roots(const kds::Polynomial<3>& p);
  /// All real roots, or the real parts of pairs that are complex up to rounding, of a quartic likewise.
  static RealRoots<4> roots(const kds::Polynomial<4>& p);

 private:
  template <int Degree>
  static double solve(const kds::Polynomial<Degree>& p, double horizon) {
    if constexpr (Degree == 1) {
      return p.c[1] < 0 ? within(p.c[0] / -p.c[1], horizon) : never;
    } else {
      if (p.c[Degree] == 0) return solve(without_leading(p), horizon);
      if constexpr (Degree == 2) {
        const auto [c, b, a] = p.c;
        const double discriminant = b * b - 4 * a * c;
        if (!(discriminant > 0)) return never;
        const double t = (-b - std::sqrt(discriminant)) / (2 * a);
        return t >= 0 ? within(t, horizon) : never;
      } else {
        return first_falling(roots(p), p, horizon);
      }
    }
  }
};

inline RealRoots<3> ClosedForm::roots(const kds::Polynomial<3>& p) {
  const double a = p.c[2] / p.c[3];
  const double b = p.c[1] / p.c[3];
  const double c = p.c[0] / p.c[3];
  const double q = (a * a - 3 * b) / 9;
  const double r = (2 * a * a * a - 9 * a * b + 27 * c) / 54;
  RealRoots<3> found;
  if (r * r < q * q * q) {
    const double angle = std::acos(std::clamp(r / std::sqrt(q * q * q), -1.0, 1.0)) / 3;
    constexpr double third = 2 * std::numbers::pi / 3;
    for (const double turn : {0.0, third, -third}) found.add(-2 * std::sqrt(q) * std::cos(angle + turn) - a / 3);
  } else {
    const double u = -std::copysign(std::cbrt(std::abs(r) + std::sqrt(r * r - q * q * q)), r);
    const double v = u == 0 ? 0 : q / u;
    found.add(u + v - a / 3);
    found.add(-0.5 * (u + v) - a / 3);  // a double root where u = v
  }
  return found;
}

inline RealRoots<4> ClosedForm::roots(const kds::Polynomial<4>& p) {
  // x = y - shift gives y^4 + e y^2 + f y + g.
  const double shift = p.c[3] / (4 * p.c[4]);
  const double b = p.c[2] / p.c[4];
  const double c = p.c[1] / p.c[4];
  const double d = p.c[0] / p.c[4];
  const double square = shift * shift;
  const double e = b - 6 * square;
  const double f = c - 2 * b * shift + 8 * square * shift;
  const double g = d - c * shift + b * square - 3 * square * square;
  // = (y^2 + h y + j) (y^2 - h y + k) with h^2 a positive root of the resolvent.
  const RealRoots<3> resolvent = roots(kds::Polynomial<3>{{-f * f, e * e - 4 * g, 2 * e, 1}});
  // The product of its roots is f^2: where only the first is real, that one is positive.
  const double z = resolvent.count < 3 ? resolvent.x[0] : *std::max_element(resolvent.x.begin(), resolvent.x.end());
  RealRoots<4> found;
  double h = 0;
  double j;
  double k;
  if (f == 0 || !(z > 0)) {  // biquadratic
    const double root = std::sqrt(std::max(e * e - 4 * g, 0.0));
    j = (e + root) / 2;
    k = (e - root) / 2;
  } else {
    h = std::sqrt(z);
    j = (e + z - f / h) / 2;
    k = (e + z + f / h) / 2;
  }
  for (const auto& [linear, constant] : {std::pair{h, j}, std::pair{-h, k}}) {
    const double root = std::sqrt(std::max(linear * linear - 4 * constant, 0.0));
    found.add((-linear - root) / 2 - shift);
    found.add((-linear + root) / 2 - shift);
  }
  return found;
}

}  // namespace bench_roots
