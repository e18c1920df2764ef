// From a root that is known to a few digits to the double that is the failure time.
#pragma once

#include "kds/arithmetic/lattice.hpp"
#include "kds/certificate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace kds::detail {

inline constexpr double undecided = std::numeric_limits<double>::quiet_NaN();

/// Slope of f at x, and a bound on how wrong it is, from the coefficients about now.
struct Slope {
  double value;
  double error;  ///< bound on the error of value
  double bend;   ///< bound on |f''| within x (1 +- 1/(16 n))
};

/// Error of the slope: with u = 2^-53, n the degree and Q = sum of i |c_i| x^(i-1), the radii of the coefficients give
/// R = sum of i r_i x^(i-1), and Horner's rule and the factors i give (2 n + 1) u Q. x itself is a rounded difference
/// of times, which moves the slope by u x |f''| <= u (n - 1) Q. Charged are 4 n u Q, which also covers the roundings of
/// Q. The bend: |f''(y)| <= sum of i (i-1) |c_i| y^(i-2) <= (n - 1) Q / x (y / x)^(n-2), and (1 + 1/(16 n))^n < 1.07;
/// with the radii added to Q, the factor 1.25 covers that. Underflow costs 2^-1074 a step times x^n in the end, which
/// the same reserve covers for x^n <= 2^400 and Q >= 2^-600; beyond these limits the error is infinite.
template <int Degree>
Slope slope_at(const Polynomial<Degree, Ball<double>>& p, double x) {
  double slope = Degree * p.c[Degree].middle;
  double magnitudes = std::abs(slope);
  double radii = Degree * p.c[Degree].radius;
  for (std::size_t i = Degree - 1; i >= 1; --i) {
    const double c = static_cast<double>(i) * p.c[i].middle;
    slope = slope * x + c;
    magnitudes = magnitudes * x + std::abs(c);
    radii = radii * x + static_cast<double>(i) * p.c[i].radius;
  }
  radii *= Ball<double>::slack;
  constexpr double farthest = static_cast<double>(std::uint64_t{1} << (Degree <= 10 ? 40 : 400 / Degree));
  const bool in_range = x <= farthest && magnitudes >= 0x1p-600;
  const double error = in_range ? radii + 4.0 * Degree * 0x1p-53 * magnitudes : std::numeric_limits<double>::infinity();
  return {slope, error, 1.25 * (Degree - 1) * (magnitudes + radii) / x};
}

/// Between one and two units in the last place.
inline double spacing(double t) { return std::abs(t) * 0x1p-52 + std::numeric_limits<double>::denorm_min(); }

/// The first double not before a root that is known up to `error`, where f falls from + to - and which is the only one
/// near: `root` rounded up, unless a double is within the error; then one exact sign decides, if no other double is
/// near. A NaN where the error is too large for that.
template <class C>
double first_double_not_before(const C& certificate, const DoubleDouble& root, double error) {
  if (std::abs(root.low) > error) return root.low > 0 ? next_up(root.high) : root.high;
  if (!(error <= 0x1p-5 * spacing(root.high) && std::abs(root.high) < never)) return undecided;
  return exact_sign_after(CertificateReference(certificate), root.high, 0) < 0 ? root.high : next_up(root.high);
}

/// The first double not before the one root of f near now + x, where f falls; p is f about now. A NaN where the numbers
/// do not decide.
///
/// Preconditions: f > 0 in (0, after], written in times since now; in (after, before) f changes its sign once, from +
/// to -, or `before` is infinite and f turns from + to - only once. Both ends are known up to 2^-40 of their sizes. x
/// may be any number: it is a guess.
///
/// One step of Newton's method from t0 with f(t0) = v in double-double and the slope s in doubles; the root is t0 + d*,
/// the step d = -v / s. Let J be t0 +- D with D = 4 |d| + 4 spacings of t0. By slope_at(), f' is s up to a relative
/// error e = (error + D bend) / |s| throughout J; it is required that e <= 1/4 and that J lies after now.
/// (1) f' < 0 on J, so there is at most one root in J. f falls by 3/4 |s| D >= 3 |v| + 3 |s| spacing on either side,
///     which is more than |v| and its error; so there is one.
/// (2) It is *the* root. f > 0 up to `after`. Beyond `before` f would have to rise first, between `before` and that
///     root; but t0 is earlier, so that would be in J.
/// (3) With v = -f'(y) d* for some y in J and v known to +-r, |d - d*| <= |d| (e / (1 - e) + 4 u) + r / ((1 - e) |s|)
///     <= 2 (|d| (e + 2^-51) + r / |s|).
/// The failure time is then that of first_double_not_before(): by (1) f > 0 before and f < 0 after the root in J.
template <class C>
class RootRounding {
 public:
  RootRounding(const C& certificate, double now) : certificate_(certificate), now_(now) {}

  template <int Degree>
  double operator()(const Polynomial<Degree, Ball<double>>& p, double x, double after, double before) const {
    double t = now_ + x;
    // A better start is worth a second evaluation and a third; if these do not suffice, f is left to exact signs.
    for (int attempt = 0; attempt < 3; ++attempt) {
      const double elapsed = t - now_;
      if (!(elapsed > after * (1 + 0x1p-39) && elapsed < before * (1 - 0x1p-39))) return undecided;
      const Slope slope = slope_at(p, elapsed);
      if (!(slope.value < 0)) return undecided;
      ++sign_counters.extended;
      const Ball<DoubleDouble> value = extended_value(certificate_, t);
      const double inverse = -1 / slope.value;
      const double step = value.middle.high * inverse;
      const double span = 4 * std::abs(step) + 4 * spacing(t);
      const double margin = (slope.error + span * slope.bend) * inverse;
      const double radius = value.radius * Ball<double>::slack * inverse;
      if (!(margin <= 0.25 && span * (16 * Degree) <= elapsed && radius <= 0.25 * spacing(t))) return undecided;
      const double error = 2 * (std::abs(step) * (margin + 0x1p-51) + radius);
      const DoubleDouble root = two_sum(t, step);
      const double first = first_double_not_before(certificate_, root, error);
      if (first == first) return first;
      t = root.high;
    }
    return undecided;
  }

 private:
  const C& certificate_;
  double now_;
};

}  // namespace kds::detail
