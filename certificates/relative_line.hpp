// The motion of one ball relative to another, where that is a line.
#pragma once

#include "kds/arithmetic/double_double.hpp"
#include "kds/simd/four_wide.hpp"
#include "kds/simd/two_doubles.hpp"

namespace kds::certificates::detail {

/// The numbers of a PointMotion: of one, in doubles, or of several, lane by lane.
template <class Number, int PathDegree>
struct MotionNumbers {
  Number coefficients[std::size_t{PathDegree} + 1][3];
  Number start;
};

/// The motion of b relative to a, about now, if that is a line: r + v (t - now). Of one pair, in doubles, or of
/// several, lane by lane. The square of the gap takes a third of the time that it takes by relative_motion(), a tenth
/// for parabolas (docs/benchmarks.md, "Relative motion").
///
/// Error bounds, with u = 2^-53. A coordinate at `now` is evaluated by Horner's rule with an elapsed time known to u:
/// at most 6 u of the sum of its terms' magnitudes, and the difference of two adds u; so r is known to 8 u m, where m
/// is that sum for both bodies. Likewise the rate v to 8 u w. Then r . v is known to (8 + 8 + 4) u m . w, r . r to
/// (16 + 4) u m . m plus products of errors, v . v likewise, and the square of the sum of the radii to 6 u of itself.
/// All are below 2^-48 (32 u) of the magnitudes, with room for the rounding of the bound; and m . w is at most M W,
/// where M and W are the sums over the axes. Underflow loses less than 2^-1000.
template <class Number>
struct RelativeLine {
  Number square, product, speeds;  ///< r . r - radii^2, r . v, v . v
  Number M, W;
  Number radii;
  static constexpr double unit = 0x1p-48;
  static constexpr double lost = 0x1p-1000;
  static constexpr double range = 0x1p1000;  ///< beyond, sums of opposite infinities might look like a number
  static constexpr double small = 0x1p240;   ///< the fourth power of it is within that range

  template <int PathDegree>
  [[gnu::always_inline]] inline RelativeLine(const MotionNumbers<Number, PathDegree>& a,
                                             const MotionNumbers<Number, PathDegree>& b, Number radii_of_both,
                                             double now)
      : radii(radii_of_both) {
    const Number since_a = now - a.start;
    const Number since_b = now - b.start;
    const Part x(a, b, 0, since_a, since_b), y(a, b, 1, since_a, since_b), z(a, b, 2, since_a, since_b);
    square = x.r * x.r + y.r * y.r + z.r * z.r - radii * radii;
    product = x.r * x.v + y.r * y.v + z.r * z.v;
    speeds = x.v * x.v + y.v * y.v + z.v * z.v;
    M = x.m + y.m + z.m;
    W = x.w + y.w + z.w;
  }

 private:
  /// Along an axis.
  struct Part {
    Number r, v, m, w;

    template <int PathDegree>
    [[gnu::always_inline]] inline Part(const MotionNumbers<Number, PathDegree>& of_a,
                                       const MotionNumbers<Number, PathDegree>& of_b, int d, Number since_a,
                                       Number since_b) {
      static_assert(PathDegree <= 2);
      const Number a0 = of_a.coefficients[0][d], a1 = of_a.coefficients[1][d];
      const Number b0 = of_b.coefficients[0][d], b1 = of_b.coefficients[1][d];
      Number moved_a = a1 * since_a;
      Number moved_b = b1 * since_b;
      m = magnitude(a0) + magnitude(b0) + magnitude(moved_a) + magnitude(moved_b);
      v = b1 - a1;
      w = magnitude(v);
      if constexpr (PathDegree == 2) {
        const Number bend = of_a.coefficients[2][d];
        moved_a = (a1 + bend * since_a) * since_a;
        moved_b = (b1 + bend * since_b) * since_b;
        m += magnitude(bend) * (since_a * since_a + since_b * since_b);
        v = (b1 + 2 * bend * since_b) - (a1 + 2 * bend * since_a);
        w = magnitude(b1) + magnitude(a1) + 2 * magnitude(bend) * (magnitude(since_a) + magnitude(since_b));
      }
      r = (b0 + moved_b) - (a0 + moved_a);
    }
  };
};

}  // namespace kds::certificates::detail
