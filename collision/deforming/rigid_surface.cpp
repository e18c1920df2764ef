#include "collision/deforming/rigid_surface.hpp"

#include "collision/shapes/polytope.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

/// The faces of a box in the order and with the vertices of Feature, two triangles each, wound outward; the diagonals
/// are from the first to the third corner.
constexpr std::array<std::array<std::uint32_t, 4>, 6> box_faces{
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

/// A mesh, or a hull, whose surface is one.
bool is_surface(const Shape& shape) {
  return std::holds_alternative<MeshShape>(shape) || std::holds_alternative<ConvexHull>(shape);
}

std::vector<Vector3d> offsets_of(const PlacedShape& shape) {
  if (is_surface(shape.shape)) {
    const MeshShape mesh = surface_of(shape.shape);
    return mesh.mesh->placed_vertices(shape.rotation, mesh.scale);
  }
  if (std::holds_alternative<Sphere>(shape.shape)) return {Vector3d::Zero()};
  if (const auto* const capsule = std::get_if<Capsule>(&shape.shape)) {
    const Vector3d half = shape.rotation.col(2) * capsule->half_length;
    return {-half, half};
  }
  if (!std::holds_alternative<Box>(shape.shape)) {
    throw std::invalid_argument(std::string("RigidSurface: a ") + kind_name(shape.shape) +
                                " cannot meet a mesh that bends");
  }
  std::vector<Vector3d> corners;
  for (unsigned i = 0; i < 8; ++i) {
    Vector3d corner = Vector3d::Zero();
    for (unsigned d = 0; d < 3; ++d) {
      corner += i >> d & 1 ? shape.half_axes[d] : Vector3d(-shape.half_axes[d]);
    }
    corners.push_back(corner);
  }
  return corners;
}

/// That of a mesh stays with it.
std::shared_ptr<const SurfaceTree> tree_of(const PlacedShape& shape, const std::vector<Vector3d>& offsets) {
  if (is_surface(shape.shape)) {
    const auto mesh = surface_of(shape.shape).mesh;
    return {mesh, &mesh->surface_tree()};
  }
  const auto made = [](SurfaceTree tree) { return std::make_shared<const SurfaceTree>(std::move(tree)); };
  if (std::holds_alternative<Sphere>(shape.shape)) return made(SurfaceTree::point());
  if (std::holds_alternative<Capsule>(shape.shape)) return made(SurfaceTree::segment());
  std::vector<Mesh::Triangle> triangles;
  for (const auto& [a, b, c, d] : box_faces) {
    triangles.push_back({a, b, c});
    triangles.push_back({a, c, d});
  }
  SurfaceTree tree(offsets, triangles);
  tree.join_pairs_of_triangles();
  return made(std::move(tree));
}

}  // namespace

template <int Degree>
RigidSurface<Degree>::RigidSurface(const PlacedShape& shape)
    : offsets_(offsets_of(shape)), tree_(tree_of(shape, offsets_)), surface_(*tree_) {
  if (const auto* const ball = std::get_if<Sphere>(&shape.shape)) surface_.set_radius(ball->radius);
  if (const auto* const capsule = std::get_if<Capsule>(&shape.shape)) surface_.set_radius(capsule->radius);
  if (std::holds_alternative<Box>(shape.shape) || std::holds_alternative<ConvexHull>(shape.shape)) surface_.set_solid();
}

template <int Degree>
void RigidSurface<Degree>::move(const certificates::PointMotion<Degree>& path, double t0, double t1) {
  const PathControls<Degree> controls(path, t0, t1);
  double farthest = 0;
  for (std::size_t i = 0; i <= Degree; ++i) {
    const auto points = surface_.change_control_points(i);
    for (std::size_t k = 0; k < offsets_.size(); ++k) {
      points[k] = controls.points[i] + offsets_[k];
      farthest = std::max(farthest, points[k].cwiseAbs().maxCoeff());
    }
  }
  surface_.set_uncertainty(controls.error + 0x1p-53 * farthest);
  surface_.refit(t0, t1);
}

template class RigidSurface<1>;
template class RigidSurface<2>;

}  // namespace kds::collision
