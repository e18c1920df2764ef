// Two bodies that turn, seen at one time: for many points of each.
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

  using PairFrame<Degree>::PairFrame;

  Eigen::Vector3d in_world_a(const Eigen::Vector3d& x) const { return times(this->matrix_a, x); }
  Eigen::Vector3d in_world_b(const Eigen::Vector3d& x) const { return times(this->matrix_b, x); }
  /// A vector of the world, in the axes of a.
  Eigen::Vector3d seen_from_a(const Eigen::Vector3d& x) const {
    return {dot(this->axis_a(0), x), dot(this->axis_a(1), x), dot(this->axis_a(2), x)};
  }
  /// Whether both turn, and hardly against each other.
  bool turn_alike() const {
    constexpr double part = 0x1p-4;
    const double rates = part * (this->rate_a + this->rate_b);
    const Eigen::Vector3d apart = this->spin_b - this->spin_a;
    return rates > 0 && dot(apart, apart) <= rates * rates;
  }

 private:
  /// In one fixed order.
  static Eigen::Vector3d times(const Eigen::Matrix3d& m, const Eigen::Vector3d& x) {
    return {m(0, 0) * x[0] + m(0, 1) * x[1] + m(0, 2) * x[2], m(1, 0) * x[0] + m(1, 1) * x[1] + m(1, 2) * x[2],
            m(2, 0) * x[0] + m(2, 1) * x[1] + m(2, 2) * x[2]};
  }
};

}  // namespace kds::collision
