// A ball inside a half space bounded by a plane across an axis.
#pragma once

#include "kds/certificate.hpp"
#include "kds/motion.hpp"
#include "kds/roots/failure_time_known_line.hpp"

#include <limits>

namespace kds::certificates {

/// side * (plane - x(t)) >= radius: a ball whose centre has coordinate x stays below (side +1) or above (-1) a plane.
template <int Degree>
struct WallSeparation {
  static constexpr int degree = Degree;
  Motion<Degree> coordinate;
  double plane;   ///< length
  double radius;  ///< length
  double side;    ///< +1 or -1

  template <class Number>
  Polynomial<Degree, Number> polynomial(double epoch) const {
    auto f = (constant<Number>(plane) - about<Number>(coordinate, epoch)) * side;
    f.c[0] = f.c[0] - radius;
    return f;
  }

  /// What failure_time() gives, bit for bit, or a NaN where that needs the general methods. It answers for straight
  /// motions of which two doubles hold the gap at the start.
  double quick_failure_time(double now, double horizon) const {
    constexpr double undecided = std::numeric_limits<double>::quiet_NaN();
    if constexpr (Degree != 1) {
      return undecided;
    } else {
      const auto& [at_start, rate] = coordinate.position.c;
      const DoubleDouble centre = two_sum(side * plane, -side * at_start);
      const DoubleDouble ball = two_sum(centre.high, -radius);
      const DoubleDouble rest = two_sum(centre.low, ball.low);
      if (rest.low != 0) return undecided;
      const KnownParabola<false> gap{two_sum(ball.high, rest.high), {-side * rate, 0}, {0, 0}, 0, 0, coordinate.start};
      return quick_line_failure_time(gap, now, horizon);
    }
  }
};

}  // namespace kds::certificates
