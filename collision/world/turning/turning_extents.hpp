// How far a body that turns reaches about its centre.
#pragma once

#include "certificates/turning/rigid_motion.hpp"
#include "collision/shapes/shape.hpp"
#include "collision/vectors.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <variant>

namespace kds::collision {

namespace detail {

/// A shape that is the same seen from the opposite side: the hull of points and of those opposite to them, in the
/// coordinates of its body, grown by a radius. `count` 0: a shape of another kind.
struct SymmetricCore {
  std::array<Eigen::Vector3d, 4> points;
  std::size_t count = 0;
  double radius = 0;
};

inline SymmetricCore symmetric_core(const Shape& shape) {
  SymmetricCore core;
  if (const auto* const box = std::get_if<Box>(&shape)) {
    const Eigen::Vector3d& h = box->half_extents;
    core.points = {Eigen::Vector3d(h[0], h[1], h[2]), Eigen::Vector3d(h[0], h[1], -h[2]),
                   Eigen::Vector3d(h[0], -h[1], h[2]), Eigen::Vector3d(h[0], -h[1], -h[2])};
    core.count = 4;
  } else if (const auto* const capsule = std::get_if<Capsule>(&shape)) {
    core.points[0] = Eigen::Vector3d(0, 0, capsule->half_length);
    core.count = 1;
    core.radius = capsule->radius;
  }
  return core;
}

}  // namespace detail

/// The half extents of a box along the axes of the world that holds a body however far it turns, rounded outward.
///
/// A point of the body keeps its height c along the axis n of the turning, and its distance rho from it. So along an
/// axis of the world it is never farther from the centre than |c n_d| + rho sqrt(1 - n_d^2): these are the bounds of
/// the body of revolution, which are never beyond those of the bounding ball. A body that does not turn reaches as far
/// as it does as it is.
///
/// Error bound: an axis that is turned is off by 2^-46 of its length, and what is added up by some roundings more:
/// 2^-40 of the bounding radius is charged.
template <int Degree>
Eigen::Vector3d turning_half_extents(const PlacedShape& shape, const certificates::RigidMotion<Degree>& motion) {
  const double radius = shape.bounding_radius;
  const detail::SymmetricCore core = detail::symmetric_core(shape.shape);
  if (core.count == 0) return Eigen::Vector3d::Constant(radius);
  const certificates::Rotation turn = motion.rotation(motion.path.start);
  const bool still = motion.spin().still();
  const double rate = norm(motion.angular_velocity);
  if (!still && !(rate >= 0x1p-400 && rate <= 0x1p400)) return Eigen::Vector3d::Constant(radius);
  const Eigen::Vector3d n = motion.angular_velocity / (still ? 1 : rate);
  Eigen::Vector3d half_extents = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < core.count; ++i) {
    const Eigen::Vector3d x = turn(core.points[i]);
    const double height = std::abs(dot(n, x));
    const double distance = norm(cross(n, x));
    for (int d = 0; d < 3; ++d) {
      const double reach =
          still ? std::abs(x[d]) : height * std::abs(n[d]) + distance * std::sqrt(std::max(0.0, 1 - n[d] * n[d]));
      half_extents[d] = std::max(half_extents[d], reach);
    }
  }
  for (int d = 0; d < 3; ++d) {
    const double grown = half_extents[d] + core.radius + 0x1p-40 * radius;
    half_extents[d] = grown < radius ? grown : radius;
  }
  return half_extents;
}

}  // namespace kds::collision
