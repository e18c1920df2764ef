// Contender: sign changes of the derivatives, from the lowest degree up, in plain doubles.
#pragma once

#include "tests/benchmarks/roots/contenders/selection.hpp"

namespace bench_roots {

/// Between two neighbouring roots of its derivative a polynomial is monotone: a change of sign between them brackets
/// one root, which Newton's method finds, guarded by halving [Yuksel22]. The last polynomial stops at the first root at
/// which it falls.
struct DerivativeIntervals {
  static constexpr const char* name = "derivative intervals";
  static constexpr bool certified = false;
  static constexpr int least_degree = 2;
  static constexpr int greatest_degree = 8;

  template <int Degree>
  static double first_negative(const kds::Polynomial<Degree>& p, double horizon) {
    if (const auto known = answered_by_signs(p)) return *known;
    return bounded(p, horizon);
  }

 private:
  template <int Degree>
  static double bounded(const kds::Polynomial<Degree>& p, double horizon) {
    if constexpr (Degree == 1) {
      return p.c[1] < 0 ? within(p.c[0] / -p.c[1], horizon) : never;
    } else {
      if (p.c[Degree] == 0) return bounded(without_leading(p), horizon);
      const double end = std::min(horizon, root_bound(p));
      double start = 0;
      const RealRoots<Degree - 1> turns = roots(kds::derivative(p), end);
      for (std::size_t i = 0; i <= turns.count; ++i) {
        const double stop = i < turns.count ? turns.x[i] : end;
        // p > 0 at the start of every stretch that is reached.
        if (p(stop) < 0) return falling_root(p, start, stop, 0.5 * (start + stop));
        start = stop;
      }
      return never;
    }
  }

  /// Roots in (0, end), rising.
  template <int Degree>
  static RealRoots<Degree> roots(const kds::Polynomial<Degree>& p, double end) {
    RealRoots<Degree> found;
    const auto keep = [&](double x) {
      if (x > 0 && x < end) found.add(x);
    };
    if constexpr (Degree == 1) {
      keep(-p.c[0] / p.c[1]);
    } else if constexpr (Degree == 2) {
      const auto [c, b, a] = p.c;
      const double discriminant = b * b - 4 * a * c;
      if (discriminant > 0) {
        const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
        const double first = q / a;
        const double second = c / q;
        keep(std::min(first, second));
        keep(std::max(first, second));
      }
    } else {
      const RealRoots<Degree - 1> turns = roots(kds::derivative(p), end);
      double start = 0;
      double at_start = p.c[0];
      for (std::size_t i = 0; i <= turns.count; ++i) {
        const double stop = i < turns.count ? turns.x[i] : end;
        const double at_stop = p(stop);
        if (at_start > 0 && at_stop < 0) keep(falling_root(p, start, stop, 0.5 * (start + stop)));
        if (at_start < 0 && at_stop > 0) keep(falling_root(-p, start, stop, 0.5 * (start + stop)));
        start = stop;
        at_start = at_stop;
      }
    }
    return found;
  }
};

}  // namespace bench_roots
