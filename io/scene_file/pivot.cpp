#include "io/scene_file/pivot.hpp"

#include "collision/shapes/compound.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/mesh.hpp"
#include "collision/shapes/polytope.hpp"

#include <exception>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace kds::io {
namespace {

using namespace kds::collision;
using Eigen::Vector3d;

/// Vertex i is on the positive side of axis d where bit d of i is set.
Shape moved(const Box& box, const Vector3d& by) {
  std::vector<Vector3d> corners;
  for (unsigned i = 0; i < 8; ++i) {
    Vector3d corner = box.half_extents;
    for (unsigned d = 0; d < 3; ++d) {
      if (!(i >> d & 1)) corner[static_cast<Eigen::Index>(d)] *= -1;
    }
    corners.push_back(corner + by);
  }
  return convex_hull(std::move(corners));
}

Shape moved(const ConvexHull& hull, const Vector3d& by) {
  std::vector<Vector3d> points(hull.polytope->points().begin(), hull.polytope->points().end());
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

template <class Other>
std::optional<Shape> moved(const Other&, const Vector3d&) {
  return std::nullopt;
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
    about = std::visit([&](const auto& each) { return std::optional<Shape>(moved(each, -pivot)); }, shape);
    if (about) place(*about, Eigen::Quaterniond::Identity());
  } catch (const std::exception& error) {
    node.fail(std::string("the shape cannot be placed about it: ") + error.what());
  }
  if (about) return *about;
  node.fail(std::string("a ") + kind_name(shape) +
            " turns about its centre alone: boxes, hulls, compounds and meshes may have a pivot");
}

}  // namespace kds::io
