// Contender: Bernstein coefficients and subdivision, in plain doubles.
#pragma once

#include "tests/benchmarks/roots/contenders/selection.hpp"

namespace bench_roots {

/// In the Bernstein form on an interval the coefficients change sign at least as often as the polynomial has roots
/// there (the rule of Descartes): no change, no root; one change, one root. What has more is halved by de Casteljau's
/// rule, the earlier half first [Lane81].
///
/// On the projective line, x = scale w / (1 - w), the coefficients c_i scale^i / binomial(n, i) are the Bernstein form
/// on all of [0, infinity); a horizon cuts it off at its w.
struct Bernstein {
  static constexpr const char* name = "Bernstein";
  static constexpr bool certified = false;
  static constexpr int least_degree = 2;
  static constexpr int greatest_degree = 8;

  template <int Degree>
  static double first_negative(const kds::Polynomial<Degree>& p, double horizon) {
    if (const auto known = answered_by_signs(p)) return *known;
    std::array<Piece<Degree>, deepest + 2> stack;
    const double scale = scale_of(p);
    stack[0] = {in_bernstein_form(p, scale), 0, 1, 0};
    if (horizon < never) cut_off(stack[0], horizon / (horizon + scale));
    for (std::size_t size = 1; size > 0;) {
      const Piece<Degree> piece = stack[--size];
      const int changes = sign_changes(piece.b);
      if (changes == 0) continue;
      const auto x = [&](double w) { return scale * (w / (1 - w)); };
      if (piece.b[0] < 0) return within(x(piece.lower), horizon);  // positive up to there: the root is the seam
      if (changes == 1 || (piece.depth == deepest && piece.b[Degree] < 0)) {
        return within(falling_root(p, x(piece.lower), x(piece.upper), x(guess(piece))), horizon);
      }
      if (piece.depth < deepest) {
        halve(piece, stack[size + 1], stack[size]);  // the left half on top
        size += 2;
      }
    }
    return never;
  }

 private:
  static constexpr int deepest = 60;  ///< halvings: 52 for the digits of the root, and some for its size

  template <int Degree>
  struct Piece {
    std::array<double, Degree + 1> b;
    double lower, upper;  // of w
    int depth;
  };

  /// A power of two near the least x at which a negative term outweighs all positive ones before it.
  template <int Degree>
  static double scale_of(const kds::Polynomial<Degree>& p) {
    std::array<int, Degree + 1> size;
    for (std::size_t i = 0; i <= Degree; ++i) size[i] = std::ilogb(p.c[i]);
    constexpr int most = 1000 / Degree;  // so that no power of it overflows
    int least = most;
    for (std::size_t i = 1; i <= Degree; ++i) {
      if (!(p.c[i] < 0)) continue;
      int balance = -most;
      for (std::size_t j = 0; j < i; ++j) {
        if (p.c[j] > 0) balance = std::max(balance, (size[j] - size[i]) / static_cast<int>(i - j));
      }
      least = std::min(least, balance);
    }
    return std::ldexp(1.0, least);
  }

  template <int Degree>
  static std::array<double, Degree + 1> in_bernstein_form(const kds::Polynomial<Degree>& p, double scale) {
    std::array<double, Degree + 1> b;
    double power = 1;
    double binomial = 1;
    for (std::size_t i = 0; i <= Degree; ++i) {
      b[i] = p.c[i] * power / binomial;
      power *= scale;
      binomial = binomial * static_cast<double>(Degree - i) / static_cast<double>(i + 1);
    }
    return b;
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

  /// Where the control polygon falls through zero. Precondition: its first sign is not negative, another one is.
  template <int Degree>
  static double guess(const Piece<Degree>& piece) {
    std::size_t i = 1;
    while (i < Degree && !(piece.b[i] < 0)) ++i;
    const double step = piece.b[i - 1] / (piece.b[i - 1] - piece.b[i]);
    return piece.lower + (piece.upper - piece.lower) * ((static_cast<double>(i) - 1 + step) / Degree);
  }

  /// Keeps what is before w, a fraction of [0, 1].
  template <int Degree>
  static void cut_off(Piece<Degree>& piece, double w) {
    auto row = piece.b;
    for (std::size_t k = 1; k <= Degree; ++k) {
      for (std::size_t i = 0; i + k <= Degree; ++i) row[i] = (1 - w) * row[i] + w * row[i + 1];
      piece.b[k] = row[0];
    }
    piece.upper = w;
  }

  template <int Degree>
  static void halve(Piece<Degree> piece, Piece<Degree>& left, Piece<Degree>& right) {
    const double middle = 0.5 * (piece.lower + piece.upper);
    left.b[0] = piece.b[0];
    for (std::size_t k = 1; k <= Degree; ++k) {
      for (std::size_t i = 0; i + k <= Degree; ++i) piece.b[i] = 0.5 * (piece.b[i] + piece.b[i + 1]);
      left.b[k] = piece.b[0];
    }
    left.lower = piece.lower;
    left.upper = right.lower = middle;
    right.b = piece.b;
    right.upper = piece.upper;
    left.depth = right.depth = piece.depth + 1;
  }
};

}  // namespace bench_roots
