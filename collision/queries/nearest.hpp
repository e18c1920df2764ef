// Which bodies are nearest to a point, as a world stands now.
#pragma once

#include "collision/body_id.hpp"
#include "collision/motions.hpp"
#include "collision/queries/hit.hpp"
#include "collision/world.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace kds::collision {

/// A body near a point.
struct NearBody {
  BodyId body{};
  double distance;        ///< from the point to the body, 0 where it is inside, in units of length
  Eigen::Vector3d point;  ///< of the body, the nearest
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

}  // namespace kds::collision
