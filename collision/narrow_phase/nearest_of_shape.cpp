#include "collision/narrow_phase/nearest_of_shape.hpp"

#include "collision/narrow_phase/nearest_point.hpp"
#include "collision/narrow_phase/part_groups.hpp"
#include "collision/shapes/shape_forms.hpp"
#include "collision/shapes/shape_kinds.hpp"
#include "collision/vectors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace kds::collision {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

NearestOfShape found(const Vector3d& point, const Vector3d& to) { return {norm(point - to), point}; }

/// Nearest of what is no farther than a radius from a point that is itself nearest of a core.
NearestOfShape grown(const Vector3d& of_core, double radius, const Vector3d& to) {
  const Vector3d way = to - of_core;
  const double distance = norm(way);
  if (distance <= radius) return {0, to};
  return {distance - radius, of_core + (radius / distance) * way};
}

NearestOfShape nearest_of_rounded_box(const RoundedCore& box, const Vector3d& to) {
  Vector3d point = Vector3d::Zero();
  bool inside = box.generators.size() == 3;
  for (const auto& each : box.generators) {
    const Vector3d half = each.length * each.direction;
    const double part = dot(to, half) / squared_norm(half);
    inside = inside && std::abs(part) <= 1;
    point += std::clamp(part, -1.0, 1.0) * half;
  }
  return inside ? NearestOfShape{0, to} : grown(point, box.radius, to);
}

/// Keeps the nearest of many.
class Nearest {
 public:
  explicit Nearest(const Vector3d& to) : to_(to) {}

  void take(const PlacedTriangle& triangle) {
    const NearestOfShape of_triangle = found(nearest_point(triangle, to_).point, to_);
    if (of_triangle.distance < best_.distance) best_ = of_triangle;
  }
  const NearestOfShape& best() const { return best_; }

 private:
  Vector3d to_;
  NearestOfShape best_{std::numeric_limits<double>::infinity(), Vector3d::Zero()};
};

NearestOfShape nearest_of_hull(const Polytope& hull, const Matrix3d& rotation, const Vector3d& to) {
  const Vector3d local = rotation.transpose() * to;
  const auto points = hull.points();
  Nearest nearest(to);
  bool inside = true;
  for (const std::vector<std::uint32_t>& face : hull.structure().faces) {
    if (side_of_plane(points[face[0]], points[face[1]], points[face[2]], local) <= 0) continue;
    inside = false;  // and the nearest point is on a face that sees it
    for (std::size_t i = 2; i < face.size(); ++i) {
      nearest.take({{placed_vertex(rotation, 1, points[face[0]]), placed_vertex(rotation, 1, points[face[i - 1]]),
                     placed_vertex(rotation, 1, points[face[i]])}});
    }
  }
  return inside ? NearestOfShape{0, to} : nearest.best();
}

/// At most the distance of a point, in the coordinates of the tree, from what is in a node.
double least_distance(const ObbNode& node, const Vector3d& point) {
  double square = 0, size = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double along = 0;
    for (std::size_t d = 0; d < 3; ++d) {
      const double difference = point[static_cast<Eigen::Index>(d)] - static_cast<double>(node.centre[d]);
      along += difference * static_cast<double>(node.axes[d][axis]);
      size += std::abs(difference);
    }
    const double beyond = std::max(0.0, std::abs(along) - static_cast<double>(node.half_extents[axis]));
    square += beyond * beyond;
  }
  constexpr double roundings = 0x1p-18;  // of axes in floats, which are orthonormal to some units of 2^-24
  return std::sqrt(square) - roundings * size;
}

NearestOfShape nearest_of_mesh(const MeshShape& shape, const Matrix3d& rotation, const Vector3d& to) {
  const ObbTree& tree = shape.mesh->tree();
  const double unit = tree.unit() * shape.scale;
  const Vector3d local = (rotation.transpose() * to) / unit;
  const auto bound = [&](std::uint32_t node) { return unit * least_distance(tree.nodes()[node], local); };
  Nearest nearest(to);
  std::vector<std::pair<double, std::uint32_t>> waiting{{bound(0), 0}};
  while (!waiting.empty()) {
    const auto [least, index] = waiting.back();
    waiting.pop_back();
    if (least > nearest.best().distance) continue;
    const ObbNode& node = tree.nodes()[index];
    if (node.is_leaf()) {
      for (const LeafTriangle& triangle : tree.leaf_triangles().subspan(node.first, node.count)) {
        PlacedTriangle placed;
        for (std::size_t i = 0; i < 3; ++i) {
          placed.vertices[i] = placed_vertex(rotation, shape.scale, shape.mesh->vertices()[triangle.vertices[i]]);
        }
        nearest.take(placed);
      }
      continue;
    }
    std::array<std::pair<double, std::uint32_t>, 2> children{
        {{bound(node.first), node.first}, {bound(node.first + 1), node.first + 1}}};
    if (children[0].first < children[1].first) std::swap(children[0], children[1]);  // the nearer comes next
    waiting.insert(waiting.end(), children.begin(), children.end());
  }
  return nearest.best();
}

NearestOfShape nearest_of_half_space(const HalfSpace& placed, const Vector3d& to) {
  const double above = dot(placed.normal, to) - placed.offset;
  return above > 0 ? NearestOfShape{above, to - above * placed.normal} : NearestOfShape{0, to};
}

NearestOfShape nearest_of_bending_mesh(const MeshScript& script, const Matrix3d& rotation, const Vector3d& to,
                                       double t) {
  Nearest nearest(to);
  for (const Mesh::Triangle& triangle : script.triangles()) {
    PlacedTriangle placed;
    for (std::size_t i = 0; i < 3; ++i)
      placed.vertices[i] = placed_vertex(rotation, 1, script.position(triangle[i], t));
    nearest.take(placed);
  }
  return nearest.best();
}

/// The first of parts that are as near.
NearestOfShape nearest_of_parts(const PlacedShape& shape, const Vector3d& to) {
  const std::span<const PlacedShape> parts = parts_of(shape);
  const PartGroups groups(shape);
  const double rounding = 0x1p-40 * (shape.bounding_radius + norm(to));
  const auto bound = [&](std::uint32_t group) {
    const auto [low, high] = groups.box(group);
    return norm(to - to.cwiseMax(low).cwiseMin(high)) - rounding;
  };
  NearestOfShape nearest{std::numeric_limits<double>::infinity(), Vector3d::Zero()};
  std::uint32_t number = 0;
  std::vector<std::pair<double, std::uint32_t>> waiting{{bound(0), 0}};
  while (!waiting.empty()) {
    const auto [least, group] = waiting.back();
    waiting.pop_back();
    if (least > nearest.distance) continue;
    if (groups.is_leaf(group)) {
      groups.each_part(group, [&](std::uint32_t i) {
        const NearestOfShape of_part = nearest_of_shape(parts[i], to);
        if (of_part.distance > nearest.distance || (of_part.distance == nearest.distance && i > number)) return;
        nearest = of_part;
        number = i;
      });
      continue;
    }
    const std::uint32_t first = groups.first_child(group);
    std::array<std::pair<double, std::uint32_t>, 2> children{{{bound(first), first}, {bound(first + 1), first + 1}}};
    if (children[0].first < children[1].first) std::swap(children[0], children[1]);  // the nearer comes next
    waiting.insert(waiting.end(), children.begin(), children.end());
  }
  return nearest;
}

}  // namespace

NearestOfShape nearest_of_shape(const PlacedShape& shape, const Vector3d& to, double t) {
  const Matrix3d& rotation = shape.rotation;
  const ByForm nearest{
      [&](const RoundedBox&) { return nearest_of_rounded_box(placed_core(shape), to); },
      [&](const Polytope& polytope) { return nearest_of_hull(polytope, rotation, to); },
      [&](const MeshShape& mesh) { return nearest_of_mesh(mesh, rotation, to); },
      [&](const BendingMesh& mesh) { return nearest_of_bending_mesh(*mesh.script, rotation, to, t); },
      [&](const HalfSpace&) { return nearest_of_half_space(placed_half_space(shape), to); },
      [&](const Compound&) { return nearest_of_parts(shape, to); },
  };
  return ask_form(shape.shape, nearest);
}

}  // namespace kds::collision
