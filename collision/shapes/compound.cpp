#include "collision/shapes/compound.hpp"

#include "collision/shapes/mesh_shape.hpp"
#include "collision/shapes/part_tree.hpp"
#include "collision/vectors.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <variant>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

/// The eight corners of a placed box, numbered as those of a box.
std::vector<Vector3d> corners_of(const PlacedShape& box) {
  std::vector<Vector3d> corners;
  for (unsigned i = 0; i < 8; ++i) {
    Vector3d corner = Vector3d::Zero();
    for (std::size_t d = 0; d < 3; ++d) corner += (i >> d & 1 ? 1.0 : -1.0) * box.half_axes[d];
    corners.push_back(corner);
  }
  return corners;
}

void move_by(std::vector<Vector3d>& points, const Vector3d& way) {
  for (Vector3d& point : points) point += way;
}

/// The hull or mesh that a part is in the body.
Shape in_place(const CompoundPart& part) {
  const PlacedShape placed = place(part.shape, part.orientation);
  if (const auto* const mesh = std::get_if<MeshShape>(&part.shape)) {
    std::vector<Vector3d> vertices = mesh->mesh->placed_vertices(placed.rotation, mesh->scale);
    move_by(vertices, part.position);
    const auto triangles = mesh->mesh->triangles();
    return MeshShape{std::make_shared<const Mesh>(std::move(vertices),
                                                  std::vector<Mesh::Triangle>(triangles.begin(), triangles.end()))};
  }
  std::vector<Vector3d> points;
  if (const auto* const hull = std::get_if<ConvexHull>(&part.shape)) {
    for (const Vector3d& point : hull->polytope->points()) points.push_back(placed_vertex(placed.rotation, 1, point));
  } else {
    points = corners_of(placed);
  }
  move_by(points, part.position);
  return convex_hull(std::move(points));
}

bool may_be_part(const Shape& shape) {
  return std::holds_alternative<Box>(shape) || std::holds_alternative<ConvexHull>(shape) ||
         std::holds_alternative<MeshShape>(shape);
}

[[noreturn]] void refuse_kind(std::size_t part, const Shape& shape, const char* kinds) {
  throw InvalidCompound(std::string("is a ") + kind_name(shape) + "; parts are " + kinds, part);
}

}  // namespace

CompoundParts::CompoundParts(std::vector<Shape> parts) : parts_(std::move(parts)) {
  if (parts_.empty()) throw InvalidCompound("has no parts");
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Shape& part = parts_[i];
    const auto* const mesh = std::get_if<MeshShape>(&part);
    if (!mesh && !std::holds_alternative<ConvexHull>(part)) refuse_kind(i, part, "hulls and meshes");
    if (mesh && mesh->scale != 1) throw InvalidCompound("scale: must be 1", i);
    has_mesh_ = has_mesh_ || mesh;
  }
  if (parts_.size() > PartTree::leaf_size) tree_ = std::make_shared<const PartTree>(parts_);
}

PartTree::PartTree(std::span<const Shape> parts) {
  std::vector<PlacedShape> placed;
  placed.reserve(parts.size());
  for (const Shape& part : parts) {
    try {
      placed.push_back(place_turned(part, Eigen::Matrix3d::Identity()));
    } catch (const std::invalid_argument& error) {
      throw InvalidCompound(error.what(), placed.size());
    }
  }
  order_.resize(parts.size());
  std::iota(order_.begin(), order_.end(), 0);
  build(placed);
}

void PartTree::build(std::span<const PlacedShape> parts) {
  const auto around = [&](std::uint32_t first, std::uint32_t count) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    constexpr double rounded_up = 1 + 0x1p-40;
    Node node{Vector3d::Constant(infinity), Vector3d::Constant(-infinity), Vector3d::Zero(), 0, 0, first, count};
    const std::span<const std::uint32_t> group(order_.data() + first, count);
    for (const std::uint32_t i : group) {
      node.low = node.low.cwiseMin(parts[i].low);
      node.high = node.high.cwiseMax(parts[i].high);
    }
    node.centre = 0.5 * (node.low + node.high);
    for (const std::uint32_t i : group) {
      const BallOfPart ball(parts[i]);
      node.radius = std::max(node.radius, (norm(ball.centre - node.centre) + ball.radius) * rounded_up);
      node.reach = std::max(node.reach, norm(ball.centre) * rounded_up);
    }
    return node;
  };
  nodes_.push_back(around(0, static_cast<std::uint32_t>(order_.size())));
  for (std::size_t at = 0; at < nodes_.size(); ++at) {  // those that follow are its children's
    const auto [first, count] = std::pair(nodes_[at].first, nodes_[at].count);
    const auto begin = order_.begin() + first, end = begin + count;
    if (count <= leaf_size) {
      std::sort(begin, end);
      continue;
    }
    const auto centre = [&](std::uint32_t i) -> Vector3d { return parts[i].low + parts[i].high; };
    Vector3d low = centre(*begin), high = low;
    std::for_each(begin, end, [&](std::uint32_t i) { low = low.cwiseMin(centre(i)), high = high.cwiseMax(centre(i)); });
    Eigen::Index axis = 0;
    (high - low).maxCoeff(&axis);
    const std::uint32_t half = count / 2;
    std::nth_element(begin, begin + half, end, [&](std::uint32_t i, std::uint32_t j) {
      const double x = centre(i)[axis], y = centre(j)[axis];
      return x != y ? x < y : i < j;
    });
    nodes_[at].first = static_cast<std::uint32_t>(nodes_.size());
    nodes_[at].count = 0;
    nodes_.push_back(around(first, half));
    nodes_.push_back(around(first + half, count - half));
  }
}

Compound compound(std::span<const CompoundPart> parts) {
  std::vector<Shape> placed;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!may_be_part(parts[i].shape)) refuse_kind(i, parts[i].shape, "boxes, hulls and meshes");
    if (!parts[i].position.allFinite()) throw InvalidCompound("position: must be finite", i);
    try {
      placed.push_back(in_place(parts[i]));
      place(placed.back(), Eigen::Quaterniond::Identity());
    } catch (const std::invalid_argument& error) {
      throw InvalidCompound(error.what(), i);
    }
  }
  return {std::make_shared<const CompoundParts>(std::move(placed))};
}

namespace detail {

void place_parts(PlacedShape& placed) {
  placed.parts = nullptr;
  const auto* const compound = std::get_if<Compound>(&placed.shape);
  if (!compound) return;
  try {
    placed.parts = place_turned(placed.shape, placed.rotation).parts;
  } catch (const std::invalid_argument&) {
  }
}

bool same_parts(const PlacedShape& a, const PlacedShape& b) {
  if (!a.parts || !b.parts) return !a.parts && !b.parts;
  const auto same = [](const PlacedShape& x, const PlacedShape& y) {
    return x.shape.index() == y.shape.index() && x.rotation == y.rotation && x.low == y.low && x.high == y.high;
  };
  return std::equal(a.parts->begin(), a.parts->end(), b.parts->begin(), b.parts->end(), same);
}

void ShapeKind<Compound>::place(const Compound& compound, PlacedShape& placed) {
  if (!compound.parts) throw std::invalid_argument("compound: is missing");
  std::vector<PlacedShape> parts;
  placed.low.setConstant(std::numeric_limits<double>::infinity());
  placed.high = -placed.low;
  placed.bounding_radius = 0;
  for (const Shape& shape : compound.parts->parts()) {
    try {
      parts.push_back(place_turned(shape, placed.rotation));
    } catch (const std::invalid_argument& error) {
      throw InvalidCompound(error.what(), parts.size());
    }
    const PlacedShape& part = parts.back();
    placed.low = placed.low.cwiseMin(part.low);
    placed.high = placed.high.cwiseMax(part.high);
    placed.bounding_radius = std::max(placed.bounding_radius, part.bounding_radius);
  }
  if (compound.parts->has_mesh()) grow(placed, box_margin * placed.bounding_radius);
  placed.parts = std::make_shared<const std::vector<PlacedShape>>(std::move(parts));
}

std::array<double, 2> ShapeKind<Compound>::extent(const Compound& compound, const PlacedShape& placed,
                                                  const Vector3d& direction) {
  std::array<double, 2> ends{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const PlacedShape& part : *placed.parts) {
    const std::array<double, 2> of_part = collision::extent(part, direction);
    ends = {std::min(ends[0], of_part[0]), std::max(ends[1], of_part[1])};
  }
  if (!compound.parts->has_mesh()) return ends;
  const double margin = (box_margin + rotation_margin) * placed.bounding_radius * norm(direction);
  return {ends[0] - margin, ends[1] + margin};
}

std::vector<PartPoints> points_of_parts(const Compound& compound) {
  std::vector<PartPoints> parts;
  for (const Shape& shape : compound.parts->parts()) {
    PartPoints& part = parts.emplace_back();
    if (const auto* const hull = std::get_if<ConvexHull>(&shape)) {
      part.points.assign(hull->polytope->points().begin(), hull->polytope->points().end());
    } else {
      const Mesh& mesh = *std::get<MeshShape>(shape).mesh;
      part.points.assign(mesh.vertices().begin(), mesh.vertices().end());
      part.triangles.assign(mesh.triangles().begin(), mesh.triangles().end());
    }
  }
  return parts;
}

Compound compound_of_points(std::vector<PartPoints> parts) {
  std::vector<Shape> shapes;
  try {
    for (PartPoints& part : parts) {
      if (part.triangles.empty()) {
        shapes.push_back(convex_hull(std::move(part.points)));
      } else {
        shapes.push_back(MeshShape{std::make_shared<const Mesh>(std::move(part.points), std::move(part.triangles))});
      }
    }
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error("snapshot: a compound: part " + std::to_string(shapes.size()) + ": " + error.what());
  }
  try {
    return {std::make_shared<const CompoundParts>(std::move(shapes))};
  } catch (const InvalidCompound& error) {
    throw std::runtime_error(std::string("snapshot: a ") + error.what());
  }
}

}  // namespace detail

}  // namespace kds::collision
