// The shapes of bodies.
#pragma once

#include "io/scene.hpp"
#include "io/scene_file/json_node.hpp"

#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace kds::io {

/// The shape that a node, the "shape" of a body, describes. Throws JsonError.
kds::collision::Shape read_shape(const JsonNode& node, const std::vector<SceneMesh>& meshes);

/// A unit quaternion, w first. Throws JsonError.
Eigen::Quaterniond read_orientation(const JsonNode& node);

/// What is wrong with the size of a mesh, or nothing. `scaled`: it is said of the scale, else of the mesh.
std::string mesh_size_problem(const kds::collision::MeshShape& shape, bool scaled);

}  // namespace kds::io
