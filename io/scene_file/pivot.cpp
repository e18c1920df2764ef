#include "io/scene_file/pivot.hpp"

#include "collision/narrow_phase/convex_core.hpp"
#include "collision/shapes/shape_kinds.hpp"

#include <exception>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace kds::io {
namespace {

using namespace kds::collision;
using Eigen::Vector3d;

/// The corners of a box are numbered as in ConvexCore; of what is rounded no hull can be made.
std::optional<Shape> moved(const ConvexCore& core, const Vector3d& by) {
  if (core.radius() > 0) return std::nullopt;
  std::vector<Vector3d> points(core.points().begin(), core.points().end());
  for (Vector3d& x : points) x += by;
  return convex_hull(std::move(points));
}

Shape moved(const MeshShape& shape, const Vector3d& by) {
  std::vector<Vector3d> vertices;
  for (const Vector3d& v : shape.mesh->vertices()) vertices.emplace_back(shape.scale * v + by);
  const auto triangles = shape.mesh->triangles();
  return MeshShape{std::make_shared<const Mesh>(std::move(vertices),
                                                std::vector<Mesh::Triangle>(triangles.begin(), triangles.end()))};
}

Shape moved(const Compound& compound, const Vector3d& by) {
  auto parts = kds::collision::detail::points_of_parts(compound);
  for (auto& part : parts) {
    for (Vector3d& x : part.points) x += by;
  }
  return kds::collision::detail::compound_of_points(std::move(parts));
}

std::optional<Shape> moved(const Shape& shape, const Vector3d& by) {
  using Moved = std::optional<Shape>;
  const ByForm move{
      [&](const RoundedBox&) { return moved(ConvexCore(shape), by); },
      [&](const Polytope&) { return moved(ConvexCore(shape), by); },
      [&](const MeshShape& mesh) { return Moved(moved(mesh, by)); },
      [&](const Compound& compound) { return Moved(moved(compound, by)); },
      [&](const auto&) { return Moved(); },
  };
  return ask_form(shape, move);
}

}  // namespace

std::optional<Vector3d> read_pivot(const JsonNode& motion) {
  const std::vector<JsonNode> pieces = motion.elements();
  const auto of = [](const JsonNode& piece) {
    return piece.has("pivot") ? piece["pivot"].vector() : Vector3d(Vector3d::Zero());
  };
  const Vector3d pivot = of(pieces.front());
  for (const JsonNode& piece : pieces) {
    if (of(piece) == pivot) continue;
    (piece.has("pivot") ? piece["pivot"] : piece).fail("all pieces of a motion must have the same pivot");
  }
  return pivot.isZero(0) ? std::nullopt : std::optional(pivot);
}

Shape about_pivot(const Shape& shape, const Vector3d& pivot, const JsonNode& node) {
  std::optional<Shape> about;
  try {
    about = moved(shape, -pivot);
    if (about) place(*about, Eigen::Quaterniond::Identity());
  } catch (const std::exception& error) {
    node.fail(std::string("the shape cannot be placed about it: ") + error.what());
  }
  if (about) return *about;
  node.fail(std::string("a ") + kind_name(shape) +
            " turns about its centre alone: boxes, hulls, compounds and meshes may have a pivot");
}

}  // namespace kds::io
