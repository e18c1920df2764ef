// A box at rest that holds a moving one for a while.
#pragma once

#include "collision/broad_phase/kinetic_box.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace kds::collision {

/// An axis-aligned box that stays where it is. Boxes that touch overlap.
struct StaticBox {
  Eigen::Array3d min;
  Eigen::Array3d max;

  bool overlaps(const StaticBox& other) const { return (min <= other.max).all() && (other.min <= max).all(); }
  bool contains(const StaticBox& other) const { return (min <= other.min).all() && (other.max <= max).all(); }
  double extent() const { return (max - min).maxCoeff(); }
};

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

/// A box that holds a kinetic box over [from, to], also one whose ends have passed each other.
///
/// Corners that move alike share what they move by; the sums then have one rounding more, and the same margin covers
/// them.
template <int Degree>
StaticBox swept_box(const KineticBox<Degree>& box, double from, double to) {
  if constexpr (Degree == 1) {
    if (corners_move_alike(box)) {
      const double begin = from - box.min.start;
      const double end = to - box.min.start;
      StaticBox swept;
      for (int d = 0; d < 3; ++d) {  // plain numbers: arrays of three are not computed any faster
        const double velocity = box.min.coefficients[1][d];
        const double at_begin = velocity * begin;
        const double at_end = velocity * end;
        const double low = box.min.coefficients[0][d];
        const double high = box.max.coefficients[0][d];
        const double first = std::min(at_begin, at_end);
        const double last = std::max(at_begin, at_end);
        const double magnitude = std::max(std::abs(low), std::abs(high)) + std::max(std::abs(first), std::abs(last));
        const double margin = 8 * 0x1p-53 * magnitude;
        swept.min[d] = std::min(low, high) + first - margin;
        swept.max[d] = std::max(low, high) + last + margin;
      }
      return swept;
    }
  }
  const StaticBox low = swept_point(box.min, from, to);
  const StaticBox high = swept_point(box.max, from, to);
  return {low.min.min(high.min), low.max.max(high.max)};
}

/// swept_box(box, t, t), bit for bit.
template <int Degree>
StaticBox box_at(const KineticBox<Degree>& box, double t) {
  if constexpr (Degree == 1) {
    if (corners_move_alike(box)) {
      const double elapsed = t - box.min.start;
      StaticBox at;
      for (int d = 0; d < 3; ++d) {
        const double moved = box.min.coefficients[1][d] * elapsed;
        const double low = box.min.coefficients[0][d];
        const double high = box.max.coefficients[0][d];
        const double margin = 8 * 0x1p-53 * (std::max(std::abs(low), std::abs(high)) + std::abs(moved));
        at.min[d] = std::min(low, high) + moved - margin;
        at.max[d] = std::max(low, high) + moved + margin;
      }
      return at;
    }
  }
  return swept_box(box, t, t);
}

}  // namespace kds::collision
