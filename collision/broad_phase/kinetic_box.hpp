// Kinetic bounding volumes: axis-aligned boxes whose ends move.
#pragma once

#include "certificates/point_motion.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "kds/simd/two_doubles.hpp"

#include <Eigen/Core>

#include <cstddef>

namespace kds::collision {

/// An axis-aligned box with a motion for each corner: it may grow and shrink ([Coming06] section 5.2).
///
/// It must contain its body until `valid_until`, when the owner of the body makes a new one.
template <int Degree>
struct KineticBox {
  certificates::PointMotion<Degree> min;
  certificates::PointMotion<Degree> max;
  double valid_until = never;  ///< s
  /// The body lies within this distance of a point that is at least as far from each side of the box: for a ball its
  /// radius, otherwise 0. Broad phases may round the edges of the box by it.
  double rounding = 0;
};

/// The box that moves with `motion` and spans [low, high] about it, rounded outward: its real ends are never inside
/// the exact sums.
///
/// Both ends at once, and without a branch, since processors cannot predict how a sum rounds: the next double where the
/// exact sum is farther outward. A sum that is rounded is never zero.
template <int Degree>
inline KineticBox<Degree> box_around(const certificates::PointMotion<Degree>& motion, const Eigen::Vector3d& low,
                                     const Eigen::Vector3d& high, double rounding = 0) {
  constexpr Two outward{-1, 1};
  constexpr TwoBits step{-1, 1};
  KineticBox<Degree> box;
  box.rounding = rounding;
  box.min.start = box.max.start = motion.start;
  for (std::size_t i = 1; i <= Degree; ++i) box.min.coefficients[i] = box.max.coefficients[i] = motion.coefficients[i];
  for (int d = 0; d < 3; ++d) {
    const double at = motion.coefficients[0][d];
    const Two centre = both(at);
    const Two extent{low[d], high[d]};
    const Two sum = centre + extent;
    const Two part = sum - centre;
    const Two error = (centre - (sum - part)) + (extent - part);
    const TwoBits negative = sum < 0;                   // all bits set
    const TwoBits away = (step ^ negative) - negative;  // in magnitude
    const TwoBits moved = bits(sum) + (away & (error * outward > 0));
    const Two ends = number(moved);
    box.min.coefficients[0][d] = ends[0];
    box.max.coefficients[0][d] = ends[1];
  }
  return box;
}

}  // namespace kds::collision
