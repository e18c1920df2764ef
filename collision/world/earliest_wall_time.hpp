// A lower bound on the time at which a ball leaves through a wall.
#pragma once

#include "certificates/point_motion.hpp"
#include "collision/world_options.hpp"
#include "kds/arithmetic/two.hpp"

#include <algorithm>
#include <cmath>

namespace kds::collision {

/// A time before which a ball will not be outside a wall and going outward; `never` for never. Wall 2 d is the lower
/// one on axis d, 2 d + 1 the upper.
///
/// Error bound, for straight paths: the gap is a sum of five numbers, with a product of a time known to one rounding:
/// at most 6 units of 2^-53 of their magnitudes. The quotient by the speed, which is a double, and the sum with the
/// clock round by one each.
template <int Degree>
double earliest_wall_time(const certificates::PointMotion<Degree>& motion, double radius, const Walls& walls, int wall,
                          double now) {
  if constexpr (Degree == 1) {
    const int axis = wall / 2;
    const double out = wall % 2 != 0 ? 1 : -1;
    const double speed = motion.coefficients[1][axis] * out;
    if (!(speed > 0)) return never;
    const double plane = out > 0 ? walls.max[axis] : walls.min[axis];
    const double moved = motion.coefficients[1][axis] * (now - motion.start);
    const double gap = out * (plane - (motion.coefficients[0][axis] + moved)) - radius;
    const double error =
        0x1p-49 * (std::abs(plane) + std::abs(motion.coefficients[0][axis]) + std::abs(moved) + radius);
    const double t = now + (gap - error) / speed * (1 - 0x1p-50);
    return t - 0x1p-51 * std::abs(t);
  } else {
    return now;
  }
}

/// The earliest of all walls'. Without a branch, since nobody can predict which walls bodies approach.
inline double earliest_wall_time_of_all(const certificates::PointMotion<1>& motion, double radius, const Walls& walls,
                                        double now) {
  // As above, on two axes; `never` where a body does not move, or a wall is nowhere.
  const auto wait = [&](int d, int e) {
    const auto two = [&](const Eigen::Vector3d& v) { return Two{v[d], v[e]}; };
    const Two at = two(motion.coefficients[0]);
    const Two speed = two(motion.coefficients[1]);
    const Two low = two(walls.min);
    const Two high = two(walls.max);
    const Two moved = speed * (now - motion.start);
    const Two position = at + moved;
    const Two gap = (speed > 0 ? high - position : position - low) - radius;
    const Two error = 0x1p-49 * (magnitude(speed > 0 ? high : low) + magnitude(at) + magnitude(moved) + radius);
    const Two time = (gap - error) / magnitude(speed);
    return ((speed != 0) & (time < never)) ? time : both(never);
  };
  const Two xy = wait(0, 1);
  const Two z = wait(2, 2);
  const double earliest = std::min({xy[0], xy[1], z[0]});
  if (earliest == never) return never;
  const double t = now + earliest * (1 - 0x1p-50);
  return t - 0x1p-51 * std::abs(t);
}

}  // namespace kds::collision
