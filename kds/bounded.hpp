// Values of which only samples and a bound on their speed or acceleration are known: the black-box model of motion.
#pragma once

#include "kds/uncertain.hpp"

#include <cmath>

namespace kds {

/// A value that was at `position` at time `start` and has moved at most at `speed` since: whatever it did, it lies in
/// position +- speed (t - start) at any t >= start. Papers: [Kahan91]; [deBerg11], the black-box model.
struct Bounded {
  static constexpr int degree = 1;
  static constexpr bool sampled = true;

  double position = 0;  ///< length
  double speed = 0;     ///< length/s, >= 0
  double start = 0;     ///< s, when the sample was taken

  friend bool operator==(const Bounded&, const Bounded&) = default;
};

/// Whether it is a sample that may be used: all numbers finite, and the bound not negative.
inline bool is_finite(const Bounded& value) {
  return std::isfinite(value.position) && std::isfinite(value.start) && value.speed >= 0 && std::isfinite(value.speed);
}

template <class Number>
Uncertain<0, 1, Number> about(const Bounded& value, double epoch) {
  Uncertain<0, 1, Number> result;
  result.middle.c[0] = Number(value.position);
  result.radius.c[0] = difference<Number>(epoch, value.start) * Number(value.speed);
  result.radius.c[1] = Number(value.speed);
  result.epoch = epoch;
  result.since = value.start;
  return result;
}

template <class Number>
Uncertain<0, 1, Number> difference_about(const Bounded& a, const Bounded& b, double epoch) {
  return about<Number>(a, epoch) - about<Number>(b, epoch);
}

/// A value that was at `position` and had `velocity` at time `start`, and has not accelerated by more than
/// `acceleration` since: it lies in position + velocity (t - start) +- acceleration (t - start)^2 / 2. The uncertainty
/// grows with the square of the time, so smooth motions need far fewer samples than with a bound on the speed.
struct BoundedAcceleration {
  static constexpr int degree = 2;
  static constexpr bool sampled = true;
  static constexpr bool moves = true;  ///< the sample goes on at its velocity: see MovingSample

  double position = 0;      ///< length
  double velocity = 0;      ///< length/s
  double acceleration = 0;  ///< length/s^2, >= 0: a bound on the magnitude
  double start = 0;         ///< s, when the sample was taken

  friend bool operator==(const BoundedAcceleration&, const BoundedAcceleration&) = default;
};

/// Likewise.
inline bool is_finite(const BoundedAcceleration& value) {
  return std::isfinite(value.position) && std::isfinite(value.velocity) && std::isfinite(value.start) &&
         value.acceleration >= 0 && std::isfinite(value.acceleration);
}

template <class Number>
Uncertain<1, 2, Number> about(const BoundedAcceleration& value, double epoch) {
  const Number elapsed = difference<Number>(epoch, value.start);
  Uncertain<1, 2, Number> result;
  result.middle = taylor_shift<Number>(Polynomial<1>{{value.position, value.velocity}}, elapsed);
  result.radius = taylor_shift<Number>(Polynomial<2>{{0, 0, value.acceleration}}, elapsed) * 0.5;
  result.epoch = epoch;
  result.since = value.start;
  return result;
}

template <class Number>
Uncertain<1, 2, Number> difference_about(const BoundedAcceleration& a, const BoundedAcceleration& b, double epoch) {
  return about<Number>(a, epoch) - about<Number>(b, epoch);
}

}  // namespace kds
