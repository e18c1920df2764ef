#include "io/scene_file/pivot.hpp"

#include "collision/shapes/mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace kds::io {
namespace {

using Eigen::Vector3d;
using kds::collision::Mesh;

struct Surface {
  std::vector<Vector3d> vertices;
  std::vector<Mesh::Triangle> triangles;
};

/// Vertex i is on the positive side of axis d where bit d of i is set.
Surface surface_of(const kds::collision::Box& box) {
  Surface surface;
  for (unsigned i = 0; i < 8; ++i) {
    Vector3d corner;
    for (unsigned d = 0; d < 3; ++d) {
      const double half = box.half_extents[static_cast<Eigen::Index>(d)];
      corner[static_cast<Eigen::Index>(d)] = i >> d & 1 ? half : -half;
    }
    surface.vertices.push_back(corner);
  }
  for (std::uint32_t d = 0; d < 3; ++d) {
    const std::uint32_t u = 1u << (d + 1) % 3, v = 1u << (d + 2) % 3, far = 1u << d;
    surface.triangles.insert(surface.triangles.end(), {{0, v, u | v}, {0, u | v, u}});  // counterclockwise from outside
    surface.triangles.insert(surface.triangles.end(), {{far, far | u, far | u | v}, {far, far | u | v, far | v}});
  }
  return surface;
}

Surface surface_of(const kds::collision::MeshShape& shape) {
  Surface surface;
  for (const Vector3d& v : shape.mesh->vertices()) surface.vertices.push_back(shape.scale * v);
  surface.triangles.assign(shape.mesh->triangles().begin(), shape.mesh->triangles().end());
  return surface;
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

kds::collision::Shape about_pivot(const kds::collision::Shape& shape, const Vector3d& pivot, const JsonNode& node) {
  Surface surface;
  if (const auto* box = std::get_if<kds::collision::Box>(&shape)) {
    surface = surface_of(*box);
  } else if (const auto* mesh = std::get_if<kds::collision::MeshShape>(&shape)) {
    surface = surface_of(*mesh);
  } else {
    node.fail(std::string("a ") + kind_name(shape) +
              " turns about its centre alone: boxes and meshes may have a pivot");
  }
  for (Vector3d& v : surface.vertices) v -= pivot;
  try {
    return kds::collision::MeshShape{
        std::make_shared<const Mesh>(std::move(surface.vertices), std::move(surface.triangles))};
  } catch (const kds::collision::InvalidMesh& error) {
    node.fail(std::string("the shape, placed about it, is no mesh: ") + error.what());
  }
}

}  // namespace kds::io
