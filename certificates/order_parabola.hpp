// When two values whose difference is a parabola change places: the quick answer.
#pragma once

#include "kds/double_double.hpp"
#include "kds/failure_time_lattice.hpp"
#include "kds/motion.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace kds::certificates::detail {

/// upper - lower as g + r x + a x^2 with x = t - epoch. Each coefficient is the sum of two doubles, high + low, of
/// which the low one need not be the smallest possible.
struct Parabola {
  DoubleDouble g;
  DoubleDouble r;
  DoubleDouble a;        ///< exact; |low| <= 2^-53 |high|
  double g_spread;       ///< bound on |g.low| + 2^48 times the error of g
  double r_spread;       ///< the same for r
  double epoch;
};

/// What failure_time() gives for g + r x + a x^2, bit for bit, or a NaN where it takes more care. If `turned`, the value
/// is known to be positive just after now (and failure_time_after_turn() is meant).
///
/// A parabola falls through zero once at most: where it is positive now, that is its failure, if it is still ahead.
/// Signs at now and at the horizon say whether; the quadratic formula says where, and one value there, in doubles with
/// exact products of halves, places the root among the doubles.
///
/// Cost: 20 ns, of which a square root and a division are half.
template <bool turned>
double quick_parabola_failure_time(const Parabola& p, double now, double horizon);

/// The difference of two motions with a common start.
template <int Degree>
Parabola parabola_between(const Motion<Degree>& lower, const Motion<Degree>& upper);

/// The difference of two motions, written about the later start.
template <int Degree>
Parabola shifted_parabola_between(const Motion<Degree>& lower, const Motion<Degree>& upper);

// ---------------------------------------------------------------------------------------------------------------

/// The number cut off after 26 significant bits. What is cut off has 27 and is below 2^-25 of it. Products of two such
/// numbers, or of one such and one that has been cut off, are exact while nothing underflows.
inline double leading_bits(double x) {
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) & ~((std::uint64_t{1} << 27) - 1));
}

template <int Degree>
Parabola parabola_between(const Motion<Degree>& lower, const Motion<Degree>& upper) {
  Parabola p;
  p.g = two_sum(upper.position.c[0], -lower.position.c[0]);
  p.r = two_sum(upper.position.c[1], -lower.position.c[1]);
  p.a = two_sum(upper.position.c[2], -lower.position.c[2]);
  p.g_spread = 0x1p-53 * std::abs(p.g.high);
  p.r_spread = 0x1p-53 * std::abs(p.r.high);
  p.epoch = lower.start;
  return p;
}

/// Spread, with u = 2^-53 and m the sum of the magnitudes of all that is added up, which is |g_late| + |g_early| +
/// |h| (|r| + |b|) for g and |r_late| + |r_early| + 2 |b| for r. Their low parts, in units of u, are
///     b: 2 |b|      mean: |r| + 3 |b|      way: 5 |h| (|r| + |b|)      and so g: 7 m, r: 4 m,
/// as every high part is rounded once, the sums and products of two doubles are exact, and h.low is u |h| at most. The
/// errors of the low parts, in units of u^2, are their own roundings and what they leave out (low times low):
///     b: 3 |b|      mean: 6 (|r| + |b|)    way: 22 |h| (|r| + |b|)     and so g: 35 m, r: 10 m.
/// 2^48 35 u^2 is 1.1 u: in all less than 16 u m = 2^-49 m. Products that underflow may cost 2^-1070, and h times that,
/// which falling_root() and value_at() can bear if |h| < 2^200.
template <int Degree>
Parabola shifted_parabola_between(const Motion<Degree>& lower, const Motion<Degree>& upper) {
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
  Parabola p;
  p.g = {sign * gap.high, sign * (gap.low - (place.low + way.low))};
  p.r = {sign * drift.high, sign * (drift.low - (rate.low + 2 * b.low))};
  p.a = {sign * bend.high, sign * bend.low};
  p.g_spread = unit * (std::abs(late.position.c[0]) + std::abs(g) +
                       std::abs(h.high) * (std::abs(r) + std::abs(b.high)));
  p.r_spread = unit * (std::abs(late.position.c[1]) + std::abs(r) + 2 * std::abs(b.high));
  p.epoch = late.start;
  return p;
}

/// A number and a bound on its error.
struct Estimate {
  double value;
  double error;

  bool positive() const { return value > error; }
  bool negative() const { return -value > error; }
};

/// Far below everything that is decided here, and far above what underflow can do to it.
inline constexpr double underflow = 0x1p-800;

/// Error bound, with u = 2^-53: the high part of g is off by its spread, h by u |h|, a by u |a|. So a h is off by 3 u,
/// and at the end |g| has taken part in one rounding, |r h| in four and |a h^2| in seven: 8 u of their sum, and the
/// spreads; doubled, for the roundings of the bound.
inline Estimate value_at(const Parabola& p, double h) {
  const double b = p.a.high * h;
  const double size = std::abs(p.g.high) + std::abs(h) * (std::abs(p.r.high) + std::abs(b));
  return {p.g.high + h * (p.r.high + b),
          0x1p-49 * size + 2 * (p.g_spread + std::abs(h) * p.r_spread) + underflow};
}

/// Likewise: 3 u of 2 |a h|, the spread of r, and one rounding of the sum.
inline Estimate slope_at(const Parabola& p, double h) {
  const double twice = 2 * p.a.high * h;
  return {p.r.high + twice, 0x1p-50 * (std::abs(p.r.high) + std::abs(twice)) + 2 * p.r_spread + underflow};
}

/// r^2 - 4 a g. The roundings are 3 u of the sum of the magnitudes; doubled, with what the spreads do.
inline Estimate discriminant_of(const Parabola& p) {
  const double square = p.r.high * p.r.high;
  const double product = 4 * p.a.high * p.g.high;
  return {square - product, 0x1p-50 * (square + std::abs(product)) +
                                2 * ((2 * std::abs(p.r.high) + p.r_spread) * p.r_spread +
                                     4 * std::abs(p.a.high) * p.g_spread) +
                                underflow};
}

/// The first double not before the root at which p falls, or a NaN where that is not certain to exist or too near a
/// double to tell.
///
/// With D known to 2^-16 of itself, its root q is known to 2^-16.9 and -q is the slope at the root meant, x + d. Where
/// p falls at x, which is demanded below, p(x) = v gives d = 2 v / (q + sqrt(q^2 + 4 a v)); if |a d| <= 2^-20 q that is
/// v / q up to 2^-20 of itself. So d is known to 2^-16 of itself, and to E / q if v is known to E.
///
/// E: let x = c + e, c its leading bits, and likewise r = r_c + r_e, a = a_c + a_e, c^2 = s_c + s_e (which is exact).
///     v = g + (r_c c + a_c s_c) + [r_e c + a s_e + a_e s_c + e (r + a (c + x))] + low parts.
/// The products in parentheses are exact, and so is their sum, in two doubles. With m = |x| (|r| + |a x|) all that is
/// in brackets is below 2^-25 m (2 + 2), and |g + (...)| below that and |v|. So their at most seven roundings each make
/// 2^-52 |v| + 2^-73 m. The low parts are off by 2^-48 of the spreads when given, and another 2^-50 in here.
inline double falling_root(const Parabola& p, const Estimate& discriminant) {
  const double g = p.g.high;
  const double r = p.r.high;
  const double a = p.a.high;
  const double q = std::sqrt(discriminant.value);
  const double inverse = 1 / q;
  // (-r - q) / (2 a) = 2 g / (q - r): the one without cancellation.
  const double sum = std::abs(r) + q;
  const bool rises_first = r > 0;
  const double x = (rises_first ? -sum : 2 * g) / (rises_first ? 2 * a : sum);

  const double c = leading_bits(x);
  const double e = x - c;
  const double square = c * c;
  const double square_c = leading_bits(square);
  const double r_c = leading_bits(r);
  const double a_c = leading_bits(a);
  const double slope = r + a * (c + x);
  const DoubleDouble first = two_sum(r_c * c, a_c * square_c);
  const double second = ((r - r_c) * c + a * (square - square_c)) + ((a - a_c) * square_c + e * slope);
  const double low = p.g.low + x * (p.r.low + p.a.low * x);
  const double v = (g + first.high) + ((first.low + low) + second);
  const double d = v * inverse;

  const DoubleDouble place = two_sum(p.epoch, x);
  const DoubleDouble time = fast_two_sum(place.high, place.low + d);
  const double size = std::abs(r) + std::abs(a * x);
  const double error = (0x1p-72 * std::abs(x) * size + 0x1p-46 * (p.g_spread + std::abs(x) * p.r_spread)) * inverse +
                       0x1p-16 * std::abs(d) + 0x1p-98 * std::abs(place.high);
  // p falls at x: there its slope is that computed, which belongs to the middle of c and x, but for a few u of r and
  // a x and 2^-25 of a x, together less than q / 8.
  const bool falls = (-2 * slope >= q) & (size * 0x1p-20 <= q);
  const bool near = std::abs(a * d) * 0x1p20 <= q;
  // Within these limits c^2 is exact and other products lose nothing that counts by underflow.
  const bool in_range = (std::abs(x) * size > 0x1p-600) & (std::abs(x) > 0x1p-200) & (std::abs(x) < 0x1p200);
  const bool certain = (discriminant.value > 0x1p16 * discriminant.error) & falls & near & in_range &
                       (std::abs(place.high) >= std::abs(place.low + d)) & (std::abs(time.low) > error);
  if (!certain) return std::numeric_limits<double>::quiet_NaN();
  // next_up() where the low part is positive, without a branch: it would be mispredicted half the time.
  const std::int64_t up = time.low > 0;
  return std::bit_cast<double>(std::bit_cast<std::int64_t>(time.high) + (time.high < 0 ? -up : up));
}

template <bool turned>
double quick_parabola_failure_time(const Parabola& p, double now, double horizon) {
  constexpr double undecided = std::numeric_limits<double>::quiet_NaN();
  const double elapsed = now - p.epoch;
  const double remaining = horizon - p.epoch;
  if (!(std::abs(elapsed) < 0x1p200)) return undecided;
  if constexpr (!turned) {
    const Estimate value = value_at(p, elapsed);
    if (!value.positive()) return value.negative() ? now : undecided;
  }
  // Positive just after now. It fails nowhere if it is convex and rises, or has no roots, and not before the horizon if
  // it is positive there and concave or still falling.
  const bool convex = p.a.high > 0;
  const Estimate discriminant = discriminant_of(p);
  const Estimate slope = slope_at(p, elapsed);
  const bool rises = slope.positive();
  const bool no_root = discriminant.negative();
  const bool positive_then = value_at(p, remaining).positive();
  const bool falls_then = slope_at(p, remaining).negative();
  const bool later = (remaining < 0x1p200) & positive_then & (!convex | falls_then);
  // One branch for all, since which certificates fail is what processors cannot foresee.
  if ((convex & (rises | no_root)) | later) return never;
  if (convex & !slope.negative()) return undecided;
  const double t = falling_root(p, discriminant);
  return t > horizon ? never : t;
}

}  // namespace kds::certificates::detail
