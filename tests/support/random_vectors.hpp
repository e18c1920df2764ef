// Random vectors for tests.
#pragma once

#include "tests/support/random_numbers.hpp"

#include <Eigen/Core>

namespace kds::tests {

/// Each coordinate is in [-size, size).
inline Eigen::Vector3d random_vector(Random& random, double size = 1) {
  // In this order with every compiler, so that a seed stands for the same vectors: that of arguments is not specified.
  const double x = random.between(-size, size), y = random.between(-size, size), z = random.between(-size, size);
  return {x, y, z};
}

}  // namespace kds::tests
