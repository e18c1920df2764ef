#include "collision/narrow_phase/lowest_place.hpp"

#include "collision/shapes/mesh.hpp"
#include "collision/shapes/obb_tree.hpp"
#include "collision/shapes/polytope.hpp"
#include "collision/shapes/rotation.hpp"
#include "collision/shapes/shape_forms.hpp"
#include "collision/vectors.hpp"
#include "kds/arithmetic/exact.hpp"
#include "kds/arithmetic/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <variant>
#include <vector>

namespace kds::collision {
namespace {

using certificates::LowestPlace;
using Eigen::Vector3d;

/// Heights of vertices, as doubles have them, are off by less than this part of the greatest magnitude: nine products
/// of three factors and their sums, of entries and coordinates that are at most 1 and at most that.
constexpr double roundings = 0x1p-48;

/// Keeps the vertices that may be the lowest.
class Lowest {
 public:
  Lowest(const PlacedShape& shape, double scale, std::span<const Vector3d> vertices, const Vector3d& normal,
         double margin)
      : shape_(shape), scale_(scale), vertices_(vertices), normal_(normal), margin_(margin) {}

  void take(std::uint32_t vertex) {
    const double height = dot(normal_, rotated(shape_.rotation, vertices_[vertex])) * scale_;
    if (height > least_ + margin_) return;
    least_ = std::min(least_, height);
    found_.emplace_back(height, vertex);
  }
  double least() const { return least_; }

  /// Those that may be no higher than the lowest by the margin, each once, by number.
  std::vector<std::uint32_t> vertices() const {
    std::vector<std::uint32_t> result;
    for (const auto& [height, vertex] : found_) {
      if (height <= least_ + margin_) result.push_back(vertex);
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

 private:
  const PlacedShape& shape_;
  double scale_;
  std::span<const Vector3d> vertices_;
  Vector3d normal_;
  double margin_, least_ = never;
  std::vector<std::pair<double, std::uint32_t>> found_;
};

/// Shows `lowest` all vertices of triangles that may be the lowest.
void look(const Mesh& mesh, const PlacedShape& shape, double scale, const Vector3d& normal, double margin,
          Lowest& lowest) {
  const ObbTree& tree = mesh.tree();
  const double unit = tree.unit() * scale;
  const Vector3d n = rotated_back(shape.rotation, normal);
  const auto bound = [&](const ObbNode& node) {
    double height = 0, size = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double along = 0;
      for (std::size_t d = 0; d < 3; ++d) {
        along += n[static_cast<Eigen::Index>(d)] * static_cast<double>(node.axes[d][axis]);
      }
      const double half = static_cast<double>(node.half_extents[axis]);
      const double centre = static_cast<double>(node.centre[axis]);
      height += n[static_cast<Eigen::Index>(axis)] * centre - half * std::abs(along);
      size += std::abs(centre) + half;
    }
    constexpr double of_floats = 0x1p-18;  // of axes that are orthonormal to some units of 2^-24
    return unit * (height - of_floats * size);
  };
  std::vector<std::pair<double, std::uint32_t>> waiting{{bound(tree.nodes()[0]), 0}};
  while (!waiting.empty()) {
    const auto [least, index] = waiting.back();
    waiting.pop_back();
    if (least > lowest.least() + margin) continue;
    const ObbNode& node = tree.nodes()[index];
    if (node.is_leaf()) {
      for (const LeafTriangle& triangle : tree.leaf_triangles().subspan(node.first, node.count)) {
        for (const std::uint32_t vertex : triangle.vertices) lowest.take(vertex);
      }
      continue;
    }
    const std::uint32_t left = node.first, right = node.first + 1;
    std::pair of_left{bound(tree.nodes()[left]), left}, of_right{bound(tree.nodes()[right]), right};
    if (of_left.first < of_right.first) std::swap(of_left, of_right);  // the lower comes next
    waiting.push_back(of_left), waiting.push_back(of_right);
  }
}

/// The vertices of a hull or a mesh that are lowest, up to a margin.
std::vector<std::uint32_t> lowest_vertices(const PlacedShape& shape, const Vector3d& normal, double margin) {
  if (const Polytope* const hull = polytope_of(shape.shape)) {
    Lowest lowest(shape, 1, hull->points(), normal, margin);
    for (const std::uint32_t i : hull->structure().corners) lowest.take(i);
    return lowest.vertices();
  }
  const auto& mesh = std::get<MeshShape>(shape.shape);
  Lowest lowest(shape, mesh.scale, mesh.mesh->vertices(), normal, margin);
  look(*mesh.mesh, shape, mesh.scale, normal, margin, lowest);
  return lowest.vertices();
}

}  // namespace

LowestOfShape::LowestOfShape(const PlacedShape& shape, const Vector3d& normal) {
  if (rounded_box_of(shape.shape)) {
    const RoundedCore core = placed_core(shape);
    place_.radius = core.radius;
    generators_ = core.generators;
  } else {
    const MeshShape surface = surface_of(shape.shape);
    const auto points = surface.mesh->vertices();
    place_.turn = shape.rotation;
    place_.scale = surface.scale;
    const auto vertices = lowest_vertices(shape, normal, 2 * roundings * shape.bounding_radius);
    place_.point = points[vertices.front()];
    Exact least = vertices.size() > 1 ? place_.height<Exact>(normal) : Exact(0.0);
    for (std::size_t i = 1; i < vertices.size(); ++i) {
      LowestPlace other = place_;
      other.point = points[vertices[i]];
      const Exact height = other.height<Exact>(normal);
      if ((least - height).sign() > 0) place_.point = other.point, least = height;
    }
  }
  place_.generators = {generators_.data(), generators_.size()};
  height_ = place_.height<Ball<double>>(normal).middle;
}

SupportingFeature lowest_feature(const PlacedShape& shape, const Vector3d& normal) {
  const auto* const mesh = std::get_if<MeshShape>(&shape.shape);
  if (!mesh) return supporting_feature(shape, -normal);
  const auto low = lowest_vertices(shape, normal, parallel_sine * shape.bounding_radius);
  const auto is_low = [&](std::uint32_t vertex) { return std::binary_search(low.begin(), low.end(), vertex); };
  SupportingFeature support{Feature::vertex(low.front()), {}};
  for (const std::uint32_t i : low) {
    support.vertices.push_back(placed_vertex(shape.rotation, mesh->scale, mesh->mesh->vertices()[i]));
  }
  if (low.size() == 1) return support;
  const auto triangles = mesh->mesh->triangles();
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const Mesh::Triangle& triangle = triangles[i];
    std::vector<std::uint32_t> of_triangle;
    std::copy_if(triangle.begin(), triangle.end(), std::back_inserter(of_triangle), is_low);
    if (of_triangle.size() == 3) {
      support.feature = Feature::face(i);
      break;
    }
    if (of_triangle.size() == 2 && support.feature.kind == Feature::Kind::vertex) {
      support.feature = Feature::edge(of_triangle[0], of_triangle[1]);
    }
  }
  return support;
}

}  // namespace kds::collision
