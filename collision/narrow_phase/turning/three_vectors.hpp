// Three vectors side by side.
#pragma once

#include "kds/simd/four_doubles.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>

namespace kds::collision {

/// Row d holds the coordinates d of three vectors; the fourth lane is 0.
using ThreeVectors = std::array<FourDoubles, 3>;

inline ThreeVectors side_by_side(const std::array<Eigen::Vector3d, 3>& v) {
  return {FourDoubles(v[0][0], v[1][0], v[2][0], 0), FourDoubles(v[0][1], v[1][1], v[2][1], 0),
          FourDoubles(v[0][2], v[1][2], v[2][2], 0)};
}
inline Eigen::Vector3d vector(const ThreeVectors& v, std::size_t i) { return {v[0][i], v[1][i], v[2][i]}; }

/// Each of them times a matrix.
inline ThreeVectors turned(const Eigen::Matrix3d& m, const ThreeVectors& v) {
  ThreeVectors result;
  for (std::size_t d = 0; d < 3; ++d) {
    const auto i = static_cast<Eigen::Index>(d);
    result[d] = FourDoubles(m(i, 0)) * v[0] + FourDoubles(m(i, 1)) * v[1] + FourDoubles(m(i, 2)) * v[2];
  }
  return result;
}
/// The products of a vector with each.
inline FourDoubles dots(const Eigen::Vector3d& x, const ThreeVectors& v) {
  return FourDoubles(x[0]) * v[0] + FourDoubles(x[1]) * v[1] + FourDoubles(x[2]) * v[2];
}

}  // namespace kds::collision
