#include "io/pictures/compound_surface.hpp"

#include "collision/shapes/compound.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

namespace kds::io {
namespace {

using kds::collision::Compound;
using kds::collision::Mesh;

std::shared_ptr<const Mesh> surface_of(const Compound& compound) {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Mesh::Triangle> triangles;
  for (const kds::collision::Shape& part : compound.parts->parts()) {
    const Mesh& surface = *kds::collision::surface_of(part).mesh;
    const auto first = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), surface.vertices().begin(), surface.vertices().end());
    for (const auto& [a, b, c] : surface.triangles()) triangles.push_back({first + a, first + b, first + c});
  }
  return std::make_shared<const Mesh>(std::move(vertices), std::move(triangles));
}

}  // namespace

bool has_compounds(const Scene& scene) {
  return std::any_of(scene.bodies.begin(), scene.bodies.end(),
                     [](const SceneBody& body) { return std::holds_alternative<Compound>(body.shape); });
}

Scene with_surfaces(const Scene& scene) {
  Scene drawn = scene;
  std::map<const void*, std::shared_ptr<const Mesh>> surfaces;
  for (SceneBody& body : drawn.bodies) {
    const auto* const compound = std::get_if<Compound>(&body.shape);
    if (!compound) continue;
    std::shared_ptr<const Mesh>& surface = surfaces[compound->parts.get()];
    if (!surface) surface = surface_of(*compound);
    body.shape = kds::collision::MeshShape{surface};
  }
  return drawn;
}

}  // namespace kds::io
