// Contender: closed forms without avoidable cancellation, and with residuals of twice the precision.
#pragma once

#include "kds/arithmetic/double_double.hpp"
#include "tests/benchmarks/roots/contenders/closed_form.hpp"

namespace bench_roots {

/// Degree 2: the discriminant by error-free products [Kahan04], and of the two forms of the root the one that does not
/// cancel. Degree 3 and 4: the roots of ClosedForm, then two steps of Newton's method with the polynomial evaluated by
/// the compensated rule of Horner [Graillat09].
struct Compensated {
  static constexpr const char* name = "compensated";
  static constexpr bool certified = false;
  static constexpr int least_degree = 2;
  static constexpr int greatest_degree = 4;

  template <int Degree>
  static double first_negative(const kds::Polynomial<Degree>& p, double horizon) {
    if (const auto known = answered_by_signs(p)) return *known;
    return solve(p, horizon);
  }

 private:
  template <int Degree>
  static double solve(const kds::Polynomial<Degree>& p, double horizon) {
    if constexpr (Degree == 1) {
      return p.c[1] < 0 ? within(p.c[0] / -p.c[1], horizon) : never;
    } else {
      if (p.c[Degree] == 0) return solve(without_leading(p), horizon);
      if constexpr (Degree == 2) {
        const auto [c, b, a] = p.c;
        const double discriminant = difference_of_products(b, b, 4 * a, c);
        if (!(discriminant > 0)) return never;
        const double root = std::sqrt(discriminant);
        const double t = b > 0 ? (b + root) / (-2 * a) : 2 * c / (root - b);
        return t >= 0 ? within(t, horizon) : never;
      } else {
        RealRoots<Degree> roots = ClosedForm::roots(p);
        const auto slope = kds::derivative(p);
        for (std::size_t i = 0; i < roots.count; ++i) {
          for (int step = 0; step < 2; ++step) {
            const double correction = compensated_value(p, roots.x[i]) / slope(roots.x[i]);
            // Near a multiple root the step is noise, and none is better.
            if (std::abs(correction) <= 0x1p-10 * std::abs(roots.x[i])) roots.x[i] -= correction;
          }
        }
        return first_falling(roots, p, horizon);
      }
    }
  }

  /// a b - c d, to two roundings of the result.
  static double difference_of_products(double a, double b, double c, double d) {
    const kds::DoubleDouble left = kds::two_product(a, b);
    const kds::DoubleDouble right = kds::two_product(c, d);
    return (left.high - right.high) + (left.low - right.low);
  }

  template <int Degree>
  static double compensated_value(const kds::Polynomial<Degree>& p, double x) {
    double value = p.c[Degree];
    double correction = 0;
    for (std::size_t i = Degree; i-- > 0;) {
      const kds::DoubleDouble product = kds::two_product(value, x);
      const kds::DoubleDouble sum = kds::two_sum(product.high, p.c[i]);
      value = sum.high;
      correction = correction * x + (product.low + sum.low);
    }
    return value + correction;
  }
};

}  // namespace bench_roots
