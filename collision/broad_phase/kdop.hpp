// Kinetic k-DOPs: the extents of bodies along more directions than the axes.
#pragma once

#include "collision/body_id.hpp"
#include "collision/broad_phase/kinetic_box.hpp"
#include "collision/broad_phase/swept_box.hpp"
#include "kds/arithmetic/ball.hpp"
#include "kds/arithmetic/double_double.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::collision {

/// An interval of direction . x whose ends move: one of the k / 2 slabs of a k-DOP. Lengths are in units of length
/// times that of the direction.
template <int Degree>
struct KineticSlab {
  Motion<Degree> min;
  Motion<Degree> max;
};

/// Three numbers -1, 0 or 1, not all zero: what structures::kdop_directions() gives. Products with them are exact.
using KdopDirection = std::array<double, 3>;

/// The directions beyond the axes in which bodies are bounded, and the function that gives a body's extent along them.
template <int Degree>
struct Kdops {
  std::vector<KdopDirection> directions;
  /// The slab of a body along directions[i]: must contain it from now on, until the body's box is changed.
  std::function<KineticSlab<Degree>(BodySlot id, std::size_t i, double now)> slab;
};

namespace detail {

/// x + y + z, rounded down: the greatest double not above the sum, except that it may be lower by 2^-50 of the terms if
/// cancellation leaves less than that. The sign of a rounded sum of two doubles is exact.
inline double sum_below(double x, double y, double z) {
  const DoubleDouble first = two_sum(x, y);
  const DoubleDouble second = two_sum(first.high, z);
  const DoubleDouble rest = two_sum(first.low, second.low);
  const DoubleDouble sum = two_sum(second.high, rest.high);
  if (rest.low != 0) return next_down(sum.high - 0x1p-50 * (std::abs(x) + std::abs(y) + std::abs(z)));
  return sum.low < 0 ? next_down(sum.high) : sum.high;
}

/// direction . c, rounded down.
template <class Vector>
double along_below(const KdopDirection& direction, const Vector& c) {
  return sum_below(direction[0] * c[0], direction[1] * c[1], direction[2] * c[2]);
}
template <class Vector>
double along_above(const KdopDirection& direction, const Vector& c) {
  return -sum_below(-direction[0] * c[0], -direction[1] * c[1], -direction[2] * c[2]);
}

}  // namespace detail

/// The extent of a box along a direction, from and to, rounded outward; infinite where sums might overflow.
inline std::array<double, 2> span_along(const KdopDirection& direction, const StaticBox& box) {
  constexpr double largest_summed = 0x1p1000;
  Eigen::Vector3d least, most;
  for (int d = 0; d < 3; ++d) {
    const bool forward = direction[static_cast<std::size_t>(d)] > 0;
    least[d] = forward ? box.min[d] : box.max[d];
    most[d] = forward ? box.max[d] : box.min[d];
  }
  if (!(box.min.abs().max(box.max.abs()) <= largest_summed).all()) return {-never, never};
  return {detail::along_below(direction, least), detail::along_above(direction, most)};
}

/// The ends of a slab at a time, from and to, rounded outward.
template <int Degree>
std::array<double, 2> slab_at(const KineticSlab<Degree>& slab, double t) {
  const Ball<double> low = about<Ball<double>>(slab.min, t).c[0];
  const Ball<double> high = about<Ball<double>>(slab.max, t).c[0];
  return {next_down(low.middle - low.radius), next_up(high.middle + high.radius)};
}

/// The slab along a direction of a body that covers [low, high] about a moving centre. Precondition: the motion has
/// started by now.
///
/// Each coefficient is rounded outward, and so is the whole since the time from the start is not negative: the ends
/// drift apart by less than 2^-52 of the speed.
template <int Degree>
KineticSlab<Degree> slab_around(const certificates::PointMotion<Degree>& motion, double low, double high,
                                const KdopDirection& direction) {
  KineticSlab<Degree> slab;
  for (std::size_t i = 0; i <= Degree; ++i) {
    slab.min.position.c[i] = detail::along_below(direction, motion.coefficients[i]);
    slab.max.position.c[i] = detail::along_above(direction, motion.coefficients[i]);
  }
  slab.min.position.c[0] = detail::sum_below(slab.min.position.c[0], low, 0);
  slab.max.position.c[0] = -detail::sum_below(-slab.max.position.c[0], -high, 0);
  slab.min.start = slab.max.start = motion.start;
  return slab;
}

/// The slab along a direction of a kinetic box, rounded outward: valid from now on, whenever its motions start.
template <int Degree>
KineticSlab<Degree> slab_around(const KineticBox<Degree>& box, const KdopDirection& direction, double now) {
  Polynomial<Degree, Ball<double>> low{}, high{};
  for (int d = 0; d < 3; ++d) {
    const double sign = direction[static_cast<std::size_t>(d)];
    if (sign == 0) continue;
    low = low + about<Ball<double>>((sign > 0 ? box.min : box.max).axis(d), now) * sign;
    high = high + about<Ball<double>>((sign > 0 ? box.max : box.min).axis(d), now) * sign;
  }
  KineticSlab<Degree> slab;
  for (std::size_t i = 0; i <= Degree; ++i) {
    slab.min.position.c[i] = next_down(low.c[i].middle - low.c[i].radius);
    slab.max.position.c[i] = next_up(high.c[i].middle + high.c[i].radius);
  }
  slab.min.start = slab.max.start = now;
  return slab;
}

/// Throws std::invalid_argument for a slab that is not finite: coordinates whose sums overflow.
template <int Degree>
void require_finite(const KineticSlab<Degree>& slab, BodySlot id) {
  if (is_finite(slab.min) && is_finite(slab.max)) return;
  throw std::invalid_argument("k-DOP of body " + std::to_string(id) + ": the sum of its coordinates is not finite");
}

}  // namespace kds::collision
