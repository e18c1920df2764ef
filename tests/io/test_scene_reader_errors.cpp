#include "io/scene_reader.hpp"
#include "tests/io/sample_scene.hpp"
#include "tests/io/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

namespace test_scene_reader_errors {

using namespace kds::io;
using kds::io::tests::TemporaryFolder;
using kds::io::tests::tetrahedron;
using kds::io::tests::valid_scene;
using nlohmann::json;

namespace {

std::string error_of(const std::string& text, const std::filesystem::path& file) {
  try {
    parse_scene(text, file);
    return "no error";
  } catch (const SceneError& error) {
    return error.what();
  }
}

/// The error, with the folder's name taken out.
std::string error_in(const TemporaryFolder& folder, const std::string& text) {
  std::string error = error_of(text, folder / "scene.json");
  const std::string prefix = (folder / "").string();
  for (std::size_t at = 0; (at = error.find(prefix)) != std::string::npos;) error.erase(at, prefix.size());
  return error;
}

struct Edit {
  std::string pointer;  ///< what is replaced or added (JSON pointer)
  std::string value;    ///< JSON; empty takes it away
  std::string error;    ///< after "scene.json: "
};

std::string edited(const Edit& edit) {
  const json base = json::parse(valid_scene);
  const json patch = edit.value.empty()
                         ? json{{"op", "remove"}, {"path", edit.pointer}}
                         : json{{"op", "add"}, {"path", edit.pointer}, {"value", json::parse(edit.value)}};
  // "add" to an object replaces what is there, to an array it inserts: put the new element in, then drop the old one.
  json result = base.patch(json::array({patch}));
  const json::json_pointer pointer(edit.pointer);
  if (!edit.value.empty() && base.contains(pointer.parent_pointer()) && base[pointer.parent_pointer()].is_array() &&
      base.contains(pointer)) {
    const auto next = std::stoul(pointer.back()) + 1;
    result[pointer.parent_pointer()].erase(next);
  }
  return result.dump();
}

}  // namespace

TEST_CASE("scene reader: each bad value is named with its place") {
  const TemporaryFolder folder;
  folder.write("ring.obj", tetrahedron);
  const auto edit = GENERATE_COPY(values<Edit>({
      {"/scene", "2", "scene: must be 1, the only format there is"},
      {"/scene", "\"1\"", "scene: must be 1, the only format there is"},
      {"/scene", "", "scene: is missing"},
      {"/colour", "1", "colour: unknown key"},
      {"/end_time", "", "end_time: is missing"},
      {"/end_time", "-1", "end_time: must be >= 0, where the motion begins"},
      {"/end_time", "\"soon\"", "end_time: must be a number"},
      {"/response", "\"bouncy\"", "response: must be \"none\" or \"elastic\""},
      {"/response", "\"elastic\"",
       "bodies[2].motion[1]: with \"response\": \"elastic\" a body has only one piece of motion"},
      {"/domain", "[]", "domain: must be an object"},
      {"/domain/min", "", "domain.min: is missing"},
      {"/domain/min", "[0,0]", "domain.min: must be an array of 3 numbers"},
      {"/domain/max/1", "0", "domain.max[1]: must be > domain.min[1]"},
      {"/domain/walls", "\"soft\"", "domain.walls: must be \"open\" or \"reflect\""},
      {"/domain/colour", "0", "domain.colour: unknown key"},
      {"/domain/max", "[80,80,12]",
       "bodies[1].motion[0].position: begins outside the reflecting walls: z = 10 with a bounding radius of "
       "3.74166, between 0 and 12"},
      {"/meshes/ring/file", "\"none.obj\"", "meshes.ring.file: none.obj: no such file"},
      {"/meshes/ring/file", "\"ring.png\"", "meshes.ring.file: ring.png: no such file"},
      {"/meshes/ring/file", "7", "meshes.ring.file: must be a string"},
      {"/meshes/ring/scale", "7", "meshes.ring.scale: unknown key"},
      {"/meshes/ring", "{}", "meshes.ring.file: is missing"},
      {"/meshes/ring/heightfield", "7", "meshes.ring: must have either \"file\" or \"heightfield\""},
      {"/meshes/ring", R"({"heightfield": {"heights": [[1, 2], [3]], "spacing": [1, 1]}})",
       "meshes.ring.heightfield.heights[1]: must have as many numbers as the first row, 2"},
      {"/meshes/ring", R"({"heightfield": {"heights": [[1], [2]], "spacing": [1, 1]}})",
       "meshes.ring.heightfield.heights: must have at least two rows of two numbers"},
      {"/meshes/ring", R"({"heightfield": {"heights": [], "spacing": [1, 1]}})",
       "meshes.ring.heightfield.heights: must have at least two rows of two numbers"},
      {"/meshes/ring", R"({"heightfield": {"heights": [[1, 2], [3, "x"]], "spacing": [1, 1]}})",
       "meshes.ring.heightfield.heights[1][1]: must be a number"},
      {"/meshes/ring", R"({"heightfield": {"heights": [[1, 2], [3, 4]], "spacing": [1, 0]}})",
       "meshes.ring.heightfield.spacing[1]: must be > 0"},
      {"/meshes/ring", R"({"heightfield": {"heights": [[1, 2], [3, 4]]}})",
       "meshes.ring.heightfield.spacing: is missing"},
      {"/bodies", "", "bodies: is missing"},
      {"/bodies", "{}", "bodies: must be an array"},
      {"/bodies/1", "3", "bodies[1]: must be an object"},
      {"/bodies/1/colour", "3", "bodies[1].colour: unknown key"},
      {"/bodies/1/name", "", "bodies[1].name: is missing"},
      {"/bodies/1/name", "\"\"", "bodies[1].name: must not be empty"},
      {"/bodies/1/name", "\"a\"", "bodies[1].name: \"a\" is the name of bodies[0] too"},
      {"/bodies/1/name", "\"a\\nb\"", "bodies[1].name: must not hold control characters"},
      {"/bodies/0/shape", "", "bodies[0].shape: is missing"},
      {"/bodies/0/shape", "{}",
       "bodies[0].shape: must have exactly one of \"sphere\", \"box\", \"mesh\", \"capsule\", \"hull\", "
       "\"half_space\" and \"compound\""},
      {"/bodies/0/shape/box", "{}",
       "bodies[0].shape: must have exactly one of \"sphere\", \"box\", \"mesh\", \"capsule\", \"hull\", "
       "\"half_space\" and \"compound\""},
      {"/bodies/0/shape/cone", "{}", "bodies[0].shape.cone: unknown key"},
      {"/bodies/0/shape/scale", "2", "bodies[0].shape.scale: is for meshes only"},
      {"/bodies/0/shape/sphere/radius", "0", "bodies[0].shape.sphere.radius: must be > 0"},
      {"/bodies/0/shape/sphere/radius", "-1", "bodies[0].shape.sphere.radius: must be > 0"},
      {"/bodies/0/shape/sphere/radius", "1e-40", "bodies[0].shape.sphere.radius: must be at least 1e-30"},
      {"/bodies/0/shape/sphere/radius", "1e40", "bodies[0].shape.sphere.radius: must be at most 1e+30 in magnitude"},
      {"/bodies/0/shape/sphere/radius", "null", "bodies[0].shape.sphere.radius: must be a number"},
      {"/bodies/0/shape/sphere", "{}", "bodies[0].shape.sphere.radius: is missing"},
      {"/bodies/0/shape", R"({"capsule": {"radius": 1}})", "bodies[0].shape.capsule.half_length: is missing"},
      {"/bodies/0/shape", R"({"capsule": {"radius": 0, "half_length": 1}})",
       "bodies[0].shape.capsule.radius: must be > 0"},
      {"/bodies/0/shape", R"({"capsule": {"radius": 1, "half_length": -1}})",
       "bodies[0].shape.capsule.half_length: must be >= 0"},
      {"/bodies/0/shape", R"({"capsule": {"radius": 1, "half_length": 1e-40}})",
       "bodies[0].shape.capsule.half_length: must be 0, or at least 1e-30"},
      {"/bodies/0/shape", R"({"capsule": {"radius": 1, "half_length": 1, "axis": 2}})",
       "bodies[0].shape.capsule.axis: unknown key"},
      {"/bodies/0/shape", R"({"half_space": {"normal": [0, 0, 1]}})", "bodies[0].shape.half_space.offset: is missing"},
      {"/bodies/0/shape", R"({"compound": {}})", "bodies[0].shape.compound.parts: is missing"},
      {"/bodies/0/shape", R"({"compound": {"parts": []}})",
       "bodies[0].shape.compound.parts: must have at least one part"},
      {"/bodies/0/shape", R"({"compound": {"parts": [{"shape": {"sphere": {"radius": 1}}}]}})",
       "bodies[0].shape.compound.parts[0].shape.sphere: cannot be a part of a compound: boxes, hulls and meshes can"},
      {"/bodies/0/shape", R"({"compound": {"parts": [{"shape": {"compound": {"parts": 1}}}]}})",
       "bodies[0].shape.compound.parts[0].shape.compound: cannot be a part of a compound: boxes, hulls and meshes can"},
      {"/bodies/0/shape",
       R"({"compound": {"parts": [{"shape": {"box": {"half_extents": [1,1,1]}}}], "about_centre_of_mass": 1}})",
       "bodies[0].shape.compound.about_centre_of_mass: must be true or false"},
      {"/bodies/0/shape", R"({"compound": {"parts": [{"shape": {"box": {"half_extents": [1,1,1]}}, "at": 1}]}})",
       "bodies[0].shape.compound.parts[0].at: unknown key"},
      {"/bodies/0/shape",
       R"({"compound": {"parts": [{"shape": {"box": {"half_extents": [1,1,1]}}, "position": [1,2]}]}})",
       "bodies[0].shape.compound.parts[0].position: must be an array of 3 numbers"},
      {"/bodies/0/shape",
       R"({"compound": {"parts": [{"shape": {"box": {"half_extents": [1,1,1]}}},
           {"shape": {"box": {"half_extents": [1,1,1e-25]}}, "position": [0,0,1]}]}})",
       "bodies[0].shape.compound.parts[1]: has no volume: all points lie in a plane"},
      {"/bodies/0/shape", R"({"hull": {}})", "bodies[0].shape.hull.points: is missing"},
      {"/bodies/0/shape", R"({"hull": {"points": [[0,0,0],[1,0,0],[0,1,0],[0,0,1],[1,1]]}})",
       "bodies[0].shape.hull.points[4]: must be an array of 3 numbers"},
      {"/bodies/0/shape", R"({"hull": {"points": [[0,0,0],[1,0,0],[0,1,0]]}})",
       "bodies[0].shape.hull.points: has 3 points; a solid takes at least 4"},
      {"/bodies/0/shape", R"({"hull": {"points": [[0,0,0],[1,0,0],[0,1,0],[1,1,0]]}})",
       "bodies[0].shape.hull.points: has no volume: all points lie in a plane"},
      {"/bodies/0/shape", R"({"hull": {"points": [[0,0,0],[1,1,1],[2,2,2],[-1,-1,-1]]}})",
       "bodies[0].shape.hull.points: has no volume: all points lie in a line"},
      {"/bodies/0/shape", R"({"hull": {"points": [[0,0,0],[1,0,0],[0,1,0],[0,0,1]], "scale": 2}})",
       "bodies[0].shape.hull.scale: unknown key"},
      {"/bodies/1/shape/box/half_extents", "1", "bodies[1].shape.box.half_extents: must be an array of 3 numbers"},
      {"/bodies/1/shape/box/half_extents/2", "0", "bodies[1].shape.box.half_extents[2]: must be > 0"},
      {"/bodies/2/shape/mesh", "\"rang\"", "bodies[2].shape.mesh: there is no mesh \"rang\" in \"meshes\""},
      {"/bodies/2/shape/scale", "0", "bodies[2].shape.scale: must be > 0"},
      {"/bodies/2/orientation", "[1,1,0,0]", "bodies[2].orientation: must be a unit quaternion; its norm is 1.41421"},
      {"/bodies/2/orientation", "[0,0,0,0]", "bodies[2].orientation: must be a unit quaternion; its norm is 0"},
      {"/bodies/2/orientation", "[1,0,0]", "bodies[2].orientation: must be an array of 4 numbers"},
      {"/bodies/1/mass", "0", "bodies[1].mass: must be > 0"},
      {"/bodies/1/mass", "\"2\"", "bodies[1].mass: must be a number"},
      {"/bodies/1/inertia", "0", "bodies[1].inertia: must be > 0"},
      {"/bodies/1/inertia", "\"1\"", "bodies[1].inertia: must be a number"},
      {"/bodies/1/inertia", "[1,1]", "bodies[1].inertia: must be an array of 3 numbers"},
      {"/bodies/1/inertia", "[1,0,1]", "bodies[1].inertia[1]: must be > 0"},
      {"/bodies/1/inertia", "[1,[0,1,0],1]", "bodies[1].inertia[1]: must be a number"},
      {"/bodies/1/inertia", "[[1,0,0],[0,1],[0,0,1]]", "bodies[1].inertia[1]: must be an array of 3 numbers"},
      {"/bodies/0/motion/0/angular_velocity", "1",
       "bodies[0].motion[0].angular_velocity: must be an array of 3 numbers"},
      {"/bodies/0/motion/0/angular_velocity", "[0,0,1e31]",
       "bodies[0].motion[0].angular_velocity[2]: must be at most 1e+30 in magnitude"},
      {"/bodies/0/motion/0/pivot", "[1,0,0]",
       "bodies[0].motion[0].pivot: a sphere turns about its centre alone: boxes, hulls, compounds and meshes "
       "may have a pivot"},
      {"/bodies/1/motion/0/pivot", "[1,0]", "bodies[1].motion[0].pivot: must be an array of 3 numbers"},
      {"/bodies/2/motion/0/pivot", "[1,0,0]", "bodies[2].motion[1]: all pieces of a motion must have the same pivot"},
      {"/bodies/2/motion/1/pivot", "[1,0,0]",
       "bodies[2].motion[1].pivot: all pieces of a motion must have the same pivot"},
      {"/bodies/0/motion/0/orientation", "[1,0,0,0]",
       "bodies[0].motion[0].orientation: the first piece begins with the \"orientation\" of the body"},
      {"/bodies/2/motion/1/orientation", "[1,1,0,0]",
       "bodies[2].motion[1].orientation: must be a unit quaternion; its norm is 1.41421"},
      {"/bodies/1/fixed", "1", "bodies[1].fixed: must be true or false"},
      {"/restitution", "1.5", "restitution: must be in [0, 1]"},
      {"/restitution", "\"high\"", "restitution: must be a number"},
      {"/domain/restitution", "-0.1", "domain.restitution: must be in [0, 1]"},
      {"/bodies/1/restitution", "-1", "bodies[1].restitution: must be in [0, 1]"},
      {"/bodies/1/restitution", "null", "bodies[1].restitution: must be a number"},
      {"/friction", "-0.1", "friction: must be >= 0"},
      {"/bodies/1/friction", "\"rough\"", "bodies[1].friction: must be a number"},
      {"/tangential_restitution", "1.5", "tangential_restitution: must be in [-1, 1]"},
      {"/bodies/1/tangential_restitution", "-2", "bodies[1].tangential_restitution: must be in [-1, 1]"},
      {"/rolling_friction", "-1", "rolling_friction: must be >= 0"},
      {"/bodies/1/rolling_friction", "\"soft\"", "bodies[1].rolling_friction: must be a number"},
      {"/domain/friction", "1", "domain.friction: unknown key"},
      {"/friction", "0.5",
       "friction: bodies of this scene do not turn: none has an \"angular_velocity\" or an \"inertia\""},
      {"/bodies/2/tangential_restitution", "0",
       "bodies[2].tangential_restitution: bodies of this scene do not turn: none has an \"angular_velocity\" or an "
       "\"inertia\""},
      {"/bodies/0/motion", "", "bodies[0].motion: is missing"},
      {"/bodies/0/motion", "[]", "bodies[0].motion: must have at least one piece"},
      {"/bodies/0/motion/0/start", "", "bodies[0].motion[0].start: is missing"},
      {"/bodies/0/motion/0/position", "[]", "bodies[0].motion[0].position: must have at least one coefficient"},
      {"/bodies/0/motion/0/position/1", "[1,2]", "bodies[0].motion[0].position[1]: must be an array of 3 numbers"},
      {"/bodies/0/motion/0/position/1/0", "true", "bodies[0].motion[0].position[1][0]: must be a number"},
      {"/bodies/0/motion/0/position", "[[1,1,1],[1,1,1],[1,1,1],[1,1,1]]",
       "bodies[0].motion[0].position: has 4 coefficients; at most 3 (position, velocity, half the acceleration) are "
       "supported"},
      {"/bodies/0/motion/0/position/1", "[0,0,1e31]",
       "bodies[0].motion[0].position[1][2]: must be at most 1e+30 in magnitude"},
      {"/bodies/0/motion/0/start", "-1e29",
       "bodies[0].motion[0].position: may reach a magnitude of 4.9e+58 "
       "by t = 1; at most 1e+30 is supported"},
      {"/bodies/2/motion/1/start", "0",
       "bodies[2].motion[1].start: must be later than the start of the piece before, 0"},
      {"/bodies/2/motion/1/position/0/0", "79",
       "bodies[2].motion[1].position: begins outside the reflecting walls: x = 79 with a bounding radius of "
       "2, between 0 and 80"},
  }));
  INFO("edit of " << edit.pointer << " to " << edit.value);
  CHECK(error_in(folder, edited(edit)) == "scene.json: " + edit.error);
}

TEST_CASE("scene reader: what is not JSON is named with path, line and column") {
  const auto [text, error] = GENERATE(table<std::string, std::string>({
      {"",
       "scene.json: document: line 1, column 1: syntax error while parsing value - unexpected end of input; "
       "expected '[', '{', or a literal"},
      {"{\"scene\": 1,\n \"end_time\": NaN}",
       "scene.json: end_time: line 2, column 14: syntax error while parsing value - invalid literal; last read: "
       "'\"end_time\": N'"},
      {"{\"scene\": 1, \"bodies\": [{\"mass\": Infinity}]}",
       "scene.json: bodies[0].mass: line 1, column 34: syntax error while parsing value - invalid literal; last read: "
       "'\"mass\": I'"},
      {"{\"end_time\": 1e999}", "scene.json: end_time: number overflow parsing '1e999'"},
      {"{\"bodies\": [1, 2, [-1e999]]}", "scene.json: bodies[2][0]: number overflow parsing '-1e999'"},
      {"{\"scene\": 1, \"scene\": 1}", "scene.json: scene: this key is given twice"},
      {"{\"meshes\": {\"a\": {\"file\": \"x\", \"file\": \"y\"}}}",
       "scene.json: meshes.a.file: this key is given twice"},
      {"{\"\": 1}", "scene.json: \"\": unknown key"},
      {"{\"\": 1e999}", "scene.json: \"\": number overflow parsing '1e999'"},
      {"{\"scene\": 1, \"end_time\": 1, \"meshes\": {\"\": {\"file\": 1, \"\": 1}}}",
       "scene.json: meshes.\"\".\"\": unknown key"},
      {"{\"meshes\": {\"\": [1e999]}}", "scene.json: meshes.\"\"[0]: number overflow parsing '1e999'"},
      {"[]", "scene.json: document: must be an object"},
      {"7", "scene.json: document: must be an object"},
  }));
  CHECK(error_of(text, "scene.json") == error);
}

TEST_CASE("scene reader: a file that cannot be read") {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& name) {
    try {
      read_scene(folder / name);
      return std::string("no error");
    } catch (const SceneError& e) {
      return std::string(e.what());
    }
  };
  CHECK(error("none.json") == (folder / "none.json").string() + ": file: cannot be read: No such file or directory");
  CHECK(error("") == (folder / "").string() + ": file: cannot be read: Is a directory");
  folder.write("empty.json", "");
  CHECK_THAT(error("empty.json"), Catch::Contains("empty.json: document: line 1, column 1: syntax error"));
}

TEST_CASE("scene reader: a NUL byte is named where it is, also after the document") {
  using namespace std::string_literals;
  const auto error = [](const std::string& text) { return error_of(text, "scene.json"); };
  const std::string whole = R"({"scene": 1, "end_time": 1, "bodies": []})";
  REQUIRE(parse_scene(whole, "scene.json").bodies.empty());
  const std::string nul = "a NUL byte, which JSON has no place for";
  CHECK(error(whole + "\0"s) == "scene.json: document: line 1, column 42: " + nul);
  CHECK(error(whole + "\n\0{"s) == "scene.json: document: line 2, column 1: " + nul);
  CHECK(error("\0"s + whole) == "scene.json: document: line 1, column 1: " + nul);
  CHECK(error("{\n\"scene\": \0 1}"s) == "scene.json: scene: line 2, column 10: " + nul);
  CHECK(error("{\"bodies\": [{\"name\": \"b\0\"}]}"s) == "scene.json: bodies[0].name: line 1, column 24: " + nul);
  CHECK(error("{\"scene\": 1,").find("unexpected end of input") != std::string::npos);
}

TEST_CASE("scene reader: an error is one line, whatever the keys and names hold") {
  const std::string error = error_of("{\"a\\nb\": 1, \"scene\": 1}", "sce\nne.json");
  CHECK(error == "sce ne.json: a b: unknown key");
}

TEST_CASE("scene reader: an error is UTF-8, whatever the bytes of the file are") {
  const auto in_key = [](const std::string& key) { return "{\"scene\": 1, \"" + key + "\": 1}"; };
  const std::string instead = "\xef\xbf\xbd";  // U+FFFD
  CHECK(error_of(in_key("s\xf6"), "scene.json") ==
        "scene.json: scene: line 1, column 16: syntax error while parsing object key - invalid string: ill-formed "
        "UTF-8 byte; last read: '\"s" +
            instead + "'; expected string literal");
  CHECK(error_of("[\xff", "scene.json").find("last read: '[" + instead + "'") != std::string::npos);
  CHECK(error_of("{}", "\xff.json").starts_with(instead + ".json: scene: "));
  CHECK(error_of(in_key("caf\u00e9"), "scene.json") == "scene.json: caf\u00e9: unknown key");
  // What begins another line, or tells a terminal something.
  CHECK(error_of(in_key("a\u2028b\u0085c\u009bd"), "scene.json") == "scene.json: a b c d: unknown key");
}

TEST_CASE("scene reader: bad mesh files are named with mesh and place") {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& mesh) {
    folder.write("ring.obj", mesh);
    return error_in(folder, valid_scene);
  };
  const std::string where = "scene.json: meshes.ring.file: ring.obj: ";
  CHECK_THAT(error("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"),
             Catch::StartsWith(where + "no triangle is left: 1 of 1 triangle is degenerate, in line 4"));
  CHECK(error("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 2\n") == "no error");  // it is left out
  CHECK(error("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n") ==
        where + "line 4: a face names vertex 4, but the file has 3 vertices");
  CHECK(error("v 0 0 0\nv 1 0\n") == where + "line 2: a vertex needs three coordinates");
  CHECK(error("v 0 0 0\n\nv 1 nan 0\n") == where + "line 3: \"nan\" is not a finite number");
  CHECK(error("v 0 0 x1\n") == where + "line 1: \"x1\" is not a finite number");
  CHECK(error("v 0 0 0\nv 1 0 0\nv 0 1 0\n") == where + "has no triangles");
  CHECK(error("") == where + "cannot be read, or is empty");
}

TEST_CASE("scene reader: a mesh times its scale is of a size that is supported") {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& size, const std::string& scale) {
    folder.write("ring.obj", "v 0 0 0\nv " + size + " 0 0\nv 0 " + size + " 0\nf 1 2 3\n");
    return error_in(folder, R"({"scene": 1, "end_time": 1, "meshes": {"ring": {"file": "ring.obj"}}, "bodies": [
      {"name": "a", "shape": {"mesh": "ring")" +
                                scale + R"(}, "motion": [{"start": 0, "position": [[0,0,0]]}]}]})");
  };
  CHECK(error("0.9e20", R"(, "scale": 1e10)") == "no error");
  CHECK(error("1e30", R"(, "scale": 1e30)") ==
        "scene.json: bodies[0].shape.scale: makes the mesh reach 1e+60 from its origin; at most 1e+30 is supported");
  CHECK(error("1e-20", R"(, "scale": 1e-20)") ==
        "scene.json: bodies[0].shape.scale: makes the mesh reach 1e-40 from its origin; at least 1e-30 is supported");
  CHECK(error("1.2e30", "") ==
        "scene.json: bodies[0].shape.mesh: reaches 1.2e+30 from its origin; at most 1e+30 is supported");
  CHECK(error("1 0 0\nv 1 1e-5", R"(, "scale": 1e-30)") ==
        "scene.json: bodies[0].shape.scale: makes an edge of the mesh 1e-35 long; at least 7.70372e-34 is supported");
}

TEST_CASE("scene reader: no mutation of a valid scene breaks it") {
  const TemporaryFolder folder;
  folder.write("ring.obj", tetrahedron);
  const auto seed = static_cast<std::uint64_t>(GENERATE(range(1, 9)));
  INFO("seed " << seed);
  std::mt19937_64 random(seed);
  const std::vector<std::string> pieces{"0",  "-1",   "1e400", "NaN",    "null", "[",  "]",    "{",        "}",
                                        ",",  "\"",   ":",     "[[[]]]", "1e-5", "{}", "true", "\xff",     "\"a\"",
                                        "\\", "1e30", "-1e30", "\n",     "0.5",  "//", "-0",   "\"mesh\"", "\xf0\x9f"};
  int scenes = 0;
  int errors = 0;
  for (int round = 0; round < 400; ++round) {
    std::string text = valid_scene;
    const std::uint64_t changes = 1 + random() % 4;
    for (std::uint64_t i = 0; i < changes; ++i) {
      const std::size_t at = random() % text.size();
      const std::size_t length = std::min<std::size_t>(random() % 8, text.size() - at);
      switch (random() % 4) {
        case 0:
          text.erase(at, length);
          break;
        case 1:
          text.replace(at, length, pieces[random() % pieces.size()]);
          break;
        case 2:
          text.insert(at, text.substr(random() % text.size(), random() % 40));
          break;
        default:
          text[at] = static_cast<char>(random());
      }
    }
    try {
      const Scene scene = parse_scene(text, folder / "scene.json");
      REQUIRE(scene.end_time >= scene.begin_time);
      for (const SceneBody& body : scene.bodies) REQUIRE_FALSE(body.motion.empty());
      ++scenes;
    } catch (const SceneError& error) {
      const std::string line = error.what();
      INFO(line);
      REQUIRE(line.starts_with((folder / "scene.json").string() + ": "));
      REQUIRE(line.find('\n') == std::string::npos);
      ++errors;
    }
  }
  CHECK(errors > 100);
  CHECK(scenes > 0);
}

TEST_CASE("scene reader: where something is nested without end is said in few words") {
  const std::string error = error_of(std::string(100000, '['), "scene.json");
  CHECK_THAT(error, Catch::StartsWith("scene.json: [0][0][0]"));
  CHECK_THAT(error, Catch::Contains("[0]...: line 1, column 100001: "));
  CHECK(error.size() < 400);
}

}  // namespace test_scene_reader_errors
