// Two values in order.
#pragma once

#include "certificates/order_parabola.hpp"
#include "certificates/order_together.hpp"
#include "kds/arithmetic/unrolled.hpp"
#include "kds/certificate.hpp"
#include "kds/lasting.hpp"
#include "kds/motion.hpp"
#include "kds/roots/failure_time.hpp"

#include <cmath>
#include <limits>

namespace kds::certificates {

/// lower(t) <= upper(t). The motions are referred to, and must outlive it.
template <int Degree>
struct Order {
  static constexpr int degree = Degree;
  const Motion<Degree>& lower;
  const Motion<Degree>& upper;

  Order(Lasting<Motion<Degree>> low, Lasting<Motion<Degree>> high) : lower(low), upper(high) {}

  template <class Number>
  Polynomial<Degree, Number> polynomial(double epoch) const {
    return difference_about<Number>(upper, lower, epoch);
  }

  Ball<DoubleDouble> extended_value(double t) const { return extended_difference(upper, lower, t); }

  /// Cheap and sufficient: values that move together, and values at rest in one place.
  bool vanishes() const {
    if (lower.position.c[0] != upper.position.c[0]) return false;
    bool at_rest = true;
    for (std::size_t i = 1; i <= Degree; ++i) {
      if (lower.position.c[i] != upper.position.c[i]) return false;
      at_rest = at_rest && lower.position.c[i] == 0;
    }
    return at_rest || lower.start == upper.start;
  }

  bool is_negative_of(const Order& other) const { return &lower == &other.upper && &upper == &other.lower; }

  /// A value in doubles, and more than its error.
  struct RoughValue {
    double value;
    double margin;
  };

  /// x(t) in doubles: if two values differ by more than the sum of their margins, their order in doubles is the exact
  /// one.
  ///
  /// Error bound: each term goes through at most 3 n + 1 roundings (the time since the start counts n times, Horner's
  /// rule 2 n, a difference of two values once), n the degree; 32 are charged, of the sum of all terms' magnitudes.
  /// Underflow is negligible against 2^-1000, and an overflow fails every comparison.
  static RoughValue rough_value(const Motion<Degree>& x, double t) {
    static_assert(Degree <= 8);
    const double elapsed = t - x.start;
    double sum = x.position.c[Degree];
    double size = std::abs(sum);
    unrolled<Degree>([&](auto k) {
      const double c = x.position.c[Degree - 1 - k];
      sum = sum * elapsed + c;
      size = size * std::abs(elapsed) + std::abs(c);
    });
    return {sum, 0x1p-48 * size + 0x1p-1000};
  }

  /// Sign of upper(t) - lower(t) in doubles where that is certain, else 0.
  int quick_sign(double t) const {
    const auto [above, above_margin] = rough_value(upper, t);
    const auto [below, below_margin] = rough_value(lower, t);
    const double gap = above - below;
    const double margin = above_margin + below_margin;
    return gap > margin ? 1 : (-gap > margin ? -1 : 0);
  }

  /// What failure_time() gives, bit for bit, or a NaN where that needs the general methods. It answers for pairs whose
  /// difference is a line (straight motions, and those that share their accelerations) or a parabola.
  double quick_failure_time(double now, double horizon) const;

  /// For two pairs together: see order_together.hpp.
  static TwoTimes quick_failure_times(const Order& first, const Order& second, double now, double horizon) {
    if constexpr (Degree == 1) {
      return certificates::quick_failure_times(first.lower, first.upper, second.lower, second.upper, now, horizon);
    }
    return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  }

  /// The same for failure_time_after_turn().
  double quick_failure_time_after_turn(double now, double horizon) const;

 private:
  /// The same for straight motions.
  double quick_straight_failure_time(double now, double horizon) const requires(Degree == 1);

  /// Whether the difference is known to be a parabola or less.
  bool at_most_quadratic() const {
    for (std::size_t i = 3; i <= Degree; ++i) {
      if (lower.position.c[i] != upper.position.c[i]) return false;
      if (lower.position.c[i] != 0 && lower.start != upper.start) return false;
    }
    return true;
  }

  template <bool turned>
  double quick_parabola_failure_time(double now, double horizon) const {
    if (lower.start == upper.start) {
      return kds::quick_parabola_failure_time<turned>(detail::parabola_between(lower, upper), now, horizon);
    }
    return kds::quick_parabola_failure_time<turned>(detail::shifted_parabola_between(lower, upper), now, horizon);
  }
};

template <int Degree>
Order(const Motion<Degree>&, const Motion<Degree>&) -> Order<Degree>;

template <int Degree>
double Order<Degree>::quick_failure_time(double now, double horizon) const {
  if constexpr (Degree == 0) {
    return std::numeric_limits<double>::quiet_NaN();
  } else if constexpr (Degree == 1) {
    return quick_straight_failure_time(now, horizon);
  } else {
    if (!at_most_quadratic()) return std::numeric_limits<double>::quiet_NaN();
    if (lower.position.c[2] != upper.position.c[2]) return quick_parabola_failure_time<false>(now, horizon);
    if (lower.start == upper.start) {
      return quick_line_failure_time(detail::line_between(lower, upper), now, horizon);
    }
    return quick_line_failure_time(detail::shifted_parabola_between(lower, upper), now, horizon);
  }
}

/// A line that is positive and does not fall stays positive. Values that were in the other order before, as most are
/// after a swap, differ by a line that rises.
///
/// Error bound of the rate with starts of their own, in units of 2^-53 of the sum of the magnitudes: the time between
/// the starts, the run, which is that times 2 a, and the two sums are rounded once each. 8 are charged for these 4.
template <int Degree>
double Order<Degree>::quick_failure_time_after_turn(double now, double horizon) const {
  constexpr double undecided = std::numeric_limits<double>::quiet_NaN();
  if constexpr (Degree == 0) {
    return undecided;
  } else if constexpr (Degree == 1) {
    return upper.position.c[1] >= lower.position.c[1] ? never : undecided;
  } else {
    if (!at_most_quadratic()) return undecided;
    if (lower.position.c[2] != upper.position.c[2]) return quick_parabola_failure_time<true>(now, horizon);
    const double low_rate = lower.position.c[1];
    const double high_rate = upper.position.c[1];
    if (lower.start == upper.start) return high_rate >= low_rate ? never : undecided;
    const double run = 2 * lower.position.c[2] * (lower.start - upper.start);
    const double size = (std::abs(low_rate) + std::abs(high_rate)) + std::abs(run);
    return (high_rate - low_rate) + run > 0x1p-50 * size + 0x1p-1000 ? never : undecided;
  }
}

/// First the signs at now and at the horizon, in doubles: where these decide, no line has to be moved to the start of
/// the other. The rest nearly always falls through zero within the horizon: first_double_after_line() says when.
///
/// Error bound, with u = 2^-53. A run c1 (now - start) goes through two roundings, then the sum and the difference of
/// the two positions through one each: 4.1 u of all magnitudes. Charged are 8 u, which leaves room for the rounding of
/// `surely` and of the sum of the magnitudes. Underflow is negligible against a gap of 2^-1000; an overflow leaves an
/// infinity or a NaN, which fails the tests. `fall` is a difference of doubles, so its sign is exact; it, its product
/// and the time left are rounded by u each, for which the last factor is more than enough.
template <int Degree>
double Order<Degree>::quick_straight_failure_time(double now, double horizon) const requires(Degree == 1) {
  constexpr double undecided = std::numeric_limits<double>::quiet_NaN();
  const auto& [low, low_rate] = lower.position.c;
  const auto& [high, high_rate] = upper.position.c;
  const double fall = low_rate - high_rate;
  const double low_run = low_rate * (now - lower.start);
  const double high_run = high_rate * (now - upper.start);
  const double gap = (high + high_run) - (low + low_run);
  const double size = (std::abs(low) + std::abs(low_run)) + (std::abs(high) + std::abs(high_run));
  const double margin = 0x1p-50 * size + 0x1p-1000;
  const double surely = gap - margin;
  if (!(surely > 0)) return -gap > margin ? now : undecided;
  if (fall <= 0 || surely > fall * (horizon - now) * (1 + 0x1p-50)) return never;
  const double t = lower.start == upper.start
                       ? kds::detail::first_double_after_line(detail::line_between(lower, upper))
                       : kds::detail::first_double_after_line(detail::shifted_line_between(lower, upper));
  return t > horizon ? never : t;
}

}  // namespace kds::certificates

namespace kds {

KDS_COMPILED_ONCE(extern template, certificates::Order<1>);
KDS_COMPILED_ONCE(extern template, certificates::Order<2>);
KDS_COMPILED_ONCE(extern template, certificates::Order<3>);

}  // namespace kds
