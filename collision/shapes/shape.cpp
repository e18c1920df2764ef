#include "collision/shapes/shape.hpp"

#include "collision/shapes/mesh.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace kds::collision {
namespace {

/// How far from 1 the norm of an orientation may be; scene files carry few digits. The quaternion is normalised.
constexpr double quaternion_tolerance = 1e-6;

void require_size(double value, const char* what) {
  if (!std::isfinite(value)) throw std::invalid_argument(std::string(what) + ": must be finite");
  if (!(value > 0)) throw std::invalid_argument(std::string(what) + ": must be > 0");
}

/// What the axes of a turned box may be off orthonormal, and what adding up its extents may round.
constexpr double rotation_margin = 16 * 0x1p-52;

/// A mesh touches a little before its surfaces do (the margin of mesh_contact.hpp); its box is grown by this fraction
/// of its size, so that the broad phase finds the pair before then for paths of up to a million sizes.
constexpr double mesh_margin = 0x1p-24;

void grow(PlacedShape& placed, double margin) {
  placed.low.array() -= margin;
  placed.high.array() += margin;
}

/// Exactly representable orientations (the identity, quarter turns) give exact boxes, which need no margin.
bool is_signed_permutation(const Eigen::Matrix3d& m) {
  return ((m.array() == 0) || (m.array().abs() == 1)).all();
}

}  // namespace

void require_radius(double radius) { require_size(radius, "radius"); }

PlacedShape placed_ball(double radius) {
  require_radius(radius);
  PlacedShape placed;
  placed.shape = Sphere{radius};
  placed.bounding_radius = radius;
  placed.high.setConstant(radius);
  placed.low = -placed.high;
  return placed;
}

PlacedShape place(const Shape& shape, const Eigen::Quaterniond& orientation) {
  if (!orientation.coeffs().allFinite()) throw std::invalid_argument("orientation: must be finite");
  if (std::abs(orientation.norm() - 1) > quaternion_tolerance) {
    throw std::invalid_argument("orientation: must be a unit quaternion");
  }
  const bool identity = orientation.vec().isZero(0);
  return place_turned(
      shape, identity ? Eigen::Matrix3d(Eigen::Matrix3d::Identity()) : orientation.normalized().toRotationMatrix());
}

PlacedShape place_turned(const Shape& shape, const Eigen::Matrix3d& rotation) {
  const Eigen::Matrix3d off = rotation * rotation.transpose() - Eigen::Matrix3d::Identity();
  if (!(off.cwiseAbs().maxCoeff() <= 2 * rotation_margin && rotation.determinant() > 0)) {
    throw std::invalid_argument("orientation: its matrix is no rotation");
  }
  PlacedShape placed;
  placed.shape = shape;
  placed.rotation = rotation;
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    placed = placed_ball(sphere->radius);
    placed.rotation = rotation;
  } else if (const auto* box = std::get_if<Box>(&shape)) {
    for (int d = 0; d < 3; ++d) require_size(box->half_extents[d], "half_extents");
    for (int d = 0; d < 3; ++d) {
      placed.half_axes[static_cast<std::size_t>(d)] = placed.rotation.col(d) * box->half_extents[d];
      placed.high += placed.half_axes[static_cast<std::size_t>(d)].cwiseAbs();
    }
    placed.low = -placed.high;
    if (!is_signed_permutation(placed.rotation)) grow(placed, rotation_margin * placed.high.norm());
    placed.bounding_radius = box->half_extents.norm() * (1 + rotation_margin);
  } else {
    const auto& instance = std::get<MeshShape>(shape);
    if (!instance.mesh) throw std::invalid_argument("mesh: is missing");
    require_size(instance.scale, "scale");
    instance.mesh->extents(placed.rotation, instance.scale, placed.low, placed.high);
    const double radius = instance.mesh->bounding_radius() * instance.scale;
    grow(placed, mesh_margin * radius);
    placed.bounding_radius = radius * (1 + rotation_margin);
  }
  return placed;
}

std::array<double, 2> extent(const PlacedShape& shape, const Eigen::Vector3d& direction) {
  const double length = direction.norm() * (1 + rotation_margin);
  double low = 0, high = 0, margin = 0;
  if (const auto* sphere = std::get_if<Sphere>(&shape.shape)) {
    high = sphere->radius * length;
    low = -high;
  } else if (std::holds_alternative<Box>(shape.shape)) {
    for (const Eigen::Vector3d& half : shape.half_axes) high += std::abs(direction.dot(half));
    low = -high;
    margin = rotation_margin * shape.bounding_radius * length;
  } else {
    const auto& instance = std::get<MeshShape>(shape.shape);
    const std::array<double, 2> ends = instance.mesh->extent(shape.rotation, instance.scale, direction);
    low = ends[0];
    high = ends[1];
    margin = (mesh_margin + rotation_margin) * shape.bounding_radius * length;
  }
  return {low - margin, high + margin};
}

}  // namespace kds::collision
