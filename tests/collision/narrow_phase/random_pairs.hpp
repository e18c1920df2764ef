// Shapes of every kind and paths, for tests of one mesh against another shape.
#pragma once

#include "tests/collision/sample_meshes.hpp"

#include <Eigen/Geometry>

#include <cstdint>

namespace kds::collision::samples {

enum class Cubes {
  any,
  facing,  ///< of one size, every other one not turned: faces that meet at once
};

/// A ring, a cube of triangles, a solid box, a ball or a capsule: kinds 0 to 4, of which the first two are meshes.
inline PlacedShape shape_of_kind(Random& random, std::uint32_t kind, Cubes cubes = Cubes::any) {
  static const auto ring = torus(8, 4);
  static const auto cube = cuboid();
  const double size = random.uniform(0.3, 1);
  switch (kind) {
    case 0:
      return place(MeshShape{ring, size}, random.orientation());
    case 1:
      if (cubes == Cubes::any) return place(MeshShape{cube, size}, random.orientation());
      return place(MeshShape{cube, 0.5}, random.below(2) == 0 ? Eigen::Quaterniond::Identity() : random.orientation());
    case 2:
      return place(Box{{size, 0.5 * size, 0.7 * size}}, random.orientation());
    case 3:
      return placed_ball(size);
    default:
      return place(Capsule{0.5 * size, 0.7 * size}, random.orientation());
  }
}

/// A path that began up to a second before the clock; at degree 2 every other one is straight.
template <int Degree>
certificates::PointMotion<Degree> random_path(Random& random, double clock, double speed) {
  certificates::PointMotion<Degree> path;
  path.start = clock - random.uniform(0, 1);
  path.coefficients[0] = random.vector(2.5);
  path.coefficients[1] = random.vector(speed);
  if constexpr (Degree == 2) path.coefficients[2] = random.vector(1) * random.below(2);
  return path;
}

}  // namespace kds::collision::samples
