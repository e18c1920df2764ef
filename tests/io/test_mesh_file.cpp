#include "io/mesh_file.hpp"

#include "collision/shapes/mesh.hpp"
#include "tests/io/temporary_folder.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace test_mesh_file {

using namespace kds::io;
using kds::io::tests::TemporaryFolder;

TEST_CASE("mesh file: OBJ keeps the order and every bit of its vertices") {
  const TemporaryFolder folder;
  const MeshData mesh = read_mesh_file(folder.write("a.obj",
                                                    "# a comment\n"
                                                    "o thing\n"
                                                    "v 0.3 0.1 1e-7\r\n"
                                                    "v 5 5 5\n"  // in no face
                                                    "\tv  1 0 -0.7  1.0\n"
                                                    "v +2 1.1 0\n"
                                                    "vn 0 0 1\nvt 0 0\n"
                                                    "f 4/1/1 3//1 1\n"
                                                    "usemtl none\n"
                                                    "f -4 -2 -1\n"));
  REQUIRE(mesh.vertices.size() == 4);
  CHECK(mesh.vertices[0] == Eigen::Vector3d(0.3, 0.1, 1e-7));
  CHECK(mesh.vertices[2] == Eigen::Vector3d(1, 0, -0.7));
  CHECK(mesh.vertices[3] == Eigen::Vector3d(2, 1.1, 0));
  REQUIRE(mesh.triangles.size() == 2);
  CHECK(mesh.triangles[0] == std::array<std::uint32_t, 3>{3, 2, 0});
  CHECK(mesh.triangles[1] == std::array<std::uint32_t, 3>{0, 2, 3});
}

TEST_CASE("mesh file: polygons are cut into triangles") {
  const TemporaryFolder folder;
  const MeshData mesh = read_mesh_file(folder.write("a.obj",
                                                    "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nv 1 2 0\n"
                                                    "f 1 2 3 4\nf 1 2 3 5 4\n"));
  CHECK(mesh.triangles.size() == 5);
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    area += 0.5 * (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm();
  }
  CHECK(area == Approx(2 + 3));
}

TEST_CASE("mesh file: what is written is read back bit for bit") {
  const TemporaryFolder folder;
  MeshData mesh;
  for (int i = 0; i < 20; ++i) mesh.vertices.emplace_back(std::sin(i), std::cos(i) * 1e-9, std::tan(i) * 1e9);
  for (std::uint32_t i = 0; i + 2 < 20; ++i) mesh.triangles.push_back({i, i + 1, i + 2});
  const MeshData again = read_mesh_file(folder.write("a.obj", to_obj(mesh)));
  CHECK(again.vertices == mesh.vertices);
  CHECK(again.triangles == mesh.triangles);
}

TEST_CASE("mesh file: equal vertices of an STL file become one") {
  const TemporaryFolder folder;
  const std::string ascii =
      "solid s\n"
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
      "facet normal 0 0 1\nouter loop\nvertex 1 0 0\nvertex 1 1e-3 0\nvertex 0 1 0\nendloop\nendfacet\n"
      "endsolid s\n";
  const MeshData mesh = read_mesh_file(folder.write("a.stl", ascii));
  CHECK(mesh.vertices.size() == 4);
  REQUIRE(mesh.triangles.size() == 2);
  CHECK(mesh.triangles[1] == std::array<std::uint32_t, 3>{1, 3, 2});

  std::string binary(80, ' ');
  const auto append = [&binary](auto value) { binary.append(reinterpret_cast<const char*>(&value), sizeof value); };
  append(std::uint32_t{2});
  for (const auto& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) append(0.0F);
    for (const std::uint32_t v : triangle) {
      for (int d = 0; d < 3; ++d) append(static_cast<float>(mesh.vertices[v][d]));
    }
    append(std::uint16_t{0});
  }
  const MeshData same = read_mesh_file(folder.write("B.STL", binary));
  CHECK(same.vertices == mesh.vertices);
  CHECK(same.triangles == mesh.triangles);
}

TEST_CASE("mesh file: coordinates of an STL file that are not finite are refused with their triangle") {
  const TemporaryFolder folder;
  const std::string coordinate = GENERATE("nan", "inf", "-inf", "1e39");
  INFO(coordinate);
  const std::string good =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  const std::string bad =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 " + coordinate + " 0\nvertex 0 1 0\nendloop\nendfacet\n";
  const auto file = folder.write("a.stl", "solid s\n" + good + bad + "endsolid s\n");
  CHECK_THROWS_WITH(read_mesh_file(file), "line 9: triangle 1: has a coordinate that is not finite");
}

TEST_CASE("mesh file: lines end in LF, CR or both, and go on after a backslash, and a mark of UTF-8 is passed over") {
  const TemporaryFolder folder;
  const std::string text = "\xEF\xBB\xBFv 0 0 0\nv 1 0 \\\n0\nv 0 1 0\nf 1 2\\\n3\nf 1 \\\n 3 \\\n 2\n";
  std::string carriage = text, both;
  std::replace(carriage.begin(), carriage.end(), '\n', '\r');
  for (const char c : text) both += c == '\n' ? "\r\n" : std::string(1, c);
  for (const std::string& written : {text, carriage, both, text.substr(0, text.size() - 1), text + "\\"}) {
    CAPTURE(written);
    const MeshData mesh = read_mesh_file(folder.write("a.obj", written));
    CHECK(mesh.vertices.size() == 3);
    CHECK(mesh.triangles == std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 1}});
  }
}

TEST_CASE("mesh file: faces without area are left out, whatever their corners") {
  const TemporaryFolder folder;
  MeshData mesh = read_mesh_file(folder.write("a.obj",
                                              "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 3 0 0\nv 2 0 0\n"
                                              "f 1 2 3\n"
                                              "f 1\nf 1 2\nf 2 2 2 2\nf 1 2 1 2\nf 1 4 2 5\nf 3 2 1\n"));
  CHECK(mesh.triangles.size() == 7);
  CHECK(leave_out_degenerate(mesh) == std::vector<std::size_t>{1, 2, 3, 4, 5});
  CHECK(mesh.triangles == std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {2, 1, 0}});
}

TEST_CASE("mesh file: degenerate triangles are left out") {
  const TemporaryFolder folder;
  MeshData mesh = read_mesh_file(folder.write("a.obj",
                                              "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nv 0 0 0\nv 0.5 1e-18 0\n"
                                              "f 1 1 2\n"  // a vertex twice
                                              "f 1 2 3\n"
                                              "f 1 2 4\n"  // in a line
                                              "f 1 5 3\n"  // two vertices in one place
                                              "f 1 6 2\n"  // in a line, up to roundings
                                              "f 3 2 4\n"));
  CHECK(leave_out_degenerate(mesh) == std::vector<std::size_t>{0, 2, 3, 4});
  using Triangle = std::array<std::uint32_t, 3>;
  CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}});
  CHECK(mesh.vertices.size() == 6);
  CHECK(leave_out_degenerate(mesh).empty());
}

TEST_CASE("mesh file: faces that cross themselves are fans") {
  const TemporaryFolder folder;
  const std::string square = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";
  MeshData mesh = read_mesh_file(folder.write("a.obj", square + "f 1 2 3\nf 1 4 2 3\n"));
  CHECK(mesh.triangles == std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 3, 1}, {0, 1, 2}});
  CHECK(mesh.fans == std::vector<std::size_t>{6});
  CHECK(mend(mesh) == std::vector<std::string>{"a face crosses itself and is cut as a fan, in line 6"});
  mesh = read_mesh_file(folder.write("a.obj", square + "f 1 4 2 3\n\nf 2 3 2 4 1\nf 3 1 2 3 1 2\nf 1 2 2\n"));
  CHECK(mend(mesh) == std::vector<std::string>{"2 faces cross themselves and are cut as fans, the first is in line 5",
                                               "3 of 8 triangles are degenerate and left out, the first is in line 8"});
}

TEST_CASE("mesh file: a mesh of which no triangle is left is refused") {
  const TemporaryFolder folder;
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 2 0 0\n";
  MeshData mesh = read_mesh_file(folder.write("a.obj", vertices + "f 1 2 3\n"));
  CHECK_THROWS_WITH(mend(mesh), "no triangle is left: 1 of 1 triangle is degenerate, in line 4");
  mesh = read_mesh_file(folder.write("a.obj", vertices + "f 1 1 3\n\nf 1 2 3\n"));
  CHECK_THROWS_WITH(mend(mesh), "no triangle is left: 2 of 2 triangles are degenerate, the first is in line 4");
}

TEST_CASE("mesh file: a binary STL file is refused with the byte of its triangle") {
  const TemporaryFolder folder;
  std::string binary(80, ' ');
  const auto append = [&binary](auto value) { binary.append(reinterpret_cast<const char*>(&value), sizeof value); };
  append(std::uint32_t{3});
  for (int triangle = 0; triangle < 3; ++triangle) {
    for (int k = 0; k < 12; ++k) append(triangle == 2 && k == 7 ? INFINITY : float(k * k));
    append(std::uint16_t{0});
  }
  CHECK_THROWS_WITH(read_mesh_file(folder.write("a.stl", binary)),
                    "byte 184: triangle 2: has a coordinate that is not finite");
}

TEST_CASE("mesh file: the defects of ordinary models, at random") {
  const TemporaryFolder folder;
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    std::mt19937 random(seed);
    const std::string end = seed % 2 == 0 ? "\r\n" : "\n";
    std::string text = "# cells of a plane" + end;
    std::size_t line = 1, vertices = 0, without_area = 0, first_without_area = 0;
    std::map<std::size_t, double> areas;  // by line
    const auto vertex = [&](double x, double y) {
      text += "v " + std::to_string(x) + ' ' + std::to_string(y) + " 0" + end;
      ++line;
      return ++vertices;
    };
    // Corners are told as others tell them: with normals that are there or not, or counted from the end.
    const auto face = [&](const std::vector<std::size_t>& corners, double area) {
      text += 'f';
      const auto style = random() % 4;
      for (const std::size_t corner : corners) {
        text += ' ';
        text += style == 0 ? '-' + std::to_string(vertices + 1 - corner) : std::to_string(corner);
        if (style == 1) text += "//" + std::to_string(corner);
        if (style == 2) text += "/1/1";
      }
      text += end;
      areas[++line] = area;
      if (area == 0 && without_area++ == 0) first_without_area = line;
    };
    for (int cell = 0; cell < 30; ++cell) {
      const double x = 2 * (cell % 6), y = 2 * (cell / 6);
      const std::size_t a = vertex(x, y), b = vertex(x + 1, y), c = vertex(x + 1, y + 1), d = vertex(x, y + 1);
      switch (random() % 8) {
        case 0:
          face({a, b, c, d}, 1);
          break;  // a quad
        case 1:
          face({a, b, c}, 0.5), face({a, c, d}, 0.5);
          break;
        case 2:
          face({a, b, b, c, d}, 1);
          break;   // a corner twice
        case 3: {  // one vertex in two places of the list, a corner in an edge
          const std::size_t again = vertex(x, y), between = vertex(x + 0.5, y);
          face({again, between, b, c, d}, 1);
          break;
        }
        case 4: {  // a hole, connected with the outline by an edge
          const std::size_t p = vertex(x + 0.25, y + 0.25), q = vertex(x + 0.25, y + 0.75),
                            r = vertex(x + 0.75, y + 0.75), s = vertex(x + 0.75, y + 0.25);
          face({a, b, c, d, a, p, q, r, s, p}, 0.75);
          break;
        }
        case 5:
          face({a, b, c, d}, 1), face({a, b, a}, 0);
          break;
        case 6: {  // a sliver, all in a line
          const std::size_t between = vertex(x + 0.5, y);
          face({a, between, b}, 0), face({a, b, c, d}, 1);
          break;
        }
        default: {  // many corners, not convex
          const std::size_t inner = vertex(x + 0.5, y + 0.5), other = vertex(x + 0.5, y + 1);
          face({a, inner, b, c, other, d}, 0.75);
        }
      }
    }
    MeshData mesh = read_mesh_file(folder.write("a.obj", text));
    REQUIRE(mesh.lines.size() == mesh.triangles.size());
    const std::vector<std::string> said = mend(mesh);
    REQUIRE(mesh.lines.size() == mesh.triangles.size());
    std::map<std::size_t, double> left;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      const auto& [a, b, c] = mesh.triangles[i];
      const Eigen::Vector3d &o = mesh.vertices[a], &p = mesh.vertices[b], &q = mesh.vertices[c];
      left[mesh.lines[i]] += 0.5 * (p - o).cross(q - o)[2];
    }
    for (const auto& [number, area] : areas) CHECK(left[number] == Approx(area).margin(1e-12));
    CHECK_NOTHROW(kds::collision::Mesh(mesh.vertices, mesh.triangles));
    if (without_area == 0) continue;
    REQUIRE(said.size() == 1);
    CHECK_THAT(said[0], Catch::Contains("degenerate and left out"));
    CHECK(std::stoul(said[0].substr(said[0].rfind(' ') + 1)) <= first_without_area);
  }
}

TEST_CASE("mesh file: files that are no mesh") {
  const TemporaryFolder folder;
  const auto error = [&](const std::filesystem::path& file) {
    try {
      read_mesh_file(file);
      return std::string("no error");
    } catch (const MeshFileError& e) {
      return std::string(e.what());
    }
  };
  CHECK(error(folder / "none.obj") == "no such file");
  CHECK(error(folder.write("a.ply", "ply\n")) == "only .obj and .stl files are read");
  CHECK(error(folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n")) ==
        "line 4: a face names vertex 4, but the file has 3 vertices");
  CHECK(error(folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n")) != "no error");
  CHECK(error(folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf a b c\n")) != "no error");
  CHECK(error(folder.write("a.obj", std::string("\0\1\2garbage", 10))) == "has no triangles");
  const auto face_of = [&](const std::string& corners) {
    return error(folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf " + corners + "\n"));
  };
  CHECK(face_of("1 2 3") == "no error");
  CHECK(face_of("+1/7/8 2//3 3/4") == "no error");
  CHECK(face_of("1.9 2 3") == "line 5: \"1.9\" is not the number of a vertex");
  CHECK(face_of("1 2 4294967297") == "line 5: \"4294967297\" is not the number of a vertex");
  CHECK(face_of("1 2x/1 3") == "line 5: \"2x/1\" is not the number of a vertex");
  CHECK(face_of("0 1 2") == "line 5: \"0\" is not the number of a vertex");
  CHECK(face_of("1\v2 3 1 2") != "no error");
  CHECK(face_of("1 2 3\r# a comment\r\nf 1.9 2 3") == "line 7: \"1.9\" is not the number of a vertex");
  CHECK(face_of("1 2 \\\n3 \\\n\nf 1 2 3x") == "line 8: \"3x\" is not the number of a vertex");
  CHECK(face_of("-1 -2 -4") == "line 5: a face names vertex -4, but there are 3 before it");
  CHECK(face_of("-1 -2 -2147483648") == "line 5: a face names vertex -2147483648, but there are 3 before it");
  CHECK(face_of("1 2 2147483647") == "line 5: a face names vertex 2147483647, but the file has 3 vertices");
  CHECK(face_of("") == "line 5: a face has no corners");
  CHECK(error(folder.write("a.stl", "solid s\nendsolid s\n")) != "no error");
  CHECK(error(folder.write("a.stl", "x")) != "no error");
}

}  // namespace test_mesh_file
