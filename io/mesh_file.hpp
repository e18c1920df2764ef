// Triangle meshes from OBJ and STL files.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace kds::io {

/// The triangles of a mesh file, as it has them.
struct MeshData {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::size_t> fans{};   ///< lines of an OBJ file whose faces cross themselves, and became fans
  std::vector<std::size_t> lines{};  ///< of an OBJ file: for each triangle the line of its face; else empty
};

/// What is wrong with a mesh file; the message does not name the file.
struct MeshFileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Reads .obj or .stl (assimp, in single precision). Vertices of an OBJ file keep its order and its numbers to the last
/// bit, and polygons are cut into triangles, those that cross themselves as fans (polygon.hpp); all but vertices and
/// faces is passed over. Equal vertices of an STL file, which repeats them for every triangle, become one. Throws
/// MeshFileError, with the number of the line, or of the byte in a binary STL file, and
/// std::filesystem::filesystem_error for a file that cannot be looked at; whether the triangles make a sound mesh is
/// not checked here.
MeshData read_mesh_file(const std::filesystem::path& file);

/// Removes the triangles that no mesh can have (collision::is_degenerate), which ordinary files contain: they have no
/// area, so that at most a crack as wide as roundings is left. The others keep their order. Returns which they were, by
/// their places among all triangles, from 0. Precondition: what read_mesh_file() gives.
std::vector<std::size_t> leave_out_degenerate(MeshData& mesh);

/// The same, and tells in words what has been mended in a mesh from a file: a sentence for what was left out, one for
/// fans; none if nothing had to be. Throws MeshFileError if no triangle is left.
std::vector<std::string> mend(MeshData& mesh);

/// The text of an OBJ file that read_mesh_file gives back bit for bit.
std::string to_obj(const MeshData& mesh);

}  // namespace kds::io
