// How long a polynomial stays above a margin, certified by its Bernstein coefficients.
#pragma once

#include "kds/motion.hpp"
#include "kds/polynomial.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace kds::certificates {

/// Sum of the absolute values of the coefficients: a bound on |p| in [0, 1].
template <int Degree>
double norm(const Polynomial<Degree>& p) {
  double sum = 0;
  for (const double c : p.c) sum += std::abs(c);
  return sum;
}

namespace detail {

/// table[i][j] = C(i, j) / C(Degree, j): Bernstein coefficient i of a polynomial is the sum of table[i][j] c[j].
template <int Degree>
constexpr auto bernstein_table() {
  std::array<std::array<double, Degree + 1>, Degree + 1> table{};
  for (int i = 0; i <= Degree; ++i) {
    double ratio = 1;  // C(i, j) / C(Degree, j)
    for (int j = 0; j <= i; ++j) {
      table[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = ratio;
      if (j < Degree) ratio = ratio * (i - j) / (Degree - j);
    }
  }
  return table;
}

/// Bernstein coefficients of p on [s, s + width].
template <int Degree>
std::array<double, Degree + 1> bernstein(const Polynomial<Degree>& p, double s, double width) {
  static constexpr auto table = bernstein_table<Degree>();
  auto local = taylor_shift<double>(p, s);
  double factor = width;
  for (std::size_t j = 1; j <= Degree; ++j) {
    local.c[j] *= factor;
    factor *= width;
  }
  std::array<double, Degree + 1> b;
  for (std::size_t i = 0; i <= Degree; ++i) {
    b[i] = local.c[0];
    for (std::size_t j = 1; j <= i; ++j) b[i] += table[i][j] * local.c[j];
  }
  return b;
}

}  // namespace detail

/// An r in [s, 1] such that p > margin on all of [s, r]; near the first time at which it is not, or 1.
///
/// Where the Bernstein coefficients of a stretch are all above the margin, p is; where they are not, the part of the
/// stretch before a line below the control polygon comes down to the margin is still free, and a shorter stretch
/// is tried from there. Gains quadratically on a simple root, by halves on a double one.
///
/// Rounding: shift, scaling and change of basis take at most 5 Degree + 8 roundings of parts whose absolute values sum
/// to at most norm(p); 64 x 2^-53 norm(p) is added to the margin, which covers degree 8.
template <int Degree>
double positive_until(const Polynomial<Degree>& p, double s, double margin) {
  static_assert(Degree >= 1 && Degree <= 8);
  constexpr int most_stretches = 48;
  const double level = margin + 0x1p-47 * norm(p);
  double width = 1 - s;
  double start = 0;
  for (int i = 0; i < most_stretches && s < 1; ++i) {
    const auto b = detail::bernstein(p, s, width);
    if (!(b[0] > level)) return s;
    // Near the root: what is left of it is for whoever asked to see to.
    if (i == 0) start = b[0] - level;
    // The steepest line from the first control point down to another one lies below all of them.
    double steepest = 0;
    bool all_above = true;
    for (std::size_t j = 1; j <= Degree; ++j) {
      all_above = all_above && b[j] > level;
      steepest = std::max(steepest, (b[0] - b[j]) * Degree / static_cast<double>(j));
    }
    if (all_above) {
      s += width;
      width = std::min(1 - s, 4 * width);
    } else {
      s += (b[0] - level) / steepest * (1 - 0x1p-40) * width;
      if (b[0] - level < 0x1p-10 * start) return s;
      width = std::min(1 - s, 0.5 * width);
    }
  }
  return std::min(s, 1.0);
}

}  // namespace kds::certificates
