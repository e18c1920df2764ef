// Random orientations for tests of how bodies turn.
#pragma once

#include "tests/support/random_numbers.hpp"

#include <Eigen/Geometry>

namespace kds::collision::tests {

/// A unit quaternion.
inline Eigen::Quaterniond random_rotation(kds::tests::Random& random) {
  Eigen::Quaterniond q(0, 0, 0, 0);
  while (q.norm() < 0.1) {
    for (int i = 0; i < 4; ++i) q.coeffs()[i] = random.between(-1, 1);
  }
  return q.normalized();
}

}  // namespace kds::collision::tests
