#include "collision/shapes/shape.hpp"

#include "collision/shapes/shape_kinds.hpp"
#include "collision/vectors.hpp"
#include "kds/number_text.hpp"

#include <Eigen/LU>

#include <cmath>
#include <stdexcept>
#include <string>

namespace kds::collision {
namespace {

using detail::rotation_margin;

/// How far from 1 the norm of an orientation may be; scene files carry few digits. The quaternion is normalised.
constexpr double quaternion_tolerance = 1e-6;

[[noreturn]] void refuse(const char* kind, const char* function) {
  throw std::logic_error(std::string(function) + ": asked of a " + kind);
}

[[noreturn]] void refuse_size(double value, const std::string& name) {
  if (!std::isfinite(value)) throw std::invalid_argument(name + ": must be finite");
  if (!(value > 0)) throw std::invalid_argument(name + ": must be > 0");
  if (value < smallest_size)
    throw std::invalid_argument(name + ": " + number_text(value) + " is below " + power_text(smallest_size));
  throw std::invalid_argument(name + ": " + number_text(value) + " is above " + power_text(largest_magnitude));
}

}  // namespace

/// Asked of each ball that the narrow phase makes into a shape: nothing is made for what is in range.
void require_size(double value, const char* what) {
  if (!(value >= smallest_size && value <= largest_magnitude)) refuse_size(value, what);
}

void require_radius(double radius) { require_size(radius, "radius"); }

PlacedShape placed_ball(double radius) {
  PlacedShape placed;
  placed.shape = Sphere{radius};
  detail::ShapeKind<Sphere>::place(Sphere{radius}, placed);
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
  ask_kind(shape, [&](auto kind, const auto& each) { kind.place(each, placed); });
  return placed;
}

bool is_placed(const PlacedShape& shape) {
  const PlacedShape again = place_turned(shape.shape, shape.rotation);
  const bool has_axes = ask_kind(shape.shape, [](auto kind, const auto&) { return kind.has_half_axes; });
  return again.shape.index() == shape.shape.index() && (!has_axes || again.half_axes == shape.half_axes) &&
         again.low == shape.low && again.high == shape.high && again.bounding_radius == shape.bounding_radius &&
         detail::same_parts(again, shape);
}

std::array<double, 2> extent(const PlacedShape& shape, const Eigen::Vector3d& direction) {
  return ask_kind(shape.shape, [&](auto kind, const auto& each) { return kind.extent(each, shape, direction); });
}

SupportingFeature supporting_feature(const PlacedShape& shape, const Eigen::Vector3d& direction) {
  return ask_kind(shape.shape, [&](auto kind, const auto& each) -> SupportingFeature {
    if constexpr (requires { kind.support(each, shape, direction); }) {
      return kind.support(each, shape, direction);
    } else {
      refuse(kind.name, "supporting_feature");
    }
  });
}

RoundedCore rounded_core(const PlacedShape& shape) {
  return ask_kind(shape.shape, [&](auto kind, const auto& each) -> RoundedCore {
    if constexpr (requires { kind.rounded_box(each); }) {
      const RoundedBox box = kind.rounded_box(each);
      RoundedCore core{{}, box.radius};
      for (int d = 0; d < 3; ++d) {
        if (box.half_extents[d] > 0) core.generators.push_back({shape.rotation.col(d), box.half_extents[d]});
      }
      return core;
    } else {
      refuse(kind.name, "rounded_core");
    }
  });
}

const char* kind_name(const Shape& shape) {
  return ask_kind(shape, [](auto kind, const auto&) { return kind.name; });
}

Eigen::Vector3d measures(const Shape& shape) {
  return ask_kind(shape, [](auto kind, const auto& each) { return kind.measures(each); });
}

bool has_mesh(const Shape& shape) {
  if (const auto* const compound = std::get_if<Compound>(&shape)) return compound->parts && compound->parts->has_mesh();
  return std::holds_alternative<MeshShape>(shape);
}

std::shared_ptr<const Mesh> mesh_of(const Shape& shape) {
  const auto* const instance = std::get_if<MeshShape>(&shape);
  return instance ? instance->mesh : nullptr;
}

}  // namespace kds::collision
