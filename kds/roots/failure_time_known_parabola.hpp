// Rung 1: the failure time of a parabola whose coefficients are known.
#pragma once

#include "kds/arithmetic/double_double.hpp"
#include "kds/arithmetic/lattice.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace kds {

/// g + r x + a x^2 with x = t - epoch, each coefficient the sum of two doubles, high + low. a is exact, with |a.low| <=
/// 2^-53 |a.high|; so are g and r, unless the parabola has been `shifted` from another epoch.
template <bool shifted>
struct KnownParabola {
  DoubleDouble g;
  DoubleDouble r;
  DoubleDouble a;
  double g_spread;  ///< if shifted: bound on |g.low| + 2^48 times the error of g
  double r_spread;  ///< the same for r
  double epoch;
};

/// What failure_time() gives for g + r x + a x^2, a != 0, bit for bit, or a NaN where this needs the general methods.
/// If `turned`, the value is known to be positive just after now: failure_time_after_turn() is meant.
///
/// A parabola falls through zero once at most: if it is positive now, that crossing is its failure, if it is still
/// ahead. Signs at now and at the horizon decide whether it is; the quadratic formula says where, and one value there,
/// its large parts computed exactly, places the root among the doubles. (It is inlined: a parabola passed on in memory
/// costs a fifth more.) Parabolas that nearly touch zero, or are negative so briefly that perhaps no double sees it,
/// are left to the general method.
template <bool turned, bool shifted>
double quick_parabola_failure_time(const KnownParabola<shifted>& p, double now, double horizon);

// ---------------------------------------------------------------------------------------------------------------

namespace detail {

/// The first `bits` significant bits of a number, 1 <= bits <= 53. The rest is below 2^(1 - bits) of it. Products of
/// numbers of 53 bits together are exact while nothing underflows.
template <int bits>
double leading_bits(double x) {
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) & ~((std::uint64_t{1} << (53 - bits)) - 1));
}

/// Half the distance to the next double of larger size; nonsense for the very small.
inline double half_spacing(double t) {
  constexpr std::uint64_t exponent = 0x7ff0000000000000;
  return std::bit_cast<double>((std::bit_cast<std::uint64_t>(t) & exponent) - (std::uint64_t{53} << 52));
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

/// p(h). Error bound, with u = 2^-53: g.high is off by u |g| or its spread, h by u |h|, a by u |a|. So a h is off by
/// 3 u, and at the end |g| has taken part in two roundings, |r h| in five and |a h^2| in seven: 8 u of their sum, and
/// the spreads; doubled, for the roundings of the bound.
template <bool shifted>
Estimate value_at(const KnownParabola<shifted>& p, double h) {
  const double b = p.a.high * h;
  const double size = std::abs(p.g.high) + std::abs(h) * (std::abs(p.r.high) + std::abs(b));
  double error = 0x1p-49 * size + underflow;
  if constexpr (shifted) error += 2 * (p.g_spread + std::abs(h) * p.r_spread);
  return {p.g.high + h * (p.r.high + b), error};
}

/// p'(h). Likewise: 3 u of |a h|, twice; u |r| or the spread; and the two sums: 5 u.
template <bool shifted>
Estimate slope_at(const KnownParabola<shifted>& p, double h) {
  const double b = p.a.high * h;
  double error = 0x1p-49 * (std::abs(p.r.high) + std::abs(b)) + underflow;
  if constexpr (shifted) error += 2 * p.r_spread;
  return {(p.r.high + b) + b, error};
}

/// r^2 - 4 a g. The roundings are 4 u of the sum of the magnitudes; doubled, with what the spreads do.
template <bool shifted>
Estimate discriminant_of(const KnownParabola<shifted>& p) {
  const double square = p.r.high * p.r.high;
  const double product = 4 * (p.a.high * p.g.high);
  double error = 0x1p-50 * (square + std::abs(product)) + underflow;
  if constexpr (shifted) {
    error += 2 * ((2 * std::abs(p.r.high) + p.r_spread) * p.r_spread + 4 * std::abs(p.a.high) * p.g_spread);
  }
  return {square - product, error};
}

/// Where p falls through zero, roughly.
struct FallingRoot {
  double x;
  double steepness;  ///< the square root of the discriminant: p' is -steepness at the root
  bool certain;      ///< whether it exists, and the steepness is known to 2^-32 of itself
};

template <bool shifted>
FallingRoot falling_root(const KnownParabola<shifted>& p, const Estimate& discriminant) {
  const double half = 0.5 / p.a.high;  // independent of the square root, so computed beside it
  const double q = std::sqrt(discriminant.value);
  const double sum = p.r.high + q;
  // (-r - q) / (2 a) loses digits by cancellation if r < 0, which the step below corrects; 2 g / (q - r) is the same
  // root without.
  const double x = std::abs(sum) > 0x1p-20 * q ? -sum * half : 2 * p.g.high / (q - p.r.high);
  return {x, q, discriminant.value > 0x1p32 * discriminant.error};
}

/// The first double not before the root of p, or a NaN where that cannot be told.
///
/// Let q be the steepness and x + d the root. Where p falls at x, which is demanded below, p(x) = v gives
/// d = 2 v / (q + sqrt(q^2 + 4 a v)). If |a d| <= 2^-36 q that is v / q up to 2^-36 of itself. So d is known to 2^-31
/// of itself, and to E / q if v is known to E.
///
/// E: let x = c + e, c being its first 17 bits; r = r_c + r_e with 36 bits in r_c; a = a_c + a_e with 19 bits in a_c.
///     v = [g + r_c c] + a_c c^2 + (r_e c + a_e c^2 + e (r + a (c + x)) + low parts).
/// The products up to a_c c^2 are exact, and so is the sum in brackets, in two doubles. With m = |x| (|r| + |a x|) what
/// is in parentheses is below m times 2^-35, 2^-18, 2^-15; its roundings, six at r_e c and a_e c^2, seven at the third,
/// are below 2^-65 m. The high part of the bracket and a_c c^2 make a number that is below all this and |v|, rounded
/// three times: 2^-51 |v| + 2^-67 m. That is E = 2^-64.5 m. If shifted, the low parts are off by 2^-48 of the spreads
/// when given, and by another 2^-50 in here.
template <bool shifted>
[[gnu::always_inline]] inline double first_double_after(const KnownParabola<shifted>& p, const FallingRoot& root) {
  const double g = p.g.high;
  const double r = p.r.high;
  const double a = p.a.high;
  const auto [x, q, certain] = root;
  const double inverse = 1 / q;

  const double c = leading_bits<17>(x);
  const double r_c = leading_bits<36>(r);
  const double a_c = leading_bits<19>(a);
  const double square = c * c;
  const double slope = r + a * (c + x);
  const DoubleDouble first = two_sum(g, r_c * c);
  const double rest = ((r - r_c) * c + (a - a_c) * square) + (p.g.low + x * (p.r.low + p.a.low * x)) + (x - c) * slope;
  const double v = ((first.high + a_c * square) + rest) + first.low;
  const double d = v * inverse;

  // The root is place + low. Half a spacing more, rounded to the nearest double, is the first double not before it.
  const DoubleDouble place = two_sum(p.epoch, x);
  const double low = place.low + d;
  const double t = place.high + (d + (place.low + half_spacing(place.high)));
  // Up to rounding; here it is checked. The double before t is t minus one spacing: not minus half of one (then this
  // would be t, and nothing decided), and not 3/2. Differences of neighbours are exact.
  const double before = t - 0x1.0000000000001p-53 * std::abs(t);
  const double margin = std::min((t - place.high) - low, low - (before - place.high));

  const double size = std::abs(r) + std::abs(a * x);
  double value_error = 0x1p-64 * std::abs(x) * size;
  if constexpr (shifted) value_error += 0x1p-46 * (p.g_spread + std::abs(x) * p.r_spread);
  const double error = value_error * inverse + 0x1p-30 * std::abs(d) + 0x1p-98 * std::abs(place.high);
  // p falls at x: its slope there is the one computed, between c and x, up to 2^-16 of a x and a few u: q / 8 in all.
  const bool falls = -2 * slope >= q;
  const bool near = std::max(0x1p-12 * size, 0x1p36 * std::abs(a * d)) <= q;
  // Roots are q / |a| apart: if p rises again, then at least a spacing after t. Else t might be beyond a dip that no
  // double sees.
  const bool falls_long = 0x1p-50 * std::abs(a * place.high) <= q;
  // Then c^2 is exact, and other products lose nothing that counts by underflow: |x| size is above 2^-200 q / 4.
  const bool in_range = std::abs(x) > 0x1p-200;
  const bool told = falls & near & falls_long & in_range & certain & (margin > error);
  return told ? t : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace detail

template <bool turned, bool shifted>
[[gnu::always_inline]] inline double quick_parabola_failure_time(const KnownParabola<shifted>& p, double now,
                                                                 double horizon) {
  constexpr double undecided = std::numeric_limits<double>::quiet_NaN();
  const double elapsed = now - p.epoch;
  if (!(std::abs(elapsed) < 0x1p200)) return undecided;
  const bool convex = p.a.high > 0;
  const detail::Estimate slope = detail::slope_at(p, elapsed);
  const detail::Estimate discriminant = detail::discriminant_of(p);
  if constexpr (turned) {
    if (convex) return slope.positive() ? never : undecided;
  } else {
    const detail::Estimate value = detail::value_at(p, elapsed);
    if (!value.positive()) return value.negative() ? now : undecided;
    // Positive, and convex: it never fails if it rises or has no root. This is one comparison, since processors cannot
    // predict which certificates fail. A NaN is the first argument of max and min, so that the result is a NaN.
    const double rise = slope.value - slope.error;
    const double depth = -discriminant.value - discriminant.error;
    if (std::min(std::max(rise, depth), p.a.high) > 0) return never;
    if (!(std::min(slope.value + slope.error, p.a.high) < 0)) return undecided;  // convex, and slope not certain
  }
  if (horizon < never) {
    // Positive throughout if positive at the horizon and concave or still falling there.
    const double remaining = horizon - p.epoch;
    const bool positive = detail::value_at(p, remaining).positive();
    const bool falling = detail::slope_at(p, remaining).negative();
    if ((remaining < 0x1p200) & positive & (!convex | falling)) return never;
  }
  const double t = detail::first_double_after(p, detail::falling_root(p, discriminant));
  return t > horizon ? never : t;
}

}  // namespace kds
