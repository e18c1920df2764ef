// Capsules as shapes.
#pragma once

#include "collision/shapes/rounded_box.hpp"
#include "collision/shapes/shape_kind.hpp"

#include <utility>

namespace kds::collision::detail {

template <>
struct ShapeKind<Capsule> {
  static constexpr const char* name = "capsule";
  static constexpr bool has_half_axes = false;

  static void place(const Capsule& capsule, PlacedShape& placed);
  static std::array<double, 2> extent(const Capsule& capsule, const PlacedShape& placed,
                                      const Eigen::Vector3d& direction);

  static Eigen::Vector3d measures(const Capsule& capsule) {
    return {capsule.radius, capsule.radius, capsule.half_length};
  }

  /// Vertex 0 is the end at -half_length, vertex 1 the other, and the edge what is between them.
  static SupportingFeature support(const Capsule& capsule, const PlacedShape& placed, const Eigen::Vector3d& direction);

  static RoundedBox rounded_box(const Capsule& capsule) { return {{0, 0, capsule.half_length}, capsule.radius}; }

  /// Those of a cylinder and of two halves of a ball, whose centres of mass are 3/8 of the radius from where they are
  /// cut.
  static Eigen::Vector3d moments(const Capsule& capsule, double mass) {
    const double r = capsule.radius, h = capsule.half_length;
    const double of_cylinder = mass * (3 * h) / (3 * h + 2 * r);
    const double of_ball = mass * (2 * r) / (3 * h + 2 * r);
    const double ball = 0.4 * (r * r);
    const double across = of_cylinder * (r * r / 4 + h * h / 3) + of_ball * (ball + h * h + 0.75 * (h * r));
    const double along = of_cylinder * (r * r / 2) + of_ball * ball;
    return {across, across, along};
  }

  /// The two circles about its axis, four lines along it and four half circles.
  template <class Pen>
  static void outline(const Capsule& capsule, Pen& pen) {
    const double r = capsule.radius, h = capsule.half_length;
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Vector3d end(0, 0, side * h), pole(0, 0, side * r);
      pen.arc(end, {r, 0, 0}, {0, r, 0}, 4);
      pen.arc(end, {r, 0, 0}, pole, 2);
      pen.arc(end, {0, r, 0}, pole, 2);
    }
    for (const auto& [x, y] : {std::pair(r, 0.0), {0.0, r}, {-r, 0.0}, {0.0, -r}}) pen.line({x, y, -h}, {x, y, h});
  }

  template <class Archive>
  static void archive(Archive& archive, Capsule& capsule, PlacedShape&, const NumberedMeshes&) {
    archive(capsule.radius, capsule.half_length);
  }
};

}  // namespace kds::collision::detail
