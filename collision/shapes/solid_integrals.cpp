#include "collision/shapes/solid_integrals.hpp"

#include "collision/vectors.hpp"
#include "kds/arithmetic/power_of_two.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

namespace kds::collision {
namespace {

using Eigen::Vector3d;
using Triangle = std::array<std::uint32_t, 3>;

[[noreturn]] void refuse_mesh(const std::string& what) {
  throw std::invalid_argument("mass_properties: the mesh " + what);
}

/// For each vertex the first one at its place.
std::vector<std::uint32_t> first_at_place(std::span<const Vector3d> vertices) {
  const auto before = [&](std::uint32_t i, std::uint32_t j) {
    const Vector3d& v = vertices[i];
    const Vector3d& w = vertices[j];
    return std::tie(v[0], v[1], v[2], i) < std::tie(w[0], w[1], w[2], j);
  };
  std::vector<std::uint32_t> order(vertices.size()), first(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), before);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool same = k > 0 && vertices[order[k]] == vertices[order[k - 1]];
    first[order[k]] = same ? first[order[k - 1]] : order[k];
  }
  return first;
}

/// A side of a triangle, between places.
struct Side {
  std::uint32_t low, high;  // the first vertices at its ends
  bool upward;              // from low to high
  std::uint32_t triangle;
};

/// Precondition: all sides between two places, whose directions do not cancel each other.
[[noreturn]] void refuse_edge(std::span<const Side> sides) {
  const std::string edge = "edge " + std::to_string(sides[0].low) + "-" + std::to_string(sides[0].high);
  if (sides.size() == 1) {
    refuse_mesh("is open: " + edge + " belongs to one triangle, " + std::to_string(sides[0].triangle));
  }
  if (sides.size() % 2 != 0)
    refuse_mesh("is open: " + edge + " belongs to " + std::to_string(sides.size()) + " triangles");
  std::vector<std::uint32_t> up, down;
  for (const Side& side : sides) (side.upward ? up : down).push_back(side.triangle);
  const std::vector<std::uint32_t>& more = up.size() > down.size() ? up : down;
  refuse_mesh("is not consistently oriented: triangles " + std::to_string(more[0]) + " and " + std::to_string(more[1]) +
              " both run along " + edge + " that way");
}

void require_closed(std::span<const Vector3d> vertices, std::span<const Triangle> triangles) {
  const std::vector<std::uint32_t> first = first_at_place(vertices);
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const Triangle& triangle = triangles[i];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = first[triangle[k]], to = first[triangle[(k + 1) % 3]];
      sides.push_back({std::min(from, to), std::max(from, to), from < to, i});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& x, const Side& y) {
    return std::tie(x.low, x.high, x.triangle) < std::tie(y.low, y.high, y.triangle);
  });
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i, upward = 0;
    for (; end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high; ++end) {
      upward += sides[end].upward;
    }
    if (2 * upward != end - i) refuse_edge(std::span(sides).subspan(i, end - i));
    i = end;
  }
}

SolidIntegrals integrate(std::span<const Vector3d> vertices, std::span<const Triangle> triangles) {
  SolidIntegrals sum;
  // A corner of a triangle: the triangles around it make tetrahedra without volume, which are left out.
  sum.origin = vertices[triangles[0][0]];
  double largest = 0;
  for (const Triangle& triangle : triangles) {
    for (const std::uint32_t i : triangle) {
      largest = std::max(largest, (vertices[i] - sum.origin).cwiseAbs().maxCoeff());
    }
  }
  int exponent = 0;
  std::frexp(largest, &exponent);
  sum.unit = power_of_two(exponent);
  const double per_unit = power_of_two(-exponent);
  for (const auto& [i, j, k] : triangles) {
    const Vector3d &p = vertices[i], &q = vertices[j], &r = vertices[k];
    const PreciseVector a = precise_difference(p, sum.origin) * per_unit;
    const PreciseVector b = precise_difference(q, sum.origin) * per_unit;
    const PreciseVector c = precise_difference(r, sum.origin) * per_unit;
    const PreciseVector e = precise_difference(q, p) * per_unit;
    const PreciseVector f = precise_difference(r, p) * per_unit;
    const DoubleDouble determinant = dot(a, cross(e, f));
    sum.magnitude += magnitude_sum(a) * magnitude_sum(e) * magnitude_sum(f);
    sum.volume = sum.volume + determinant;
    // Over a tetrahedron with a corner at the origin the integral of x is V / 4 times the sum s of the other corners,
    // that of x x^T is V / 20 times the sum of their squares and that of s.
    const PreciseVector s = a + b + c;
    sum.first += s * determinant;
    for (std::size_t d = 0; d < 3; ++d) {
      const auto product = [&](std::size_t x, std::size_t y) {
        return (a[x] * a[y] + b[x] * b[y] + c[x] * c[y] + s[x] * s[y]) * determinant;
      };
      sum.squares[d] = sum.squares[d] + product(d, d);
      sum.products[d] = sum.products[d] + product((d + 1) % 3, (d + 2) % 3);
    }
  }
  return sum;
}

}  // namespace

SolidIntegrals solid_integrals(std::span<const Vector3d> vertices, std::span<const Triangle> triangles) {
  require_closed(vertices, triangles);
  return integrate(vertices, triangles);
}

}  // namespace kds::collision
