// Turning about a fixed axis at a constant rate: how far it has gone at a time.
#pragma once

#include "kds/arithmetic/ball.hpp"
#include "kds/arithmetic/enclosed_sine_cosine.hpp"
#include "kds/arithmetic/exact.hpp"
#include "kds/arithmetic/sine_cosine.hpp"
#include "kds/arithmetic/square_root.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

namespace kds {

/// cos a and w sin a for the angle a = w (t - start), where w >= 0 is the rate. The rate itself is a square root; in
/// this form it appears together with the sine alone, so that all else that formulas hold are sums of products of
/// doubles: w^2 is one.
template <class Number>
struct SpinAngle {
  Number cosine;     ///< cos a
  Number rate_sine;  ///< w sin a, rad/s
};

/// An angular velocity that stays as it is; the angle is zero at `start`.
struct Spin {
  std::array<double, 3> velocity{};  ///< rad/s
  double start = 0;                  ///< s

  bool still() const { return velocity[0] == 0 && velocity[1] == 0 && velocity[2] == 0; }

  /// w^2 = |velocity|^2, rad^2/s^2, in the arithmetic of Number.
  template <class Number>
  Number squared_rate() const {
    const Number x(velocity[0]);
    const Number y(velocity[1]);
    const Number z(velocity[2]);
    return x * x + y * y + z * z;
  }

  /// w, rad/s.
  ///
  /// Error bound: the squares are exact as double-doubles, their two sums err by 2^-102 each and have no signs to
  /// cancel, and the root halves that and adds 2^-103: less than 2^-100 w. Squares of components so small that they
  /// lose their low part count for nothing beside that of the greatest, if this is in the range that is asked for.
  /// Beyond it all bounds are carried along.
  Ball<DoubleDouble> rate() const {
    if (still()) return Ball<DoubleDouble>(0.0);
    const auto [x, y, z] = velocity;
    const double greatest = std::max({std::abs(x), std::abs(y), std::abs(z)});
    if (!(greatest >= 0x1p-200 && greatest <= 0x1p400)) return square_root(squared_rate<Ball<DoubleDouble>>());
    const DoubleDouble square = (two_product(x, x) + two_product(y, y)) + two_product(z, z);
    const DoubleDouble root = detail::rounded_root(square);
    return {root, 0x1p-100 * root.high};
  }

  /// a at t, rad.
  Ball<DoubleDouble> angle(double t) const { return angle(rate(), t); }
  /// The same where the rate is known already.
  Ball<DoubleDouble> angle(const Ball<DoubleDouble>& rate, double t) const {
    return rate * Ball<DoubleDouble>(two_sum(t, -start), 0.0);
  }

  /// The turn at t: Number is Ball<double> or Ball<DoubleDouble>. The angle is reduced in double-doubles for both, so
  /// that many turns cost no precision.
  template <class Number>
  SpinAngle<Number> turn(double t) const {
    if (still()) return {Number(1.0), Number(0.0)};
    const Ball<DoubleDouble> w = rate();
    const auto a = sine_cosine<Number>(angle(w, t));
    if constexpr (std::is_same_v<Number, Ball<double>>) {
      const Ball<double> rounded(w.middle.high, std::abs(w.middle.low) + w.radius);
      return {a.cosine, rounded * a.sine};
    } else {
      return {a.cosine, w * a.sine};
    }
  }

  /// The same to 2^-bits, relative to 1 and to w.
  SpinAngle<Enclosure> enclosed_turn(double t, int bits) const {
    const Exact time = Exact(t) - Exact(start);
    const Exact square = squared_rate<Exact>();
    // The root is known relative to itself and to the time that multiplies it.
    const int needed = bits + std::max(0, time.magnitude_bits()) + std::max(0, -square.magnitude_bits() / 2);
    const Enclosure w = enclosed_square_root(square, needed + 2);
    const auto a = enclosed_sine_cosine(w * Enclosure(time), bits + 2);
    return {a.cosine, w * a.sine};
  }
};

}  // namespace kds
