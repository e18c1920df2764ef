// The path of one ball as seen from another, where that is a line.
#pragma once

#include "certificates/point_motion.hpp"
#include "kds/arithmetic/double_double.hpp"
#include "kds/arithmetic/two.hpp"
#include "kds/roots/failure_time.hpp"

#include <array>
#include <cstddef>

namespace kds::certificates {

template <int PathDegree>
struct BallSeparation;

namespace detail {

/// The path of b as seen from a, about now, if that is a line: r + v (t - now). Of one pair, in doubles, or of two,
/// lane by lane.
///
/// Error bounds, with u = 2^-53. A coordinate at `now` is evaluated by Horner's rule with an elapsed time known to u:
/// at most 6 u of the sum of its terms' magnitudes, and the difference of two adds u; so r is known to 8 u m, where m
/// is that sum for both bodies. Likewise the rate v to 8 u w. Then r . v is known to (8 + 8 + 4) u m . w, r . r to
/// (16 + 4) u m . m plus products of errors, v . v likewise, and the square of the reach to 6 u of itself. All are
/// below 2^-48 (32 u) of the magnitudes, with room for the rounding of the bound; and m . w is at most M W, where M and
/// W are the sums over the axes. Underflow loses less than 2^-1000.
template <class Number>
struct RelativeLine {
  Number square, product, speeds;  ///< r . r - reach^2, r . v, v . v
  Number M, W;
  Number reach;
  static constexpr double unit = 0x1p-48;
  static constexpr double lost = 0x1p-1000;
  static constexpr double range = 0x1p1000;  ///< beyond, sums of opposite infinities might look like a number
  static constexpr double small = 0x1p240;   ///< the fourth power of it is within that range

  /// One pair.
  template <int PathDegree>
  [[gnu::always_inline]] inline RelativeLine(const BallSeparation<PathDegree>& balls, double now)
      : RelativeLine(balls.radius_a + balls.radius_b, [&](int d) {
          Axis<PathDegree> axis{{}, {}, now - balls.a.start, now - balls.b.start};
          for (std::size_t k = 0; k <= PathDegree; ++k) {
            axis.a[k] = balls.a.coefficients[k][d];
            axis.b[k] = balls.b.coefficients[k][d];
          }
          return axis;
        }) {}

  /// Two.
  template <int PathDegree>
  [[gnu::always_inline]] inline RelativeLine(const BallSeparation<PathDegree>& one,
                                             const BallSeparation<PathDegree>& other, double now)
      : RelativeLine(Number{one.radius_a + one.radius_b, other.radius_a + other.radius_b}, [&](int d) {
          Axis<PathDegree> axis{
              {}, {}, now - Number{one.a.start, other.a.start}, now - Number{one.b.start, other.b.start}};
          for (std::size_t k = 0; k <= PathDegree; ++k) {
            axis.a[k] = Number{one.a.coefficients[k][d], other.a.coefficients[k][d]};
            axis.b[k] = Number{one.b.coefficients[k][d], other.b.coefficients[k][d]};
          }
          return axis;
        }) {}

  /// f' now, where f is the square of the distance less that of the reach.
  Ball<double> rate() const { return bounded(2 * product, 2 * (M * W)); }

  Polynomial<2, Ball<double>> polynomial() const {
    Polynomial<2, Ball<double>> f;
    f.c[0] = bounded(square, M * M + reach * reach);
    f.c[1] = rate();
    f.c[2] = bounded(speeds, W * W);
    return f;
  }

 private:
  /// The motions along an axis, and the time since they began.
  template <int PathDegree>
  struct Axis {
    std::array<Number, PathDegree + 1> a, b;
    Number elapsed_a, elapsed_b;
  };

  struct Part {
    Number r, v, m, w;

    template <int PathDegree>
    [[gnu::always_inline]] inline explicit Part(const Axis<PathDegree>& axis) {
      const auto& [a, b, elapsed_a, elapsed_b] = axis;
      Number moved_a = a[1] * elapsed_a;
      Number moved_b = b[1] * elapsed_b;
      m = magnitude(a[0]) + magnitude(b[0]) + magnitude(moved_a) + magnitude(moved_b);
      v = b[1] - a[1];
      w = magnitude(v);
      if constexpr (PathDegree == 2) {
        const Number bend = a[2];
        moved_a = (a[1] + bend * elapsed_a) * elapsed_a;
        moved_b = (b[1] + bend * elapsed_b) * elapsed_b;
        m += magnitude(bend) * (elapsed_a * elapsed_a + elapsed_b * elapsed_b);
        v = (b[1] + 2 * bend * elapsed_b) - (a[1] + 2 * bend * elapsed_a);
        w = magnitude(b[1]) + magnitude(a[1]) + 2 * magnitude(bend) * (magnitude(elapsed_a) + magnitude(elapsed_b));
      }
      r = (b[0] + moved_b) - (a[0] + moved_a);
    }
  };

  template <class AxisOf>
  [[gnu::always_inline]] inline RelativeLine(Number reach_of_both, AxisOf&& axis) : reach(reach_of_both) {
    const Part x(axis(0)), y(axis(1)), z(axis(2));
    square = x.r * x.r + y.r * y.r + z.r * z.r - reach * reach;
    product = x.r * x.v + y.r * y.v + z.r * z.v;
    speeds = x.v * x.v + y.v * y.v + z.v * z.v;
    M = x.m + y.m + z.m;
    W = x.w + y.w + z.w;
  }

  static Ball<double> bounded(double value, double magnitude) {
    return {value, magnitude < range ? unit * magnitude + lost : never};
  }
};

}  // namespace detail
}  // namespace kds::certificates
