// Rung 1: the failure time of a line whose coefficients are known.
#pragma once

#include "kds/roots/failure_time_known_parabola.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kds {

/// What failure_time() gives for g + r x, the parabola p with a = 0, bit for bit, or a NaN where this needs the general
/// methods.
template <bool shifted>
double quick_line_failure_time(const KnownParabola<shifted>& p, double now, double horizon);

// ---------------------------------------------------------------------------------------------------------------

namespace detail {

/// Whether the line is certainly zero at t; false where doubles do not decide. Precondition: t is its root up to
/// rounding, and g and r are in the range below.
inline bool is_root(const KnownParabola<false>& p, double t) {
  const DoubleDouble h = two_sum(t, -p.epoch);
  const DoubleDouble run = two_product(p.r.high, h.high);
  return h.low == 0 && p.r.low == 0 && run.high == -p.g.high && run.low == -p.g.low;
}

/// The first double not before the root of the line p, r < 0, or a NaN where that cannot be told.
///
/// x = -g / r in doubles; c is its first 26 bits, and r = r_c + r_e with 26 bits in r_c. Then g + r_c c and r_e c are
/// exact, the first by [Sterbenz], and below 2^-23 g together. One step of Newton's method, with v = f(start),
/// d = -v / r, gives the root as start + d. Error bound, with u = 2^-53:
/// - not shifted: start = c. The sums are off by 2^-75 |g|. |d| is below 2^-23 |x|, and known to 3 u of itself. In all
///   less than 2^-73 |x|.
/// - shifted: start = x, for r may be known so roughly that a longer step would not be exact enough: d is off by
///   |r_spread / r| of itself. v has one more part, (x - c) r, off by 2^-78 |g|; and the low parts are off by 2^-48 of
///   the spreads when given, and by another 2^-50 in here. The sum of the low parts of start and time is off by 2^-98
///   of the time, and more than that is charged for d.
template <bool shifted>
[[gnu::always_inline]] inline double first_double_after_line(const KnownParabola<shifted>& p) {
  const double g = p.g.high;
  const double r = p.r.high;
  const double inverse = 1 / r;
  const double x = -g * inverse;
  const double c = leading_bits<26>(x);
  const double r_c = leading_bits<26>(r);
  const double low_parts = p.g.low + c * p.r.low;
  double v = ((g + c * r_c) + c * (r - r_c)) + low_parts;
  if constexpr (shifted) v += (x - c) * (r + p.r.low);
  const double d = -v * inverse;

  // As in first_double_after(): half a spacing more, rounded to the nearest double, and the proof that it is the one.
  const DoubleDouble place = two_sum(p.epoch, shifted ? x : c);
  const double low = place.low + d;
  const double t = place.high + (d + (place.low + half_spacing(place.high)));
  const double before = t - 0x1.0000000000001p-53 * std::abs(t);
  const double margin = std::min((t - place.high) - low, low - (before - place.high));

  double error = 0x1p-72 * std::abs(x) + 0x1p-98 * std::abs(place.high);
  bool known = true;
  if constexpr (shifted) {
    const double rate_error = -p.r_spread * inverse;
    error += 2 * std::abs(d) * rate_error - 0x1p-46 * inverse * (p.g_spread + std::abs(x) * p.r_spread);
    known = rate_error < 0x1p-10;
  }
  // Nothing over- or underflows then.
  const double least = std::min(std::abs(g), -r);
  const double greatest = std::max(std::abs(g), -r);
  const bool told = known & (least > 0x1p-450) & (greatest < 0x1p450);
  if (told & (margin > error)) return t;
  if constexpr (!shifted) {  // times on a grid: the root is a double itself
    if (told && is_root(p, place.high + low)) return place.high + low;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace detail

template <bool shifted>
[[gnu::always_inline]] inline double quick_line_failure_time(const KnownParabola<shifted>& p, double now,
                                                             double horizon) {
  constexpr double undecided = std::numeric_limits<double>::quiet_NaN();
  const double elapsed = now - p.epoch;
  if (!(std::abs(elapsed) < 0x1p200)) return undecided;
  const detail::Estimate value = detail::value_at(p, elapsed);
  if (!value.positive()) return value.negative() ? now : undecided;
  const double r = p.r.high;  // has the sign of r where nothing is shifted
  if constexpr (shifted) {
    if (!(std::abs(r) > 2 * p.r_spread || (r == 0 && p.r_spread == 0))) return undecided;
  }
  if (r >= 0) return never;
  const double remaining = horizon - p.epoch;
  if (remaining < 0x1p200 && detail::value_at(p, remaining).positive()) return never;
  const double t = detail::first_double_after_line(p);
  return t > horizon ? never : t;
}

}  // namespace kds
