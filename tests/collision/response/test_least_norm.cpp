// Symmetric equations that may depend on each other, against Eigen's complete orthogonal decomposition.
#include "collision/response/least_norm.hpp"
#include "tests/support/random_numbers.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace kds::collision::test_least_norm {
namespace {

using kds::tests::Random;

/// Products of n unit vectors of r coordinates: a matrix of rank min(n, r), as of n touches of bodies with r degrees of
/// freedom.
Eigen::MatrixXd random_products(Random& random, int n, int r) {
  Eigen::MatrixXd vectors(n, r);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < r; ++j) vectors(i, j) = random.between(-1, 1);
    vectors.row(i).normalize();
  }
  Eigen::MatrixXd products = vectors * vectors.transpose();
  products.diagonal().setOnes();
  return products;
}

Eigen::VectorXd solve(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& b) {
  const auto n = static_cast<std::size_t>(b.size());
  const std::vector<double> x = least_norm_solution({matrix.data(), n * n}, {b.data(), n});
  return Eigen::Map<const Eigen::VectorXd>(x.data(), b.size());
}

TEST_CASE("least norm: known solutions", "[resting]") {
  const auto close = [](const Eigen::VectorXd& found, const std::vector<double>& x) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (!(std::abs(found[static_cast<Eigen::Index>(i)] - x[i]) <= 1e-15)) return false;
    }
    return static_cast<std::size_t>(found.size()) == x.size();
  };
  Eigen::MatrixXd one(1, 1), two(2, 2), same(3, 3);
  one << 1;
  two << 1, 0.5, 0.5, 1;
  same << 1, 1, -1, 1, 1, -1, -1, -1, 1;
  CHECK(close(solve(one, Eigen::VectorXd::Constant(1, 3)), {3}));
  CHECK(close(solve(two, Eigen::Vector2d(2, 2.5)), {1, 2}));
  // Three times the same equation: shared in equal parts. Contradictions are met half way.
  CHECK(close(solve(same, Eigen::Vector3d(3, 3, -3)), {1, 1, -1}));
  CHECK(close(solve(same, Eigen::Vector3d(6, 0, -3)), {1, 1, -1}));
}

TEST_CASE("least norm: as accurate as a complete orthogonal decomposition, of every rank", "[resting]") {
  double worst = 0, worst_of_eigen = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    Random random(seed);
    const int n = random.integer(1, 40);
    const int r = random.integer(1, n + 4);
    INFO("seed " << seed << ", " << n << " equations of rank " << std::min(n, r));
    const Eigen::MatrixXd matrix = random_products(random, n, r);
    Eigen::VectorXd wanted(n), b(n);
    for (int i = 0; i < n; ++i) wanted[i] = random.between(-1, 1);
    b = matrix * wanted;
    const Eigen::VectorXd x = solve(matrix, b);
    const Eigen::VectorXd by_eigen = matrix.completeOrthogonalDecomposition().solve(b);
    // What cannot be told apart by the equations is left out: the solution is no longer than any other.
    CHECK(x.norm() <= wanted.norm() * (1 + 1e-9));
    const double residual = (matrix * x - b).norm() / std::max(b.norm(), x.norm());
    const double residual_of_eigen = (matrix * by_eigen - b).norm() / std::max(b.norm(), by_eigen.norm());
    CHECK(residual < 1e-14);
    worst = std::max(worst, residual);
    worst_of_eigen = std::max(worst_of_eigen, residual_of_eigen);
    const Eigen::VectorXd values = matrix.selfadjointView<Eigen::Lower>().eigenvalues();
    const double least = values[n - std::min(n, r)];
    CHECK((x - by_eigen).norm() <= 1e-14 / least * (1 + x.norm()));
  }
  CHECK(worst < 4 * worst_of_eigen);
}

TEST_CASE("least norm: what contradicts itself is met as nearly as possible", "[resting]") {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Random random(seed);
    const int n = random.integer(3, 20);
    const int r = random.integer(1, n - 1);
    INFO("seed " << seed << ", " << n << " equations of rank " << r);
    const Eigen::MatrixXd matrix = random_products(random, n, r);
    Eigen::VectorXd b(n);
    for (int i = 0; i < n; ++i) b[i] = random.between(-1, 1);
    const Eigen::VectorXd x = solve(matrix, b);
    // The residual is orthogonal to all that the matrix can give.
    CHECK((matrix * (matrix * x - b)).norm() <= 1e-12 * (1 + x.norm()));
  }
}

}  // namespace
}  // namespace kds::collision::test_least_norm
