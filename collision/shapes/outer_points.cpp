#include "collision/shapes/outer_points.hpp"

#include "collision/shapes/obb_tree.hpp"

#include <algorithm>
#include <vector>

namespace kds::collision {

using Eigen::Vector3d;

void OuterPoints::add(const Vector3d& point) {
  constexpr std::size_t together = 8;
  static_assert(most % together == 0);
  const std::size_t place = added_++;
  size_ = (added_ + together - 1) / together * together;
  for (std::size_t d = 0; d < 3; ++d) {
    auto& coordinates = coordinates_[d];
    std::fill(coordinates.begin() + static_cast<std::ptrdiff_t>(place),
              coordinates.begin() + static_cast<std::ptrdiff_t>(size_),
              static_cast<float>(point[static_cast<Eigen::Index>(d)]));
  }
}

namespace {

/// The numbers of the vertices that triangles use, each once, if they are no more than these.
std::vector<std::uint32_t> corners_up_to(std::size_t most, const ObbTree& tree) {
  std::vector<std::uint32_t> corners;
  for (const LeafTriangle& triangle : tree.leaf_triangles()) {
    for (const std::uint32_t vertex : triangle.vertices) {
      if (std::find(corners.begin(), corners.end(), vertex) == corners.end()) corners.push_back(vertex);
    }
    if (corners.size() > most) return {};
  }
  return corners;
}

void add_corners_of_boxes(OuterPoints& points, const ObbTree& tree, std::uint32_t number, int levels) {
  const ObbNode& node = tree.nodes()[number];
  if (levels > 0 && !node.is_leaf()) {
    for (const std::uint32_t child : {node.first, node.first + 1}) {
      add_corners_of_boxes(points, tree, child, levels - 1);
    }
    return;
  }
  for (int corner = 0; corner < 8; ++corner) {
    Vector3d x;
    for (std::size_t d = 0; d < 3; ++d) {
      double sum = node.centre[d];
      for (std::size_t k = 0; k < 3; ++k) {
        const double along = static_cast<double>(node.axes[d][k]) * static_cast<double>(node.half_extents[k]);
        sum += corner >> k & 1 ? along : -along;
      }
      x[static_cast<Eigen::Index>(d)] = sum;
    }
    points.add(x);
  }
}

}  // namespace

OuterPoints outer_points(const ObbTree& tree, std::span<const Vector3d> vertices) {
  OuterPoints points;
  const auto corners = corners_up_to(OuterPoints::most, tree);
  for (const std::uint32_t corner : corners) points.add(vertices[corner] / tree.unit());
  if (corners.empty()) add_corners_of_boxes(points, tree, 0, 3);
  return points;
}

}  // namespace kds::collision
