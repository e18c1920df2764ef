// Balls as shapes.
#pragma once

#include "collision/shapes/rounded_box.hpp"
#include "collision/shapes/shape_kind.hpp"
#include "collision/vectors.hpp"

namespace kds::collision::detail {

template <>
struct ShapeKind<Sphere> {
  static constexpr const char* name = "sphere";
  static constexpr bool has_half_axes = false;

  static void place(const Sphere& sphere, PlacedShape& placed) {
    require_radius(sphere.radius);
    placed.bounding_radius = sphere.radius;
    placed.high.setConstant(sphere.radius);
    placed.low = -placed.high;
  }

  static std::array<double, 2> extent(const Sphere& sphere, const PlacedShape&, const Eigen::Vector3d& direction) {
    const double half_width = sphere.radius * (norm(direction) * (1 + rotation_margin));
    return {-half_width, half_width};
  }

  static Eigen::Vector3d measures(const Sphere& sphere) { return Eigen::Vector3d::Constant(sphere.radius); }

  static SupportingFeature support(const Sphere& sphere, const PlacedShape&, const Eigen::Vector3d& direction) {
    return {{}, {sphere.radius * direction}};
  }

  static RoundedBox rounded_box(const Sphere& sphere) { return {Eigen::Vector3d::Zero(), sphere.radius}; }

  static Eigen::Vector3d moments(const Sphere& sphere, double mass) {
    return Eigen::Vector3d::Constant(0.4 * mass * (sphere.radius * sphere.radius));
  }

  /// Three great circles.
  template <class Pen>
  static void outline(const Sphere& sphere, Pen& pen) {
    for (int d = 0; d < 3; ++d) {
      pen.arc(Eigen::Vector3d::Zero(), sphere.radius * Eigen::Vector3d::Unit(d),
              sphere.radius * Eigen::Vector3d::Unit((d + 1) % 3), 4);
    }
  }

  template <class Archive>
  static void archive(Archive& archive, Sphere& sphere, PlacedShape&, const NumberedMeshes&) {
    archive(sphere.radius);
  }
};

}  // namespace kds::collision::detail
