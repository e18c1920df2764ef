// The shapes of bodies.
#pragma once

#include "io/scene.hpp"
#include "io/scene_file/json_node.hpp"

#include <Eigen/Geometry>

#include <string>
#include <string_view>
#include <vector>

namespace kds::io {

/// The shape that a node, the "shape" of a body, describes. Throws JsonError.
kds::collision::Shape read_shape(const JsonNode& node, const std::vector<SceneMesh>& meshes);

/// A unit quaternion, w first. Throws JsonError.
Eigen::Quaterniond read_orientation(const JsonNode& node);

/// What is wrong with a mesh that reaches so far from its origin, or nothing; it begins with `reaches`, a verb.
std::string mesh_size_problem(double radius, std::string_view reaches);

}  // namespace kds::io
