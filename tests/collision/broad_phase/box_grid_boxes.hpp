// What tests of the hierarchical hash grid have in common.
#pragma once

#include "collision/broad_phase/box_grid.hpp"
#include "tests/support/random_numbers.hpp"

#include <algorithm>
#include <utility>

namespace kds::collision::tests {

using kds::tests::Random;

/// Of this size at most, its centre at most `side` from (far, far, far) along each axis.
inline StaticBox random_box(Random& random, double size, double side, double far) {
  Eigen::Array3d centre;
  Eigen::Array3d half;
  for (int d = 0; d < 3; ++d) {
    centre[d] = far + random.between(-side, side);
    half[d] = size * random.between(0.1, 0.5);
  }
  return {centre - half, centre + half};
}

inline std::pair<BoxGrid::Id, BoxGrid::Id> ordered(BoxGrid::Id a, BoxGrid::Id b) {
  return {std::min(a, b), std::max(a, b)};
}

}  // namespace kds::collision::tests
