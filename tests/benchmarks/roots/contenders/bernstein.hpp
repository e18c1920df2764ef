// Contender: Bernstein coefficients and subdivision, in plain doubles.
#pragma once

#include "tests/benchmarks/roots/contenders/selection.hpp"

namespace bench_roots {

/// In the Bernstein form on an interval the coefficients change sign at least as often as the polynomial has roots
/// there (the rule of Descartes): no change, no root; one change, one root. What has more is halved by de Casteljau's
/// rule, the earlier half first [Lane81]. [0, infinity) is cut off at a bound of the roots.
struct Bernstein {
  static constexpr const char* name = "Bernstein";
  static constexpr bool certified = false;
  static constexpr int least_degree = 2;
  static constexpr int greatest_degree = 8;

  template <int Degree>
  static double first_negative(const kds::Polynomial<Degree>& p, double horizon) {
    if (const auto known = answered_by_signs(p)) return *known;
    return bounded(p, horizon);
  }

 private:
  static constexpr int deepest =
      100;  ///< halvings: 52 for the digits of the root, and some to come down from a bound far out

  template <int Degree>
  struct Piece {
    std::array<double, Degree + 1> b;
    double lower, width;
    int depth;
  };

  template <int Degree>
  static double bounded(const kds::Polynomial<Degree>& p, double horizon) {
    if constexpr (Degree == 1) {
      return p.c[1] < 0 ? within(p.c[0] / -p.c[1], horizon) : never;
    } else {
      if (p.c[Degree] == 0) return bounded(without_leading(p), horizon);
      const double end = std::min(horizon, root_bound(p));
      std::array<Piece<Degree>, deepest + 2> stack;
      std::size_t size = 1;
      stack[0] = {in_bernstein_form(p, end), 0, end, 0};
      while (size > 0) {
        const Piece<Degree> piece = stack[--size];
        const int changes = sign_changes(piece.b);
        if (changes == 0) continue;
        if (piece.b[0] < 0) return piece.lower;  // positive up to there: the root is the seam
        if (changes == 1 || (piece.depth == deepest && piece.b[Degree] < 0)) {
          return falling_root(p, piece.lower, piece.lower + piece.width);
        }
        if (piece.depth < deepest) {
          halve(piece, stack[size + 1], stack[size]);  // the left half on top
          size += 2;
        }
      }
      return never;
    }
  }

  template <std::size_t Size>
  static int sign_changes(const std::array<double, Size>& b) {
    int changes = 0;
    bool negative = false;  // what comes before the first is positive: a root at the lower end has been passed
    for (const double x : b) {
      changes += x != 0 && (x < 0) != negative;
      if (x != 0) negative = x < 0;
    }
    return changes;
  }

  template <int Degree>
  static std::array<double, Degree + 1> in_bernstein_form(const kds::Polynomial<Degree>& p, double end) {
    // b_j = sum over i <= j of C(j, i) / C(Degree, i) c_i end^i: a table of rising differences.
    std::array<double, Degree + 1> b;
    double power = 1;
    double binomial = 1;
    for (std::size_t i = 0; i <= Degree; ++i) {
      b[i] = p.c[i] * power / binomial;
      power *= end;
      binomial = binomial * static_cast<double>(Degree - i) / static_cast<double>(i + 1);
    }
    for (std::size_t k = 1; k <= Degree; ++k) {
      for (std::size_t i = Degree; i >= k; --i) b[i] += b[i - 1];
    }
    return b;
  }

  template <int Degree>
  static void halve(Piece<Degree> piece, Piece<Degree>& left, Piece<Degree>& right) {
    const double half = 0.5 * piece.width;
    const double lower = piece.lower;
    left.b[0] = piece.b[0];
    for (std::size_t k = 1; k <= Degree; ++k) {
      for (std::size_t i = 0; i + k <= Degree; ++i) piece.b[i] = 0.5 * (piece.b[i] + piece.b[i + 1]);
      left.b[k] = piece.b[0];
    }
    right = {piece.b, lower + half, half, piece.depth + 1};
    left.lower = lower;
    left.width = half;
    left.depth = piece.depth + 1;
  }
};

}  // namespace bench_roots
