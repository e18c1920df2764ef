// When the balls of four pairs may meet, computed together.
#pragma once

#include "certificates/earliest_approach.hpp"
#include "certificates/point_motion.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <type_traits>

namespace kds::certificates {

/// A ball, and how its centre moves. One cache line at degree 1.
template <int PathDegree>
struct alignas(64) MovingBall {
  PointMotion<PathDegree> motion;
  double radius = no_radius;  ///< length

  /// The radius of a shape that is not a ball: the answer for it is a NaN.
  static constexpr double no_radius = std::numeric_limits<double>::quiet_NaN();
};

/// Four pairs of balls. The balls are referred to, and must stay in place. Pairs are tested more often than they meet,
/// since motions change before; so a lower bound is wanted first. It answers for the paths that
/// BallSeparation::quick_failure_time() answers for.
///
/// For paths of degree 3 and above the answer is a NaN: their pairs are tested one by one.
///
/// Computed in registers of four doubles where the processor has them (found out when a program runs), else of two,
/// with the same results bit by bit. Cost: some 50 or 90 instructions a pair.
template <int PathDegree>
class BallsTogether {
 public:
  static constexpr std::size_t size = 4;

  /// Precondition: place < size.
  void put(std::size_t place, const MovingBall<PathDegree>& a, const MovingBall<PathDegree>& b) {
    pairs_.a[place] = numbers_of(a);
    pairs_.b[place] = numbers_of(b);
  }

  /// Writes four numbers to `earliest`. Precondition: all four places have been put.
  ///
  /// For each place a time not before `now` and not after BallSeparation::first_approach(now, horizon); `never` where
  /// they certainly do not meet and are apart now, `-never` where they certainly do not meet, but may penetrate now; a
  /// NaN where doubles do not decide.
  void earliest_approaches(double now, double horizon, double* earliest) const {
    if constexpr (PathDegree <= 2) {
      detail::find_approaches<PathDegree>(pairs_, now, horizon, earliest);
    } else {
      std::fill_n(earliest, size, std::numeric_limits<double>::quiet_NaN());
    }
  }

 private:
  static const std::byte* numbers_of(const MovingBall<PathDegree>& ball) {
    static_assert(std::is_standard_layout_v<MovingBall<PathDegree>>);
    static_assert(sizeof ball.motion == (3 * (PathDegree + 1) + 1) * sizeof(double));
    static_assert(offsetof(MovingBall<PathDegree>, radius) == sizeof ball.motion);
    return reinterpret_cast<const std::byte*>(&ball);
  }

  detail::FourPairs pairs_;
};

}  // namespace kds::certificates
