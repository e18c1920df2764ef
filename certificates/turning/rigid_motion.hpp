// Motion of a rigid body: its origin on a polynomial path, turning about a fixed axis at a constant rate.
#pragma once

#include "certificates/point_motion.hpp"
#include "certificates/turning/rotation.hpp"
#include "certificates/turning/turned_orientation.hpp"
#include "certificates/vectors.hpp"
#include "kds/turning/spin.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>
#include <limits>

namespace kds::certificates {

/// A vector that was rounded: each coordinate, and the whole vector, is within `error` of the one that is meant.
struct BoundedVector {
  Eigen::Vector3d vector;
  double error;
};

/// A point b of the body is at path(t) + R(t) b, where R(t) = exp((t - start) [W]) R(q): W is the angular velocity, [W]
/// x = W x x, and R(q) the rotation that the quaternion means, q x q^-1 for any length of q but 0.
///
/// The numbers are taken as exact, and so is the rotation that they mean: orthogonal at all times, at a rate that is
/// not distorted. A body whose inertia is the same about all axes moves like this when it is free; others do piece by
/// piece.
///
/// It is a moving element (kds/framework/moving_set.hpp), so that plans of pieces (kds/pieces.hpp) take it as it is;
/// start, restarted() and reversed() are those of PointMotion.
template <int Degree>
struct RigidMotion {
  static_assert(Degree == 1 || Degree == 2);
  static constexpr int degree = Degree;

  /// Of the origin of the body, which stays at zero by default; its start is that of the turning too.
  PointMotion<Degree> path{{Eigen::Vector3d::Zero()}};
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< q, at the start
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();       ///< W, rad/s, in the axes of the world

  double start() const { return path.start; }

  Spin spin() const { return {{angular_velocity[0], angular_velocity[1], angular_velocity[2]}, path.start}; }

  /// The rotation at t, for as many vectors of the body as wanted.
  Rotation rotation(double t) const { return {orientation, spin(), t}; }
  /// The same where the rate of the spin is known already.
  Rotation rotation(const Ball<DoubleDouble>& rate, double t) const { return {orientation, spin(), rate, t}; }

  /// Where the origin is at t.
  BoundedVector origin(double t) const;

  /// Where a point of the body is at t.
  BoundedVector position(const Eigen::Vector3d& point, double t) const;

  /// Where a direction of the body points to at t.
  BoundedVector direction(const Eigen::Vector3d& vector, double t) const;

  /// The velocity of a point of the body at t: that of the origin, and W x R(t) b.
  BoundedVector velocity(const Eigen::Vector3d& point, double t) const;

  /// A motion that starts at t and is this one up to the rounding of its numbers: the coefficients of the path as those
  /// of PointMotion, and each coordinate of the quaternion, which is off by at most 2^-49 of its length. W is the same,
  /// bit for bit; so is the quaternion where W is zero. It is another motion: what is exact of it is exact of its own
  /// numbers, and it is off this one by the rounding, which a body that is restarted often adds up.
  RigidMotion restarted(double t) const;

  /// All numbers are finite, and the quaternion is not zero.
  bool finite() const {
    const auto& q = orientation.coeffs();
    const Eigen::Vector3d& w = angular_velocity;
    return path.finite() && (q - q).sum() == 0 && (w - w).sum() == 0 && !q.isZero(0);
  }

  friend bool operator==(const RigidMotion& a, const RigidMotion& b) {
    return a.path == b.path && a.orientation.coeffs() == b.orientation.coeffs() &&
           a.angular_velocity == b.angular_velocity;
  }
};

/// The path of the origin of the body.
template <int Degree>
const PointMotion<Degree>& path_of(const RigidMotion<Degree>& motion) {
  return motion.path;
}

/// The same motion in time that runs backwards, exactly: see Motion.
template <int Degree>
RigidMotion<Degree> reversed(const RigidMotion<Degree>& motion) {
  return {reversed(motion.path), motion.orientation, Eigen::Vector3d::Zero() - motion.angular_velocity};
}

/// For snapshots (kds/framework/snapshot.hpp).
template <class Archive, int Degree>
void archive_members(Archive& archive, RigidMotion<Degree>& motion) {
  archive(motion.path);
  auto& q = motion.orientation.coeffs();
  archive(q[0], q[1], q[2], q[3]);
  auto& w = motion.angular_velocity;
  archive(w[0], w[1], w[2]);
}

// ---------------------------------------------------------------------------------------------------------------

/// Of Horner's rule with the elapsed time rounded, 2^-50 of the sum of the magnitudes of the terms is charged: the term
/// of degree 2 is rounded six times at most, by 2^-53 each, and the vector has three coordinates.
template <int Degree>
BoundedVector RigidMotion<Degree>::origin(double t) const {
  const double elapsed = std::abs(t - path.start);
  double terms = magnitude_sum(path.coefficients[Degree]);
  for (std::size_t i = Degree; i-- > 0;) terms = terms * elapsed + magnitude_sum(path.coefficients[i]);
  return {path.position(t), 0x1p-50 * terms + 0x1p-600};
}

template <int Degree>
BoundedVector RigidMotion<Degree>::direction(const Eigen::Vector3d& vector, double t) const {
  const Rotation turn = rotation(t);
  return {turn(vector), turn.error() * magnitude_sum(vector) + 0x1p-600};
}

template <int Degree>
BoundedVector RigidMotion<Degree>::position(const Eigen::Vector3d& point, double t) const {
  const BoundedVector o = origin(t);
  const BoundedVector d = direction(point, t);
  const Eigen::Vector3d sum = o.vector + d.vector;
  return {sum, o.error + d.error + 0x1p-52 * magnitude_sum(sum)};
}

/// The cross product adds 3 u |W| |b| to |W| times the error of the direction, u = 2^-53.
template <int Degree>
BoundedVector RigidMotion<Degree>::velocity(const Eigen::Vector3d& point, double t) const {
  const double elapsed = std::abs(t - path.start);
  double terms = magnitude_sum(path.coefficients[Degree]) * Degree;
  for (std::size_t i = Degree; i-- > 1;) {
    terms = terms * elapsed + magnitude_sum(path.coefficients[i]) * static_cast<double>(i);
  }
  const BoundedVector d = direction(point, t);
  const Eigen::Vector3d turning = cross(angular_velocity, d.vector);
  const Eigen::Vector3d sum = path.velocity(t) + turning;
  const double rate = magnitude_sum(angular_velocity);
  return {sum, 0x1p-50 * terms + rate * (d.error + 0x1p-50 * magnitude_sum(point)) + 0x1p-52 * magnitude_sum(sum) +
                   0x1p-600};
}

template <int Degree>
RigidMotion<Degree> RigidMotion<Degree>::restarted(double t) const {
  return {path.restarted(t), turned_orientation(orientation, spin(), t), angular_velocity};
}

}  // namespace kds::certificates
