// Pairs of boxes that turn, at random.
#pragma once

#include "tests/benchmarks/turning/query.hpp"
#include "tests/support/random_numbers.hpp"

#include <Eigen/Core>

#include <utility>

namespace turning {

inline Eigen::Vector3d between(kds::tests::Random& random, double size) {
  return size * Eigen::Vector3d(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
}

/// Boxes that pass each other at a distance of up to their size, and turn by `turn` rad in a second.
inline Query random_boxes(kds::tests::Random& random, double turn) {
  Query query;
  for (auto [half, motion] : {std::pair(&query.half_a, &query.a), std::pair(&query.half_b, &query.b)}) {
    *half = Eigen::Vector3d(random.between(0.2, 1), random.between(0.2, 1), random.between(0.2, 1));
    const Eigen::Vector3d velocity = between(random, 2);
    *motion = {{{between(random, 1) - 0.5 * velocity, velocity}}};
    motion->path.coefficients[0][0] += motion == &query.a ? -0.8 : 0.8;
    motion->orientation.coeffs() =
        Eigen::Vector4d(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
    motion->angular_velocity = turn * between(random, 1).normalized();
  }
  return query;
}

}  // namespace turning
