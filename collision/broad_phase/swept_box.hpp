// Swept AABBs: boxes at rest that contain a moving one for a while.
#pragma once

#include "collision/broad_phase/kinetic_box.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "kds/simd/two_doubles.hpp"
#include "structures/span_ahead.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kds::collision {

/// An axis-aligned box at rest. Boxes that touch overlap.
struct StaticBox {
  Eigen::Array3d min;
  Eigen::Array3d max;

  bool overlaps(const StaticBox& other) const { return (min <= other.max).all() && (other.min <= max).all(); }
  bool contains(const StaticBox& other) const { return (min <= other.min).all() && (other.max <= max).all(); }
  double extent() const { return (max - min).maxCoeff(); }
};

/// Contains all boxes with finite ends.
inline StaticBox whole_space() {
  constexpr double largest = std::numeric_limits<double>::max();
  return {Eigen::Array3d::Constant(-largest), Eigen::Array3d::Constant(largest)};
}

/// Extremes of a moving point's coordinates over [from, to], rounded outward. Precondition, here and below: from <= to,
/// both finite. Ends may overflow to infinity.
///
/// Horner's rule over |elapsed| errs by at most 2 Degree + 1 roundings of the sum of the magnitudes of its terms, and
/// the elapsed time by one more for each factor; 8 units in the last place of that sum cover degrees 1 and 2.
///
/// span_ahead(), which bounds each term by itself, takes three times as many instructions (a box: 535 instead of 169 at
/// degree 1, 1 027 instead of 354 at degree 2; callgrind), and its boxes of parabolas are 7 % larger in half a second,
/// 18 % in two.
template <int Degree>
requires(Degree <= 2) StaticBox swept_point(const certificates::PointMotion<Degree>& motion, double from, double to) {
  using Eigen::Array3d;
  const double begin = from - motion.start;
  const double end = to - motion.start;
  const double longest = std::max(std::abs(begin), std::abs(end));
  const Array3d c0 = motion.coefficients[0].array();
  const Array3d c1 = motion.coefficients[1].array();
  Array3d size = c0.abs() + c1.abs() * longest;
  StaticBox swept;
  if constexpr (Degree == 1) {
    const Array3d at_begin = c0 + c1 * begin;
    const Array3d at_end = c0 + c1 * end;
    swept = {at_begin.min(at_end), at_begin.max(at_end)};
  } else {
    const Array3d c2 = motion.coefficients[2].array();
    const Array3d at_begin = c0 + (c1 + c2 * begin) * begin;
    const Array3d at_end = c0 + (c1 + c2 * end) * end;
    swept = {at_begin.min(at_end), at_begin.max(at_end)};
    for (int d = 0; d < 3; ++d) {
      const double turn = -c1[d] / (2 * c2[d]);
      if (!(c2[d] != 0 && turn > begin && turn < end)) continue;
      const double between = c0[d] + (c1[d] + c2[d] * turn) * turn;
      swept.min[d] = std::min(swept.min[d], between);
      swept.max[d] = std::max(swept.max[d], between);
    }
    size += c2.abs() * longest * longest;
  }
  const Array3d margin = 8 * 0x1p-53 * size;
  swept.min -= margin;
  swept.max += margin;
  return swept;
}

/// The same for a curve of any degree, bounded by span_ahead(): the shorter the span, the tighter the bound.
template <int Degree>
requires(Degree >= 3) StaticBox swept_point(const certificates::PointMotion<Degree>& motion, double from, double to) {
  StaticBox swept;
  for (int d = 0; d < 3; ++d) {
    const structures::Span span = structures::span_ahead(motion.axis(d), from, next_up(to - from));
    swept.min[d] = span.min;
    swept.max[d] = span.max;
  }
  return swept;
}

/// About the seconds in which a point moves by `distance` from its place at `from`, and never by more than a few times
/// that; `never` at rest. Until then no term of its Taylor series there exceeds the distance. It decides how far ahead
/// to search, not what is found. From the third power on it is right within a factor of two, by exponents alone: so it
/// is the same on every system.
template <int Degree>
double time_to_move(const certificates::PointMotion<Degree>& motion, double from, double distance) {
  constexpr double largest = std::numeric_limits<double>::max();
  const auto local = motion.restarted(from);
  double time = never;
  if (!(distance > 0)) return 0;
  for (std::size_t i = 1; i <= Degree; ++i) {
    const double size = local.coefficients[i].cwiseAbs().maxCoeff();
    if (!(size > 0)) continue;
    if (!(size <= largest)) return 0;
    time = std::min(time, largest);
    const int power = static_cast<int>(i);
    const int ratio = std::ilogb(distance) - std::ilogb(size);
    const int exponent = (ratio >= 0 ? ratio : ratio - power + 1) / power;
    time = std::min(time, i == 1 ? distance / size : (i == 2 ? std::sqrt(distance / size) : std::ldexp(1.0, exponent)));
  }
  return time;
}

/// Whether both corners of a box move alike, as they do unless a caller gives the box.
inline bool corners_move_alike(const KineticBox<1>& box) {
  const Eigen::Vector3d& v = box.min.coefficients[1];
  const Eigen::Vector3d& w = box.max.coefficients[1];
  return box.min.start == box.max.start && v[0] == w[0] && v[1] == w[1] && v[2] == w[2];
}

namespace detail {

/// Two coordinates of a box whose corners move alike.
struct AlikeEnds {
  AlikeEnds(Two from_low, Two from_high, Two at_velocity, double elapsed)
      : low(lesser(from_high, from_low)),
        high(greater(from_high, from_low)),
        size(greater(-low, high)),
        velocity(at_velocity),
        moved(at_velocity * elapsed) {}

  struct Span {
    Two min, max;
  };
  /// The extent on the way between the displacements `moved`, after `elapsed`, and `then`.
  Span until(Two then) const {
    const Two first = lesser(then, moved);
    const Two last = greater(then, moved);
    const Two margin = 8 * 0x1p-53 * (size + greater(-first, last));
    return {low + first - margin, high + last + margin};
  }

  Two low, high;  ///< at the start of the motion
  Two size;       ///< the greater magnitude of these
  Two velocity;
  Two moved;
};

/// A box that holds a kinetic box over [from, to].
template <int Degree>
StaticBox swept_by_corners(const KineticBox<Degree>& box, double from, double to) {
  const StaticBox low = swept_point(box.min, from, to);
  const StaticBox high = swept_point(box.max, from, to);
  return {low.min.min(high.min), low.max.max(high.max)};
}

}  // namespace detail

/// The box that a kinetic box sweeps from an instant on, also one whose ends have passed each other. Refers to the box.
///
/// For corners that move alike the displacement is computed once; the sums then have one rounding more, which the same
/// margin covers.
template <int Degree>
class BoxSweep {
 public:
  BoxSweep(const KineticBox<Degree>& box, double from) : box_(box), from_(from) {}

  /// A box that contains it over [from, to].
  StaticBox until(double to) const { return detail::swept_by_corners(box_, from_, to); }
  /// until(from).
  StaticBox begin() const { return until(from_); }
  /// The greatest magnitude of its velocities at the beginning.
  double speed() const {
    return std::max(box_.min.velocity(from_).cwiseAbs().maxCoeff(), box_.max.velocity(from_).cwiseAbs().maxCoeff());
  }
  /// About the seconds until a corner has moved by `distance`: see the function of that name.
  double time_to_move(double distance) const {
    return std::min(collision::time_to_move(box_.min, from_, distance),
                    collision::time_to_move(box_.max, from_, distance));
  }

 private:
  const KineticBox<Degree>& box_;
  double from_;
};

/// The same for a box whose corners move alike, on straight paths: 91 instructions a box in place of 169.
class AlikeSweep {
 public:
  AlikeSweep(const KineticBox<1>& box, double from)
      : xy_(xy(box.min.coefficients[0]), xy(box.max.coefficients[0]), xy(box.min.coefficients[1]),
            from - box.min.start),
        zz_(zz(box.min.coefficients[0]), zz(box.max.coefficients[0]), zz(box.min.coefficients[1]),
            from - box.min.start),
        start_(box.min.start) {}

  StaticBox until(double to) const {
    const double elapsed = to - start_;
    return joined(xy_.until(xy_.velocity * elapsed), zz_.until(zz_.velocity * elapsed));
  }
  StaticBox begin() const { return joined(xy_.until(xy_.moved), zz_.until(zz_.moved)); }
  double speed() const {
    const Two speed = greater(magnitude(xy_.velocity), magnitude(zz_.velocity));
    return std::max(speed[0], speed[1]);
  }

 private:
  /// Written out, since compilers compute arrays of three one number at a time.
  static Two xy(const Eigen::Vector3d& v) { return Two{v[0], v[1]}; }
  static Two zz(const Eigen::Vector3d& v) { return both(v[2]); }
  static StaticBox joined(const detail::AlikeEnds::Span& xy, const detail::AlikeEnds::Span& zz) {
    return {{xy.min[0], xy.min[1], zz.min[0]}, {xy.max[0], xy.max[1], zz.max[0]}};
  }

  detail::AlikeEnds xy_;
  detail::AlikeEnds zz_;
  double start_;
};

template <>
class BoxSweep<1> {
 public:
  BoxSweep(const KineticBox<1>& box, double from)
      : box_(box), from_(from), alike_(corners_move_alike(box)), sweep_(box, from) {}

  StaticBox until(double to) const { return alike_ ? sweep_.until(to) : detail::swept_by_corners(box_, from_, to); }
  StaticBox begin() const { return alike_ ? sweep_.begin() : detail::swept_by_corners(box_, from_, from_); }
  double speed() const {
    if (alike_) return sweep_.speed();
    return std::max(sweep_.speed(), box_.max.coefficients[1].cwiseAbs().maxCoeff());
  }

 private:
  const KineticBox<1>& box_;
  double from_;
  bool alike_;
  AlikeSweep sweep_;
};

/// A box that holds a kinetic box over [from, to].
template <int Degree>
StaticBox swept_box(const KineticBox<Degree>& box, double from, double to) {
  return BoxSweep<Degree>(box, from).until(to);
}

/// The same; whole_space() if it is unbounded, or a bound is a NaN.
template <int Degree>
StaticBox bounded_swept_box(const KineticBox<Degree>& box, double from, double to) {
  constexpr double largest = std::numeric_limits<double>::max();
  const StaticBox swept = swept_box(box, from, to);
  return (swept.min >= -largest).all() && (swept.max <= largest).all() ? swept : whole_space();
}

/// swept_box(box, t, t), bit for bit.
template <int Degree>
StaticBox box_at(const KineticBox<Degree>& box, double t) {
  return BoxSweep<Degree>(box, t).begin();
}

}  // namespace kds::collision
