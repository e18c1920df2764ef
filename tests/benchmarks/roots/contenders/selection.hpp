// What all contenders in plain doubles share: what the coefficients tell at once, and which root it is.
#pragma once

#include "kds/polynomial.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace bench_roots {

inline constexpr double never = std::numeric_limits<double>::infinity();

/// The answer, where the signs of the coefficients tell it: negative just after 0, or no sign change and thus no root
/// ahead. Exact, and nearly free; so every contender begins with it.
template <int Degree>
std::optional<double> answered_by_signs(const kds::Polynomial<Degree>& p) {
  bool falls = false;
  bool started = false;
  for (const double c : p.c) {
    if (c < 0) {
      if (!started) return 0.0;
      falls = true;
    }
    started = started || c != 0;
  }
  if (!falls) return never;
  return std::nullopt;
}

/// The same polynomial, its leading coefficient left out.
template <int Degree>
kds::Polynomial<Degree - 1> without_leading(const kds::Polynomial<Degree>& p) {
  kds::Polynomial<Degree - 1> lower;
  for (std::size_t i = 0; i < Degree; ++i) lower.c[i] = p.c[i];
  return lower;
}

inline double within(double t, double horizon) { return t <= horizon ? t : never; }

/// Real roots as they come out of a formula.
template <int Degree>
struct RealRoots {
  std::array<double, Degree> x{};
  std::size_t count = 0;

  void add(double root) { x[count++] = root; }
};

/// The first of the roots after which p is negative, by the signs of p half way between them. Parts of complex pairs
/// may be among the roots: they do not turn the sign.
template <int Degree>
double first_falling(RealRoots<Degree> roots, const kds::Polynomial<Degree>& p, double horizon) {
  std::size_t ahead = 0;  // positive and finite ones, sorted
  for (std::size_t i = 0; i < roots.count; ++i) {
    const double x = roots.x[i];
    if (!(x > 0 && x < never)) continue;
    std::size_t place = ahead++;
    for (; place > 0 && roots.x[place - 1] > x; --place) roots.x[place] = roots.x[place - 1];
    roots.x[place] = x;
  }
  for (std::size_t i = 0; i < ahead; ++i) {
    const double beyond = i + 1 < ahead ? 0.5 * roots.x[i] + 0.5 * roots.x[i + 1] : 1.5 * roots.x[i];
    if (p(beyond) < 0) return within(roots.x[i], horizon);
  }
  return never;
}

/// An upper bound on the roots' sizes, a power of two: 2 max |c_i / c_n|^(1 / (n - i)) [Fujiwara16], by exponents
/// alone. No more than 2^(1000 / n), so that its powers stay finite. Precondition: the leading coefficient is not 0.
template <int Degree>
double root_bound(const kds::Polynomial<Degree>& p) {
  const int leading = std::ilogb(p.c[Degree]);
  int bound = std::numeric_limits<int>::min();
  for (int i = 0; i < Degree; ++i) {
    const double c = p.c[static_cast<std::size_t>(i)];
    if (c == 0) continue;
    const int ratio = std::ilogb(c) + 1 - leading;  // |c / leading| < 2^ratio
    const int steps = Degree - i;
    bound = std::max(bound, (ratio >= 0 ? (ratio + steps - 1) / steps : -(-ratio / steps)) + 1);
  }
  return std::ldexp(1.0, std::min(bound, 1000 / Degree));
}

/// The root between lower and upper, where p falls through zero once: Newton's method from x, halving where it leaves
/// the interval (doubling, where that has no upper end).
template <int Degree>
double falling_root(const kds::Polynomial<Degree>& p, double lower, double upper, double x) {
  const auto slope = kds::derivative(p);
  for (int i = 0; i < 200; ++i) {
    const double value = p(x);
    (value < 0 ? upper : lower) = x;
    double next = x - value / slope(x);
    if (!(next > lower && next < upper)) next = upper < never ? 0.5 * (lower + upper) : 2 * lower;
    if (std::abs(next - x) <= 0x1p-52 * std::abs(next)) return next;
    x = next;
  }
  return x;
}

}  // namespace bench_roots
