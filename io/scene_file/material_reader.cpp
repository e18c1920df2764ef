#include "io/scene_file/material_reader.hpp"

namespace kds::io {
namespace {

double read_friction(const JsonNode& node) {
  const double x = node.number();
  if (!(x >= 0)) node.fail("must be >= 0");
  return x;
}

double read_tangential_restitution(const JsonNode& node) {
  const double x = node.number();
  if (!(x >= -1 && x <= 1)) node.fail("must be in [-1, 1]");
  return x;
}

}  // namespace

SurfaceNumbers read_surface(const JsonNode& node, const SurfaceNumbers& of_scene) {
  SurfaceNumbers surface = of_scene;
  if (node.has("restitution")) surface.restitution = node["restitution"].fraction();
  if (node.has("friction")) surface.friction = read_friction(node["friction"]);
  if (node.has("tangential_restitution")) {
    surface.tangential_restitution = read_tangential_restitution(node["tangential_restitution"]);
  }
  return surface;
}

void refuse_friction(const JsonNode& root, const std::vector<JsonNode>& bodies) {
  const auto refuse = [](const JsonNode& node) {
    for (const char* key : {"friction", "tangential_restitution"}) {
      if (node.has(key)) {
        node[key].fail("bodies of this scene do not turn: none has an \"angular_velocity\" or an \"inertia\"");
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
