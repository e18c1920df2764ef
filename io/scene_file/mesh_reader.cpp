#include "io/scene_file/mesh_reader.hpp"

#include "collision/shapes/heightfield.hpp"
#include "io/checksum.hpp"
#include "io/mesh_file.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace kds::io {
namespace {

using kds::collision::Mesh;

std::shared_ptr<const Mesh> read_mesh(const JsonNode& node, const std::filesystem::path& folder, Scene& scene) {
  const std::string name = node.string();
  try {
    MeshData data = read_mesh_file(folder / name);
    for (const std::string& mended : mend(data)) scene.warnings.push_back(node.path() + ": " + name + ": " + mended);
    scene.sources.push_back({node.path(), name, chained(checksum_of(data.vertices), checksum_of(data.triangles))});
    return std::make_shared<const Mesh>(std::move(data.vertices), std::move(data.triangles));
  } catch (const MeshFileError& error) {
    node.fail(name + ": " + error.what());
  } catch (const kds::collision::InvalidMesh& error) {
    node.fail(name + ": " + error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    node.fail(name + ": " + error.code().message());
  }
}

/// A terrain, written in the scene.
std::shared_ptr<const Mesh> read_heightfield(const JsonNode& node) {
  const JsonNode rows = node.object({"heights", "spacing"})["heights"];
  std::vector<double> heights;
  std::size_t columns = 0;
  for (const JsonNode& row : rows.elements()) {
    const std::vector<JsonNode> numbers = row.elements();
    if (columns == 0) columns = numbers.size();
    if (numbers.size() != columns) row.fail("must have as many numbers as the first row, " + std::to_string(columns));
    for (const JsonNode& height : numbers) heights.push_back(height.number());
  }
  if (columns < 2 || heights.size() < 2 * columns) rows.fail("must have at least two rows of two numbers");
  const std::vector<JsonNode> spacing = node["spacing"].tuple(2);
  const double along_x = spacing[0].positive(), along_y = spacing[1].positive();
  try {
    return std::make_shared<const Mesh>(kds::collision::heightfield(heights, columns, along_x, along_y));
  } catch (const kds::collision::InvalidMesh& error) {
    node.fail(error.what());
  }
}

}  // namespace

void read_meshes(const JsonNode& node, const std::filesystem::path& folder, Scene& scene) {
  for (const auto& [name, entry] : node.members()) {
    entry.object({"file", "heightfield"});
    if (entry.has("heightfield")) {
      if (entry.has("file")) entry.fail("must have either \"file\" or \"heightfield\"");
      scene.meshes.push_back({name, "", read_heightfield(entry["heightfield"])});
      continue;
    }
    const JsonNode file = entry["file"];
    auto mesh = read_mesh(file, folder, scene);
    scene.meshes.push_back({name, file.string(), std::move(mesh)});
  }
}

}  // namespace kds::io
