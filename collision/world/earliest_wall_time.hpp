// A lower bound on the time at which a ball leaves through a wall.
#pragma once

#include "certificates/point_motion.hpp"
#include "certificates/positive_parabola.hpp"
#include "collision/world_options.hpp"
#include "kds/arithmetic/lattice.hpp"
#include "kds/simd/two_doubles.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace kds::collision {

/// A time before which a ball is not both outside a wall and moving outward; `never` if it never is. Wall 2 d is the
/// lower one on axis d, 2 d + 1 the upper. For degree 3 and above: `now`, the trivial bound.
///
/// Error bound, for straight paths: the gap is a sum of five numbers, with a product of a time known to one rounding:
/// at most 6 units of 2^-53 of their magnitudes. The quotient by the speed, which is a double, and the sum with the
/// clock round by one each. For parabolas: the gap is a sum of six, with two such products: at most 10 units; its rate
/// is one of two: at most 4.
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
  } else if constexpr (Degree == 2) {
    const int axis = wall / 2;
    const double out = wall % 2 != 0 ? 1 : -1;
    const double plane = out > 0 ? walls.max[axis] : walls.min[axis];
    const double elapsed = now - motion.start;
    const double at = motion.coefficients[0][axis];
    const double speed = motion.coefficients[1][axis];
    const double half = motion.coefficients[2][axis];
    const double moved = speed * elapsed;
    const double turned = half * elapsed;
    const double gap = out * (plane - (at + (moved + turned * elapsed))) - radius;
    const double size = std::abs(plane) + std::abs(at) + std::abs(moved) + std::abs(turned * elapsed) + radius;
    const double rate = -out * (speed + 2 * turned) - 0x1p-49 * (std::abs(speed) + 2 * std::abs(turned));
    const double wait = certificates::positive_for(gap - 0x1p-48 * size, rate, -out * half);
    return wait > 0 && wait < never ? next_down(now + wait) : now + wait;
  } else {
    return now;
  }
}

namespace detail {

/// The wait in seconds from now to that time, for two coordinates at once; `never` where one does not move. Without a
/// branch, since processors cannot predict which walls bodies approach.
inline Two wait_for_wall(Two at, Two speed, Two elapsed, Two radius, Two low, Two high) {
  const Two moved = speed * elapsed;
  const Two plane = speed > 0 ? high : low;
  const Two ahead = plane - (at + moved);
  const Two gap = (speed > 0 ? ahead : -ahead) - radius;
  const Two error = 0x1p-49 * (magnitude(plane) + magnitude(at) + magnitude(moved) + radius);
  const Two time = (gap - error) / magnitude(speed);
  return speed != 0 ? lesser(time, both(never)) : both(never);
}

/// now + wait, rounded down.
inline double after_wait(double wait, double now) {
  if (wait == never) return never;
  const double t = now + wait * (1 - 0x1p-50);
  return t - 0x1p-51 * std::abs(t);
}

}  // namespace detail

/// The earliest of these times for all six walls.
template <int Degree>
double earliest_wall_time_of_all(const certificates::PointMotion<Degree>& motion, double radius, const Walls& walls,
                                 double now) {
  double earliest = never;
  for (int wall = 0; wall < 6; ++wall) {
    earliest = std::min(earliest, earliest_wall_time(motion, radius, walls, wall, now));
  }
  return earliest;
}
inline double earliest_wall_time_of_all(const certificates::PointMotion<1>& motion, double radius, const Walls& walls,
                                        double now) {
  const auto wait = [&](int d, int e) {
    const auto two = [&](const Eigen::Vector3d& v) { return Two{v[d], v[e]}; };
    return detail::wait_for_wall(two(motion.coefficients[0]), two(motion.coefficients[1]), both(now - motion.start),
                                 both(radius), two(walls.min), two(walls.max));
  };
  const Two xy = wait(0, 1);
  const Two z = wait(2, 2);
  return detail::after_wait(std::min({xy[0], xy[1], z[0]}), now);
}

/// The same for two balls at once, in less time than one by one.
inline std::array<double, 2> earliest_wall_times_of_all(
    const std::array<const certificates::PointMotion<1>*, 2>& motions, Two radii, const Walls& walls, double now) {
  const Two elapsed{now - motions[0]->start, now - motions[1]->start};
  const auto wait_xy = [&](std::size_t ball) {
    const auto xy = [](const Eigen::Vector3d& v) { return Two{v[0], v[1]}; };
    const auto& [at, speed] = motions[ball]->coefficients;
    return detail::wait_for_wall(xy(at), xy(speed), both(elapsed[ball]), both(radii[ball]), xy(walls.min),
                                 xy(walls.max));
  };
  const auto z = [&](std::size_t i) { return Two{motions[0]->coefficients[i][2], motions[1]->coefficients[i][2]}; };
  const Two a = wait_xy(0);
  const Two b = wait_xy(1);
  const Two both_z = detail::wait_for_wall(z(0), z(1), elapsed, radii, both(walls.min[2]), both(walls.max[2]));
  const Two first = lesser(lesser(Two{a[0], b[0]}, Two{a[1], b[1]}), both_z);
  return {detail::after_wait(first[0], now), detail::after_wait(first[1], now)};
}

}  // namespace kds::collision
