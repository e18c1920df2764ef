// Volume, centre and second moments of what a closed mesh bounds.
#pragma once

#include "collision/precise_vector.hpp"
#include "kds/arithmetic/double_double.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace kds::collision {

/// Integrals over the solid that a closed mesh bounds, with lengths in `unit`, a power of two, counted from `origin`: 6
/// times the volume, 24 times the integral of x, 120 times that of x x^T. In this unit no coordinate is beyond 1.
struct SolidIntegrals {
  Eigen::Vector3d origin;
  double unit = 1;
  DoubleDouble volume{};
  PreciseVector first{};
  PreciseVector squares{}, products{};  // of x x, y y, z z; of y z, z x, x y
  double magnitude = 0;                 // sum of bounds on the magnitudes of the tetrahedra's volumes

  /// 6 times the volume, off the exact one by at most this. A determinant is 6 products of 3 exact differences, each
  /// sum and product rounded by 2^-102 of itself; so are the n sums. The other integrals, with their factors of 6 / 24
  /// and 6 / 120 and coordinates up to 1, are off by less.
  double error(std::size_t triangles) const { return (static_cast<double>(triangles) + 16) * 0x1p-102 * magnitude; }
};

/// Of triangles that turn counter-clockwise seen from outside. Throws std::invalid_argument, naming an edge and
/// triangles, unless they run along each edge, between two places, as often in one direction as in the other: then the
/// integrals do not depend on the common corner of the tetrahedra. O(n log n).
SolidIntegrals solid_integrals(std::span<const Eigen::Vector3d> vertices,
                               std::span<const std::array<std::uint32_t, 3>> triangles);

}  // namespace kds::collision
