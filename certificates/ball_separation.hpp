// Two balls apart.
#pragma once

#include "certificates/conjunction.hpp"
#include "certificates/line_distance.hpp"
#include "certificates/point_motion.hpp"
#include "certificates/positive_parabola.hpp"
#include "certificates/relative_line.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "kds/certificate.hpp"
#include "kds/roots/failure_time.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace kds::certificates {

/// |b(t) - a(t)|^2 >= (radius_a + radius_b)^2: two balls do not penetrate. Degree: twice that of the paths.
/// The motions are referred to, and must outlive it; the radii are finite and not negative.
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
    const Number radii = Number(radius_a) + radius_b;
    auto f = square(r[0]) + square(r[1]) + square(r[2]);
    f.c[0] = f.c[0] - radii * radii;
    return f;
  }

  Ball<DoubleDouble> extended_value(double t) const {
    if constexpr (PathDegree == 1) return extended_square_gap(a, b, radius_a, radius_b, t);
    const Ball<DoubleDouble> radii = Ball<DoubleDouble>(radius_a) + radius_b;
    Ball<DoubleDouble> f = -(radii * radii);
    for (int d = 0; d < 3; ++d) {
      const Ball<DoubleDouble> r = extended_difference(b.axis(d), a.axis(d), t);
      f = f + r * r;
    }
    return f;
  }

  /// What failure_time() gives, bit for bit, or a NaN where that needs the general methods. It answers for balls whose
  /// relative motion is along a line: straight paths, and those that share their acceleration.
  double quick_failure_time(double now, double horizon) const;

  /// The first double t in [now, horizon] just after which the balls penetrate and approach, or `never`.
  double first_approach(double now, double horizon) const;

  /// A time up to which a plane stays between the balls, so that they are apart; the nearer they pass each other, the
  /// earlier it is. Not later than now where they may touch up to rounding, and where a path is of degree 3 and above.
  /// For paths that quick_failure_time() does not answer for it costs a fifth of first_approach(), or less.
  double apart_until(double now) const;

  /// Whether one plane, which moves with a, is certainly between the balls from one time to another: then they do not
  /// touch in between. False where none is found. It finds one mostly where they stay farther apart than their relative
  /// path bends. Cost: a small part of a failure time's from degree 3 on.
  bool plane_between(double from, double to) const;

  /// Whether the path of b as seen from a is a line.
  bool relative_path_is_line() const {
    if constexpr (PathDegree == 1) {
      return true;
    } else {
      bool line = a.coefficients[2] == b.coefficients[2];
      for (std::size_t i = 3; i <= PathDegree; ++i) {  // Terms that both share cancel, if both have one start.
        line = line && a.coefficients[i] == b.coefficients[i] && (a.start == b.start || a.coefficients[i].isZero(0));
      }
      return line;
    }
  }

 private:
  using Line = detail::RelativeLine<double>;
  Line relative_line(double now) const;
  double quick_root(const Polynomial<2, Ball<double>>& f, double now, double horizon) const;
};

// ---------------------------------------------------------------------------------------------------------------

namespace detail {

/// Up to degree 2: if the relative motion of two balls is along a line, higher coefficients are zero or cancel.
template <int PathDegree>
MotionNumbers<double, std::min(PathDegree, 2)> numbers_of(const PointMotion<PathDegree>& motion) {
  MotionNumbers<double, std::min(PathDegree, 2)> numbers;
  for (std::size_t k = 0; k <= std::min(PathDegree, 2); ++k) {
    for (int d = 0; d < 3; ++d) numbers.coefficients[k][d] = motion.coefficients[k][d];
  }
  numbers.start = motion.start;
  return numbers;
}

inline Ball<double> bounded(double value, double magnitude) {
  using Line = RelativeLine<double>;
  return {value, magnitude < Line::range ? Line::unit * magnitude + Line::lost : never};
}

/// f' now, where f is the square of the distance minus that of the sum of the radii.
inline Ball<double> rate_of_gap(const RelativeLine<double>& line) {
  return bounded(2 * line.product, 2 * (line.M * line.W));
}

/// f itself.
inline Polynomial<2, Ball<double>> square_gap(const RelativeLine<double>& line) {
  Polynomial<2, Ball<double>> f;
  f.c[0] = bounded(line.square, line.M * line.M + line.radii * line.radii);
  f.c[1] = rate_of_gap(line);
  f.c[2] = bounded(line.speeds, line.W * line.W);
  return f;
}

}  // namespace detail

template <int PathDegree>
detail::RelativeLine<double> BallSeparation<PathDegree>::relative_line(double now) const {
  return {detail::numbers_of(a), detail::numbers_of(b), radius_a + radius_b, now};
}

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
  const auto f = detail::square_gap(relative_line(now));
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
    const Line line = relative_line(now);
    // f is convex along a line, so balls that part will never approach again.
    const int rate = certain_sign(detail::rate_of_gap(line));
    if (rate > 0) return never;
    const auto f = detail::square_gap(line);
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

/// Along the unit vector n from centre to centre the gap is a polynomial c0 + c1 s + c2 s^2, and no greater than what
/// is between the balls. Each coefficient is reduced by `rounding` times the sum of its terms' magnitudes, which is
/// eight times the rounding error in computing it; the length of n, too, differs from 1 by no more than that. By
/// relative_motion(), with a bound for each number, it takes 1.5 times as long, for parabolas 2.7 times
/// (docs/benchmarks.md, "Relative motion").
template <int PathDegree>
double BallSeparation<PathDegree>::apart_until(double now) const {
  if constexpr (PathDegree > 2) return now;
  constexpr double rounding = 0x1p-47;
  constexpr std::size_t last = std::min(PathDegree, 2);
  std::array<Eigen::Vector3d, 3> apart{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  std::array<double, 3> terms{};  // sums of their magnitudes
  for (const PointMotion<PathDegree>* ball : {&a, &b}) {
    const double elapsed = now - ball->start;
    const double sign = ball == &b ? 1 : -1;
    const double size = std::abs(elapsed);
    std::array<double, 3> of{};
    for (std::size_t k = 0; k <= last; ++k) of[k] = ball->coefficients[k].cwiseAbs().sum();
    const auto& c = ball->coefficients;
    if constexpr (last == 2) {
      apart[0] += sign * (c[0] + elapsed * (c[1] + elapsed * c[2]));
      apart[1] += sign * (c[1] + 2 * elapsed * c[2]);
      apart[2] += sign * c[2];
    } else {
      apart[0] += sign * (c[0] + elapsed * c[1]);
      apart[1] += sign * c[1];
    }
    terms[0] += of[0] + size * (of[1] + size * of[2]);
    terms[1] += of[1] + 2 * size * of[2];
    terms[2] += of[2];
  }
  const double distance = apart[0].norm();
  if (!(distance > 0 && distance < never)) return now;
  const double radii = radius_a + radius_b;
  const double c0 = distance - radii - rounding * (terms[0] + radii);
  const double c1 = apart[0].dot(apart[1]) / distance - rounding * terms[1];
  const double c2 = apart[0].dot(apart[2]) / distance - rounding * terms[2];
  const double wait = positive_for(c0, c1, c2);
  return wait > 0 && wait < never ? next_down(now + wait) : now + wait;
}

/// With the relative path p(s) = c0 + c1 s + ... about the middle of the time, |s| <= half, and any vector n,
///   n . p(s) >= n . c0 - |n . c1| half - |n| (|c2| half^2 + |c3| half^3 + ...).
/// The balls are apart if that exceeds |n| times the sum of the radii. The best n is where the line c0 + c1 s comes
/// nearest to the origin; how exactly it is found does not matter.
///
/// Rounding: let M be the sum over both paths, and over their coefficients, of |ci| (|elapsed| + half)^i, a bound on
/// all terms. Coefficients about the middle, their products with half^i and with n err by some 6 Degree roundings of
/// |n| M in all, and the sum of the radii by one of its own: `rounding` is eight times that for degrees to 10. By
/// relative_motion() it takes twice as long (docs/benchmarks.md, "Relative motion").
template <int PathDegree>
bool BallSeparation<PathDegree>::plane_between(double from, double to) const {
  constexpr double rounding = 0x1p-44;
  const double middle = from + 0.5 * (to - from);
  const double half = std::max(middle - from, to - middle);
  std::array<Eigen::Vector3d, std::size_t{PathDegree} + 1> c;
  for (auto& coefficient : c) coefficient.setZero();
  double terms = 0;
  for (const PointMotion<PathDegree>* ball : {&a, &b}) {
    const double elapsed = middle - ball->start;
    const double farthest = std::abs(elapsed) + half;
    auto about_middle = ball->coefficients;
    double size = 0;
    for (std::size_t i = PathDegree + std::size_t{1}; i-- > 0;) {
      size = size * farthest + ball->coefficients[i].cwiseAbs().sum();
      for (std::size_t k = i; k < PathDegree; ++k) about_middle[k] += elapsed * about_middle[k + 1];
    }
    terms += size;
    for (std::size_t i = 0; i <= PathDegree; ++i) {
      if (ball == &b) {
        c[i] += about_middle[i];
      } else {
        c[i] -= about_middle[i];
      }
    }
  }
  const double speeds = c[1].dot(c[1]);
  const double nearest = speeds > 0 ? std::clamp(-c[0].dot(c[1]) / speeds, -half, half) : 0;
  const Eigen::Vector3d n = c[0] + nearest * c[1];
  double bend = 0;
  for (std::size_t i = PathDegree; i >= 2; --i) bend = (bend + c[i].cwiseAbs().sum()) * half;
  const double least = radius_a + radius_b + bend * half + rounding * (terms + radius_a + radius_b);
  const double along = n.dot(c[0]) - std::abs(n.dot(c[1])) * half;
  return along > 0 && along > n.norm() * least && along < never;
}

}  // namespace kds::certificates
