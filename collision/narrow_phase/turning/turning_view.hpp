// Two bodies that turn, seen at one time, with their turns as matrices: for many points of each.
#pragma once

#include "collision/narrow_phase/turning/pair_frame.hpp"

#include <Eigen/Core>

namespace kds::collision {

/// A pair frame, and what turns points of either body.
///
/// Error bound. A column of a matrix is off by 2^-46 at most (Rotation), so a point x is, times the matrix, by (2^-46 +
/// 3 u) times the sum of the magnitudes of its coordinates, u = 2^-53: less than 2^-45 |x| 3^(1/2), which is within
/// what PairFrame has room for.
template <int Degree>
struct TurningView : PairFrame<Degree> {
  using RigidMotion = certificates::RigidMotion<Degree>;

  TurningView(const RigidMotion& a, const RigidMotion& b, double t) : PairFrame<Degree>(a, b, t) {
    for (int k = 0; k < 3; ++k) {
      matrix_a.col(k) = this->turn_a(Eigen::Vector3d::Unit(k));
      matrix_b.col(k) = this->turn_b(Eigen::Vector3d::Unit(k));
    }
  }

  Eigen::Vector3d in_world_a(const Eigen::Vector3d& x) const { return times(matrix_a, x); }
  Eigen::Vector3d in_world_b(const Eigen::Vector3d& x) const { return times(matrix_b, x); }
  /// A vector of the world, in the axes of a.
  Eigen::Vector3d seen_from_a(const Eigen::Vector3d& x) const {
    return {dot(matrix_a.col(0), x), dot(matrix_a.col(1), x), dot(matrix_a.col(2), x)};
  }

  Eigen::Matrix3d matrix_a, matrix_b;

 private:
  /// In one fixed order.
  static Eigen::Vector3d times(const Eigen::Matrix3d& m, const Eigen::Vector3d& x) {
    return {m(0, 0) * x[0] + m(0, 1) * x[1] + m(0, 2) * x[2], m(1, 0) * x[0] + m(1, 1) * x[1] + m(1, 2) * x[2],
            m(2, 0) * x[0] + m(2, 1) * x[1] + m(2, 2) * x[2]};
  }
};

}  // namespace kds::collision
