// Bodies that turn about another point than their centre.
#pragma once

#include "collision/shapes/shape.hpp"
#include "io/scene_file/json_node.hpp"

#include <Eigen/Core>

#include <optional>

namespace kds::io {

/// The pivot of the pieces of a motion, in the axes of the body, or nothing if they have none (or the centre). All have
/// to have the same, since it is where the body is held. Precondition: the pieces are objects.
std::optional<Eigen::Vector3d> read_pivot(const JsonNode& motion);

/// A shape about its pivot: that point of it is at the origin then, which is what motions move and turn. Its points are
/// moved, and rounded; a box is then a hull, whose vertices are numbered as those of the box. Fails, at the node, for
/// shapes of which that cannot be made.
kds::collision::Shape about_pivot(const kds::collision::Shape& shape, const Eigen::Vector3d& pivot,
                                  const JsonNode& node);

}  // namespace kds::io
