#include "collision/shapes/heightfield.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace kds::collision {
namespace {

void require(bool holds, const std::string& what) {
  if (!holds) throw std::invalid_argument("heightfield: " + what);
}

void check(std::span<const double> heights, std::size_t columns, double spacing_x, double spacing_y) {
  require(columns >= 2, "columns: must be at least 2");
  const std::string all = std::to_string(heights.size()) + " numbers are ";
  require(heights.size() % columns == 0, "heights: " + all + "no whole rows of " + std::to_string(columns));
  require(heights.size() >= 2 * columns, "heights: " + all + "fewer than two rows of " + std::to_string(columns));
  require(heights.size() <= std::numeric_limits<std::uint32_t>::max(),
          "heights: " + all + "too many: 2^32 - 1 at most");
  for (const double spacing : {spacing_x, spacing_y}) {
    require(spacing > 0 && std::isfinite(spacing), "spacing: must be > 0 and finite");
  }
  for (std::size_t i = 0; i < heights.size(); ++i) {
    require(std::isfinite(heights[i]), "heights[" + std::to_string(i) + "]: must be finite");
  }
}

}  // namespace

Mesh heightfield(std::span<const double> heights, std::size_t columns, double spacing_x, double spacing_y) {
  check(heights, columns, spacing_x, spacing_y);
  const std::size_t rows = heights.size() / columns;
  const auto place = [](std::size_t i, std::size_t count, double spacing) {
    return (static_cast<double>(i) - 0.5 * static_cast<double>(count - 1)) * spacing;
  };
  std::vector<Eigen::Vector3d> vertices;
  vertices.reserve(heights.size());
  for (std::size_t i = 0; i < heights.size(); ++i) {
    vertices.emplace_back(place(i % columns, columns, spacing_x), place(i / columns, rows, spacing_y), heights[i]);
  }
  std::vector<Mesh::Triangle> triangles;
  triangles.reserve(2 * (rows - 1) * (columns - 1));
  for (std::size_t j = 0; j + 1 < rows; ++j) {
    for (std::size_t i = 0; i + 1 < columns; ++i) {
      const auto corner = static_cast<std::uint32_t>(j * columns + i);
      const auto above = static_cast<std::uint32_t>(corner + columns);
      triangles.push_back({corner, corner + 1, above + 1});
      triangles.push_back({corner, above + 1, above});
    }
  }
  return {std::move(vertices), std::move(triangles)};
}

}  // namespace kds::collision
