// The difference of two moving values as a line or parabola with its error bounds.
#pragma once

#include "kds/motion.hpp"
#include "kds/roots/failure_time_known_parabola.hpp"

#include <cmath>
#include <limits>

namespace kds::certificates::detail {

/// The difference of two motions with a common start, known to be a line.
template <int Degree>
KnownParabola<false> line_between(const Motion<Degree>& lower, const Motion<Degree>& upper);

/// The difference of two straight motions, written about the later start.
KnownParabola<true> shifted_line_between(const Motion<1>& lower, const Motion<1>& upper);

/// The difference of two motions with a common start.
template <int Degree>
KnownParabola<false> parabola_between(const Motion<Degree>& lower, const Motion<Degree>& upper);

/// The difference of two motions, written about the later start.
template <int Degree>
KnownParabola<true> shifted_parabola_between(const Motion<Degree>& lower, const Motion<Degree>& upper);

// ---------------------------------------------------------------------------------------------------------------

template <int Degree>
[[gnu::always_inline]] inline KnownParabola<false> line_between(const Motion<Degree>& lower,
                                                                const Motion<Degree>& upper) {
  KnownParabola<false> p;
  p.g = two_sum(upper.position.c[0], -lower.position.c[0]);
  p.r = two_sum(upper.position.c[1], -lower.position.c[1]);
  p.epoch = lower.start;
  return p;
}

/// Spread: as below, with a = 0. g has a low part of 7 m at most in units of u, and an error of 13 m in units of u^2,
/// where m = |g_late| + |g_early| + |h r|: in all less than 8 u m. The rate is exact.
[[gnu::always_inline]] inline KnownParabola<true> shifted_line_between(const Motion<1>& lower, const Motion<1>& upper) {
  const bool upper_later = upper.start >= lower.start;
  const auto& late = upper_later ? upper : lower;
  const auto& early = upper_later ? lower : upper;
  const auto [g, r] = early.position.c;
  const DoubleDouble h = two_sum(late.start, -early.start);
  DoubleDouble way = two_product(r, h.high);
  way.low += r * h.low;
  const DoubleDouble place = two_sum(g, way.high);
  const double sign = upper_later ? 1.0 : -1.0;
  const DoubleDouble gap = two_sum(late.position.c[0], -place.high);
  const DoubleDouble drift = two_sum(late.position.c[1], -r);
  const double unit = std::abs(h.high) < 0x1p200 ? 0x1p-50 : std::numeric_limits<double>::infinity();
  KnownParabola<true> p;
  p.g = {sign * gap.high, sign * (gap.low - (place.low + way.low))};
  p.r = {sign * drift.high, sign * drift.low};
  p.g_spread = unit * (std::abs(late.position.c[0]) + std::abs(g) + std::abs(way.high));
  p.r_spread = 0;
  p.epoch = late.start;
  return p;
}

template <int Degree>
[[gnu::always_inline]] inline KnownParabola<false> parabola_between(const Motion<Degree>& lower,
                                                                    const Motion<Degree>& upper) {
  KnownParabola<false> p;
  p.g = two_sum(upper.position.c[0], -lower.position.c[0]);
  p.r = two_sum(upper.position.c[1], -lower.position.c[1]);
  p.a = two_sum(upper.position.c[2], -lower.position.c[2]);
  p.epoch = lower.start;
  return p;
}

/// Spread, with u = 2^-53 and m the sum of the magnitudes of all summands, which is |g_late| + |g_early| +
/// |h| (|r| + |b|) for g and |r_late| + |r_early| + 2 |b| for r. Their low parts, in units of u, are
///     b: 2 |b|      mean: |r| + 3 |b|      way: 5 |h| (|r| + |b|)      and so g: 7 m, r: 4 m,
/// as every high part is rounded once, the sums and products of two doubles are exact, and h.low is u |h| at most. The
/// errors of the low parts, in units of u^2, are their own roundings and what they leave out (low times low):
///     b: 3 |b|      mean: 6 (|r| + |b|)    way: 22 |h| (|r| + |b|)     and so g: 35 m, r: 10 m.
/// 2^48 35 u^2 is 1.1 u: in all less than 16 u m = 2^-49 m. Products that underflow may cost 2^-1070, and h times that,
/// which quick_parabola_failure_time() can bear if |h| < 2^200.
template <int Degree>
[[gnu::always_inline]] inline KnownParabola<true> shifted_parabola_between(const Motion<Degree>& lower,
                                                                           const Motion<Degree>& upper) {
  const bool upper_later = upper.start >= lower.start;
  const auto& late = upper_later ? upper : lower;
  const auto& early = upper_later ? lower : upper;
  const double g = early.position.c[0];
  const double r = early.position.c[1];
  const double a = early.position.c[2];
  const DoubleDouble h = two_sum(late.start, -early.start);
  // The early motion about the later start: a, r + 2 b, g + h (r + b).
  DoubleDouble b = two_product(a, h.high);
  b.low += a * h.low;
  const DoubleDouble rate = two_sum(r, 2 * b.high);
  DoubleDouble mean = two_sum(r, b.high);
  mean.low += b.low;
  DoubleDouble way = two_product(mean.high, h.high);
  way.low += mean.high * h.low + mean.low * h.high;
  const DoubleDouble place = two_sum(g, way.high);

  const double sign = upper_later ? 1.0 : -1.0;
  const DoubleDouble gap = two_sum(late.position.c[0], -place.high);
  const DoubleDouble drift = two_sum(late.position.c[1], -rate.high);
  const DoubleDouble bend = two_sum(late.position.c[2], -a);
  const double unit = std::abs(h.high) < 0x1p200 ? 0x1p-49 : std::numeric_limits<double>::infinity();
  KnownParabola<true> p;
  p.g = {sign * gap.high, sign * (gap.low - (place.low + way.low))};
  p.r = {sign * drift.high, sign * (drift.low - (rate.low + 2 * b.low))};
  p.a = {sign * bend.high, sign * bend.low};
  p.g_spread =
      unit * (std::abs(late.position.c[0]) + std::abs(g) + std::abs(h.high) * (std::abs(r) + std::abs(b.high)));
  p.r_spread = unit * (std::abs(late.position.c[1]) + std::abs(r) + 2 * std::abs(b.high));
  p.epoch = late.start;
  return p;
}

}  // namespace kds::certificates::detail
