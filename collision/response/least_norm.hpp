// Linear equations of touches: symmetric, and often not independent of each other.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace kds::collision {

/// The shortest x for which |A x - b| is least. A is symmetric, n x n, row by row, has no negative eigenvalue beyond
/// rounding and ones on its diagonal.
///
/// A = L L^T by Cholesky with diagonal pivoting, which stops where only rounding errors are left on the diagonal
/// [Higham02], section 10.3. If that is before the end, L = Q R has full column rank, and x = Q (R R^T)^-1 Q^T b.
///
/// All sums are in one order, so that the bits are the same whatever vector instructions a compiler may use.
/// Cost: n^3 / 3 products for independent equations, and up to 4 n r^2 more where the rank r is less than n.
std::vector<double> least_norm_solution(std::span<const double> matrix, std::span<const double> b);

}  // namespace kds::collision
