// Boxes as shapes.
#pragma once

#include "collision/shapes/rounded_box.hpp"
#include "collision/shapes/shape_kind.hpp"
#include "collision/vectors.hpp"

#include <cmath>
#include <cstddef>

namespace kds::collision {

/// A vertex, edge or face of a box: per axis +1 or -1 for a side, 0 for "anywhere along it".
using BoxSide = Eigen::Matrix<int, 3, 1>;

/// Numbered as Feature says.
Feature box_feature(const BoxSide& side);

namespace detail {

template <>
struct ShapeKind<Box> {
  static constexpr const char* name = "box";
  static constexpr bool has_half_axes = true;

  static void place(const Box& box, PlacedShape& placed) {
    for (int d = 0; d < 3; ++d) require_size(box.half_extents[d], "half_extents");
    for (int d = 0; d < 3; ++d) {
      Eigen::Vector3d& half = placed.half_axes[static_cast<std::size_t>(d)];
      half = placed.rotation.col(d) * box.half_extents[d];
      placed.high += half.cwiseAbs();
    }
    placed.low = -placed.high;
    if (!is_signed_permutation(placed.rotation)) grow(placed, rotation_margin * norm(placed.high));
    placed.bounding_radius = norm(box.half_extents) * (1 + rotation_margin);
  }

  static std::array<double, 2> extent(const Box&, const PlacedShape& placed, const Eigen::Vector3d& direction) {
    double half_width = 0;
    for (const Eigen::Vector3d& half : placed.half_axes) half_width += std::abs(dot(direction, half));
    half_width += rotation_margin * placed.bounding_radius * (norm(direction) * (1 + rotation_margin));
    return {-half_width, half_width};
  }

  static Eigen::Vector3d measures(const Box& box) { return box.half_extents; }

  static SupportingFeature support(const Box&, const PlacedShape& placed, const Eigen::Vector3d& direction);

  static RoundedBox rounded_box(const Box& box) { return {box.half_extents, 0}; }

  static Eigen::Vector3d moments(const Box& box, double mass) {
    const Eigen::Vector3d squares = box.half_extents.cwiseProduct(box.half_extents);
    return {mass * (squares[1] + squares[2]) / 3, mass * (squares[2] + squares[0]) / 3,
            mass * (squares[0] + squares[1]) / 3};
  }

  /// The twelve edges.
  template <class Pen>
  static void outline(const Box& box, Pen& pen) {
    for (int d = 0; d < 3; ++d) {
      for (const double u : {-1.0, 1.0}) {
        for (const double v : {-1.0, 1.0}) {
          Eigen::Vector3d from;
          from[d] = -1, from[(d + 1) % 3] = u, from[(d + 2) % 3] = v;
          Eigen::Vector3d to = from;
          to[d] = 1;
          pen.line(from.cwiseProduct(box.half_extents), to.cwiseProduct(box.half_extents));
        }
      }
    }
  }

  template <class Archive>
  static void archive(Archive& archive, Box& box, PlacedShape& placed, const NumberedMeshes&) {
    archive_vector(archive, box.half_extents);
    for (Eigen::Vector3d& half : placed.half_axes) archive_vector(archive, half);
  }
};

}  // namespace detail

}  // namespace kds::collision
