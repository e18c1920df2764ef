#include "io/mesh_file.hpp"

#include "collision/shapes/mesh.hpp"
#include "io/polygon.hpp"
#include "kds/number_text.hpp"

#include <assimp/scene.h>

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

/// The first word of `line`, which loses it; empty at the end.
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

/// `words` are what follows the f of a line: corners such as 7, 7/1, 7//1 and -2, the last vertex but one of the
/// `vertices` that come before the line. Numbers from 0.
std::vector<std::uint32_t> read_obj_face(std::string_view words, std::size_t vertices) {
  std::vector<std::uint32_t> corners;
  for (std::string_view word = next_word(words); !word.empty(); word = next_word(words)) {
    int vertex = 0;
    const bool is_number = read_number(word.substr(0, word.find('/')), vertex) && vertex != 0;
    if (!is_number) throw MeshFileError('"' + std::string(word) + "\" is not the number of a vertex");
    if (vertex < 0 && static_cast<std::size_t>(-static_cast<std::int64_t>(vertex)) > vertices) {
      throw MeshFileError("a face names vertex " + std::to_string(vertex) + ", but there are " +
                          std::to_string(vertices) + " before it");
    }
    corners.push_back(
        static_cast<std::uint32_t>(vertex > 0 ? vertex - 1 : static_cast<std::int64_t>(vertices) + vertex));
  }
  if (corners.empty()) throw MeshFileError("a face has no corners");
  return corners;
}

/// Hands out the lines of a text, with the number of each; they end in LF, CR or both, and one that ends in a backslash
/// goes on in the next.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {
    if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);  // a mark of UTF-8
  }

  bool next() {
    if (text_.empty()) return false;
    line.clear();
    number = last_ + 1;
    do {
      if (line.ends_with('\\')) line.back() = ' ';
      const std::size_t length = std::min(text_.find_first_of("\r\n"), text_.size());
      line += text_.substr(0, length);
      text_.remove_prefix(length);
      if (text_.starts_with("\r\n")) text_.remove_prefix(1);
      if (!text_.empty()) text_.remove_prefix(1);
      ++last_;
    } while (line.ends_with('\\') && !text_.empty());
    return true;
  }

  std::string line;
  std::size_t number = 0;  ///< of the first of those that it is made of

 private:
  std::string_view text_;
  std::size_t last_ = 0;
};

/// Vertices and faces; what else there is has no meaning here.
MeshData read_obj(const std::filesystem::path& file) {
  const std::string text = read_text(file);
  struct Face {
    std::size_t line;
    std::vector<std::uint32_t> corners;
  };
  std::vector<Face> faces;
  MeshData mesh;
  const auto at_line = [](std::size_t number, const auto& read) {
    try {
      read();
    } catch (const MeshFileError& error) {
      throw MeshFileError("line " + std::to_string(number) + ": " + error.what());
    }
  };
  for (Lines lines(text); lines.next();) {
    at_line(lines.number, [&] {
      std::string_view rest = lines.line;
      const std::string_view keyword = next_word(rest);
      if (keyword == "v") mesh.vertices.push_back(read_obj_vertex(rest));
      if (keyword == "f") faces.push_back({lines.number, read_obj_face(rest, mesh.vertices.size())});
    });
  }
  for (const Face& face : faces) {
    at_line(face.line, [&] {
      for (const std::uint32_t corner : face.corners) {
        if (corner < mesh.vertices.size()) continue;
        throw MeshFileError("a face names vertex " + std::to_string(std::uint64_t{corner} + 1) + ", but the file has " +
                            std::to_string(mesh.vertices.size()) + " vertices");
      }
      auto triangles = cut_into_triangles(mesh.vertices, face.corners);
      if (!triangles) {
        triangles = fan(face.corners);
        mesh.fans.push_back(face.line);
      }
      mesh.triangles.insert(mesh.triangles.end(), triangles->begin(), triangles->end());
      mesh.lines.resize(mesh.triangles.size(), face.line);
    });
  }
  return mesh;
}

/// Where a triangle of an STL file begins, in words. A binary file has 84 bytes, of which the last four are the number
/// of its triangles, and 50 for each.
std::string place_in_stl(const std::filesystem::path& file, std::size_t triangle) {
  constexpr std::size_t head = 84, each = 50;
  const std::string text = read_text(file);
  std::uint32_t count = 0;
  for (std::size_t k = 0; k < 4 && text.size() >= head; ++k) {
    count |= std::uint32_t{static_cast<unsigned char>(text[head - 4 + k])} << (8 * k);
  }
  if (text.size() >= head && (text.size() - head) / each == count && count > 0) {
    return "byte " + std::to_string(head + each * triangle) + ": ";
  }
  std::size_t facets = 0;
  for (Lines lines(text); lines.next();) {
    std::string_view rest = lines.line;
    if (next_word(rest) == "facet" && facets++ == triangle) return "line " + std::to_string(lines.number) + ": ";
  }
  return "";
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
        const std::size_t triangle = mesh.triangles.size();
        throw MeshFileError(place_in_stl(file, triangle) + "triangle " + std::to_string(triangle) + ": " + what);
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
  std::size_t kept = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (kds::collision::is_degenerate(mesh.vertices, mesh.triangles[i])) {
      left_out.push_back(i);
      continue;
    }
    if (!mesh.lines.empty()) mesh.lines[kept] = mesh.lines[i];
    mesh.triangles[kept++] = mesh.triangles[i];
  }
  mesh.triangles.resize(kept);
  if (!mesh.lines.empty()) mesh.lines.resize(kept);
  return left_out;
}

std::vector<std::string> mend(MeshData& mesh) {
  std::vector<std::string> sentences;
  const auto number = [](std::size_t n) { return std::to_string(n); };
  if (const std::vector<std::size_t>& fans = mesh.fans; fans.size() == 1) {
    sentences.push_back("a face crosses itself and is cut as a fan, in line " + number(fans[0]));
  } else if (!fans.empty()) {
    sentences.push_back(number(fans.size()) + " faces cross themselves and are cut as fans, the first is in line " +
                        number(fans[0]));
  }
  const std::size_t triangles = mesh.triangles.size();
  const std::string all = " of " + number(triangles) + (triangles == 1 ? " triangle" : " triangles");
  const std::vector<std::size_t> lines = mesh.lines;
  const std::vector<std::size_t> left_out = leave_out_degenerate(mesh);
  // Polygons become several triangles each, so of an OBJ file the number of one says less than its line.
  const auto place = [&] {
    return lines.empty() ? "triangle " + number(left_out[0]) : "in line " + number(lines[left_out[0]]);
  };
  if (!left_out.empty() && mesh.triangles.empty()) {
    throw MeshFileError("no triangle is left: " + number(left_out.size()) + all +
                        (left_out.size() == 1 ? " is degenerate, " : " are degenerate, the first is ") + place());
  }
  if (left_out.size() == 1) {
    sentences.push_back('1' + all + " is degenerate and left out, " + place());
  } else if (!left_out.empty()) {
    sentences.push_back(number(left_out.size()) + all + " are degenerate and left out, the first is " + place());
  }
  return sentences;
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
