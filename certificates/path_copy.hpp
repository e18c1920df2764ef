// The copies of a moving point in a plane that repeats itself.
#pragma once

#include "kds/bounded.hpp"
#include "kds/lasting.hpp"
#include "kds/motion.hpp"

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>

namespace kds::certificates {

/// Numbers of whole periods along x and y.
struct PeriodOffset {
  std::int64_t x = 0;
  std::int64_t y = 0;

  friend PeriodOffset operator+(const PeriodOffset& a, const PeriodOffset& b) { return {a.x + b.x, a.y + b.y}; }
  friend PeriodOffset operator-(const PeriodOffset& a, const PeriodOffset& b) { return {a.x - b.x, a.y - b.y}; }
  friend PeriodOffset operator-(const PeriodOffset& a) { return {-a.x, -a.y}; }
  friend auto operator<=>(const PeriodOffset&, const PeriodOffset&) = default;
};

/// The sides of the rectangle that repeats, in units of length.
using Periods = std::array<double, 2>;

/// Differences of offsets are at most this: whole numbers that are doubles.
inline constexpr std::int64_t farthest_offset = std::int64_t{1} << 52;
/// Periods are at most this, so that the product with an offset is finite, and is the sum of two doubles.
inline constexpr double longest_period = 0x1p900;

/// A coordinate of a copy: a motion, and how many periods it is displaced.
template <class Axis>
struct DisplacedMotion {
  Axis motion;
  std::int64_t periods;
  double period;

  friend bool operator==(const DisplacedMotion&, const DisplacedMotion&) = default;
};

/// a - b as a polynomial in (t - epoch). The displacement is the product of a whole number and a double: it is added
/// exactly in Exact, and with the error of that product in balls.
template <class Number, class Axis>
auto difference_about(const DisplacedMotion<Axis>& a, const DisplacedMotion<Axis>& b, double epoch) {
  auto f = difference_about<Number>(a.motion, b.motion, epoch);
  const std::int64_t periods = a.periods - b.periods;
  if (periods == 0) return f;
  Polynomial<0, Number> displacement;
  displacement.c[0] = Number(static_cast<double>(periods)) * Number(a.period);
  return f + displacement;
}

/// a - b at t, in double-doubles.
template <class Axis>
Ball<DoubleDouble> extended_difference(const DisplacedMotion<Axis>& a, const DisplacedMotion<Axis>& b, double t) {
  const auto f = extended_difference(a.motion, b.motion, t);
  const std::int64_t periods = a.periods - b.periods;
  if (periods == 0) return f;
  return f + Ball<DoubleDouble>(two_product(static_cast<double>(periods), a.period), 0.0);
}

namespace detail {

/// What kind of motion a copy has: that of its point.
template <class Path>
struct MovesAs {};
template <class Path>
requires requires { Path::sampled; }
struct MovesAs<Path> {
  static constexpr bool sampled = true;
};

}  // namespace detail

/// A moving point displaced by whole periods: where one of its copies is. A path for certificates: InCircle of four
/// copies is the in-circle test of these places, exact as that of points.
///
/// Preconditions: the path and the periods outlast it; differences of offsets within one certificate are at most
/// farthest_offset, periods at most longest_period.
template <class Path>
struct PathCopy : detail::MovesAs<Path> {
  static constexpr int degree = Path::degree;
  static constexpr bool refers = true;

  const Path* path;
  const Periods* periods;
  PeriodOffset offset;

  PathCopy(Lasting<Path> of, Lasting<Periods> sides, const PeriodOffset& displaced_by)
      : path(&static_cast<const Path&>(of)), periods(&static_cast<const Periods&>(sides)), offset(displaced_by) {}

  auto axis(int d) const {
    return DisplacedMotion<decltype(path->axis(d))>{path->axis(d), d == 0 ? offset.x : offset.y,
                                                    (*periods)[static_cast<std::size_t>(d)]};
  }

  /// Whether they are always in the same place: cheap, and sufficient.
  friend bool operator==(const PathCopy& a, const PathCopy& b) {
    return a.offset == b.offset && (a.path == b.path || *a.path == *b.path);
  }
  /// Whether they are copies of one point.
  friend bool is_copy_of_same(const PathCopy& a, const PathCopy& b) { return a.path == b.path; }
};

}  // namespace kds::certificates
