#include "examples/kds-collide/mesh_file.hpp"

#include "examples/kds-collide/number_text.hpp"

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

namespace kds_collide {
namespace {

std::string read_text(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file)) throw MeshFileError("is a directory");
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf())) throw MeshFileError("cannot be read, or is empty");
  return std::move(text).str();
}

/// The vertices of an OBJ file. tinyobjloader rounds numbers carelessly (0.3 becomes 0.30000000000000004) and takes
/// what is no number for 0, so the coordinates are read here and only the faces there.
std::vector<Eigen::Vector3d> read_obj_vertices(std::istream& text) {
  std::vector<Eigen::Vector3d> vertices;
  std::string line;
  for (std::size_t number = 1; std::getline(text, line); ++number) {
    std::istringstream words(line);
    std::string word;
    if (!(words >> word) || word != "v") continue;
    Eigen::Vector3d vertex;
    for (int d = 0; d < 3; ++d) {
      const auto where = [number] { return "line " + std::to_string(number) + ": "; };
      if (!(words >> word)) throw MeshFileError(where() + "a vertex needs three coordinates");
      const char* begin = word.data() + (word.starts_with('+') ? 1 : 0);
      const char* end = word.data() + word.size();
      const auto [stop, error] = std::from_chars(begin, end, vertex[d]);
      if (error != std::errc() || stop != end || !std::isfinite(vertex[d])) {
        throw MeshFileError(where() + "\"" + word + "\" is not a finite number");
      }
    }
    vertices.push_back(vertex);
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
  if (attributes.vertices.size() != 3 * vertex_count) throw MeshFileError("has line ends other than LF or CR LF");
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
      if (face.mNumIndices != 3) throw MeshFileError("face " + std::to_string(f) + " is not a triangle");
      std::array<std::uint32_t, 3> triangle{};
      for (std::size_t i = 0; i < 3; ++i) {
        const aiVector3D& p = part.mVertices[face.mIndices[i]];
        const auto next = static_cast<std::uint32_t>(mesh.vertices.size());
        const auto [entry, is_new] = numbers.try_emplace({p.x, p.y, p.z}, next);
        if (is_new) mesh.vertices.emplace_back(p.x, p.y, p.z);
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

}  // namespace kds_collide
