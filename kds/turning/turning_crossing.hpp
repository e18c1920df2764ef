// Where a derivative of a turning certificate changes its sign, among the doubles: by signs alone.
#pragma once

#include "kds/arithmetic/lattice.hpp"
#include "kds/turning/turning_certificate.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace kds {

/// How failure times of turning certificates were found. One set a thread; reset by assigning {}.
struct TurningSearchCounters {
  std::uint64_t expansions = 0;  ///< Taylor models in doubles
  std::uint64_t extended = 0;    ///< Taylor models in double-doubles
  std::uint64_t enclosed = 0;    ///< Taylor models of exact coefficients
  std::uint64_t signs = 0;       ///< exact signs
  std::uint64_t searches = 0;    ///< stretches that were left to the signs of all derivatives
};
inline thread_local TurningSearchCounters turning_search_counters;

namespace detail {

/// Exact signs of f, or of -f, and where they change.
template <class C>
class TurningCrossing {
 public:
  TurningCrossing(const C& certificate, int side) : certificate_(certificate), side_(side) {}

  int sign(double t, int order = 0) const {
    ++turning_search_counters.signs;
    return side_ * sign_after(certificate_, t, order);
  }

  /// f in double-doubles.
  Ball<DoubleDouble> value(double t) const {
    ++turning_search_counters.signs;
    const auto value = extended_turning_value(certificate_, t);
    return side_ > 0 ? value : -value;
  }

  /// The first double not before a root of f, by one value in double-doubles; no number where that does not tell.
  ///
  /// `slope` is f' at the guess, 1/s, and `bend` at least |f''|, 1/s^2, up to `radius` from it. Error bound: up to d =
  /// 2 |f / slope| from the guess f' is off by at most q = bend d, and its radius; where that is less than a quarter of
  /// it, f changes its sign within d, for there it changes by more than 3/4 of 2 |f|. So the root is at guess - f / (f'
  /// at a time between): the quotient by the slope is off by 4/3 of q / slope of itself at most, and by 4/3 of the
  /// radius of f, divided by the slope; a rounding of the quotient is charged with four.
  double next_to_root(double guess, const Ball<double>& slope, double bend, double radius) const {
    const Ball<DoubleDouble> at_guess = value(guess);
    const double steepness = std::abs(slope.middle);
    const double quotient = at_guess.middle.high / slope.middle;
    const double d = 2.1 * (std::abs(quotient) + at_guess.radius / steepness);
    const double unsure = (slope.radius + bend * d) * Ball<double>::slack;
    if (!(unsure <= 0.25 * steepness && d <= radius)) return std::numeric_limits<double>::quiet_NaN();
    const double error = std::abs(quotient) * (1.5 * unsure / steepness + 0x1p-51) + 1.5 * at_guess.radius / steepness;
    const DoubleDouble root = two_sum(guess, -quotient);
    const double next = next_up(root.high);
    if (root.low > error && root.low + error < next - root.high) return next;
    if (-root.low > error && error - root.low < root.high - next_down(root.high)) return root.high;
    return std::numeric_limits<double>::quiet_NaN();
  }

  /// The first double in (below, above] whose sign is that of `above`, for derivative number `order`. Precondition: the
  /// sign at `below` differs, and there is one change between. `guess` may be anything.
  ///
  /// Newton's method on values in double-doubles, with the slope at the guess: three or four signs where the guess is
  /// good. Where double-doubles do not tell the sign, growing steps away from the guess, and where either makes no way
  /// bisection of the doubles.
  double operator()(int order, double below, double above, int sign_above, double guess) const {
    int without_progress = 0;
    std::uint64_t stride = 1;
    double slope = 0;
    double candidate = guess;
    while (next_up(below) < above) {
      const std::uint64_t width = lattice_distance(below, above);
      if (without_progress > 2 || std::isnan(candidate)) {
        candidate = lattice_middle(below, above);
        without_progress = 0;
      }
      candidate = std::clamp(candidate, next_up(below), next_down(above));
      const auto value = order == 0 ? extended_turning_value(certificate_, candidate)
                                    : turning_derivative<Ball<DoubleDouble>>(certificate_, candidate, order);
      int s = side_ * certain_sign(value);
      const bool certain = s != 0;
      if (certain) {
        ++turning_search_counters.signs;
      } else {
        s = sign(candidate, order);
      }
      (s == sign_above ? above : below) = candidate;
      const std::uint64_t left = lattice_distance(below, above);
      if (certain) {
        if (left > width / 2) ++without_progress;
        if (slope == 0) slope = turning_derivative<Ball<double>>(certificate_, candidate, order + 1).middle;
        const DoubleDouble root = -value.middle / DoubleDouble(slope) + candidate;
        // The first double not before Newton's root; once that is known to be past the root, the one before it.
        candidate = root.low > 0 ? next_up(root.high) : root.high;
        if (candidate == above) candidate = next_down(above);
      } else if (stride < left / 2) {
        const auto step = static_cast<std::int64_t>(stride);
        candidate = lattice_point(lattice_index(candidate) + (s == sign_above ? -step : step));
        stride *= 8;
      } else {
        candidate = lattice_middle(below, above);
      }
    }
    return above;
  }

 private:
  const C& certificate_;
  int side_;
};

/// The first double in [l, r] just after which f < 0, or `never`, where derivative number `top` does not change its
/// sign: as DerivativeIntervals (kds/roots/failure_time_by_signs.hpp) does with polynomials.
///
/// A cell is a pair of neighbouring doubles. Call a set of cells *complete* for a function if that has no sign change
/// outside them. The empty set is complete for derivative number `top`. Given a complete set for number k + 1, number k
/// is monotone between its cells, so that it changes its sign where exact signs at the ends differ, and once: a search
/// finds that cell. The old ones stay, for there the sign of number k may change twice, unseen from the ends. In the
/// end, the first double just after which f < 0 is one where f turns between two cells, or the end of a cell.
///
/// `guess(k, from, to)` is a time near which number k is zero. Precondition: f > 0 just after l.
template <class C, class Guess>
double first_negative_by_signs(const TurningCrossing<C>& crossing, double l, double r, int top, const Guess& guess) {
  ++turning_search_counters.searches;
  std::vector<double> ends;  // of the cells, in order of time
  const auto change = [&](int order, double start, double stop) {
    if (!(start < stop)) return never;
    const int before = crossing.sign(start, order);
    const int after = crossing.sign(stop, order);
    if (before == after || before == 0 || after == 0) return never;
    return crossing(order, start, stop, after, guess(order, start, stop));
  };
  for (int order = top - 1; order > 0; --order) {
    std::vector<double> refined;
    double start = l;
    for (std::size_t i = 0; i <= ends.size(); ++i) {
      const double t = change(order, start, i < ends.size() ? next_down(ends[i]) : r);
      if (t != never) refined.push_back(t);
      if (i == ends.size()) break;
      refined.push_back(ends[i]);
      start = ends[i];
    }
    ends = refined;
  }
  double start = l;
  for (const double end : ends) {
    const double t = change(0, start, next_down(end));
    if (t != never) return t;  // f was not negative before, so it is from here on
    if (crossing.sign(end) < 0) return end;
    start = end;
  }
  return change(0, start, r);
}

}  // namespace detail
}  // namespace kds
