// Two values in order.
#pragma once

#include "certificates/order_parabola.hpp"
#include "kds/certificate.hpp"
#include "kds/failure_time.hpp"
#include "kds/motion.hpp"

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

  /// What failure_time() gives, bit for bit, or a NaN where it takes more care. It knows pairs that differ by a line
  /// (straight motions, and those that share their accelerations) or a parabola.
  double quick_failure_time(double now, double horizon) const
    requires(Degree >= 1);

  /// The same for failure_time_after_turn().
  double quick_failure_time_after_turn(double now, double horizon) const
    requires(Degree >= 2);

 private:
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
  double inverse = 1 / rate;
  double root = -gap * inverse;  // from the epoch on
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

  // One step of division with an exact residual. `coarse` is the root to 26 bits, and the rate's high part is split
  // into 26 and 27, so both products are exact; the first nearly cancels the gap, so that difference is exact as well
  // [Sterbenz] and below 2^-24 of the gap. What is rounded are sums and a quotient of that size or less: the error
  // of coarse + correction is below 2^-72 of the root.
  const Line<DoubleDouble> fine = line<DoubleDouble>();
  const DoubleDouble& g = fine.gap.middle;
  const DoubleDouble& r = fine.rate.middle;
  if (!(std::abs(g.high) > 0x1p-450)) return undecided;
  if (lower.start != upper.start) {  // Else it is the same number.
    inverse = 1 / r.high;
    root = -g.high * inverse;
  }
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
  const std::int64_t up = time.low > 0;
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

}  // namespace kds::certificates
