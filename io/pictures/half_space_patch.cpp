#include "io/pictures/half_space_patch.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <memory>
#include <variant>
#include <vector>

namespace kds::io {
namespace {

using Eigen::Vector3d;
using kds::collision::HalfSpace;

/// A box around all that has bounds.
Eigen::AlignedBox3d surroundings(const Scene& scene) {
  Eigen::AlignedBox3d box;
  if (scene.domain) box.extend(scene.domain->min), box.extend(scene.domain->max);
  for (const SceneBody& body : scene.bodies) {
    if (kds::collision::unbounded(body.shape)) continue;
    const double radius = kds::collision::place(body.shape, body.orientation).bounding_radius;
    const Vector3d at = body.motion.front().path.coefficients[0];
    box.extend(at - Vector3d::Constant(radius));
    box.extend(at + Vector3d::Constant(radius));
  }
  if (box.isEmpty()) box.extend(Vector3d::Constant(-1)), box.extend(Vector3d::Constant(1));
  return box;
}

/// In the coordinates of the body.
kds::collision::Shape patch(const SceneBody& body, const Vector3d& middle, double half_side) {
  const auto& half_space = std::get<HalfSpace>(body.shape);
  const Vector3d out = half_space.normal.normalized();
  const Vector3d at = body.orientation.conjugate() * (middle - body.motion.front().path.coefficients[0]);
  const Vector3d centre = at - (out.dot(at) - half_space.offset) * out;
  int least = 0;
  out.cwiseAbs().minCoeff(&least);
  const Vector3d u = half_side * out.cross(Vector3d::Unit(least)).normalized();
  const Vector3d v = out.cross(u);
  const std::vector<Vector3d> corners{centre - u - v, centre + u - v, centre + u + v, centre - u + v};
  return kds::collision::MeshShape{std::make_shared<const kds::collision::Mesh>(
      corners, std::vector<kds::collision::Mesh::Triangle>{{0, 1, 2}, {0, 2, 3}})};
}

}  // namespace

bool has_half_spaces(const Scene& scene) {
  return std::any_of(scene.bodies.begin(), scene.bodies.end(),
                     [](const SceneBody& body) { return kds::collision::unbounded(body.shape); });
}

Scene with_patches(const Scene& scene) {
  Scene drawn = scene;
  const Eigen::AlignedBox3d box = surroundings(scene);
  // As wide as the ball around the box, and some more: a view of all patches shows the bodies large enough.
  const double half_side = 0.6 * box.diagonal().norm();
  for (SceneBody& body : drawn.bodies) {
    if (kds::collision::unbounded(body.shape)) body.shape = patch(body, box.center(), half_side);
  }
  return drawn;
}

}  // namespace kds::io
