// Contender: eigenvalues of the companion matrix, by Eigen's (unsupported) module Polynomials.
#pragma once

#include "tests/benchmarks/roots/contenders/selection.hpp"

#include <unsupported/Eigen/Polynomials>

#include <algorithm>

namespace bench_roots {

/// The module's solver of dynamic size: one of a fixed size for each degree takes minutes to compile, and what it saves
/// in memory management is small against the eigenvalues.
struct CompanionEigen {
  static constexpr const char* name = "companion (Eigen)";
  static constexpr bool certified = false;
  static constexpr int least_degree = 2;
  static constexpr int greatest_degree = 8;

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
      // The matrix holds the quotients by the leading coefficient.
      const bool overflows =
          std::any_of(p.c.begin(), p.c.end(), [&](double x) { return !std::isfinite(x / p.c[Degree]); });
      if (overflows) return solve(without_leading(p), horizon);
      const Eigen::Map<const Eigen::VectorXd> coefficients(p.c.data(), Degree + 1);
      const Eigen::PolynomialSolver<double, Eigen::Dynamic> solver(coefficients);
      RealRoots<Degree> roots;
      for (const auto& z : solver.roots()) roots.add(z.real());
      return first_falling(roots, p, horizon);
    }
  }
};

}  // namespace bench_roots
