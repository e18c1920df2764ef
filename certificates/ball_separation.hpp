// Two balls apart.
#pragma once

#include "certificates/conjunction.hpp"
#include "certificates/point_motion.hpp"
#include "kds/certificate.hpp"
#include "kds/roots/failure_time.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace kds::certificates {

/// |b(t) - a(t)|^2 >= (radius_a + radius_b)^2: two balls do not penetrate. Degree 2 for linear, 4 for quadratic paths.
template <int PathDegree>
struct BallSeparation {
  static constexpr int degree = 2 * PathDegree;
  const PointMotion<PathDegree>& a;
  const PointMotion<PathDegree>& b;
  double radius_a;
  double radius_b;

  template <class Number>
  Polynomial<degree, Number> polynomial(double epoch) const {
    const auto r = relative_motion<Number>(a, b, epoch);
    const Number reach = Number(radius_a) + radius_b;
    auto f = square(r[0]) + square(r[1]) + square(r[2]);
    f.c[0] = f.c[0] - reach * reach;
    return f;
  }

  Ball<DoubleDouble> extended_value(double t) const {
    const Ball<DoubleDouble> reach = Ball<DoubleDouble>(radius_a) + radius_b;
    Ball<DoubleDouble> f = -(reach * reach);
    for (int d = 0; d < 3; ++d) {
      const Ball<DoubleDouble> r = extended_difference(b.axis(d), a.axis(d), t);
      f = f + r * r;
    }
    return f;
  }

  /// What failure_time() gives, bit for bit, or a NaN where it takes more care. It knows balls one of which moves along
  /// a line as seen from the other: straight paths, and those that share their acceleration.
  double quick_failure_time(double now, double horizon) const;

  /// The first double t in [now, horizon] just after which the balls penetrate and approach, or `never`.
  double first_approach(double now, double horizon) const;

  /// The same, or for less a time that is not later.
  struct Estimate {
    double time;
    bool exact;
  };
  Estimate estimated_first_approach(double now, double horizon) const;

  /// f > 0 at t, by a quick test that knows the paths that quick_failure_time() knows; false says nothing.
  bool surely_apart(double t) const;

 private:
  struct RelativeLine;
  bool relative_path_is_line() const;
  double quick_root(const Polynomial<2, Ball<double>>& f, double now, double horizon) const;
};

// ---------------------------------------------------------------------------------------------------------------

template <int PathDegree>
bool BallSeparation<PathDegree>::relative_path_is_line() const {
  if constexpr (PathDegree == 1) {
    return true;
  } else {
    static_assert(PathDegree == 2);
    return a.coefficients[2] == b.coefficients[2];
  }
}

/// The path of b as seen from a, about now, if that is a line: r + v (t - now).
///
/// Error bounds, with u = 2^-53. A coordinate at `now` is evaluated by Horner's rule with an elapsed time known to u:
/// at most 6 u of the sum of its terms' magnitudes, and the difference of two adds u; so r is known to 8 u m, where m
/// is that sum for both bodies. Likewise the rate v to 8 u w. Then r . v is known to (8 + 8 + 4) u m . w, r . r to
/// (16 + 4) u m . m plus products of errors, v . v likewise, and the square of the reach to 6 u of itself. All are
/// below 2^-48 (32 u) of the magnitudes, with room for the rounding of the bound; and m . w is at most M W, where M and
/// W are the sums over the axes. Underflow loses less than 2^-1000.
template <int PathDegree>
struct BallSeparation<PathDegree>::RelativeLine {
  double square, product, speeds;  ///< r . r - reach^2, r . v, v . v
  double M, W;
  double reach;
  static constexpr double unit = 0x1p-48;
  static constexpr double lost = 0x1p-1000;
  static constexpr double range = 0x1p1000;  ///< beyond, sums of opposite infinities might look like a number
  static constexpr double small = 0x1p240;   ///< the fourth power of it is within that range

  /// Two coordinates in one register, and the third.
  using Two = double __attribute__((vector_size(16)));
  static Two pair(const Eigen::Vector3d& x) { return Two{x[0], x[1]}; }
  static double third(const Eigen::Vector3d& x) { return x[2]; }
  static Two magnitude(Two x) {
    using Bits = std::int64_t __attribute__((vector_size(16)));
    return reinterpret_cast<Two>(reinterpret_cast<Bits>(x) & std::numeric_limits<std::int64_t>::max());
  }
  static double magnitude(double x) { return std::abs(x); }

  template <class X>
  struct Part {
    X r, v, m, w;

    template <class Take>
    [[gnu::always_inline]] inline Part(const BallSeparation& balls, double now, Take take) {
      const X a0 = take(balls.a.coefficients[0]);
      const X a1 = take(balls.a.coefficients[1]);
      const X b0 = take(balls.b.coefficients[0]);
      const X b1 = take(balls.b.coefficients[1]);
      const double elapsed_a = now - balls.a.start;
      const double elapsed_b = now - balls.b.start;
      X moved_a = a1 * elapsed_a;
      X moved_b = b1 * elapsed_b;
      m = magnitude(a0) + magnitude(b0) + magnitude(moved_a) + magnitude(moved_b);
      v = b1 - a1;
      w = magnitude(v);
      if constexpr (PathDegree == 2) {
        const X bend = take(balls.a.coefficients[2]);
        moved_a = (a1 + bend * elapsed_a) * elapsed_a;
        moved_b = (b1 + bend * elapsed_b) * elapsed_b;
        m += magnitude(bend) * (elapsed_a * elapsed_a + elapsed_b * elapsed_b);
        v = (b1 + 2 * bend * elapsed_b) - (a1 + 2 * bend * elapsed_a);
        w = magnitude(b1) + magnitude(a1) + 2 * magnitude(bend) * (std::abs(elapsed_a) + std::abs(elapsed_b));
      }
      r = (b0 + moved_b) - (a0 + moved_a);
    }
  };

  [[gnu::always_inline]] inline RelativeLine(const BallSeparation& balls, double now)
      : reach(balls.radius_a + balls.radius_b) {
    const Part<Two> xy(balls, now, pair);
    const Part<double> z(balls, now, third);
    const auto sum = [](Two x, double y) { return x[0] + x[1] + y; };
    square = sum(xy.r * xy.r, z.r * z.r) - reach * reach;
    product = sum(xy.r * xy.v, z.r * z.v);
    speeds = sum(xy.v * xy.v, z.v * z.v);
    M = sum(xy.m, z.m);
    W = sum(xy.w, z.w);
  }

  /// f' now.
  Ball<double> rate() const { return bounded(2 * product, 2 * (M * W)); }

  Polynomial<2, Ball<double>> polynomial() const {
    Polynomial<2, Ball<double>> f;
    f.c[0] = bounded(square, M * M + reach * reach);
    f.c[1] = rate();
    f.c[2] = bounded(speeds, W * W);
    return f;
  }

 private:
  static Ball<double> bounded(double value, double magnitude) {
    return {value, magnitude < range ? unit * magnitude + lost : never};
  }
};

/// f > 0 now, and falls: when it reaches zero.
template <int PathDegree>
double BallSeparation<PathDegree>::quick_root(const Polynomial<2, Ball<double>>& f, double now, double horizon) const {
  const int real = certain_sign(kds::detail::discriminant(f));
  if (real < 0) return never;
  return real > 0 ? kds::detail::quadratic_failure_time(*this, f, now, horizon) : kds::detail::undecided;
}

template <int PathDegree>
double BallSeparation<PathDegree>::quick_failure_time(double now, double horizon) const {
  if (!relative_path_is_line()) return kds::detail::undecided;
  const auto f = RelativeLine(*this, now).polynomial();
  const int value = certain_sign(f.c[0]);
  if (value < 0) return now;
  const int rate = certain_sign(f.c[1]);
  if (value == 0 || rate == 0) return kds::detail::undecided;
  return rate > 0 ? never : quick_root(f, now, horizon);
}

template <int PathDegree>
double BallSeparation<PathDegree>::first_approach(double now, double horizon) const {
  if (!(now <= horizon)) return never;
  if (relative_path_is_line()) {
    const RelativeLine line(*this, now);
    // f is convex along a line, so balls that part will never approach again.
    const int rate = certain_sign(line.rate());
    if (rate > 0) return never;
    const auto f = line.polynomial();
    const int value = certain_sign(f.c[0]);
    if (rate < 0 && value < 0) return now;
    if (rate < 0 && value > 0) {
      const double t = quick_root(f, now, horizon);
      if (t == never) return never;
      // They approach there if the root is farther from that of f' than from the next double: sqrt(D) > 2 c2 spacing.
      const Ball<double> square = kds::detail::discriminant(f);
      const double steep = 4 * f.c[2].middle * std::abs(t) * 0x1p-52;
      if (t > now && square.middle - square.radius > 2 * steep * steep) return t;
    }
  }
  using Parting = DerivativeCertificate<BallSeparation>;
  const Parting parting{*this};
  return first_all_broken<BallSeparation, Parting>(now, horizon, {this, 1}, {&parting, 1});
}

/// Along a line f is convex: it has its first root where it falls, at c / (p + sqrt(p^2 - c s)) with c = f now, p half
/// its rate downward and s that of v . v. Bounds in place of c, p and the discriminant give a lower bound of that, and
/// whether it is a root at all need not be known.
template <int PathDegree>
[[gnu::always_inline]] inline auto BallSeparation<PathDegree>::estimated_first_approach(double now,
                                                                                        double horizon) const
    -> Estimate {
  using Line = RelativeLine;
  if (now <= horizon && relative_path_is_line()) {
    const Line line(*this, now);
    if (line.M + line.W + line.reach < Line::small) {
      const double error = Line::unit * (line.M * line.W) + Line::lost;  // of p
      if (line.product > error) return {never, true};
      const double size = line.M * line.M + line.reach * line.reach;
      const double least = line.square - (Line::unit * size + Line::lost);
      if (least > 0 && line.product < -error) {
        // The discriminant is off by unit W^2 (4 M^2 + 2 reach^2), and by its own rounding.
        const double spare = 8 * Line::unit * (line.W * line.W) * size + Line::lost;
        const double discriminant = line.product * line.product - line.square * line.speeds + spare;
        if (discriminant < 0) return {never, true};
        const double root = least / (std::sqrt(discriminant) - line.product + error);
        const double t = next_down(now + root * (1 - 0x1p-50));
        return t > horizon ? Estimate{never, true} : Estimate{std::max(t, now), false};
      }
    }
  }
  return {first_approach(now, horizon), true};
}

template <int PathDegree>
bool BallSeparation<PathDegree>::surely_apart(double t) const {
  return relative_path_is_line() && certain_sign(RelativeLine(*this, t).polynomial().c[0]) > 0;
}

}  // namespace kds::certificates
