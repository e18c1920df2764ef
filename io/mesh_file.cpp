#include "io/mesh_file.hpp"

#include "collision/shapes/mesh.hpp"
#include "io/number_text.hpp"

#define TINYOBJLOADER_USE_DOUBLE
#define TINYOBJLOADER_IMPLEMENTATION
#include <assimp/scene.h>
#include <tiny_obj_loader.h>

#include <assimp/Importer.hpp>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace kds::io {
namespace {

std::string read_text(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file)) throw MeshFileError("is a directory");
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf())) throw MeshFileError("cannot be read, or is empty");
  return std::move(text).str();
}

/// The first word of `line`, which loses it; empty at the end. Blanks as tinyobjloader has them.
std::string_view next_word(std::string_view& line) {
  constexpr std::string_view blanks = " \t";
  line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(blanks));
  line.remove_prefix(word.size());
  return word;
}

/// Whether the whole of `word` is a number, with + before it or not.
template <class Number>
bool read_number(std::string_view word, Number& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  return error == std::errc() && stop == end;
}

/// `words` are what follows the v of a line.
Eigen::Vector3d read_obj_vertex(std::string_view words) {
  Eigen::Vector3d vertex;
  for (int d = 0; d < 3; ++d) {
    const std::string_view word = next_word(words);
    if (word.empty()) throw MeshFileError("a vertex needs three coordinates");
    if (!read_number(word, vertex[d]) || !std::isfinite(vertex[d])) {
      throw MeshFileError('"' + std::string(word) + "\" is not a finite number");
    }
  }
  return vertex;
}

/// `words` are what follows the f of a line: corners such as 7, 7/1 and 7//1.
void check_obj_face(std::string_view words) {
  for (std::string_view word = next_word(words); !word.empty(); word = next_word(words)) {
    int vertex = 0;
    if (!read_number(word.substr(0, word.find('/')), vertex) || vertex == 0) {
      throw MeshFileError('"' + std::string(word) + "\" is not the number of a vertex");
    }
  }
}

/// The vertices of an OBJ file. tinyobjloader rounds numbers carelessly (0.3 becomes 0.30000000000000004), and takes
/// what is no number for 0 and 1.9 or 4294967297 for 1. So the coordinates are read here, and the faces there after
/// their numbers are checked here.
std::vector<Eigen::Vector3d> read_obj_vertices(std::istream& text) {
  std::vector<Eigen::Vector3d> vertices;
  std::string content;
  for (std::size_t number = 1; std::getline(text, content); ++number) {
    std::string_view line = content;
    while (line.ends_with('\r')) line.remove_suffix(1);
    try {
      // tinyobjloader goes on with another line there.
      if (line.find('\r') != line.npos) throw MeshFileError("a line ends in CR alone; LF or CR LF is read");
      const std::string_view keyword = next_word(line);
      if (keyword == "v") vertices.push_back(read_obj_vertex(line));
      if (keyword == "f") check_obj_face(line);
    } catch (const MeshFileError& error) {
      throw MeshFileError("line " + std::to_string(number) + ": " + error.what());
    }
  }
  return vertices;
}

struct ObjFaces {
  std::vector<std::uint32_t> corners;
  std::size_t triangles_expected = 0;
};

/// The faces of an OBJ file, checked to be all there: tinyobjloader leaves out what it does not like.
ObjFaces read_obj_faces(const std::string& text, std::size_t vertex_count, bool triangulate) {
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::string warnings;
  std::string errors;
  std::istringstream in(text);
  if (!tinyobj::LoadObj(&attributes, &shapes, &materials, &warnings, &errors, &in, nullptr, triangulate)) {
    throw MeshFileError(errors.empty() ? "is not an OBJ file" : errors.substr(0, errors.find('\n')));
  }
  if (warnings.find("Degenerated face") != std::string::npos) {
    throw MeshFileError("a face has fewer than three corners");
  }
  ObjFaces faces;
  std::size_t corners_expected = 0;
  for (const auto& shape : shapes) {
    for (const unsigned char n : shape.mesh.num_face_vertices) {
      corners_expected += n;
      faces.triangles_expected += static_cast<std::size_t>(n) - 2;
    }
    for (const auto& index : shape.mesh.indices) {
      if (index.vertex_index < 0 || static_cast<std::size_t>(index.vertex_index) >= vertex_count) {
        throw MeshFileError("a face names vertex " + std::to_string(index.vertex_index + 1) + ", but the file has " +
                            std::to_string(vertex_count) + " vertices");
      }
      faces.corners.push_back(static_cast<std::uint32_t>(index.vertex_index));
    }
  }
  if (corners_expected != faces.corners.size()) throw MeshFileError("a face has more than 255 corners");
  return faces;
}

MeshData read_obj(const std::filesystem::path& file) {
  const std::string text = read_text(file);
  MeshData mesh;
  std::istringstream in(text);
  mesh.vertices = read_obj_vertices(in);
  const ObjFaces polygons = read_obj_faces(text, mesh.vertices.size(), false);
  const ObjFaces faces = read_obj_faces(text, mesh.vertices.size(), true);
  if (faces.corners.size() != 3 * polygons.triangles_expected) {
    throw MeshFileError("a polygon cannot be cut into triangles; is it flat and without crossing edges?");
  }
  for (std::size_t i = 0; i < faces.corners.size(); i += 3) {
    mesh.triangles.push_back({faces.corners[i], faces.corners[i + 1], faces.corners[i + 2]});
  }
  return mesh;
}

MeshData read_stl(const std::filesystem::path& file) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(file.string(), 0);
  if (!scene) throw MeshFileError(importer.GetErrorString());
  MeshData mesh;
  std::map<std::array<double, 3>, std::uint32_t> numbers;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& part = *scene->mMeshes[m];
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      const auto fail = [&](const char* what) {
        throw MeshFileError("triangle " + std::to_string(mesh.triangles.size()) + ": " + what);
      };
      if (face.mNumIndices != 3) fail("has not three corners");
      std::array<std::uint32_t, 3> triangle{};
      for (std::size_t i = 0; i < 3; ++i) {
        const aiVector3D& p = part.mVertices[face.mIndices[i]];
        const Eigen::Vector3d vertex(p.x, p.y, p.z);
        // Before it is looked for: what is no number has no place in an order.
        if (!vertex.allFinite()) fail("has a coordinate that is not finite");
        const auto next = static_cast<std::uint32_t>(mesh.vertices.size());
        const auto [entry, is_new] = numbers.try_emplace({p.x, p.y, p.z}, next);
        if (is_new) mesh.vertices.push_back(vertex);
        triangle[i] = entry->second;
      }
      mesh.triangles.push_back(triangle);
    }
  }
  return mesh;
}

}  // namespace

MeshData read_mesh_file(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) throw MeshFileError("no such file");
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (extension != ".obj" && extension != ".stl") throw MeshFileError("only .obj and .stl files are read");
  MeshData mesh = extension == ".obj" ? read_obj(file) : read_stl(file);
  if (mesh.triangles.empty()) throw MeshFileError("has no triangles");
  return mesh;
}

std::vector<std::size_t> leave_out_degenerate(MeshData& mesh) {
  std::vector<std::size_t> left_out;
  std::vector<std::array<std::uint32_t, 3>> kept;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (kds::collision::is_degenerate(mesh.vertices, mesh.triangles[i])) {
      left_out.push_back(i);
    } else {
      kept.push_back(mesh.triangles[i]);
    }
  }
  if (kept.empty()) return {};
  mesh.triangles = std::move(kept);
  return left_out;
}

std::string to_obj(const MeshData& mesh) {
  std::string text;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    text += 'v';
    for (int d = 0; d < 3; ++d) {
      text += ' ';
      append_number(text, v[d]);
    }
    text += '\n';
  }
  for (const auto& triangle : mesh.triangles) {
    text += 'f';
    for (const std::uint32_t i : triangle) {
      text += ' ';
      append_number(text, i + 1);
    }
    text += '\n';
  }
  return text;
}

}  // namespace kds::io
