// Two values in order.
#pragma once

#include "kds/certificate.hpp"
#include "kds/failure_time.hpp"
#include "kds/motion.hpp"

#include <cmath>
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

  /// What failure_time() gives, bit for bit, or a NaN where it takes more care. It knows pairs that differ by a line:
  /// straight motions, and those that share their accelerations.
  double quick_failure_time(double now, double horizon) const
    requires(Degree >= 1);

 private:
  /// The difference of two motions: gap + rate (t - epoch), with bounds on the errors of both.
  template <class T>
  struct Line {
    Ball<T> gap;
    Ball<T> rate;
    double epoch;
  };

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
  for (std::size_t i = 2; i <= Degree; ++i) {
    if (lower.position.c[i] != upper.position.c[i]) return undecided;
    if (i > 2 && lower.position.c[i] != 0 && lower.start != upper.start) return undecided;  // differ by a parabola
  }
  // In doubles: on which side of now, and of the horizon, is the root? Where that is certain it needs no better.
  const Line<double> rough = line<double>();
  const double gap = rough.gap.middle;
  const double rate = rough.rate.middle;
  if (rate == 0 && rough.rate.radius == 0) {
    const int s = certain_sign(rough.gap);
    return s > 0 ? never : (s < 0 ? now : undecided);
  }
  const double inverse = 1 / rate;
  const double root = -gap * inverse;  // from the epoch on
  const double elapsed = now - rough.epoch;
  // Roundings of the quotient (three) and of the elapsed time; twice the errors of gap and rate, which bounds their
  // effect where the rate is known to half of itself and makes the margin too large to decide where it is not.
  const double margin = 0x1p-49 * (std::abs(root) + std::abs(elapsed)) +
                        2 * (rough.gap.radius + std::abs(root) * rough.rate.radius) * std::abs(inverse);
  const double side = root - elapsed;
  if (!(std::abs(side) > margin && std::abs(rate) > 2 * rough.rate.radius)) return undecided;
  const bool ahead = side > 0;
  if (rate > 0) return ahead ? now : never;
  if (!ahead) return now;
  const double remaining = horizon - rough.epoch;
  if (root - remaining > margin + 0x1p-49 * std::abs(remaining)) return never;

  // In double-doubles: a step of division from the rough quotient. The residual is a sum of roundings of the gap and
  // of its own error: the quotient's error is below 2^-100 of it, and so is that of the sum with the epoch. Gaps so
  // small that parts of the product could underflow, and quotients that overflow, are left to the general method.
  const Line<DoubleDouble> fine = line<DoubleDouble>();
  const DoubleDouble& g = fine.gap.middle;
  const DoubleDouble& r = fine.rate.middle;
  if (!(std::abs(g.high) > 0x1p-900 && root < 0x1p900)) return undecided;
  const DoubleDouble product = two_product(root, r.high);
  const double residual = (two_sum(g.high, product.high).high + two_sum(g.high, product.high).low + product.low) +
                          (g.low + root * r.low);
  const DoubleDouble sum = two_sum(fine.epoch, root);
  const DoubleDouble time = two_sum(sum.high, sum.low - residual / r.high);
  const double error = 0x1p-98 * (std::abs(time.high) + std::abs(root)) +
                       0x1p-48 * std::abs(residual * inverse) +
                       2 * (fine.gap.radius + std::abs(root) * fine.rate.radius) * std::abs(inverse);
  if (!(std::abs(time.low) > error)) return undecided;
  const double t = time.low > 0 ? next_up(time.high) : time.high;
  return t <= horizon ? t : never;
}

}  // namespace kds::certificates
