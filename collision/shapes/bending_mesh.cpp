#include "collision/shapes/bending_mesh.hpp"

#include "collision/vectors.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <variant>

namespace kds::collision {
namespace {

using Keyframes = std::span<const MeshScript::Keyframe>;

/// Least and greatest direction . v of the vertices at some keyframes.
std::array<double, 2> ends_along(Keyframes keyframes, const Eigen::Matrix3d& rotation,
                                 const Eigen::Vector3d& direction) {
  std::array<double, 2> ends{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const auto& keyframe : keyframes) {
    for (const Eigen::Vector3d& v : keyframe.positions) {
      const double along = dot(direction, placed_vertex(rotation, 1, v));
      ends = {std::min(ends[0], along), std::max(ends[1], along)};
    }
  }
  return ends;
}

void put_bounds(Keyframes keyframes, const Eigen::Matrix3d& rotation, double margin, Eigen::Vector3d& low,
                Eigen::Vector3d& high) {
  for (int d = 0; d < 3; ++d) {
    const auto ends = ends_along(keyframes, rotation, Eigen::Vector3d::Unit(d));
    low[d] = ends[0] - margin;
    high[d] = ends[1] + margin;
  }
}

std::array<double, 2> extent_of(Keyframes keyframes, const Eigen::Matrix3d& rotation, double bounding_radius,
                                const Eigen::Vector3d& direction) {
  const double length = norm(direction) * (1 + detail::rotation_margin);
  const auto ends = ends_along(keyframes, rotation, direction);
  const double margin = (box_margin + detail::rotation_margin) * bounding_radius * length;
  return {ends[0] - margin, ends[1] + margin};
}

const MeshScript& script_of(const PlacedShape& placed) { return *std::get<BendingMesh>(placed.shape).script; }

/// Those between which t is, or the one after which or before which it is.
Keyframes keyframes_at(const MeshScript& script, double t) {
  const Keyframes all = script.keyframes();
  const std::size_t next = script.keyframes_until(t);
  const std::size_t first = next == 0 ? 0 : next - 1;
  return all.subspan(first, std::min(next + 1, all.size()) - first);
}

}  // namespace

BendingBounds bending_bounds(const PlacedShape& placed, const Eigen::Matrix3d& rotation, double t) {
  const MeshScript& script = script_of(placed);
  const std::size_t next = script.keyframes_until(t);
  BendingBounds bounds{{}, {}, std::numeric_limits<double>::infinity()};
  if (next < script.keyframes().size()) bounds.until = script.keyframes()[next].time;
  put_bounds(keyframes_at(script, t), rotation, box_margin * script.bounding_radius(), bounds.low, bounds.high);
  return bounds;
}

std::array<double, 2> bending_extent(const PlacedShape& placed, const Eigen::Matrix3d& rotation,
                                     const Eigen::Vector3d& direction, double t) {
  return extent_of(keyframes_at(script_of(placed), t), rotation, placed.bounding_radius, direction);
}

void detail::ShapeKind<BendingMesh>::place(const BendingMesh& shape, PlacedShape& placed) {
  if (!shape.script) throw std::invalid_argument("script: is missing");
  const double radius = shape.script->bounding_radius();
  require_size(radius, "script: the radius");
  put_bounds(shape.script->keyframes(), placed.rotation, box_margin * radius, placed.low, placed.high);
  placed.bounding_radius = radius * (1 + box_margin);
}

std::array<double, 2> detail::ShapeKind<BendingMesh>::extent(const BendingMesh& shape, const PlacedShape& placed,
                                                             const Eigen::Vector3d& direction) {
  return extent_of(shape.script->keyframes(), placed.rotation, placed.bounding_radius, direction);
}

}  // namespace kds::collision
