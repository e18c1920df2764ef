#include "collision/shapes/mesh_script.hpp"
#include "examples/kds-collide/generator.hpp"
#include "io/replay.hpp"
#include "io/run.hpp"
#include "io/scene_reader.hpp"
#include "tests/io/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

namespace test_bending_scenes {
using namespace kds_collide;
using namespace kds::io;
using kds::io::tests::TemporaryFolder;
using nlohmann::json;

namespace {

/// A triangle that rises by 2 in two seconds, and a ball above it.
json rising_triangle() {
  return json::parse(R"({
    "scene": 1, "end_time": 2, "response": "none", "meshes": {"t": {"file": "t.obj"}},
    "bodies": [
      {"name": "t", "shape": {"mesh": "t"}, "motion": [{"start": 0, "position": [[0,0,0]]}],
       "vertices": [{"time": 0, "positions": [[-1,-1,0],[1,-1,0],[0,1,0]]},
                    {"time": 2, "positions": [[-1,-1,2],[1,-1,2],[0,1,2]]}]},
      {"name": "b", "shape": {"sphere": {"radius": 0.5}}, "motion": [{"start": 0, "position": [[0,0,1.5]]}]}]})");
}

Scene read(const json& scene, const TemporaryFolder& folder) {
  folder.write("t.obj", "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n");
  return parse_scene(scene.dump(), folder / "scene.json");
}

std::string error_of(const json& scene) {
  const TemporaryFolder folder;
  try {
    read(scene, folder);
    return "no error";
  } catch (const SceneError& error) {
    const std::string what = error.what();
    return what.substr(what.find("scene.json: ") + 12);
  }
}

struct Events final : EventSink {
  std::vector<Event> all;
  void on_event(const Event& event) override { all.push_back(event); }
};

}  // namespace

TEST_CASE("scenes with meshes that bend: read, run and recorded") {
  const TemporaryFolder folder;
  const Scene scene = read(rising_triangle(), folder);
  const auto* const shape = std::get_if<kds::collision::BendingMesh>(&scene.bodies[0].shape);
  REQUIRE(shape);
  REQUIRE(shape->script->keyframes().size() == 2);
  CHECK(shape->script->keyframes()[1].positions[2] == Eigen::Vector3d(0, 1, 2));
  CHECK(scene.bodies[0].bent == scene.meshes[0].mesh);

  Events events;
  run(scene, {}, events);
  REQUIRE(events.all.size() == 1);
  CHECK(events.all[0].kind == EventKind::contact);
  CHECK(events.all[0].time == Approx(1).epsilon(0).margin(1e-6));
  CHECK(events.all[0].feature_a == kds::collision::Feature::face(0));

  const json data = json::parse(ReplayRecorder(scene).to_json("rising"));
  CHECK(data["bodies"][0]["shape"] == 0);
  CHECK(data["bodies"][0]["frames"] == json::parse("[[0,-1,-1,0,1,-1,0,0,1,0],[2,-1,-1,2,1,-1,2,0,1,2]]"));
  CHECK_FALSE(data["bodies"][1].contains("frames"));
}

TEST_CASE("scenes with meshes that bend: a ball bounces off one") {
  const TemporaryFolder folder;
  json scene = rising_triangle();
  scene["response"] = "elastic";
  scene["bodies"][0]["fixed"] = true;
  Events events;
  run(read(scene, folder), {}, events);
  REQUIRE(events.all.size() == 1);  // it is thrown off with twice the speed of the triangle
  CHECK(events.all[0].kind == EventKind::contact);
  CHECK(events.all[0].time == Approx(1).epsilon(0).margin(1e-6));
}

TEST_CASE("scenes with meshes that bend: one that touches itself") {
  const TemporaryFolder folder;
  // Two triangles apart from each other, of which one sinks through the other's place between t = 1 / 2 and 3 / 4.
  folder.write("two.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 1\nv 2 1 1\nv 1 2 2\nf 1 2 3\nf 4 5 6\n");
  json scene = json::parse(R"({"scene": 1, "end_time": 1, "response": "none", "meshes": {"m": {"file": "two.obj"}},
    "bodies": [{"name": "m", "shape": {"mesh": "m"}, "self_contacts": true,
                "motion": [{"start": 0, "position": [[0, 0, 0]]}],
                "vertices": [{"time": 0, "positions": [[0,0,0],[4,0,0],[0,4,0],[1,1,1],[2,1,1],[1,2,1.5]]},
                             {"time": 1, "positions": [[0,0,0],[4,0,0],[0,4,0],[1,1,-1],[2,1,-1],[1,2,-0.5]]}]}]})");
  Events events;
  run(parse_scene(scene.dump(), folder / "scene.json"), {}, events);
  REQUIRE(events.all.size() == 2);
  CHECK(events.all[0].kind == EventKind::contact);
  CHECK(events.all[0].time == Approx(0.5).epsilon(0).margin(1e-6));
  CHECK(events.all[1].kind == EventKind::separation);
  CHECK(events.all[1].time == Approx(0.75).epsilon(0).margin(1e-6));
  for (const Event& event : events.all) CHECK((event.a == 0 && event.b == 0));
  scene["bodies"][0].erase("vertices");
  CHECK_THROWS_WITH(parse_scene(scene.dump(), folder / "scene.json"),
                    Catch::Contains("bodies[0].self_contacts: is for meshes that bend"));
}

TEST_CASE("scenes with meshes that bend: what is wrong is named with its place") {
  const auto with = [](const char* pointer, const json& value) {
    json scene = rising_triangle();
    scene[json::json_pointer(pointer)] = value;
    return error_of(scene);
  };
  CHECK(with("/bodies/0/vertices", json::array()) == "bodies[0].vertices: must have at least one keyframe");
  CHECK(with("/bodies/0/vertices/1/time", 0) ==
        "bodies[0].vertices[1].time: must be later than that of the keyframe before, 0");
  CHECK(with("/bodies/0/vertices/1/positions", json::parse("[[0,0,0],[1,0,0]]")) ==
        "bodies[0].vertices[1].positions: has 2 positions, and the mesh has 3 vertices");
  CHECK(with("/bodies/0/vertices/1/positions/2", json::parse("[0,1]")) ==
        "bodies[0].vertices[1].positions[2]: must be an array of 3 numbers");
  CHECK(with("/bodies/0/vertices/0/place", 1) == "bodies[0].vertices[0].place: unknown key");
  CHECK(with("/bodies/0/shape/scale", 2) ==
        "bodies[0].vertices: is for meshes without a scale: positions are as they are given");
  CHECK(with("/bodies/1/vertices", json::array()) == "bodies[1].vertices: is for meshes only");
  CHECK(
      with("/response", "elastic") ==
      "bodies[0].vertices: contacts do not move a mesh that bends: \"fixed\": true for this body, or \"sensor\": true");
  CHECK(with("/bodies/0/motion/0/angular_velocity", json::parse("[0,0,1]")) ==
        "bodies[0].motion[0].angular_velocity: a bending mesh does not turn: its vertices say how it moves");
}

TEST_CASE("generator: a sheet on which waves run, and balls that meet it") {
  const TemporaryFolder folder;
  const GeneratedScene generated = generate_scene({.kind = "sheet", .bodies = 10, .seed = 3});
  CHECK(generated.json == generate_scene({.kind = "sheet", .bodies = 10, .seed = 3}).json);
  folder.write(generated.meshes.at(0).name, generated.meshes.at(0).text);
  const Scene scene = parse_scene(generated.json, folder / "scene.json");
  REQUIRE(scene.bodies.size() == 11);
  const auto& sheet = std::get<kds::collision::BendingMesh>(scene.bodies[0].shape);
  CHECK(sheet.script->triangles().size() == 1152);
  CHECK(sheet.script->keyframes().size() == 25);
  Events events;
  run(scene, {}, events);
  CHECK(events.all.size() >= 10);
}

}  // namespace test_bending_scenes
