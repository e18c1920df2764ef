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

  /// What failure_time() gives, bit for bit, or a NaN where it takes more care. It knows motions with a common start
  /// and common accelerations: those of bodies that have not met yet, or share a gravity.
  double quick_failure_time(double now, double horizon) const
    requires(Degree >= 1);
};

template <int Degree>
double Order<Degree>::quick_failure_time(double now, double horizon) const
  requires(Degree >= 1)
{
  constexpr double undecided = std::numeric_limits<double>::quiet_NaN();
  if (lower.start != upper.start) return undecided;
  for (std::size_t i = 2; i <= Degree; ++i) {
    if (lower.position.c[i] != upper.position.c[i]) return undecided;
  }
  const double start = upper.start;
  const DoubleDouble gap = two_sum(upper.position.c[0], -lower.position.c[0]);   // exact
  const DoubleDouble rate = two_sum(upper.position.c[1], -lower.position.c[1]);  // exact
  if (rate.high == 0) return gap.high < 0 ? now : never;
  // The root, from the start on, within 4 roundings; so it certainly lies on one side of now, or is not decided here.
  const double root = gap.high / -rate.high;
  const double elapsed = now - start;
  const double side = root - elapsed;
  const double margin = 0x1p-49 * (std::abs(root) + std::abs(elapsed));
  if (!(std::abs(side) > margin)) return undecided;
  const bool ahead = side > 0;
  if (rate.high > 0) return ahead ? now : never;
  if (!ahead) return now;
  const double remaining = horizon - start;
  if (root - remaining > 0x1p-49 * (root + std::abs(remaining))) return never;

  // One step of division in double-double. The residual's terms are roundings of the gap, added with four more
  // roundings: its error is below 2^-100 |gap|, that of the sum with the start below 2^-100 of the result. Gaps so
  // small that parts of the product could underflow, and quotients that overflow, are left to the general method.
  if (!(std::abs(gap.high) > 0x1p-900 && root < 0x1p900)) return undecided;
  const DoubleDouble product = two_product(root, rate.high);
  const double residual = (gap.high + product.high + product.low) + (gap.low + root * rate.low);
  const DoubleDouble rough = two_sum(start, root);
  const DoubleDouble time = two_sum(rough.high, rough.low + residual / -rate.high);
  const double error = 0x1p-100 * (std::abs(time.high) + root);
  if (!(std::abs(time.low) > error)) return undecided;
  const double t = time.low > 0 ? next_up(time.high) : time.high;
  return t <= horizon ? t : never;
}

}  // namespace kds::certificates
