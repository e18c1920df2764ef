// Which bodies are nearest to a point or to a shape, and how far apart two are, as a world stands now.
#pragma once

#include "collision/body_id.hpp"
#include "collision/motions.hpp"
#include "collision/narrow_phase/shape_distance.hpp"
#include "collision/queries/hit.hpp"
#include "collision/shapes/shape.hpp"
#include "collision/world.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace kds::collision {

/// A body near a point, or near a shape.
struct NearBody {
  BodyId body{};
  double distance;        ///< in units of length; 0 where the point is inside, or the shapes have a point in common
  Eigen::Vector3d point;  ///< of the body, the nearest
  Eigen::Vector3d from_point;  ///< of the shape, the nearest; or the point that was asked about
};

/// The `count` bodies nearest to a point, at now(), nearest first, those at one distance in the order in which they
/// were added; all that there are if they are fewer. As casts do (casts.hpp), it sees no bodies that enter later, no
/// masks and no walls, and does not change the world. Distances are those of nearest_of_shape()
/// (collision/narrow_phase/), of bodies in their places rounded to doubles.
///
/// Throws std::invalid_argument for a coordinate that is not finite or out of the range of shape.hpp, and what
/// World::visit_overlapping throws. Cost: boxes about the point are asked for, twice as large each time, until
/// they have enough bodies; the distances of all in the last are computed (figures in docs/queries.md).
template <class Motion>
std::vector<NearBody> nearest(const BasicWorld<Motion>& world, const Eigen::Vector3d& to, std::size_t count,
                              const BodyFilter& filter = {});

/// The same of a shape in its orientation (place()) with its centre at a point. Distances are those of shape_distance()
/// (collision/narrow_phase/). Throws also for a shape that was not made by place().
template <class Motion>
std::vector<NearBody> nearest(const BasicWorld<Motion>& world, const PlacedShape& shape, const Eigen::Vector3d& at,
                              std::size_t count, const BodyFilter& filter = {});

/// How far two bodies of the world are apart at now(), with a point of each, in the world's coordinates:
/// shape_distance(). Throws std::invalid_argument where one of them has not entered.
template <class Motion>
ShapeDistance distance_between(const BasicWorld<Motion>& world, BodyId a, BodyId b);

}  // namespace kds::collision
