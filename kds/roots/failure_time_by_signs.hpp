// Rung 3: failure times by the exact signs of all derivatives, where the quicker methods do not decide.
#pragma once

#include "kds/roots/lattice_crossing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace kds::detail {

/// Sign changes on the lattice of doubles, by derivatives, with exact signs only: correct for every polynomial,
/// whatever its roots.
///
/// A cell is a pair of neighbouring doubles. Call a set of cells *complete* for a function if the function has no sign
/// change outside them. The empty set is complete for the highest derivative, which is constant. Given a complete set
/// for f^(k+1), f^(k) is monotone between its cells, so between two of them it changes its sign where exact signs at
/// the ends differ, and once: a search finds that cell. The old cells stay in the set, for the sign of f^(k) may change
/// in one of them, and twice, unseen from its ends, as f^(k+1) does; but one in which f^(k) certainly does not change
/// its sign is dropped. In the end, the first double just after which f < 0 is one where f turns between two cells, or
/// the end of a cell.
///
/// Without a horizon the last stretch extends to infinity, where the leading coefficient gives the sign, which is
/// cheaper than the sign at the largest double; but only as long as no higher derivative turns beyond all doubles.
///
/// Cost: O(degree^2) searches of a few values in double-double each: 2 us for a parabola, up to 70 us for clustered
/// roots of degree 8.
template <int Degree>
class DerivativeIntervals {
 public:
  DerivativeIntervals(const CertificateReference<Degree>& certificate, double now, double horizon)
      : certificate_(certificate), now_(now), horizon_(horizon) {
    const auto p = certificate.template polynomial<Ball<double>>(now);
    for (std::size_t i = 0; i <= Degree; ++i) guide_.c[i] = p.c[i].middle;
  }

  /// First double in [now, horizon] with f < 0 just after, or `never`.
  double first_negative() {
    for (int order = Degree - 1; order > 0; --order) refine(order);
    return first_negative_between_cells();
  }

 private:
  static constexpr std::size_t most_cells = Degree * (Degree + 1) / 2;

  /// The doubles `before` and `at` are neighbours.
  struct Cell {
    double before;
    double at;
    Polynomial<Degree, Ball<double>> f;  ///< about `before`
  };

  /// From a set complete for f^(order+1) to one complete for f^(order).
  void refine(int order) {
    std::array<Cell, most_cells> old;
    const std::size_t count = count_;
    std::copy_n(cells_.begin(), count, old.begin());
    count_ = 0;
    double start = now_;
    for (std::size_t i = 0; i <= count; ++i) {
      const double stop = i < count ? old[i].before : horizon_;
      const double t = crossing(order, start, stop);
      if (t != never) add(t);
      if (i == count) break;
      if (!keeps_its_sign(old[i], order)) cells_[count_++] = old[i];
      start = old[i].at;
    }
  }

  double first_negative_between_cells() {
    if (sign_after(certificate_, now_) < 0) return now_;
    double start = now_;
    for (std::size_t i = 0; i <= count_; ++i) {
      const double t = crossing(0, start, i < count_ ? cells_[i].before : horizon_);
      if (t != never) return t;  // f was not negative before, so it turns negative here
      if (i == count_) return never;
      start = cells_[i].at;
      if (sign_after(certificate_, start) < 0) return start;
    }
    return never;
  }

  void add(double t) {
    const double before = next_down(t);
    cells_[count_++] = {before, t, certificate_.template polynomial<Ball<double>>(before)};
  }

  /// Whether f^(order), up to a factor the sum of binomial(i, order) c_i x^(i-order), is certainly not zero in the
  /// cell.
  static bool keeps_its_sign(const Cell& cell, int order) {
    const double width = cell.at - cell.before;
    double change = 0;
    double binomial = 1;
    double power = 1;
    for (int i = order + 1; i <= Degree; ++i) {
      binomial = binomial * i / (i - order);
      power *= width;
      const Ball<double>& c = cell.f.c[static_cast<std::size_t>(i)];
      change += binomial * power * (std::abs(c.middle) + c.radius);
    }
    const Ball<double>& value = cell.f.c[static_cast<std::size_t>(order)];
    // Roundings, a few dozen, and underflow, some 2^-1074 for each of them.
    return std::abs(value.middle) > (value.radius + change) * Ball<double>::slack + Ball<double>::underflow;
  }

  /// f^(order) is monotone on [start, stop]. The first double in (start, stop] just after which its sign is new, or
  /// `never` if the sign does not change.
  double crossing(int order, double start, double stop) {
    if (!(start < stop)) return never;
    const int before = sign_after(certificate_, start, order);
    const int after = stop < never ? sign_after(certificate_, stop, order) : sign_at_infinity(order);
    if (before == after || before == 0 || after == 0) return never;
    double above = stop;
    if (stop == never) {
      above = std::numeric_limits<double>::max();
      if (!(start < above)) return never;
    }
    const double guess = now_ + approximate_root(scaled_derivative(order), start - now_, above - now_, after > 0);
    const double t = LatticeCrossing<Degree>(certificate_, order)(start, above, after, guess);
    if (stop == never && t == above && sign_after(certificate_, t, order) != after) {
      horizon_ = above;  // The sign changes beyond all doubles.
      return never;
    }
    return t;
  }

  /// The leading term decides.
  int sign_at_infinity(int order) const {
    for (int i = Degree; i >= order; --i) {
      if (const int s = sign_after(certificate_, now_, i)) return s;
    }
    return 0;
  }

  /// f^(order) about now in doubles, up to a factor.
  Polynomial<Degree> scaled_derivative(int order) const {
    Polynomial<Degree> result;
    double binomial = 1;
    for (int i = order; i <= Degree; ++i) {
      if (i > order) binomial = binomial * i / (i - order);
      result.c[static_cast<std::size_t>(i - order)] = guide_.c[static_cast<std::size_t>(i)] * binomial;
    }
    return result;
  }

  /// A root of p between lower and upper, to a few ulps: Newton's method and bisection. A guess.
  static double approximate_root(const Polynomial<Degree>& p, double lower, double upper, bool rising) {
    const auto slope = derivative(p);
    if (!(upper < 0x1p1000)) {  // Unbounded: double the step until the sign turns.
      double step = 1;
      while (step < 0x1p900 && (p(lower + step) > 0) != rising) step *= 2;
      upper = lower + step;
    }
    double x = 0.5 * lower + 0.5 * upper;
    for (int i = 0; i < 100 && lower < upper; ++i) {
      const double value = p(x);
      ((value > 0) == rising ? upper : lower) = x;
      double next = x - value / slope(x);
      if (!(next > lower && next < upper)) next = 0.5 * lower + 0.5 * upper;
      if (std::abs(next - x) <= 0x1p-50 * std::abs(next)) return next;
      x = next;
    }
    return x;
  }

  CertificateReference<Degree> certificate_;
  Polynomial<Degree> guide_;  ///< f about now, rounded
  double now_;
  double horizon_;
  std::array<Cell, most_cells> cells_;  ///< in order of time
  std::size_t count_ = 0;
};

/// The last rung. Not inlined, so that it takes no registers from the ones before.
template <int Degree>
[[gnu::noinline, gnu::cold]] double failure_time_by_signs(const CertificateReference<Degree>& certificate, double now,
                                                          double horizon) {
  ++sign_counters.searches;
  return DerivativeIntervals<Degree>(certificate, now, horizon).first_negative();
}

}  // namespace kds::detail
