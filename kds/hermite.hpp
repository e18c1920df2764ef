// Hermite's polynomials: pieces of trajectories that are given by what they are at their two ends.
#pragma once

#include "kds/number_text.hpp"

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

namespace kds {

/// Coefficients, from the constant one on, of the only cubic in the time since the beginning of a piece that goes from
/// p0 with velocity v0 to p1 with velocity v1 in `duration` s, one coordinate of it. Rounded: at its end it is off p1
/// by less than 2^-48 (|p0| + |p1| + T (|v0| + |v1|)), T the duration, and off v1 by less than three times that over T:
/// some 20 roundings of the terms of its coefficients, which are up to three times those sums, and of Horner's rule.
inline std::array<double, 4> hermite_cubic(double p0, double v0, double p1, double v1, double duration) {
  const double way = p1 - p0;
  const double w0 = v0 * duration, w1 = v1 * duration;
  return {p0, v0, (3 * way - (2 * w0 + w1)) / duration / duration,
          ((w0 + w1) - 2 * way) / duration / duration / duration};
}

/// The same with accelerations a0 and a1 (not halves) too. Off p1 by less than 2^-45 (|p0| + |p1| + T (|v0| + |v1|) +
/// T^2 (|a0| + |a1|)), off v1 by less than five times that over T, off a1 by less than twenty times that over T^2.
inline std::array<double, 6> hermite_quintic(double p0, double v0, double a0, double p1, double v1, double a1,
                                             double duration) {
  // Position, velocity and acceleration at the end minus those of the parabola through the data at the beginning, times
  // powers of the duration.
  const double bend = a0 * duration * duration;
  const double way = p1 - p0 - v0 * duration - 0.5 * bend;
  const double rate = (v1 - v0) * duration - bend;
  const double turn = a1 * duration * duration - bend;
  const double c3 = 10 * way - 4 * rate + 0.5 * turn;
  const double c4 = 7 * rate - 15 * way - turn;
  const double c5 = 6 * way - 3 * rate + 0.5 * turn;
  const auto over = [duration](double c, int power) {
    for (int i = 0; i < power; ++i) c /= duration;
    return c;
  };
  return {p0, v0, 0.5 * a0, over(c3, 3), over(c4, 4), over(c5, 5)};
}

namespace detail {

/// The length of a piece of a trajectory, s. Throws std::invalid_argument if it is not positive and finite.
inline double duration_of_piece(const char* function, double t0, double t1) {
  const double duration = t1 - t0;
  if (duration > 0 && std::isfinite(duration) && std::isfinite(t0)) return duration;
  throw std::invalid_argument(std::string(function) + ": from " + number_text(t0) + " to " + number_text(t1) +
                              " is no stretch of time");
}

template <class Motion>
void require_finite(const char* function, const Motion& motion) {
  if (motion.finite()) return;
  throw std::invalid_argument(std::string(function) + ": a coefficient is not finite");
}

}  // namespace detail

}  // namespace kds
