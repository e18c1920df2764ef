// The readers of OBJ and STL files on any bytes: a mesh, or one line that says what is wrong.
//
// The input's first byte chooses the format: 'o' is OBJ, anything else STL.
#include "collision/shapes/mesh.hpp"
#include "io/mesh_file.hpp"
#include "tests/fuzz/check.hpp"
#include "tests/io/temporary_folder.hpp"

#include <string>
#include <string_view>
#include <utility>

namespace kds::fuzz {
namespace {

using namespace kds::io;

void check_message(const std::string_view message) {
  require(!message.empty(), "the error says nothing");
  require(message.find('\n') == std::string_view::npos, "the error is not one line");
}

void check_sound(const MeshData& mesh) {
  require(!mesh.triangles.empty(), "a mesh without triangles");
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) require(vertex < mesh.vertices.size(), "a vertex that is not there");
  }
}

}  // namespace

void run(std::span<const std::uint8_t> input) {
  if (input.empty()) return;
  static const kds::io::tests::TemporaryFolder folder;
  const bool obj = input[0] == 'o';
  const std::string text(input.begin() + 1, input.end());
  const auto file = folder.write(obj ? "a.obj" : "a.stl", text);
  MeshData mesh;
  try {
    mesh = read_mesh_file(file);
  } catch (const MeshFileError& error) {
    return check_message(error.what());
  }
  check_sound(mesh);
  if (obj) {
    const MeshData again = read_mesh_file(folder.write("b.obj", to_obj(mesh)));
    require(again.vertices == mesh.vertices && again.triangles == mesh.triangles, "written and read back it is another");
  }
  try {
    const collision::Mesh sound(std::move(mesh.vertices), std::move(mesh.triangles));
    require(sound.bounding_radius() > 0, "a mesh of no size");
  } catch (const collision::InvalidMesh& error) {
    check_message(error.what());
  }
}

}  // namespace kds::fuzz
