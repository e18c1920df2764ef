// Products of a rotation and a vector that are the same double on every target.
#pragma once

#include <Eigen/Core>

namespace kds::collision {

/// rotation * v. Eigen's own product asks for fused multiply-add where the target has it, whatever -ffp-contract says,
/// and then its last bits differ.
inline Eigen::Vector3d rotated(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& v) {
  const auto row = [&](Eigen::Index i) {
    return rotation(i, 0) * v[0] + rotation(i, 1) * v[1] + rotation(i, 2) * v[2];
  };
  return {row(0), row(1), row(2)};
}

/// The transposed (inverse) rotation * v.
inline Eigen::Vector3d rotated_back(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& v) {
  const auto column = [&](Eigen::Index i) {
    return rotation(0, i) * v[0] + rotation(1, i) * v[1] + rotation(2, i) * v[2];
  };
  return {column(0), column(1), column(2)};
}

}  // namespace kds::collision
