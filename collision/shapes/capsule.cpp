#include "collision/shapes/capsule.hpp"

#include "collision/shapes/sphere.hpp"
#include "collision/vectors.hpp"
#include "kds/arithmetic/double_double.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kds::collision::detail {

void ShapeKind<Capsule>::place(const Capsule& capsule, PlacedShape& placed) {
  require_radius(capsule.radius);
  if (capsule.half_length == 0) {
    const Sphere ball{capsule.radius};
    placed.shape = ball;
    return ShapeKind<Sphere>::place(ball, placed);
  }
  if (capsule.half_length < 0) throw std::invalid_argument("half_length: must be >= 0");
  require_size(capsule.half_length, "half_length");
  bool exact = is_signed_permutation(placed.rotation);
  for (int d = 0; d < 3; ++d) {
    const DoubleDouble half_width = two_sum(std::abs(capsule.half_length * placed.rotation(d, 2)), capsule.radius);
    exact = exact && half_width.low == 0;
    placed.high[d] = half_width.high;
  }
  placed.low = -placed.high;
  if (!exact) grow(placed, rotation_margin * norm(placed.high));
  placed.bounding_radius = (capsule.half_length + capsule.radius) * (1 + rotation_margin);
}

std::array<double, 2> ShapeKind<Capsule>::extent(const Capsule& capsule, const PlacedShape& placed,
                                                 const Eigen::Vector3d& direction) {
  const double length = norm(direction) * (1 + rotation_margin);
  const double along = std::abs(dot(direction, Eigen::Vector3d(placed.rotation.col(2))));
  const double half_width = capsule.half_length * along + capsule.radius * length;
  const double margin = rotation_margin * placed.bounding_radius * length;
  return {-half_width - margin, half_width + margin};
}

SupportingFeature ShapeKind<Capsule>::support(const Capsule& capsule, const PlacedShape& placed,
                                              const Eigen::Vector3d& direction) {
  const Eigen::Vector3d axis = placed.rotation.col(2);
  const Eigen::Vector3d half = capsule.half_length * axis;
  const Eigen::Vector3d out = capsule.radius * direction;
  const double along = dot(direction, axis);
  // Directions that lead from one thing to another that is a radius away are known the less, the thinner the capsule.
  const double rounding = 64 * 0x1p-52 * (capsule.half_length / capsule.radius);
  if (std::abs(along) <= std::max(parallel_sine, rounding)) return {Feature::edge(0, 1), {out - half, out + half}};
  return along < 0 ? SupportingFeature{Feature::vertex(0), {out - half}}
                   : SupportingFeature{Feature::vertex(1), {out + half}};
}

}  // namespace kds::collision::detail
