#include "collision/deforming/rigid_surface.hpp"

#include "collision/shapes/polytope.hpp"
#include "collision/shapes/shape_forms.hpp"
#include "collision/vectors.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

namespace kds::collision {
namespace {

using Eigen::Vector3d;

/// The faces of a box in the order and with the vertices of Feature, two triangles each, wound outward; the diagonals
/// are from the first to the third corner.
constexpr std::array<std::array<std::uint32_t, 4>, 6> box_faces{
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

[[noreturn]] void refuse(const Shape& shape) {
  throw std::invalid_argument(std::string("RigidSurface: a ") + kind_name(shape) + " cannot meet a mesh that bends");
}

/// Of a rounded box: the ends of its generators, in all combinations.
std::vector<Vector3d> corners_of(const RoundedCore& core) {
  std::vector<Vector3d> corners;
  for (unsigned i = 0; i < 1u << core.generators.size(); ++i) {
    Vector3d corner = Vector3d::Zero();
    for (unsigned d = 0; d < core.generators.size(); ++d) {
      const Vector3d half = core.generators[d].length * core.generators[d].direction;
      corner += i >> d & 1 ? half : Vector3d(-half);
    }
    corners.push_back(corner);
  }
  return corners;
}

std::vector<Vector3d> offsets_of(const PlacedShape& shape) {
  if (rounded_box_of(shape.shape)) return corners_of(placed_core(shape));
  if (!triangles_of(shape.shape)) refuse(shape.shape);
  const MeshShape mesh = surface_of(shape.shape);
  return mesh.mesh->placed_vertices(shape.rotation, mesh.scale);
}

/// The mesh keeps its own tree; those of rounded boxes are made here.
std::shared_ptr<const SurfaceTree> tree_of(const PlacedShape& shape, const std::vector<Vector3d>& offsets) {
  if (const auto mesh = triangles_of(shape.shape)) return {mesh, &mesh->surface_tree()};
  const auto made = [](SurfaceTree tree) { return std::make_shared<const SurfaceTree>(std::move(tree)); };
  if (offsets.size() == 1) return made(SurfaceTree::point());
  if (offsets.size() == 2) return made(SurfaceTree::segment());
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
  const auto box = rounded_box_of(shape.shape);
  if (box) surface_.set_radius(box->radius);
  if (box ? box->dimension() == 3 : polytope_of(shape.shape) != nullptr) surface_.set_solid();
  for (const Vector3d& offset : offsets_) vertex_radius_ = std::max(vertex_radius_, norm(offset));
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

/// A coordinate f(t) of a vertex is replaced by the parabola with the values f(t0) and f(t1) and the derivative f'(t0).
/// The difference is t^2 (t - h) / 6 times a third derivative, t from t0 on and h = t1 - t0: at most 2 / 81 h^3 times
/// |W|^3 r, as what the turning adds to f is of length r, and each derivative multiplies that by |W| at most.
template <int Degree>
template <int PathDegree>
void RigidSurface<Degree>::move(const certificates::RigidMotion<PathDegree>& motion, double t0, double t1) {
  static_assert(Degree == 2, "what turns moves on parabolas");
  const PathControls<PathDegree> path(motion.path, t0, t1);
  const auto origin = path.of_parabola();
  const Vector3d half_turn = 0.5 * (t1 - t0) * motion.angular_velocity;
  const auto begin = motion.rotation(t0), end = motion.rotation(t1);
  const std::array<std::span<Vector3d>, 3> points{surface_.change_control_points(0), surface_.change_control_points(1),
                                                  surface_.change_control_points(2)};
  double farthest = 0;
  for (std::size_t k = 0; k < offsets_.size(); ++k) {
    const Vector3d at_begin = begin(offsets_[k]);
    points[0][k] = origin[0] + at_begin;
    points[1][k] = origin[1] + (at_begin + cross(half_turn, at_begin));
    points[2][k] = origin[2] + end(offsets_[k]);
    for (std::size_t i = 0; i < 3; ++i) farthest = std::max(farthest, points[i][k].cwiseAbs().maxCoeff());
  }
  const double angle = norm(motion.angular_velocity) * (t1 - t0);
  const double turned = 2.0 / 81 * angle * angle * angle * vertex_radius_;
  // A rotation errs by its bound times the sum of the coordinates, at most twice the length; the middle point has that
  // of the first one, once more times half of the angle. Sums are rounded, and so is what is said of the angle.
  const double rotation = std::max(begin.error(), end.error()) * 2 * vertex_radius_;
  surface_.set_uncertainty(path.error +
                           (turned + (1 + angle) * (rotation + 0x1p-50 * (farthest + vertex_radius_))) * (1 + 0x1p-40));
  surface_.refit(t0, t1);
}

template class RigidSurface<1>;
template class RigidSurface<2>;
template void RigidSurface<2>::move(const certificates::RigidMotion<1>&, double, double);
template void RigidSurface<2>::move(const certificates::RigidMotion<2>&, double, double);

}  // namespace kds::collision
