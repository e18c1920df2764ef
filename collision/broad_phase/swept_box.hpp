// A box at rest that holds a moving one for a while.
#pragma once

#include "collision/broad_phase/kinetic_box.hpp"
#include "kds/arithmetic/two.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kds::collision {

/// An axis-aligned box that stays where it is. Boxes that touch overlap.
struct StaticBox {
  Eigen::Array3d min;
  Eigen::Array3d max;

  bool overlaps(const StaticBox& other) const { return (min <= other.max).all() && (other.min <= max).all(); }
  bool contains(const StaticBox& other) const { return (min <= other.min).all() && (other.max <= max).all(); }
  double extent() const { return (max - min).maxCoeff(); }
};

/// Holds all boxes of finite numbers.
inline StaticBox whole_space() {
  constexpr double largest = std::numeric_limits<double>::max();
  return {Eigen::Array3d::Constant(-largest), Eigen::Array3d::Constant(largest)};
}

/// Extremes of a moving point's coordinates over [from, to], rounded outward.
///
/// Horner's rule over |elapsed| errs by at most 2 Degree + 1 roundings of the sum of the magnitudes of its terms, and
/// the elapsed time by one more a factor; 8 units in the last place of that sum cover degrees 1 and 2.
template <int Degree>
StaticBox swept_point(const certificates::PointMotion<Degree>& motion, double from, double to) {
  static_assert(Degree == 1 || Degree == 2);
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

/// Whether both corners of a box move alike, as they do unless a caller gives the box.
inline bool corners_move_alike(const KineticBox<1>& box) {
  const Eigen::Vector3d& v = box.min.coefficients[1];
  const Eigen::Vector3d& w = box.max.coefficients[1];
  return box.min.start == box.max.start && v[0] == w[0] && v[1] == w[1] && v[2] == w[2];
}

namespace detail {

/// A coordinate, or two in a register, of a box whose corners move alike.
template <class Number>
struct AlikeEnds {
  static Number least(Number a, Number b) { return b < a ? b : a; }
  static Number most(Number a, Number b) { return a < b ? b : a; }

  AlikeEnds(Number from_low, Number from_high, Number at_velocity, double elapsed)
      : low(least(from_low, from_high)),
        high(most(from_low, from_high)),
        size(most(high, -low)),
        velocity(at_velocity),
        moved(at_velocity * elapsed) {}

  struct Span {
    Number min, max;
  };
  /// On the way from where it has moved to `elapsed` already to where it will have moved to then.
  Span until(Number then) const {
    const Number first = least(moved, then);
    const Number last = most(moved, then);
    const Number margin = 8 * 0x1p-53 * (size + most(last, -first));
    return {low + first - margin, high + last + margin};
  }

  Number low, high;  ///< at the start of the motion
  Number size;       ///< the greater magnitude of these
  Number velocity;
  Number moved;
};

/// A box that holds a kinetic box over [from, to].
template <int Degree>
StaticBox swept_by_corners(const KineticBox<Degree>& box, double from, double to) {
  const StaticBox low = swept_point(box.min, from, to);
  const StaticBox high = swept_point(box.max, from, to);
  return {low.min.min(high.min), low.max.max(high.max)};
}

}  // namespace detail

/// What a kinetic box sweeps from an instant on, also one whose ends have passed each other. Refers to the box.
///
/// Corners that move alike share what they move by; the sums then have one rounding more, and the same margin covers
/// them.
template <int Degree>
class BoxSweep {
 public:
  BoxSweep(const KineticBox<Degree>& box, double from) : box_(box), from_(from) {}

  /// A box that holds it over [from, to].
  StaticBox until(double to) const { return detail::swept_by_corners(box_, from_, to); }
  /// until(from).
  StaticBox begin() const { return until(from_); }
  /// The greatest of its velocities at first, by magnitude.
  double speed() const {
    return std::max(box_.min.velocity(from_).cwiseAbs().maxCoeff(), box_.max.velocity(from_).cwiseAbs().maxCoeff());
  }

 private:
  const KineticBox<Degree>& box_;
  double from_;
};

template <>
class BoxSweep<1> {
 public:
  BoxSweep(const KineticBox<1>& box, double from)
      : box_(box),
        from_(from),
        alike_(corners_move_alike(box)),
        xy_(xy(box.min.coefficients[0]), xy(box.max.coefficients[0]), xy(box.min.coefficients[1]),
            from - box.min.start),
        z_(box.min.coefficients[0][2], box.max.coefficients[0][2], box.min.coefficients[1][2], from - box.min.start) {}

  StaticBox until(double to) const {
    if (!alike_) return detail::swept_by_corners(box_, from_, to);
    const double elapsed = to - box_.min.start;
    return joined(xy_.until(xy_.velocity * elapsed), z_.until(z_.velocity * elapsed));
  }
  StaticBox begin() const {
    if (!alike_) return detail::swept_by_corners(box_, from_, from_);
    return joined(xy_.until(xy_.moved), z_.until(z_.moved));
  }
  double speed() const {
    const auto greatest = [](const Eigen::Vector3d& v) { return v.cwiseAbs().maxCoeff(); };
    const double speed = greatest(box_.min.coefficients[1]);
    return alike_ ? speed : std::max(speed, greatest(box_.max.coefficients[1]));
  }

 private:
  /// Arrays of three would be computed one by one.
  static Two xy(const Eigen::Vector3d& v) { return Two{v[0], v[1]}; }
  static StaticBox joined(const detail::AlikeEnds<Two>::Span& xy, const detail::AlikeEnds<double>::Span& z) {
    return {{xy.min[0], xy.min[1], z.min}, {xy.max[0], xy.max[1], z.max}};
  }

  const KineticBox<1>& box_;
  double from_;
  bool alike_;
  detail::AlikeEnds<Two> xy_;
  detail::AlikeEnds<double> z_;
};

/// A box that holds a kinetic box over [from, to].
template <int Degree>
StaticBox swept_box(const KineticBox<Degree>& box, double from, double to) {
  return BoxSweep<Degree>(box, from).until(to);
}

/// swept_box(box, t, t), bit for bit.
template <int Degree>
StaticBox box_at(const KineticBox<Degree>& box, double t) {
  return BoxSweep<Degree>(box, t).begin();
}

}  // namespace kds::collision
