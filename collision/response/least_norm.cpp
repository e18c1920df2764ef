#include "collision/response/least_norm.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kds::collision {
namespace {

/// Rounding may leave this much, for each unknown, of a diagonal entry of 1 that should become 0: it is the difference
/// of 1 and up to n squares with the sum 1, each of a quotient of such sums. With a greater number equations that
/// nearly depend on each other would count as dependent.
constexpr double rest_of_diagonal = 4 * 0x1p-52;

/// Four sums side by side, in a fixed order whether or not the processor adds them at once.
double inner_product(const double* a, const double* b, std::size_t n) {
  double sum[4] = {0, 0, 0, 0};
  std::size_t i = 0;
  for (; i + 4 <= n; i += 4) {
    for (std::size_t k = 0; k < 4; ++k) sum[k] += a[i + k] * b[i + k];
  }
  for (; i < n; ++i) sum[i % 4] += a[i] * b[i];
  return (sum[0] + sum[2]) + (sum[1] + sum[3]);
}

/// y += factor x.
void add(double factor, const double* x, double* y, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) y[i] += factor * x[i];
}

/// L by rows of n, in the order of the steps; `order` says which unknown each row is of. Returns the rank.
std::size_t factor(std::span<const double> matrix, std::vector<double>& rows, std::vector<std::size_t>& order) {
  const std::size_t n = order.size();
  std::vector<double> rest(n, 1.0);
  for (std::size_t k = 0; k < n; ++k) {
    const auto pivot = static_cast<std::size_t>(
        std::max_element(rest.begin() + static_cast<std::ptrdiff_t>(k), rest.end()) - rest.begin());
    if (!(rest[pivot] > rest_of_diagonal * static_cast<double>(n))) return k;
    if (pivot != k) {
      std::swap(rest[pivot], rest[k]);
      std::swap(order[pivot], order[k]);
      std::swap_ranges(&rows[pivot * n], &rows[pivot * n] + k, &rows[k * n]);
    }
    const double* row = &rows[k * n];
    const double diagonal = std::sqrt(rest[k]);
    rows[k * n + k] = diagonal;
    for (std::size_t i = k + 1; i < n; ++i) {
      const double entry = (matrix[order[i] * n + order[k]] - inner_product(&rows[i * n], row, k)) / diagonal;
      rows[i * n + k] = entry;
      rest[i] -= entry * entry;
    }
  }
  return n;
}

/// The r columns of L are made orthonormal one after the other, each twice: so they are orthonormal up to rounding. R
/// has rows of r.
void make_orthonormal(std::vector<std::vector<double>>& columns, std::vector<double>& r) {
  const std::size_t rank = columns.size();
  for (std::size_t k = 0; k < rank; ++k) {
    std::vector<double>& column = columns[k];
    for (int pass = 0; pass < 2; ++pass) {
      for (std::size_t j = 0; j < k; ++j) {
        const double part = inner_product(columns[j].data(), column.data(), column.size());
        r[j * rank + k] += part;
        add(-part, columns[j].data(), column.data(), column.size());
      }
    }
    const double length = std::sqrt(inner_product(column.data(), column.data(), column.size()));
    r[k * rank + k] = length;
    for (double& x : column) x /= length;
  }
}

/// x := L^-T L^-1 x for the first n rows of L.
void solve_both(const std::vector<double>& rows, std::vector<double>& x) {
  const std::size_t n = x.size();
  for (std::size_t i = 0; i < n; ++i) x[i] = (x[i] - inner_product(&rows[i * n], x.data(), i)) / rows[i * n + i];
  for (std::size_t i = n; i-- > 0;) {
    x[i] /= rows[i * n + i];
    add(-x[i], &rows[i * n], x.data(), i);
  }
}

/// x := R^-T R^-1 x.
void solve_with_triangle(const std::vector<double>& r, std::vector<double>& x) {
  const std::size_t n = x.size();
  for (std::size_t i = n; i-- > 0;) {
    x[i] = (x[i] - inner_product(&r[i * n + i] + 1, x.data() + i + 1, n - i - 1)) / r[i * n + i];
  }
  for (std::size_t i = 0; i < n; ++i) {
    x[i] /= r[i * n + i];
    add(-x[i], &r[i * n + i] + 1, x.data() + i + 1, n - i - 1);
  }
}

}  // namespace

std::vector<double> least_norm_solution(std::span<const double> matrix, std::span<const double> b) {
  const std::size_t n = b.size();
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<double> rows(n * n, 0.0);
  const std::size_t rank = factor(matrix, rows, order);
  std::vector<double> sides(n);
  for (std::size_t i = 0; i < n; ++i) sides[i] = b[order[i]];
  if (rank == n) {
    solve_both(rows, sides);
  } else {
    std::vector<std::vector<double>> columns(rank, std::vector<double>(n, 0.0));
    for (std::size_t k = 0; k < rank; ++k) {
      for (std::size_t i = k; i < n; ++i) columns[k][i] = rows[i * n + k];
    }
    std::vector<double> r(rank * rank, 0.0);
    make_orthonormal(columns, r);
    std::vector<double> along(rank);
    for (std::size_t k = 0; k < rank; ++k) along[k] = inner_product(columns[k].data(), sides.data(), n);
    solve_with_triangle(r, along);
    std::fill(sides.begin(), sides.end(), 0.0);
    for (std::size_t k = 0; k < rank; ++k) add(along[k], columns[k].data(), sides.data(), n);
  }
  std::vector<double> x(n);
  for (std::size_t i = 0; i < n; ++i) x[order[i]] = sides[i];
  return x;
}

}  // namespace kds::collision
