// Two values in order.
#pragma once

#include "certificates/order_parabola.hpp"
#include "kds/arithmetic/unrolled.hpp"
#include "kds/certificate.hpp"
#include "kds/motion.hpp"
#include "kds/roots/failure_time.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace kds::certificates {

/// lower(t) <= upper(t).
template <int Degree>
struct Order {
  static constexpr int degree = Degree;
  const Motion<Degree>& lower;
  const Motion<Degree>& upper;

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

  struct RoughValue {
    double value;
    double margin;
  };

  /// x(t) in doubles: two values whose difference exceeds the sum of their margins are in the order that they seem to
  /// be.
  ///
  /// Error bound: each term goes through at most 3 n + 1 roundings (the time since the start counts n times, Horner's
  /// rule 2 n, a difference of two values once), n the degree; 32 are charged, of the sum of all terms' magnitudes.
  /// Underflow is nothing to 2^-1000, and an overflow fails every comparison.
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

  /// What failure_time() gives, bit for bit, or a NaN where it takes more care. It knows pairs that differ by a line
  /// (straight motions, and those that share their accelerations) or a parabola.
  double quick_failure_time(double now, double horizon) const
    requires(Degree >= 1);

  /// The same for failure_time_after_turn().
  double quick_failure_time_after_turn(double now, double horizon) const
    requires(Degree >= 2);

 private:
  /// What failure_time() gives for straight motions in order at now, or a NaN where it takes more care.
  double straight_failure_time(double now, double horizon) const
    requires(Degree == 1);

  /// The first double not before the root of the line that the difference is and that falls, if not beyond the horizon;
  /// a NaN where it takes more care.
  double first_past_root(double horizon) const
    requires(Degree >= 1);

  /// The difference of two motions: gap + rate (t - epoch), with bounds on the errors of both.
  template <class T>
  struct Line {
    Ball<T> gap;
    Ball<T> rate;
    double epoch;
  };

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

  /// The later of the starts is the epoch; the motion that started earlier is shifted to it. Differences of motions
  /// that start together are exact in double-double.
  template <class T>
  Line<T> line() const {
    const bool upper_later = upper.start >= lower.start;
    const Motion<Degree>& late = upper_later ? upper : lower;
    const Motion<Degree>& early = upper_later ? lower : upper;
    Line<T> line;
    line.epoch = late.start;
    if (late.start == early.start) {
      line.gap = difference<Ball<T>>(upper.position.c[0], lower.position.c[0]);
      line.rate = difference<Ball<T>>(upper.position.c[1], lower.position.c[1]);
    } else {
      const auto shifted = about<Ball<T>>(early, late.start);
      line.gap = shifted.c[0] - late.position.c[0];
      line.rate = shifted.c[1] - late.position.c[1];
      if (upper_later) line.gap = -line.gap, line.rate = -line.rate;
    }
    return line;
  }
};

template <int Degree>
double Order<Degree>::quick_failure_time(double now, double horizon) const
  requires(Degree >= 1)
{
  constexpr double undecided = std::numeric_limits<double>::quiet_NaN();
  if constexpr (Degree == 1) {
    const double t = straight_failure_time(now, horizon);
    if (!std::isnan(t)) return t;
  }
  if (!at_most_quadratic()) return undecided;
  if constexpr (Degree >= 2) {
    if (lower.position.c[2] != upper.position.c[2]) return quick_parabola_failure_time<false>(now, horizon);
  }
  const Line<double> rough = line<double>();
  const double gap = rough.gap.middle;
  const double rate = rough.rate.middle;
  if (rate == 0 && rough.rate.radius == 0) {
    const int s = certain_sign(rough.gap);
    return s > 0 ? never : (s < 0 ? now : undecided);
  }
  // The bounds below hold while nothing over- or underflows; other numbers are left to the general method.
  const double steepness = std::abs(rate);
  if (!(steepness > 0x1p-450 && steepness < 0x1p450 && std::abs(gap) < 0x1p450)) return undecided;

  // In doubles: on which side of now, and of the horizon, is the root? Where that is certain it needs no better.
  const double inverse = 1 / rate;
  const double root = -gap * inverse;  // from the epoch on
  const double elapsed = now - rough.epoch;
  // Roundings of the quotient (two), of gap and rate (one each) and of the elapsed time, 2^-53 each; twice the
  // errors of gap and rate, which bounds their effect where the rate is known to half of itself and makes the margin
  // too large to decide where it is not.
  const double margin = 0x1p-49 * (std::abs(root) + std::abs(elapsed)) +
                        2 * (rough.gap.radius + std::abs(root) * rough.rate.radius) * std::abs(inverse);
  const double side = root - elapsed;
  if (!(std::abs(side) > margin && steepness > 2 * rough.rate.radius)) return undecided;
  const bool ahead = side > 0;
  if (rate > 0) return ahead ? now : never;
  if (!ahead) return now;
  const double remaining = horizon - rough.epoch;
  if (root - remaining > margin + 0x1p-49 * std::abs(remaining)) return never;

  return first_past_root(horizon);
}

template <int Degree>
double Order<Degree>::first_past_root(double horizon) const
  requires(Degree >= 1)
{
  constexpr double undecided = std::numeric_limits<double>::quiet_NaN();
  // One step of division with an exact residual. `coarse` is the root to 26 bits, and the rate's high part is split
  // into 26 and 27, so both products are exact; the first nearly cancels the gap, so that difference is exact as well
  // [Sterbenz] and below 2^-24 of the gap. What is rounded are sums and a quotient of that size or less: the error
  // of coarse + correction is below 2^-72 of the root.
  const Line<DoubleDouble> fine = line<DoubleDouble>();
  const DoubleDouble& g = fine.gap.middle;
  const DoubleDouble& r = fine.rate.middle;
  const double gap = std::abs(g.high);
  const double steepness = std::abs(r.high);
  // The bounds hold while nothing over- or underflows.
  if (!(steepness > 0x1p-450 && steepness < 0x1p450 && gap > 0x1p-450 && gap < 0x1p450)) return undecided;
  const double inverse = 1 / r.high;
  const double root = -g.high * inverse;
  const double coarse = kds::detail::leading_bits<26>(root);
  const double rate_high = kds::detail::leading_bits<26>(r.high);
  const double residual =
      (g.high + coarse * rate_high) + coarse * (r.high - rate_high) + (g.low + coarse * r.low);
  const DoubleDouble sum = two_sum(fine.epoch, coarse);
  const DoubleDouble time = two_sum(sum.high, sum.low - residual * inverse);
  // 2^-98 pays for the sum of the two low parts.
  const double error = 0x1p-72 * std::abs(root) + 0x1p-98 * std::abs(time.high) +
                       2 * (fine.gap.radius + std::abs(root) * fine.rate.radius) * std::abs(inverse);
  if (!(std::abs(time.low) > error)) return undecided;
  // next_up() where the low part is positive, without a branch: it would be mispredicted half the time.
  // Its sign bit, for compilers make branches of comparisons; it is not zero.
  const auto up = static_cast<std::int64_t>(~std::bit_cast<std::uint64_t>(time.low) >> 63);
  const double t = std::bit_cast<double>(std::bit_cast<std::int64_t>(time.high) + (time.high < 0 ? -up : up));
  return t <= horizon ? t : never;
}

template <int Degree>
double Order<Degree>::quick_failure_time_after_turn(double now, double horizon) const
  requires(Degree >= 2)
{
  if (!at_most_quadratic()) return std::numeric_limits<double>::quiet_NaN();
  if (lower.position.c[2] == upper.position.c[2]) return never;  // a line that has risen through zero
  return quick_parabola_failure_time<true>(now, horizon);
}

/// Error bound, with u = 2^-53. A position is c0 + c1 (now - start): its run c1 (now - start) goes through two
/// roundings, then the sum and the difference of the two positions through one each, so the gap is known to 4.1 u size,
/// and `surely` is below it with room for its own rounding. Underflow is nothing to a gap of 2^-1000; an overflow
/// leaves an infinity or a NaN, which fails the test. `fall` is a difference of doubles, so its sign is exact; it, its
/// product and the time left are rounded by u each, for which the last factor is more than enough.
template <int Degree>
double Order<Degree>::straight_failure_time(double now, double horizon) const
  requires(Degree == 1)
{
  const double lower_run = lower.position.c[1] * (now - lower.start);
  const double upper_run = upper.position.c[1] * (now - upper.start);
  const double gap = (upper.position.c[0] + upper_run) - (lower.position.c[0] + lower_run);
  const double size = (std::abs(lower.position.c[0]) + std::abs(lower_run)) +
                      (std::abs(upper.position.c[0]) + std::abs(upper_run));
  const double surely = gap - 0x1p-50 * size;
  if (!(surely > 0x1p-1000)) return std::numeric_limits<double>::quiet_NaN();
  const double fall = lower.position.c[1] - upper.position.c[1];
  if (fall <= 0 || surely > fall * (horizon - now) * (1 + 0x1p-50)) return never;
  return first_past_root(horizon);
}

}  // namespace kds::certificates
