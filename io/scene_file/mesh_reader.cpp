#include "io/scene_file/mesh_reader.hpp"

#include "io/mesh_file.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace kds::io {
namespace {

using kds::collision::Mesh;

/// "2 of 64 triangles are degenerate and left out, the first is triangle 17"
std::string left_out_text(const std::vector<std::size_t>& left_out, std::size_t triangles) {
  const std::string all = " of " + std::to_string(triangles) + (triangles == 1 ? " triangle" : " triangles");
  const std::string first = std::to_string(left_out.front());
  if (left_out.size() == 1) return '1' + all + " is degenerate and left out, triangle " + first;
  return std::to_string(left_out.size()) + all + " are degenerate and left out, the first is triangle " + first;
}

std::shared_ptr<const Mesh> read_mesh(const JsonNode& node, const std::filesystem::path& folder,
                                      std::vector<std::string>& warnings) {
  const std::string name = node.string();
  try {
    MeshData data = read_mesh_file(folder / name);
    const std::size_t triangles = data.triangles.size();
    const std::vector<std::size_t> left_out = leave_out_degenerate(data);
    if (!left_out.empty()) warnings.push_back(node.path() + ": " + name + ": " + left_out_text(left_out, triangles));
    return std::make_shared<const Mesh>(std::move(data.vertices), std::move(data.triangles));
  } catch (const MeshFileError& error) {
    node.fail(name + ": " + error.what());
  } catch (const kds::collision::InvalidMesh& error) {
    node.fail(name + ": " + error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    node.fail(name + ": " + error.code().message());
  }
}

}  // namespace

void read_meshes(const JsonNode& node, const std::filesystem::path& folder, Scene& scene) {
  for (const auto& [name, entry] : node.members()) {
    const JsonNode file = entry.object({"file"})["file"];
    auto mesh = read_mesh(file, folder, scene.warnings);
    scene.meshes.push_back({name, file.string(), std::move(mesh)});
  }
}

}  // namespace kds::io
