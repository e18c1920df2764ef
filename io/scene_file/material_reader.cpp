#include "io/scene_file/material_reader.hpp"

namespace kds::io {

SurfaceNumbers read_surface(const JsonNode& node, const SurfaceNumbers& of_scene) {
  SurfaceNumbers surface = of_scene;
  if (node.has("restitution")) surface.restitution = node["restitution"].fraction();
  if (node.has("friction")) surface.friction = node["friction"].number(friction_problem);
  if (node.has("tangential_restitution")) {
    surface.tangential_restitution = node["tangential_restitution"].number(tangential_restitution_problem);
  }
  if (node.has("rolling_friction")) surface.rolling_friction = node["rolling_friction"].number(friction_problem);
  return surface;
}

void refuse_friction(const JsonNode& root, const std::vector<JsonNode>& bodies) {
  const auto refuse = [](const JsonNode& node) {
    for (const char* key : {"friction", "tangential_restitution", "rolling_friction"}) {
      if (node.has(key)) {
        node[key].fail(nothing_turns);
      }
    }
  };
  refuse(root);
  for (const JsonNode& body : bodies) refuse(body);
}

std::variant<double, Eigen::Matrix3d> read_inertia(const JsonNode& node) {
  if (!node.is_array()) return node.positive();
  const std::vector<JsonNode> rows = node.tuple(3);
  Eigen::Matrix3d tensor = Eigen::Matrix3d::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    const JsonNode& row = rows[static_cast<std::size_t>(i)];
    if (rows.front().is_array()) {
      tensor.row(i) = row.vector();
    } else {
      tensor(i, i) = row.positive();
    }
  }
  return tensor;
}

}  // namespace kds::io
