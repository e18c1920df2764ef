// The code of docs/recipes.md that reads files and writes replays: what is quoted there stands here.
#include "collision/shapes/mesh.hpp"
#include "io/mesh_file.hpp"
#include "io/replay.hpp"
#include "io/run.hpp"
#include "io/scene_reader.hpp"
#include "io/world_recorder.hpp"
#include "tests/io/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include <memory>
#include <string>

namespace test_recipes {

using namespace kds::io;
using kds::io::tests::TemporaryFolder;

TEST_CASE("recipe: a mesh from a file") {
  const TemporaryFolder folder;
  const auto file =
      folder.write("model.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 2 0 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\n");
  MeshData data = read_mesh_file(file);
  const auto left_out = leave_out_degenerate(data);  // triangles without area, which a Mesh refuses
  const auto mesh = std::make_shared<const kds::collision::Mesh>(data.vertices, data.triangles);
  CHECK(left_out.size() == 1);
  CHECK(mesh->triangles().size() == 2);
}

TEST_CASE("recipe: a replay of a scene") {
  const std::string text = R"({"scene": 1, "end_time": 5, "response": "elastic", "bodies": [
    {"name": "left", "shape": {"sphere": {"radius": 1}}, "motion": [{"start": 0, "position": [[-3,0,0], [1,0,0]]}]},
    {"name": "right", "shape": {"sphere": {"radius": 1}}, "motion": [{"start": 0, "position": [[3,0,0], [-1,0,0]]}]}]})";
  const Scene scene = parse_scene(text, "two balls");
  ReplayRecorder recorder(scene);
  const RunResult result = run(scene, {}, recorder);
  const std::string data = recorder.to_json("two balls");  // replay_page(data, default_three_folder()) is the page
  CHECK(result.contacts == 1);
  CHECK(data.find("\"touches\":[[2") != std::string::npos);
}

TEST_CASE("recipe: a replay of a world") {
  using kds::collision::Sphere, kds::collision::World, kds::collision::WorldOptions;
  using Line = World<1>::Motion;
  const WorldOptions options;
  WorldRecorder<Line> recorder(options);  // and tells a listener of yours, if you give it one
  World<1> world(options, &recorder);
  world.add_body({.shape = Sphere{1}, .motion = {Line::line({-3, 0, 0}, {1, 0, 0})}});
  world.add_body({.shape = Sphere{1}, .motion = {Line::line({3, 0, 0}, {-1, 0, 0})}});
  world.advance_to(4);
  const std::string data = recorder.to_json(world, "two balls");  // recorder.page(world, "two balls") is the page
  CHECK(data.find("\"touches\":[[2") != std::string::npos);
}

}  // namespace test_recipes
