// Principal moments and axes of a tensor of inertia.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace kds::collision {

/// A tensor of inertia taken apart: A diag(moments) A^T, A being the rotation that `axes` means.
struct PrincipalInertia {
  Eigen::Vector3d moments = Eigen::Vector3d::Ones();         ///< > 0; mass * length^2
  Eigen::Quaterniond axes = Eigen::Quaterniond::Identity();  ///< from principal axes to those of the body
  /// Of a symmetric top: the axis about which it is symmetric, the two other moments being equal; -1 of other bodies.
  int symmetry = -1;

  friend bool operator==(const PrincipalInertia& a, const PrincipalInertia& b) {
    return a.moments == b.moments && a.axes.coeffs() == b.axes.coeffs() && a.symmetry == b.symmetry;
  }
};

/// Of a tensor that checked_inertia() accepts. Moments that differ by no more than inertia_tolerance of the greatest
/// are made equal. Put together again, the tensor is off by at most 2^-46 of its greatest entry; one that is diagonal
/// is exact, with axes that are not turned, unless two moments were made equal.
///
/// Jacobi's rotations, of + - * / and sqrt alone: the same bits on every system.
PrincipalInertia principal_inertia(const Eigen::Matrix3d& tensor);

}  // namespace kds::collision
