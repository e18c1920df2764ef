#include "collision/shapes/half_space.hpp"

#include "collision/shapes/rotation.hpp"
#include "collision/vectors.hpp"
#include "kds/number_text.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <variant>

namespace kds::collision {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// How far from 1 the length of a normal may be, as that of an orientation: scene files carry few digits.
constexpr double normal_tolerance = 1e-6;

}  // namespace

HalfSpace placed_half_space(const PlacedShape& placed) {
  const auto& half_space = std::get<HalfSpace>(placed.shape);
  return {rotated(placed.rotation, normalized(half_space.normal)), half_space.offset};
}

namespace detail {

void ShapeKind<HalfSpace>::place(const HalfSpace& half_space, PlacedShape& placed) {
  if (!half_space.normal.allFinite()) throw std::invalid_argument("normal: must be finite");
  if (!(std::abs(norm(half_space.normal) - 1) <= normal_tolerance)) {
    throw std::invalid_argument("normal: must be of unit length, to " + number_text(normal_tolerance));
  }
  if (!(std::abs(half_space.offset) <= largest_magnitude)) {
    throw std::invalid_argument("offset: must be finite, and at most " + power_text(largest_magnitude) +
                                " in magnitude");
  }
  placed.low.setConstant(-infinity);
  placed.high.setConstant(infinity);
  placed.bounding_radius = infinity;
}

std::array<double, 2> ShapeKind<HalfSpace>::extent(const HalfSpace&, const PlacedShape&, const Eigen::Vector3d&) {
  return {-infinity, infinity};
}

Eigen::Vector3d ShapeKind<HalfSpace>::measures(const HalfSpace&) { return Eigen::Vector3d::Constant(infinity); }

}  // namespace detail

}  // namespace kds::collision
