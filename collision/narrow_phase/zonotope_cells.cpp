#include "collision/narrow_phase/zonotope_cells.hpp"

#include "kds/arithmetic/double_double.hpp"
#include "kds/arithmetic/exact.hpp"

#include <cmath>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

/// Error of the product of three unit vectors: some 20 roundings in doubles.
constexpr double product_rounding = 0x1p-47;

bool exactly_parallel(const Vector3d& u, const Vector3d& v) {
  if (u == v || u == -v) return true;
  // Most are far from parallel. The product is known to 4 roundings of the product of the lengths.
  if (!(cross(u, v).cwiseAbs().maxCoeff() <= 0x1p-48 * u.cwiseAbs().maxCoeff() * v.cwiseAbs().maxCoeff())) return false;
  const auto zero = [&](Eigen::Index i, Eigen::Index j) {
    return (Exact(u[i]) * Exact(v[j]) - Exact(u[j]) * Exact(v[i])).sign() == 0;
  };
  return zero(0, 1) && zero(1, 2) && zero(2, 0);
}

}  // namespace

Vector3d accurate_cross(const Vector3d& u, const Vector3d& v) {
  const auto coordinate = [&](Eigen::Index i, Eigen::Index j) {
    return static_cast<double>(two_product(u[i], v[j]) - two_product(u[j], v[i]));
  };
  return {coordinate(1, 2), coordinate(2, 0), coordinate(0, 1)};
}

ZonotopeCells::ZonotopeCells(certificates::Generators generators) : generators_(generators) {
  const std::size_t n = size();
  for (std::size_t i = 0; i < n; ++i) {
    half_[i] = generators[i].length * generators[i].direction;
    for (std::size_t j = i + 1; j < n; ++j) {
      const Vector3d& u = generators[i].direction;
      const Vector3d& v = generators[j].direction;
      parallel_[i][j] = parallel_[j][i] = exactly_parallel(u, v);
      for (std::size_t k = j + 1; k < n; ++k) {
        const double product = dot(cross(u, v), generators[k].direction);
        const Sign sign = product > product_rounding ? 1 : (product < -product_rounding ? -1 : 0);
        const auto other = static_cast<Sign>(-sign);
        turns_[i][j][k] = turns_[j][k][i] = turns_[k][i][j] = sign;
        turns_[j][i][k] = turns_[i][k][j] = turns_[k][j][i] = other;
      }
    }
  }
}

Vector3d ZonotopeCells::centre(const Cell& cell) const {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t k = 0; k < size(); ++k) {
    if (cell.end[k] > 0) sum += half_[k];
    if (cell.end[k] < 0) sum -= half_[k];
  }
  return sum;
}

/// Whether the cell is certainly not on the surface. It is on it if there is a direction perpendicular to the
/// generators that sweep it whose product with each of the others, the fixed ones, has the sign of their end. So the
/// fixed generators, times their ends and projected along those that sweep, must not positively span the rest of space:
/// on a line two opposite vectors do, in a plane three around the origin, in space four around it.
bool ZonotopeCells::inside(const Cell& cell) const {
  std::array<std::size_t, most> fixed{};
  std::size_t count = 0;
  for (std::size_t k = 0; k < size(); ++k) {
    if (cell.end[k] != 0) fixed[count++] = k;
  }
  const auto same = [](int x, int y, int z) { return x != 0 && x == y && y == z; };
  const auto end = [&](std::size_t k) { return int{cell.end[k]}; };
  if (cell.dimension == 2 && count == 2) {
    const auto [i, j] = cell.swept;
    return turn(i, j, fixed[0]) * end(fixed[0]) * turn(i, j, fixed[1]) * end(fixed[1]) < 0;
  }
  if (cell.dimension == 1 && count == 3) {
    const std::size_t i = cell.swept[0];
    const auto around = [&](std::size_t x, std::size_t y) {
      return turn(i, fixed[x], fixed[y]) * end(fixed[x]) * end(fixed[y]);
    };
    return same(around(0, 1), around(1, 2), around(2, 0));
  }
  if (cell.dimension == 0 && count == 4) {
    // u0 [1 2 3] - u1 [0 2 3] + u2 [0 1 3] - u3 [0 1 2] = 0
    const std::array<int, 4> parts{turn(1, 2, 3) * end(0), -turn(0, 2, 3) * end(1), turn(0, 1, 3) * end(2),
                                   -turn(0, 1, 2) * end(3)};
    return same(parts[0], parts[1], parts[2]) && parts[3] == parts[0];
  }
  return false;
}

}  // namespace kds::collision
