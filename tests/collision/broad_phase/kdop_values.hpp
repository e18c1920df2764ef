// The directions of k-DOPs beyond the axes, and motions as exact polynomials.
#pragma once

#include "collision/broad_phase/kdop.hpp"
#include "kds/motion.hpp"
#include "structures/extents.hpp"
#include "tests/support/exact_algebra.hpp"

#include <vector>

namespace kds::collision::tests {

template <int Degree>
oracle::Polynomial polynomial(const Motion<Degree>& motion) {
  return oracle::Polynomial::motion({motion.position.c.begin(), motion.position.c.end()}, motion.start);
}

inline std::vector<KdopDirection> directions(int k) {
  const auto all = structures::kdop_directions(k);
  return {all.begin() + 3, all.end()};
}

}  // namespace kds::collision::tests
