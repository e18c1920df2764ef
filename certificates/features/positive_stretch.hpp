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
  std::array<std::array<double, std::size_t{Degree} + 1>, std::size_t{Degree} + 1> table{};
  for (int i = 0; i <= Degree; ++i) {
    double ratio = 1;  // C(i, j) / C(Degree, j)
    for (int j = 0; j <= i; ++j) {
      table[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = ratio;
      if (j < Degree) ratio = ratio * (i - j) / (Degree - j);
    }
  }
  return table;
}

/// Bernstein coefficients on [0, width].
template <int Degree>
std::array<double, std::size_t{Degree} + 1> bernstein(Polynomial<Degree> p, double width) {
  static constexpr auto table = bernstein_table<Degree>();
  double factor = width;
  for (std::size_t j = 1; j <= Degree; ++j) {
    p.c[j] *= factor;
    factor *= width;
  }
  std::array<double, std::size_t{Degree} + 1> b;
  for (std::size_t i = 0; i <= Degree; ++i) {
    b[i] = p.c[0];
    for (std::size_t j = 1; j <= i; ++j) b[i] += table[i][j] * p.c[j];
  }
  return b;
}

template <std::size_t Count>
bool all_above(const std::array<double, Count>& b, double level) {
  double least = b[0];
  for (std::size_t j = 1; j < Count; ++j) least = std::min(least, b[j]);
  return least > level;
}

/// The part of a stretch before the polynomial can have come down to the level, which its first coefficient is above.
/// The steepest line from the first control point down to another one lies below all of them.
template <std::size_t Count>
double steepest_descent(const std::array<double, Count>& b, double level) {
  double steepest = 0;
  for (std::size_t j = 1; j < Count; ++j) {
    steepest = std::max(steepest, (b[0] - b[j]) * (Count - 1) / static_cast<double>(j));
  }
  return (b[0] - level) / steepest * (1 - 0x1p-40);
}

/// Bernstein coefficients, of a higher degree, of a polynomial that is not below the length of n on [s, s + width].
template <int Degree, int NormalDegree>
std::array<double, std::size_t{Degree} + 1> bound_of_length(const std::array<Polynomial<NormalDegree>, 3>& n, double s,
                                                            double width) {
  std::array<std::array<double, std::size_t{NormalDegree} + 1>, 3> b;
  for (std::size_t d = 0; d < 3; ++d) b[d] = bernstein(taylor_shift<double>(n[d], s), width);
  std::array<double, std::size_t{Degree} + 1> length{};
  for (std::size_t j = 0; j <= NormalDegree; ++j) {
    length[j] = std::sqrt(b[0][j] * b[0][j] + b[1][j] * b[1][j] + b[2][j] * b[2][j]);
  }
  for (std::size_t degree = NormalDegree; degree < Degree; ++degree) {
    length[degree + 1] = length[degree];
    for (std::size_t j = degree; j > 0; --j) {
      const double part = static_cast<double>(j) / static_cast<double>(degree + 1);
      length[j] = part * length[j - 1] + (1 - part) * length[j];
    }
  }
  return length;
}

/// A guess of the last x in (0, width) before p comes down to the level, by Halley's method from 0; 0 if p turns up
/// first.
///
/// What the last step takes off is a factor of 2^-20 or more in the excess, mostly far more: the error is cubed. The
/// guess stays behind the root by 2^-25 of the start's excess, so that what rounding and that step leave does not
/// matter, mostly.
template <int Degree>
double halley_guess(const Polynomial<Degree>& p, double width, double level) {
  const double start = p.c[0] - level;
  double excess = start;
  double slope = p.c[1];
  double bend = Degree > 1 ? p.c[std::min(Degree, 2)] : 0;  // half of p''
  double x = 0;
  for (int i = 0; i < 8; ++i) {
    if (!(slope < 0)) return 0;
    const double step = excess * slope / (slope * slope - excess * bend);
    if (std::abs(excess) < 0x1p-10 * start) return x - step - 2 * (0x1p-26 * start + level) / -slope;
    x -= step;
    if (!(x < width)) return 0;
    double value = p.c[Degree];
    slope = bend = 0;
    for (std::size_t j = Degree; j-- > 0;) {
      bend = bend * x + slope;
      slope = slope * x + value;
      value = value * x + p.c[j];
    }
    excess = value - level;
  }
  return 0;
}

}  // namespace detail

/// An r in [s, 1] such that p > margin on all of [s, r]; near the first time at which it is not, or 1. It is s where p
/// is not certainly above the margin at s. Precondition: 0 <= s <= 1.
///
/// Where the Bernstein coefficients of a stretch are all above the margin, p is. If those of [s, 1] are not, those of
/// the stretch up to Halley's guess of the root usually are, which ends it. If not, the part of a stretch before a line
/// below the control polygon comes down to the margin is still free, and a shorter stretch is tried from there: this
/// gains quadratically on a simple root, by halves on a double one.
///
/// Rounding: shift, scaling and change of basis take at most 5 Degree + 8 roundings of parts whose absolute values sum
/// to at most norm(p); 64 x 2^-53 norm(p) is added to the margin, which covers degree 10.
template <int Degree>
double positive_until(const Polynomial<Degree>& p, double s, double margin) {
  static_assert(Degree >= 1 && Degree <= 10);
  constexpr int most_stretches = 48;
  const double level = margin + 0x1p-47 * norm(p);
  double width = 1 - s;
  double start = 0;
  for (int i = 0; i < most_stretches && s < 1; ++i) {
    const auto local = taylor_shift<double>(p, s);
    const auto b = detail::bernstein(local, width);
    if (!(b[0] > level)) return s;
    if (i == 0) {
      start = b[0] - level;
      if (detail::all_above(b, level)) return 1;
      const double guess = detail::halley_guess(local, width, level);
      if (guess > 0 && detail::all_above(detail::bernstein(local, guess), level)) return s + guess * (1 - 0x1p-50);
    }
    if (detail::all_above(b, level)) {
      s += width;
      width = std::min(1 - s, 4 * width);
      continue;
    }
    s += detail::steepest_descent(b, level) * width;
    if (b[0] - level < 0x1p-10 * start) return s;  // near the root: what is left is for whoever asked to see to
    width = std::min(1 - s, 0.5 * width);
  }
  return std::min(s, 1.0);
}

/// An r in [s, 1] such that p > thickness |n| + margin on all of [s, r]; near the first time at which it is not, or 1.
/// It is s where that is not certain at s. Precondition: 0 <= s <= 1; n is of no higher degree than p.
///
/// The length of a sum is at most the sum of the lengths: so |n| is below the polynomial whose Bernstein coefficients
/// are the lengths of those of n, and by less the shorter the stretch is, in square. With it the certificate is a
/// polynomial again, for the stretch at hand, and the stretch is chosen as by positive_until().
///
/// Rounding: as there, with the coefficients of n and their lengths, three roundings more each, times the thickness;
/// raising the degree is of sums with weights that sum to 1, 2 Degree roundings of parts no larger than |n|.
template <int Degree, int NormalDegree>
double positive_beyond_until(const Polynomial<Degree>& p, const std::array<Polynomial<NormalDegree>, 3>& n,
                             double thickness, double s, double margin) {
  static_assert(NormalDegree <= Degree && Degree <= 10);
  constexpr int most_stretches = 64;
  const double lengths = norm(n[0]) + norm(n[1]) + norm(n[2]);
  const double level = margin + 0x1p-46 * (norm(p) + thickness * lengths);
  double width = 1 - s;
  double start = 0;
  for (int i = 0; i < most_stretches && s < 1; ++i) {
    auto b = detail::bernstein(taylor_shift<double>(p, s), width);
    const auto length = detail::bound_of_length<Degree>(n, s, width);
    for (std::size_t j = 0; j <= Degree; ++j) b[j] -= thickness * length[j];
    if (!(b[0] > level)) return s;
    if (i == 0) start = b[0] - level;
    if (detail::all_above(b, level)) {
      s += width;
      width = std::min(1 - s, 4 * width);
      continue;
    }
    s += detail::steepest_descent(b, level) * width;
    if (b[0] - level < 0x1p-10 * start) return s;
    width = std::min(1 - s, 0.5 * width);
  }
  return std::min(s, 1.0);
}

}  // namespace kds::certificates
