// Sine and cosine in doubles and in double-doubles, with their error bounds.
#pragma once

#include "kds/arithmetic/ball.hpp"
#include "kds/arithmetic/double_double.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace kds {

/// The sine and the cosine of one angle, in a number type that knows its error.
template <class Number>
struct SineCosine {
  Number sine, cosine;
};

/// Greatest angle that sine_cosine() computes, rad: 10^12. Beyond it nothing is decided: the radii are infinite.
inline constexpr double greatest_angle = 0x1p40;

/// Sine and cosine of an angle in rad, given as a double-double within a radius. Number is Ball<double> or
/// Ball<DoubleDouble>. Made of + - * alone, each rounded as it is written: so the bits are the same on every system,
/// unlike those of the C library.
///
/// Errors, for |angle| <= greatest_angle, beside the radius of the angle itself (no derivative exceeds 1): at most
/// 2^-51 in doubles and 2^-99 in double-doubles; where the angle is below pi/4 that of the sine is relative to the
/// angle, so that small angles keep their bits. An angle that is known to be zero has the exact sine 0 and cosine 1.
///
/// Cost: about 25 ns in doubles, 160 ns in double-doubles. Where more is needed, or the angle is larger, there is
/// enclosed_sine_cosine().
template <class Number>
SineCosine<Number> sine_cosine(const Ball<DoubleDouble>& angle);

/// Sine and cosine of rate * time, rad; the product of two doubles is exact as a double-double.
template <class Number>
SineCosine<Number> sine_cosine(double rate, double time);

// ---------------------------------------------------------------------------------------------------------------

namespace detail {

/// angle = remainder + quadrant * pi / 2, up to `error`, which is 0 in the quadrant 0.
struct ReducedAngle {
  DoubleDouble remainder;  ///< below 0.786 in magnitude
  int quadrant;            ///< 0 ... 3
  double error;
};

inline constexpr double two_over_pi = 0x1.45f306dc9c883p-1;
inline constexpr std::array<double, 3> half_pi{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54, -0x1.f1976b7ed8fbcp-110};

/// The nearest whole number of right angles in an angle.
inline double right_angles(double angle) {
  constexpr double to_integer = 0x1.8p52;  // a sum with it has the unit 1
  return (angle * two_over_pi + to_integer) - to_integer;
}
inline int quadrant_of(double k) { return static_cast<int>(static_cast<std::int64_t>(k) & 3); }

/// Error bound. k = angle * 2 / pi is below 2^40 and known to 2^-12, so that rounding it to an integer leaves at most
/// pi / 4 + 2^-11 < 0.786. pi / 2 is p0 + p1 + p2 up to 2^-163, three doubles that fall by 2^-54 each. k p0 and k p1
/// are exact as two doubles each, and so is the sum of the two leading terms. The four sums of a double-double and a
/// double err by 2^-105 each, relative to partial results below 1 [Joldes17, DWPlusFP]; k p2 and its sum with a double
/// below 2^-66 are rounded by 2^-118; k times what is left out of pi / 2 is below 2^-123. In all less than 2^-102.
inline ReducedAngle reduced(const DoubleDouble& angle) {
  const double k = right_angles(angle.high);
  if (k == 0) return {angle, 0, 0};
  const DoubleDouble first = two_product(k, half_pi[0]);
  const DoubleDouble second = two_product(k, half_pi[1]);
  DoubleDouble rest = two_sum(angle.high, -first.high);
  rest = rest + angle.low;
  rest = rest - first.low;
  rest = rest - second.high;
  rest = rest - (second.low + k * half_pi[2]);
  return {rest, quadrant_of(k), 0x1p-102};
}

/// The same for doubles, of which the remainder has no more than one.
///
/// Error bound, with u = 2^-53: the first difference is exact, or below 0.79 and rounded once, where the two are not
/// within a factor of two; so are the next sum and the last one, and what they leave out is below 2^-64: 2.4 u.
inline ReducedAngle quickly_reduced(const DoubleDouble& angle) {
  const double k = right_angles(angle.high);
  if (k == 0) return {angle, 0, 0};
  const DoubleDouble first = two_product(k, half_pi[0]);
  const double rest = ((angle.high - first.high) - first.low) + (angle.low - k * half_pi[1]);
  return {rest, quadrant_of(k), 0x1p-51};
}

/// (-1)^m / (2 m + 1)! and (-1)^m / (2 m)!, m from 1: Taylor's series.
inline constexpr std::array<DoubleDouble, 13> sine_series{{
    {-0x1.5555555555555p-3, -0x1.5555555555555p-57},    // -1/3!
    {0x1.1111111111111p-7, 0x1.1111111111111p-63},      // 1/5!
    {-0x1.a01a01a01a01ap-13, -0x1.a01a01a01a01ap-73},   // -1/7!
    {0x1.71de3a556c734p-19, -0x1.c154f8ddc6c00p-73},    // 1/9!
    {-0x1.ae64567f544e4p-26, 0x1.c062e06d1f209p-80},    // -1/11!
    {0x1.6124613a86d09p-33, 0x1.f28e0cc748ebep-87},     // 1/13!
    {-0x1.ae7f3e733b81fp-41, -0x1.1d8656b0ee8cbp-97},   // -1/15!
    {0x1.952c77030ad4ap-49, 0x1.ac981465ddc6cp-103},    // 1/17!
    {-0x1.2f49b46814157p-57, -0x1.2650f61dbdcb4p-112},  // -1/19!
    {0x1.71b8ef6dcf572p-66, -0x1.d043ae40c4647p-120},   // 1/21!
    {-0x1.761b41316381ap-75, 0x1.3423c7d91404fp-130},   // -1/23!
    {0x1.3f3ccdd165fa9p-84, -0x1.58ddadf344487p-139},   // 1/25!
    {-0x1.d1ab1c2dccea3p-94, -0x1.054d0c78aea14p-149},  // -1/27!
}};
inline constexpr std::array<DoubleDouble, 13> cosine_series{{
    {-0x1p-1, 0.0},                                     // -1/2!
    {0x1.5555555555555p-5, 0x1.5555555555555p-59},      // 1/4!
    {-0x1.6c16c16c16c17p-10, 0x1.f49f49f49f49fp-65},    // -1/6!
    {0x1.a01a01a01a01ap-16, 0x1.a01a01a01a01ap-76},     // 1/8!
    {-0x1.27e4fb7789f5cp-22, -0x1.cbbc05b4fa99ap-76},   // -1/10!
    {0x1.1eed8eff8d898p-29, -0x1.2aec959e14c06p-83},    // 1/12!
    {-0x1.93974a8c07c9dp-37, -0x1.05d6f8a2efd1fp-92},   // -1/14!
    {0x1.ae7f3e733b81fp-45, 0x1.1d8656b0ee8cbp-101},    // 1/16!
    {-0x1.6827863b97d97p-53, -0x1.eec01221a8b0bp-107},  // -1/18!
    {0x1.e542ba4020225p-62, 0x1.ea72b4afe3c2fp-120},    // 1/20!
    {-0x1.0ce396db7f853p-70, 0x1.aebcdbd20331cp-124},   // -1/22!
    {0x1.f2cf01972f578p-80, -0x1.9ada5fcc1ab14p-135},   // 1/24!
    {-0x1.88e85fc6a4e5ap-89, 0x1.71c37ebd16540p-143},   // -1/26!
}};

/// (c_1 + c_2 z + c_3 z^2 ...) in doubles, from the coefficient `First` to `Last`.
template <std::size_t First, std::size_t Last>
double series(const std::array<DoubleDouble, 13>& c, double z) {
  double h = c[Last - 1].high;
  for (std::size_t m = Last - 1; m >= First; --m) h = h * z + c[m - 1].high;
  return h;
}

/// Sine and cosine of a reduced angle r, in doubles.
///
/// Error bound, with u = 2^-53 and z = r^2 < 0.618. Each coefficient of the series is at most 1/12 of the one before,
/// and signs alternate, so that each partial result of Horner's rule lies between 0 and the coefficient c_m that it
/// begins with. If the result at m + 1 errs by E c_(m+1), that at m errs by z / 12 (E + 2 u) c_m for the product (z and
/// the product are rounded), by u for the sum and by u for c_m: E <= 2.3 u in the end. The product of r, z and the
/// series (z / 6 < 0.103 of r) adds three roundings, 5.3 u of it, and the last sum u r; what is left out of r is u r:
/// in all less than 2.6 u |r| for the sine. For the cosine: 0.309 (2.3 + 2) u + u, and u |r| sin r <= 0.56 u for what
/// is left out of r: less than 3 u. The terms that are left out are below z^9 / 19! < 2^-62 of r and z^9 / 18! < 2^-58.
/// So both are within 4 u = 2^-51, the sine relative to r.
inline SineCosine<double> near_zero(double r) {
  const double z = r * r;
  return {r + r * (z * series<1, 8>(sine_series, z)), 1 + z * series<1, 8>(cosine_series, z)};
}

/// The same in double-doubles.
///
/// Error bound: as above with d = 2^-102, a bound for any operation, in place of u; the coefficients are known to
/// 2^-106. Terms from the ninth on are summed in doubles, of which the roundings (4 u of them) count for 6/19! z^8 <
/// 2^-59 of the sine's series and 2/18! z^8 < 2^-56 of the cosine's: below 2^-107 of either. E <= 1.4 d; the sine errs
/// by 0.103 (1.4 + 3) d + d < 1.6 d of r, the cosine by 0.309 (1.4 + 2) d + d < 2.1 d; what the series leave out is
/// below z^14 / 29! < 2^-112 of r and z^14 / 28! < 2^-107. So both are within 3 d < 2^-100, the sine relative to r. For
/// |r| < 2^-60 r and 1 are within 2^-120; nothing underflows elsewhere.
inline SineCosine<DoubleDouble> near_zero(const DoubleDouble& r) {
  if (std::abs(r.high) < 0x1p-60) return {r, DoubleDouble(1.0)};
  const DoubleDouble z = r * r;
  constexpr std::size_t exact_terms = 8;
  DoubleDouble s = z * series<exact_terms + 1, 13>(sine_series, z.high) + sine_series[exact_terms - 1];
  DoubleDouble c = z * series<exact_terms + 1, 13>(cosine_series, z.high) + cosine_series[exact_terms - 1];
  for (std::size_t m = exact_terms - 1; m > 0; --m) {
    s = s * z + sine_series[m - 1];
    c = c * z + cosine_series[m - 1];
  }
  return {r + r * (z * s), z * c + 1.0};
}

template <class Number>
SineCosine<Number> turned_by_quadrants(const SineCosine<Number>& a, int quadrant) {
  switch (quadrant) {
    case 0:
      return a;
    case 1:
      return {a.cosine, -a.sine};
    case 2:
      return {-a.sine, -a.cosine};
    default:
      return {-a.cosine, a.sine};
  }
}

}  // namespace detail

template <class Number>
SineCosine<Number> sine_cosine(const Ball<DoubleDouble>& angle) {
  constexpr bool quick = std::is_same_v<Number, Ball<double>>;
  static_assert(quick || std::is_same_v<Number, Ball<DoubleDouble>>);
  if (angle.is_zero()) return {Number(0.0), Number(1.0)};
  if (!(std::abs(angle.middle.high) <= greatest_angle)) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    return {{0.0, infinity}, {0.0, infinity}};
  }
  const auto reduced = quick ? detail::quickly_reduced(angle.middle) : detail::reduced(angle.middle);
  const double error = angle.radius + reduced.error;
  const double size = std::abs(reduced.remainder.high);
  SineCosine<Number> a;
  if constexpr (quick) {
    const SineCosine<double> values = detail::near_zero(reduced.remainder.high);
    a = {{values.sine, 0x1p-51 * size + error}, {values.cosine, 0x1p-51 + error}};
  } else {
    const SineCosine<DoubleDouble> values = detail::near_zero(reduced.remainder);
    a = {{values.sine, 0x1p-100 * size + error}, {values.cosine, 0x1p-100 + error}};
  }
  return detail::turned_by_quadrants(a, reduced.quadrant);
}

template <class Number>
SineCosine<Number> sine_cosine(double rate, double time) {
  const DoubleDouble angle = two_product(rate, time);
  const bool may_underflow = std::abs(angle.high) < Ball<double>::tiny && rate != 0 && time != 0;
  return sine_cosine<Number>(Ball<DoubleDouble>(angle, may_underflow ? Ball<double>::underflow : 0));
}

}  // namespace kds
