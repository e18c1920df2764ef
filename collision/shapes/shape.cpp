#include "collision/shapes/shape.hpp"

#include "collision/narrow_phase/mesh_margins.hpp"
#include "collision/shapes/mesh.hpp"
#include "collision/vectors.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

namespace kds::collision {
namespace {

/// How far from 1 the norm of an orientation may be; scene files carry few digits. The quaternion is normalised.
constexpr double quaternion_tolerance = 1e-6;

/// A number in a message, with digits enough to know it by.
std::string text(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

/// What a mesh and its scale make together.
void require_range(const Mesh& mesh, double scale) {
  const double edge = mesh.shortest_edge() * scale;
  const double radius = mesh.bounding_radius() * scale;
  if (!(edge >= shortest_edge)) {
    throw std::invalid_argument("scale: " + text(scale) + " makes an edge of the mesh " + text(edge) +
                                " long; at least 2^-110 (7.7e-34) is supported");
  }
  if (!(radius <= Mesh::largest_coordinate * (1 + 0x1p-40) * std::sqrt(3.0))) {
    throw std::invalid_argument("scale: " + text(scale) + " makes the mesh reach " + text(radius) +
                                " from its origin; at most 2^100 (1.3e30) along each axis is supported");
  }
}

/// What the axes of a turned box may be off orthonormal, and what adding up its extents may round.
constexpr double rotation_margin = 16 * 0x1p-52;

void grow(PlacedShape& placed, double margin) {
  placed.low.array() -= margin;
  placed.high.array() += margin;
}

/// Exactly representable orientations (the identity, quarter turns) give exact boxes, which need no margin.
bool is_signed_permutation(const Eigen::Matrix3d& m) { return ((m.array() == 0) || (m.array().abs() == 1)).all(); }

}  // namespace

void require_size(double value, const char* what) {
  const std::string name(what);
  if (!std::isfinite(value)) throw std::invalid_argument(name + ": must be finite");
  if (!(value > 0)) throw std::invalid_argument(name + ": must be > 0");
  if (value < smallest_size) throw std::invalid_argument(name + ": " + text(value) + " is below 2^-205 (1.9e-62)");
  if (value > largest_magnitude) throw std::invalid_argument(name + ": " + text(value) + " is above 2^205 (5.1e61)");
}

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
  const double length = norm(orientation);
  if (std::abs(length - 1) > quaternion_tolerance) {
    throw std::invalid_argument("orientation: must be a unit quaternion");
  }
  const bool identity = orientation.vec().isZero(0);
  const Eigen::Quaterniond unit(orientation.coeffs() / length);
  return place_turned(shape, identity ? Eigen::Matrix3d(Eigen::Matrix3d::Identity()) : unit.toRotationMatrix());
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
    if (!is_signed_permutation(placed.rotation)) grow(placed, rotation_margin * norm(placed.high));
    placed.bounding_radius = norm(box->half_extents) * (1 + rotation_margin);
  } else {
    const auto& instance = std::get<MeshShape>(shape);
    if (!instance.mesh) throw std::invalid_argument("mesh: is missing");
    if (!std::isfinite(instance.scale)) throw std::invalid_argument("scale: must be finite");
    if (!(instance.scale > 0)) throw std::invalid_argument("scale: must be > 0");
    require_range(*instance.mesh, instance.scale);
    instance.mesh->extents(placed.rotation, instance.scale, placed.low, placed.high);
    const double radius = instance.mesh->bounding_radius() * instance.scale;
    grow(placed, box_margin * radius);
    placed.bounding_radius = radius * (1 + rotation_margin);
  }
  return placed;
}

std::array<double, 2> extent(const PlacedShape& shape, const Eigen::Vector3d& direction) {
  const double length = norm(direction) * (1 + rotation_margin);
  double low = 0, high = 0, margin = 0;
  if (const auto* sphere = std::get_if<Sphere>(&shape.shape)) {
    high = sphere->radius * length;
    low = -high;
  } else if (std::holds_alternative<Box>(shape.shape)) {
    for (const Eigen::Vector3d& half : shape.half_axes) high += std::abs(dot(direction, half));
    low = -high;
    margin = rotation_margin * shape.bounding_radius * length;
  } else {
    const auto& instance = std::get<MeshShape>(shape.shape);
    const std::array<double, 2> ends = instance.mesh->extent(shape.rotation, instance.scale, direction);
    low = ends[0];
    high = ends[1];
    margin = (box_margin + rotation_margin) * shape.bounding_radius * length;
  }
  return {low - margin, high + margin};
}

}  // namespace kds::collision
