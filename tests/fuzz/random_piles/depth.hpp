// How deep two shapes are in each other, by formulas that have nothing in common with those of the engine.
#pragma once

#include "collision/shapes/shape.hpp"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace kds::piles {

/// A triangle of a mesh about the centre of its body, with a ball that holds it.
struct Face {
  std::array<Eigen::Vector3d, 3> corners;
  Eigen::Vector3d middle;
  double radius;
};

/// A shape, and what there is to be known of it whatever its place.
struct Solid {
  explicit Solid(collision::PlacedShape placed);

  collision::PlacedShape shape;
  std::vector<Face> faces{};  ///< of a mesh
};

/// The least distance that parts a and b, whose centres are at `at_a` and `at_b`. Negative where they are apart: of a
/// size that is no more than their distance then. A mesh is a surface. Rounded by some 2^-50 of the lengths.
double depth(const Solid& a, const Eigen::Vector3d& at_a, const Solid& b, const Eigen::Vector3d& at_b);

}  // namespace kds::piles
