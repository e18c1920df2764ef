#include "collision/narrow_phase/shape_distance.hpp"

#include "collision/narrow_phase/convex_distance.hpp"
#include "collision/narrow_phase/part_groups.hpp"
#include "collision/shapes/rounded_core.hpp"
#include "collision/shapes/shape_kinds.hpp"
#include "collision/vectors.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace kds::collision {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A part of a shape as a tree of convex volumes: of one leaf for what is convex itself, that of its boxes for a mesh.
class Part {
 public:
  explicit Part(Convex convex) : convex_(std::move(convex)) {}
  Part(const MeshShape& shape, const Matrix3d& rotation, const Vector3d& centre)
      : mesh_(shape.mesh.get()), scale_(shape.scale), rotation_(rotation), centre_(centre) {}

  Convex volume(std::uint32_t node) const { return mesh_ ? box(mesh_->tree().nodes()[node]) : *convex_; }
  bool is_leaf(std::uint32_t node) const { return !mesh_ || mesh_->tree().nodes()[node].is_leaf(); }
  /// Of two that stand side by side. Precondition: not a leaf.
  std::uint32_t first_child(std::uint32_t node) const { return mesh_->tree().nodes()[node].first; }
  /// What is in a leaf.
  std::vector<Convex> contents(std::uint32_t leaf) const {
    if (!mesh_) return {*convex_};
    std::vector<Convex> triangles;
    const ObbNode& node = mesh_->tree().nodes()[leaf];
    for (const LeafTriangle& triangle : mesh_->tree().leaf_triangles().subspan(node.first, node.count)) {
      Convex::Corners corners;
      for (const std::uint32_t vertex : triangle.vertices) corners.push_back(placed(mesh_->vertices()[vertex]));
      triangles.emplace_back(std::move(corners));
    }
    return triangles;
  }

 private:
  Vector3d placed(const Vector3d& vertex) const { return centre_ + placed_vertex(rotation_, scale_, vertex); }

  Convex box(const ObbNode& node) const {
    Convex::Corners corners;
    for (unsigned signs = 0; signs < 8; ++signs) {
      Vector3d corner;
      for (std::size_t d = 0; d < 3; ++d) {
        double x = static_cast<double>(node.centre[d]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const double half = static_cast<double>(node.half_extents[axis]) * static_cast<double>(node.axes[d][axis]);
          x += (signs >> axis & 1) != 0 ? half : -half;
        }
        corner[static_cast<Eigen::Index>(d)] = mesh_->tree().unit() * x;
      }
      corners.push_back(placed(corner));
    }
    return Convex(std::move(corners));
  }

  std::optional<Convex> convex_{};
  const Mesh* mesh_ = nullptr;
  double scale_ = 1;
  Matrix3d rotation_ = Matrix3d::Identity();
  Vector3d centre_ = Vector3d::Zero();
};

/// Of a rounded box.
Convex rounded(const PlacedShape& shape, const Vector3d& centre) {
  const RoundedCore core = rounded_core(shape);
  Convex::Corners corners;
  for (unsigned signs = 0; signs < 1u << core.generators.size(); ++signs) {
    Vector3d corner = centre;
    for (std::size_t i = 0; i < core.generators.size(); ++i) {
      corner += ((signs >> i & 1) != 0 ? 1 : -1) * core.generators[i].length * core.generators[i].direction;
    }
    corners.push_back(corner);
  }
  return Convex(std::move(corners), core.radius);
}

/// What a part of a compound, or a shape that is none, is made of. Precondition: no half-space.
void add_parts(const PlacedShape& shape, const Vector3d& centre, double t, std::vector<Part>& parts) {
  const auto place_of = [&](const Vector3d& x) -> Vector3d { return centre + placed_vertex(shape.rotation, 1, x); };
  const auto of_box = [&](const RoundedBox&) { parts.emplace_back(rounded(shape, centre)); };
  const auto of_hull = [&](const Polytope& polytope) {
    Convex::Corners corners;
    for (const Vector3d& point : polytope.points()) corners.push_back(place_of(point));
    parts.emplace_back(Convex(std::move(corners)));
  };
  const auto of_mesh = [&](const MeshShape& mesh) { parts.emplace_back(mesh, shape.rotation, centre); };
  const auto of_bending_mesh = [&](const BendingMesh& mesh) {
    for (const Mesh::Triangle& triangle : mesh.script->triangles()) {
      Convex::Corners corners;
      for (const std::uint32_t vertex : triangle) corners.push_back(place_of(mesh.script->position(vertex, t)));
      parts.emplace_back(Convex(std::move(corners)));
    }
  };
  const auto of_compound = [](const Compound&) { throw std::logic_error("shape_distance: a compound in another"); };
  const auto of_half_space = [](const HalfSpace&) { throw std::logic_error("shape_distance: parts of a half-space"); };
  ask_form(shape.shape, ByForm{of_box, of_hull, of_mesh, of_bending_mesh, of_compound, of_half_space});
}

/// The parts of a shape about a centre in groups, each made when it is looked at.
class Parts {
 public:
  /// Of a mesh that bends, where it is at the time t.
  Parts(const PlacedShape& shape, const Vector3d& centre, double t)
      : groups_(shape), centre_(centre), t_(t), parts_(parts_of(shape).size()) {}

  const PartGroups& groups() const { return groups_; }
  std::array<Vector3d, 2> box(std::uint32_t group) const {
    auto [low, high] = groups_.box(group);
    return {low + centre_, high + centre_};
  }
  const std::vector<Part>& operator[](std::uint32_t i) {
    if (parts_[i].empty()) add_parts(parts_of(groups_.shape())[i], centre_, t_, parts_[i]);
    return parts_[i];
  }
  /// Of what a box is rounded by.
  double rounding() const { return 0x1p-40 * (groups_.shape().bounding_radius + norm(centre_)); }

 private:
  PartGroups groups_;
  Vector3d centre_;
  double t_;
  std::vector<std::vector<Part>> parts_;
};

/// Keeps the nearest points of many pairs of parts.
class NearestParts {
 public:
  /// Goes down the groups of both, the nearer boxes first.
  void take(Parts& a, Parts& b) {
    struct Groups {
      double bound;
      std::uint32_t of_a, of_b;
    };
    const auto groups = [&](std::uint32_t of_a, std::uint32_t of_b) {
      const auto [low_a, high_a] = a.box(of_a);
      const auto [low_b, high_b] = b.box(of_b);
      const Vector3d apart = (low_a - high_b).cwiseMax(low_b - high_a).cwiseMax(0);
      return Groups{norm(apart) - a.rounding() - b.rounding(), of_a, of_b};
    };
    const auto size = [](Parts& parts, std::uint32_t group) {
      const auto [low, high] = parts.groups().box(group);
      return parts.groups().is_leaf(group) ? -1 : squared_norm(high - low);
    };
    std::vector<Groups> waiting{groups(0, 0)};
    while (!waiting.empty()) {
      const Groups next = waiting.back();
      waiting.pop_back();
      if (too_far(next.bound)) continue;
      const std::uint32_t of_a = next.of_a, of_b = next.of_b;
      const double size_a = size(a, of_a), size_b = size(b, of_b);
      if (size_a < 0 && size_b < 0) {
        a.groups().each_part(of_a, [&](std::uint32_t i) {
          b.groups().each_part(of_b, [&](std::uint32_t j) {
            for (const Part& part_a : a[i]) {
              for (const Part& part_b : b[j]) take(part_a, part_b);
            }
          });
        });
        continue;
      }
      const bool divides_a = size_a >= size_b;
      const std::uint32_t first = divides_a ? a.groups().first_child(of_a) : b.groups().first_child(of_b);
      Groups left = divides_a ? groups(first, of_b) : groups(of_a, first);
      Groups right = divides_a ? groups(first + 1, of_b) : groups(of_a, first + 1);
      if (left.bound < right.bound) std::swap(left, right);  // the nearer comes next
      waiting.insert(waiting.end(), {left, right});
    }
  }

  /// Goes down both trees, the nearer boxes first.
  void take(const Part& a, const Part& b) {
    std::vector<Pair> waiting;
    add(waiting, {a.volume(0), b.volume(0), 0, 0, Vector3d::Zero()});
    while (!waiting.empty()) {
      const Pair pair = std::move(waiting.back());
      waiting.pop_back();
      if (too_far(pair.bound)) continue;
      const bool leaf_a = a.is_leaf(pair.of_a), leaf_b = b.is_leaf(pair.of_b);
      if (leaf_a && leaf_b) {
        for (const Convex& of_a : a.contents(pair.of_a)) {
          for (const Convex& of_b : b.contents(pair.of_b)) keep(distance_of(of_a, of_b));
        }
        continue;
      }
      const std::size_t known = waiting.size();
      if (leaf_b || (!leaf_a && pair.a.bounding_radius() > pair.b.bounding_radius())) {
        const std::uint32_t first = a.first_child(pair.of_a);
        for (std::uint32_t child = first; child < first + 2; ++child) {
          add(waiting, {a.volume(child), pair.b, child, pair.of_b, pair.way});
        }
      } else {
        const std::uint32_t first = b.first_child(pair.of_b);
        for (std::uint32_t child = first; child < first + 2; ++child) {
          add(waiting, {pair.a, b.volume(child), pair.of_a, child, pair.way});
        }
      }
      if (waiting.size() == known + 2 && waiting[known].bound < waiting[known + 1].bound) {
        std::swap(waiting[known], waiting[known + 1]);
      }
    }
  }
  const ShapeDistance& best() const { return best_; }

 private:
  struct Pair {
    Convex a, b;  ///< volumes of nodes
    std::uint32_t of_a, of_b;
    Vector3d way;      ///< between their nearest points; at first between those of the volumes around them
    double bound = 0;  ///< at most the distance of what is in them
  };

  void add(std::vector<Pair>& waiting, Pair pair) const {
    const double radii = pair.a.radius() + pair.b.radius();
    if (too_far(norm(pair.b.middle() - pair.a.middle()) - pair.a.bounding_radius() - pair.b.bounding_radius())) return;
    if (const double square = squared_norm(pair.way); square > 0) {  // a fifth faster than without
      const double apart = dot(pair.b.farthest(Vector3d(-pair.way)) - pair.a.farthest(pair.way), pair.way);
      if (too_far(apart / std::sqrt(square) - radii)) return;
    }
    const NearestToOrigin<ConvexDifference> nearest = nearest_of_cores(pair.a, pair.b);
    pair.way = nearest.point;
    pair.bound = nearest.bound - radii;
    if (!too_far(pair.bound)) waiting.push_back(std::move(pair));
  }
  bool too_far(double bound) const { return bound >= best_.distance || best_.distance == 0; }
  void keep(const ShapeDistance& found) {
    if (found.distance < best_.distance) best_ = found;
  }

  ShapeDistance best_{std::numeric_limits<double>::infinity(), Vector3d::Zero(), Vector3d::Zero()};
};

/// The lowest point of a part along a normal, and how high it is.
struct LowestOfParts {
  double height = std::numeric_limits<double>::infinity();
  Vector3d point = Vector3d::Zero();

  bool take(const Convex& convex, const Vector3d& normal) {
    const Vector3d& corner = convex.farthest(Vector3d(-normal));
    const double here = dot(corner, normal) - convex.radius();
    if (here >= height) return false;
    height = here;
    point = corner - convex.radius() * normal;
    return true;
  }
};

LowestOfParts lowest_of(const Part& part, const Vector3d& normal) {
  LowestOfParts lowest;
  std::vector<std::uint32_t> waiting{0};
  while (!waiting.empty()) {
    const std::uint32_t node = waiting.back();
    waiting.pop_back();
    if (LowestOfParts of_volume = lowest; !of_volume.take(part.volume(node), normal)) continue;
    if (part.is_leaf(node)) {
      for (const Convex& convex : part.contents(node)) lowest.take(convex, normal);
    } else {
      waiting.insert(waiting.end(), {part.first_child(node), part.first_child(node) + 1});
    }
  }
  return lowest;
}

/// Of a shape about the origin, b, from a half-space, a.
ShapeDistance distance_from_half_space(const HalfSpace& half_space, const PlacedShape& shape, double t) {
  Parts parts(shape, Vector3d::Zero(), t);
  const auto lowest_of_box = [&](std::uint32_t group) {
    const auto [low, high] = parts.box(group);
    const Vector3d& normal = half_space.normal;
    return dot(normal, 0.5 * (low + high)) - dot(normal.cwiseAbs(), 0.5 * (high - low)) - parts.rounding();
  };
  LowestOfParts lowest;
  std::vector<std::pair<double, std::uint32_t>> waiting{{lowest_of_box(0), 0}};
  while (!waiting.empty()) {
    const auto [height, group] = waiting.back();
    waiting.pop_back();
    if (!(height < lowest.height)) continue;
    if (parts.groups().is_leaf(group)) {
      parts.groups().each_part(group, [&](std::uint32_t i) {
        for (const Part& part : parts[i]) {
          if (const LowestOfParts of_part = lowest_of(part, half_space.normal); of_part.height < lowest.height)
            lowest = of_part;
        }
      });
      continue;
    }
    const std::uint32_t first = parts.groups().first_child(group);
    std::pair left{lowest_of_box(first), first}, right{lowest_of_box(first + 1), first + 1};
    if (left.first < right.first) std::swap(left, right);  // the lower comes next
    waiting.insert(waiting.end(), {left, right});
  }
  const double distance = std::max(0.0, lowest.height - half_space.offset);
  return {distance, lowest.point - distance * half_space.normal, lowest.point};
}

/// Of two half-spaces, as {x: normal . x <= offset}.
ShapeDistance distance_of_half_spaces(const HalfSpace& a, const HalfSpace& b) {
  const Vector3d across = cross(a.normal, b.normal);
  const double square = squared_norm(across);
  if (square > 0) {  // their planes meet in a line, of which this is the point that is nearest to the origin
    const Vector3d point = (a.offset * cross(b.normal, across) + b.offset * cross(across, a.normal)) / square;
    return {0, point, point};
  }
  if (dot(a.normal, b.normal) > 0) {
    const Vector3d point = std::min(a.offset, b.offset) * a.normal;
    return {0, point, point};
  }
  const double gap = -b.offset - a.offset;
  if (gap > 0) return {gap, a.offset * a.normal, b.offset * b.normal};
  return {0, a.offset * a.normal, a.offset * a.normal};
}

HalfSpace moved(HalfSpace half_space, const Vector3d& by) {
  half_space.offset += dot(half_space.normal, by);
  return half_space;
}

ShapeDistance swapped(const ShapeDistance& found) { return {found.distance, found.of_b, found.of_a}; }

}  // namespace

ShapeDistance shape_distance(const PlacedShape& a, const PlacedShape& b, const Vector3d& centre_of_b, double t) {
  if (unbounded(b.shape)) {
    const HalfSpace placed = moved(placed_half_space(b), centre_of_b);
    if (unbounded(a.shape)) return distance_of_half_spaces(placed_half_space(a), placed);
    return swapped(distance_from_half_space(placed, a, t));
  }
  if (unbounded(a.shape)) {
    ShapeDistance found = distance_from_half_space(moved(placed_half_space(a), -centre_of_b), b, t);
    found.of_a += centre_of_b;
    found.of_b += centre_of_b;
    return found;
  }
  Parts of_a(a, Vector3d::Zero(), t), of_b(b, centre_of_b, t);
  NearestParts nearest;
  nearest.take(of_a, of_b);
  return nearest.best();
}

}  // namespace kds::collision
