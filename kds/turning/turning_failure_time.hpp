// Failure times of bodies that turn: when a turning certificate first ceases to hold.
#pragma once

#include "kds/number_text.hpp"
#include "kds/roots/failure_time.hpp"
#include "kds/turning/turning_certificate.hpp"
#include "kds/turning/turning_crossing.hpp"
#include "kds/turning/turning_reference.hpp"
#include "kds/turning/turning_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>

namespace kds {

/// The first double t in [now, horizon] with sign_after(certificate, t) < 0, or `never`. Exact, and a function of the
/// certificate, now and horizon alone, as failure_time() of polynomials is (kds/roots/failure_time.hpp): unless it is
/// now itself, the true root is after the double before t and not after t. A certificate that is zero at all times
/// never fails; one that is negative in between two neighbouring doubles only has not failed.
///
/// A horizon before now makes the interval empty. It has to be finite, for most of these functions come back for ever,
/// and whether they do fail is asked turn by turn: throws std::invalid_argument else. Precondition: now is finite.
///
/// Method. Of two bodies that do not turn f is a polynomial, whose failure times are found as those of all polynomials
/// are. Else f is analytic, and bounded with all its derivatives by the magnitudes of its terms.
///
/// 1. *Far from zero.* While the part that does not turn outweighs the others nothing is looked at: strides of any
///    length (TurningExpansion::outweighs).
/// 2. *Turn by turn.* Else f is expanded about the middle of stretches of up to a radian, the angles of both spins
///    taken together: ten powers in doubles, with a bound on all that is left out. Most often f, f' or f'' certainly
///    keeps its sign there. If f does there is no root; if f' does there is at most one; if f is concave the signs at
///    both ends tell; if convex, its least value does.
/// 3. *A root.* One value in double-doubles where the polynomial has its root most often tells which double is next to
///    it (TurningCrossing::next_to_root); else exact signs do, three or four of them.
/// 4. *Undecided* stretches are halved; where no derivative is told from zero they are expanded in double-doubles, and
///    then of exact coefficients, with 160, 320 ... bits. One of the first 9 (degree + 1) derivatives, or 25 (degree +
///    1) of two harmonics, is not zero (turning_dimension), so some stretch about any time comes to know one that keeps
///    its sign.
/// 5. *Where f touches zero*, or nearly, exact signs of the derivatives below that one isolate the roots among the
///    doubles (first_negative_by_signs). Nothing is assumed of their order or number.
///
/// Cost: docs/turning.md. In proportion to the turns between now and the root, where step 1 does not skip them.
template <TurningCertificate C>
double failure_time(const C& certificate, double now, double horizon);

/// The first double t in [now, horizon] with sign_after(certificate, t) > 0, or `never`: where one that has failed
/// holds again. Else as failure_time().
template <TurningCertificate C>
double recovery_time(const C& certificate, double now, double horizon);

/// The first double t in (now, horizon] just after which f has the other sign than `sign`, or `never`. Precondition: it
/// has that sign just after now, 1 or -1; now is finite. Throws as failure_time() does.
template <TurningCertificate C>
double change_of_sign(const C& certificate, int sign, double now, double horizon);

// ---------------------------------------------------------------------------------------------------------------

namespace detail {

inline void check_turning_horizon(double horizon) {
  if (!std::isfinite(horizon)) {
    throw std::invalid_argument("failure_time of a turning certificate: the horizon is " + number_text(horizon) +
                                ", and has to be finite");
  }
}

/// side * f of two spins that are still: a polynomial, since all cosines are 1 and all sines 0.
template <int Degree, int Harmonics>
struct WithoutTurns {
  static constexpr int degree = Degree;
  const TurningReference<Degree, Harmonics>& certificate;
  int side;

  template <class Number>
  Polynomial<Degree, Number> polynomial(double epoch) const {
    const auto f = certificate.template turning_sum<Number, Degree>(epoch);
    Polynomial<Degree, Number> sum = f.p[0][0];
    for (std::size_t i = 0; i < f.size; ++i) {
      for (std::size_t j = i == 0 ? 1 : 0; j < f.size; ++j) {
        if (!is_sine(i) && !is_sine(j) && !is_known_zero(f.p[i][j].c)) sum = sum + f.p[i][j];
      }
    }
    return side < 0 ? -sum : sum;
  }
  Ball<DoubleDouble> extended_value(double t) const {
    const Ball<DoubleDouble> value = certificate.extended_value(t);
    return side < 0 ? -value : value;
  }

  /// Of lines: by one value in double-doubles where the line in doubles has its root. Values are cheaper than
  /// polynomials.
  double quick_failure_time_after_turn(double now, double horizon) const {
    if constexpr (Degree == 1) {
      const auto p = polynomial<Ball<double>>(now);
      const Ball<double>&value = p.c[0], &slope = p.c[1];
      if (certain_sign(slope) > 0) return never;
      const double steepest = std::abs(slope.middle) + slope.radius;
      if (now + (value.middle - value.radius) / steepest * (1 - 0x1p-40) > horizon) return never;
      const double guess = std::max(now, now + value.middle / -slope.middle);
      if (certain_sign(slope) < 0 && guess < never) {
        const double t = TurningCrossing(certificate, side).next_to_root(guess, slope, 0, never);
        if (t > now) return t <= horizon ? t : never;
      }
    }
    return std::numeric_limits<double>::quiet_NaN();
  }
};
template <int Degree, int Harmonics>
bool both_still(const TurningReference<Degree, Harmonics>& certificate) {
  const std::array<Spin, 2> spins = certificate.spins();
  return spins[0].still() && spins[1].still();
}

/// The first double in [now, horizon] just after which side * f < 0, or `never`. Precondition: side * f > 0 just after
/// now.
template <int Degree, int Harmonics>
double turning_change_of_sign(const TurningReference<Degree, Harmonics>& certificate, int side, double now,
                              double horizon) {
  check_turning_horizon(horizon);
  if (both_still(certificate)) {
    return failure_time_after_turn(WithoutTurns<Degree, Harmonics>{certificate, side}, now, horizon);
  }
  return TurningSearch<Degree, Harmonics>(certificate, side).from_positive(now, horizon);
}

/// The same whatever the sign just after now.
template <int Degree, int Harmonics>
double turning_failure_time(const TurningReference<Degree, Harmonics>& certificate, int side, double now,
                            double horizon) {
  if (!(now <= horizon)) return never;
  check_turning_horizon(horizon);
  if (both_still(certificate)) {
    const int sign = side * sign_after(certificate, now);
    return sign > 0 ? turning_change_of_sign(certificate, side, now, horizon) : sign < 0 ? now : never;
  }
  return TurningSearch<Degree, Harmonics>(certificate, side).from_any(now, horizon);
}

}  // namespace detail

template <TurningCertificate C>
double failure_time(const C& certificate, double now, double horizon) {
  return detail::turning_failure_time(TurningReference(certificate), 1, now, horizon);
}

template <TurningCertificate C>
double recovery_time(const C& certificate, double now, double horizon) {
  return detail::turning_failure_time(TurningReference(certificate), -1, now, horizon);
}

template <TurningCertificate C>
double change_of_sign(const C& certificate, int sign, double now, double horizon) {
  return detail::turning_change_of_sign(TurningReference(certificate), sign, now, horizon);
}

#define KDS_TURNING_FAILURE_TIMES(prefix, ...)                                                           \
  prefix double detail::turning_failure_time(const TurningReference<__VA_ARGS__>&, int, double, double); \
  prefix double detail::turning_change_of_sign(const TurningReference<__VA_ARGS__>&, int, double, double);
#define KDS_TURNING_FAILURE_TIMES_ELSEWHERE(...) KDS_TURNING_FAILURE_TIMES(extern template, __VA_ARGS__)
KDS_FOR_EACH_TURNING_SUM(KDS_TURNING_FAILURE_TIMES_ELSEWHERE)
#undef KDS_TURNING_FAILURE_TIMES_ELSEWHERE

}  // namespace kds
