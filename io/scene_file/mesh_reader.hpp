// The meshes that a scene names.
#pragma once

#include "io/scene.hpp"
#include "io/scene_file/json_node.hpp"

#include <filesystem>

namespace kds::io {

/// Reads what `node`, the scene's "meshes", has into scene.meshes: heightfields, and files that it names, relative to a
/// folder. Of these, triangles that are degenerate are left out, and scene.warnings say how many: one must not make a
/// model useless. scene.sources tells of the files. Throws JsonError.
void read_meshes(const JsonNode& node, const std::filesystem::path& folder, Scene& scene);

}  // namespace kds::io
