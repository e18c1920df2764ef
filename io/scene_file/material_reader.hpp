// What a scene says of the surfaces of bodies, and of how they resist turning.
#pragma once

#include "io/scene.hpp"
#include "io/scene_file/json_node.hpp"

#include <Eigen/Core>

#include <variant>
#include <vector>

namespace kds::io {

/// Each number of the node's own, or else that of the scene: the keys "restitution", "friction",
/// "tangential_restitution" and "rolling_friction".
SurfaceNumbers read_surface(const JsonNode& node, const SurfaceNumbers& of_scene);

/// Why there is no friction in a scene.
inline constexpr const char* nothing_turns =
    "bodies of this scene do not turn: none has an \"angular_velocity\" or an \"inertia\"";

/// In a scene in which nothing turns: fails at the first word of friction, at the scene or at a body.
void refuse_friction(const JsonNode& root, const std::vector<JsonNode>& bodies);

/// One moment, three principal moments about the axes of the body, or a tensor in them.
std::variant<double, Eigen::Matrix3d> read_inertia(const JsonNode& node);

}  // namespace kds::io
