// The extents of a body that turns about its centre.
#pragma once

#include "certificates/turning/rigid_motion.hpp"
#include "collision/shapes/polytope.hpp"
#include "collision/shapes/shape.hpp"
#include "collision/shapes/shape_forms.hpp"
#include "collision/vectors.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <variant>

namespace kds::collision {

/// The pieces of a body that precesses (tumbling.hpp) restart its path, which rounds it. Balls and boxes around it that
/// count for several pieces are larger than those of one by this part of its radius.
inline constexpr double path_rounding = 0x1p-24;

/// Calls take(x) for points whose convex hull holds the shape: the corners of a hull; of a mesh the corners of the
/// oriented box around it, with axes rounded to floats, so that they are off by 2^-20 of its size. False for other
/// shapes.
template <class Take>
bool take_corners(const PlacedShape& shape, const Take& take) {
  if (const Polytope* const hull = polytope_of(shape.shape)) {
    for (const Eigen::Vector3d& x : hull->points()) take(x);
    return true;
  }
  if (const auto* const mesh = std::get_if<MeshShape>(&shape.shape)) {
    const ObbNode& box = mesh->mesh->tree().nodes()[0];
    const double unit = mesh->mesh->tree().unit() * mesh->scale;
    for (int corner = 0; corner < 8; ++corner) {
      Eigen::Vector3d x;
      for (std::size_t d = 0; d < 3; ++d) {
        double sum = box.centre[d];
        for (std::size_t k = 0; k < 3; ++k) {
          const double along = static_cast<double>(box.axes[d][k]) * static_cast<double>(box.half_extents[k]);
          sum += corner >> k & 1 ? along : -along;
        }
        x[static_cast<Eigen::Index>(d)] = unit * sum;
      }
      take(x);
    }
    return true;
  }
  if (!shape.parts) return false;
  return std::all_of(shape.parts->begin(), shape.parts->end(),
                     [&](const PlacedShape& part) { return take_corners(part, take); });
}

/// Whether the volume of a body with this shape is the body of revolution of points around a hull or a mesh.
inline bool takes_corners(const Shape& shape) { return polytope_of(shape) || has_mesh(shape); }

/// Of the angle between a unit vector and an axis: where that is small, from the two other coordinates, since 1 - n_d^2
/// loses angles below 1e-8.
inline double sine_of(const Eigen::Vector3d& n, int d) {
  const double square = 1 - n[d] * n[d];
  if (square > 0x1p-10) return std::sqrt(square);
  const double x = n[(d + 1) % 3], y = n[(d + 2) % 3];
  return std::sqrt(x * x + y * y);
}

/// The half extents of a box along the axes of the world that holds a body however far it turns, rounded outward.
///
/// A point of the body keeps its height c along the axis n of the turning, and its distance rho from it. So along an
/// axis of the world it is never farther from the centre than |c n_d| + rho sqrt(1 - n_d^2): these are the bounds of
/// the body of revolution, which are never beyond those of the bounding ball. For a body that does not turn these are
/// its own extents. A capsule is treated as a box without width, grown by its radius; a mesh as the oriented box around
/// it; a compound as all of its parts. For other shapes it is the box around the bounding ball.
///
/// Error bound: a rotated axis is off by 2^-46 of its length, and the sums by some roundings more: 2^-40 of the
/// bounding radius is added, and 2^-17 of it where there are meshes.
template <int Degree>
Eigen::Vector3d turning_half_extents(const PlacedShape& shape, const certificates::RigidMotion<Degree>& motion) {
  const double radius = shape.bounding_radius;
  Eigen::Vector3d edges = Eigen::Vector3d::Zero();  // half of the box that the body is
  double grown_by = 0;
  if (const auto box = rounded_box_of(shape.shape)) edges = box->half_extents, grown_by = box->radius;
  const double rate = norm(motion.angular_velocity);
  const bool still = motion.spin().still();
  if (!still && !(rate >= 0x1p-400 && rate <= 0x1p400)) return Eigen::Vector3d::Constant(radius);
  const certificates::Rotation turn = motion.rotation(motion.path.start);
  Eigen::Vector3d half_extents = Eigen::Vector3d::Zero();
  const Eigen::Vector3d n = still ? half_extents : Eigen::Vector3d(motion.angular_velocity / rate);
  const auto take = [&](const Eigen::Vector3d& x) {
    if (still) {
      half_extents = half_extents.cwiseMax(x.cwiseAbs());
      return;
    }
    const double height = std::abs(dot(n, x));
    const double distance = norm(cross(n, x));
    for (int d = 0; d < 3; ++d) {
      half_extents[d] = std::max(half_extents[d], height * std::abs(n[d]) + distance * sine_of(n, d));
    }
  };
  if (edges == Eigen::Vector3d::Zero()) {
    if (!take_corners(shape, [&](const Eigen::Vector3d& x) { take(turn(x)); })) {
      return Eigen::Vector3d::Constant(radius);
    }
    if (has_mesh(shape.shape)) grown_by = 0x1p-17 * radius;
  } else {
    std::array<Eigen::Vector3d, 3> half;
    for (int k = 0; k < 3; ++k) half[static_cast<std::size_t>(k)] = edges[k] * turn(Eigen::Vector3d::Unit(k));
    if (still) {
      for (const Eigen::Vector3d& h : half) half_extents += h.cwiseAbs();
    } else {
      for (int corner = 0; corner < 4; ++corner) {  // the opposite ones are as far
        take(half[0] + (corner & 1 ? half[1] : -half[1]) + (corner & 2 ? half[2] : -half[2]));
      }
    }
  }
  for (int d = 0; d < 3; ++d) {
    const double grown = half_extents[d] + grown_by + 0x1p-40 * radius;
    half_extents[d] = grown < radius ? grown : radius;
  }
  return half_extents;
}

}  // namespace kds::collision
