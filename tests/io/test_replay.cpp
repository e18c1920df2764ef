#include "io/replay.hpp"

#include "collision/shapes/compound.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "tests/io/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

namespace test_replay {

using namespace kds::io;
using kds::io::tests::TemporaryFolder;
using nlohmann::json;

namespace {

Scene scene_of_two() {
  Scene scene;
  scene.begin_time = 10;
  scene.end_time = 12;
  scene.response = Response::elastic;
  for (int i = 0; i < 2; ++i) {
    SceneBody body{.name = i == 0 ? "a</script>" : "b", .shape = kds::collision::Sphere{0.5}};
    body.motion.emplace_back();
    body.motion[0].path.coefficients.fill(Eigen::Vector3d::Zero());
    body.motion[0].path.coefficients[1] = {1.0 - 2 * i, 0, 0};
    body.motion[0].path.start = 10;
    scene.bodies.push_back(body);
  }
  return scene;
}

}  // namespace

TEST_CASE("replay: the record holds pieces of motion and contacts, counted from the beginning") {
  const Scene scene = scene_of_two();
  ReplayRecorder recorder(scene);
  const Eigen::Vector3d point(1, 2, 3), normal(0, 0, -1);
  recorder.on_event({11, EventKind::contact, 0, 1, point, normal, {}, {}});
  recorder.on_event({11.5, EventKind::wall, 0, 1, point, normal, {}, {}});
  recorder.on_event({11.5, EventKind::rest_at_wall, 0, 1, point, normal, {}, {}});
  recorder.on_event({12, EventKind::rest, 0, 1, point, normal, {}, {}});
  recorder.on_event({12, EventKind::pair_begin, 0, 1, point, normal, {}, {}});
  recorder.on_event({12.5, EventKind::wake, 0, 1, point, normal, {}, {}});
  MotionPiece piece = scene.bodies[1].motion[0];
  piece.path.start = 11;
  recorder.on_motion(0, piece);
  piece.path.coefficients[2] = {0, 0, -5};
  recorder.on_motion(0, piece);  // at the same instant: takes the other's place

  const std::string text = recorder.to_json("a \"title\"");
  CHECK(text.find("</script>") == std::string::npos);
  const json data = json::parse(text);
  CHECK(data["title"] == "a \"title\"");
  CHECK(data["begin"] == 10);
  CHECK(data["duration"] == 2);
  CHECK(data["bodies"][0]["name"] == "a</script>");
  CHECK(data["bodies"][0]["shape"] == "sphere");
  CHECK(data["bodies"][0]["motion"] == json::parse("[[0,0,0,0,1,0,0],[1,0,0,0,-1,0,0,0,0,-5]]"));
  CHECK(data["bodies"][1]["motion"] == json::parse("[[0,0,0,0,-1,0,0]]"));
  CHECK(data["touches"] == json::parse("[[1,0,0,1,1,2,3,0,0,-1]]"));
  CHECK(data["walls"] == json::parse("[[1.5,0,1,1,2,3,0,0,-1]]"));
  CHECK(data["rests"] == json::parse("[[1.5,1,0],[2,1,0,1],[2.5,-1,0,1]]"));
}

TEST_CASE("replay: changes of motion that nobody could see are left out") {
  Scene scene = scene_of_two();
  ReplayRecorder recorder(scene);
  for (int i = 1; i < 100; ++i) {
    MotionPiece piece = scene.bodies[0].motion[0].restarted(10 + 0.01 * i);
    piece.path.coefficients[1][1] = i % 2 == 0 ? 1e-4 : -1e-4;  // it never is 1e-4 from its way
    recorder.on_motion(0, piece);
  }
  MotionPiece turned = scene.bodies[0].motion[0].restarted(11.5);
  turned.path.coefficients[1][1] = 0.01;  // 5e-3 at the end
  recorder.on_motion(0, turned);
  const json data = json::parse(recorder.to_json("title"));
  CHECK(data["bodies"][0]["motion"] == json::parse("[[0,0,0,0,1,0,0],[1.5,1.5,0,0,1,0.01,0]]"));
}

TEST_CASE("replay: shapes by their names and measures") {
  Scene scene = scene_of_two();
  scene.bodies[0].shape = kds::collision::Box{{1, 2, 3}};
  scene.bodies[1].shape = kds::collision::Capsule{0.5, 2};
  const json data = json::parse(ReplayRecorder(scene).to_json("a"));
  CHECK(data["bodies"][0]["shape"] == "box");
  CHECK(data["bodies"][0]["size"] == json::parse("[1,2,3]"));
  CHECK(data["bodies"][1]["shape"] == "capsule");
  CHECK(data["bodies"][1]["size"] == json::parse("[0.5,0.5,2]"));
}

TEST_CASE("replay: a hull is drawn as the triangles of its surface, once for all bodies that share it") {
  Scene scene = scene_of_two();
  scene.bodies[0].shape = scene.bodies[1].shape =
      kds::collision::convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.25, 0.25, 0.25}});
  const json data = json::parse(ReplayRecorder(scene).to_json("a"));
  REQUIRE(data["meshes"].size() == 1);
  CHECK(data["meshes"][0]["triangles"].size() == 12);
  CHECK(data["bodies"][0]["shape"] == 0);
  CHECK(data["bodies"][1]["shape"] == 0);
  CHECK(data["bodies"][1]["size"] == json::parse("[1,1,1]"));
}

TEST_CASE("replay: a compound is drawn as the surfaces of its parts, once for all bodies that share it") {
  Scene scene = scene_of_two();
  const std::vector<kds::collision::CompoundPart> parts{
      {kds::collision::Box{{1, 1, 1}}, {5, 0, 0}},
      {kds::collision::convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}), {0, 0, 7}}};
  scene.bodies[0].shape = scene.bodies[1].shape = kds::collision::compound(parts);
  const json data = json::parse(ReplayRecorder(scene).to_json("a"));
  REQUIRE(data["meshes"].size() == 1);
  CHECK(data["meshes"][0]["vertices"].size() == 3 * 12);
  CHECK(data["meshes"][0]["triangles"].size() == 3 * 16);
  CHECK(data["bodies"][0]["shape"] == 0);
  CHECK(data["bodies"][1]["shape"] == 0);
  CHECK(data["bodies"][1]["size"] == json::parse("[1,1,1]"));
}

TEST_CASE("replay: a change of motion stands before the pieces of the script that come after it") {
  Scene scene = scene_of_two();
  MotionPiece piece = scene.bodies[0].motion[0];
  piece.path.start = 11.5;
  scene.bodies[0].motion.push_back(piece);
  ReplayRecorder recorder(scene);
  piece.path.start = 11;
  piece.path.coefficients[1] = {-1, 0, 0};
  recorder.on_motion(0, piece);
  piece.path.start = 11.5;
  piece.path.coefficients[1] = {3, 0, 0};
  recorder.on_motion(0, piece);  // the script's piece begins, and is changed at once
  const json data = json::parse(recorder.to_json("a"));
  CHECK(data["bodies"][0]["motion"] == json::parse("[[0,0,0,0,1,0,0],[1,0,0,0,-1,0,0],[1.5,0,0,0,3,0,0]]"));
}

TEST_CASE("replay: of bodies that turn, and of them alone, the record holds how each piece turns") {
  Scene scene = scene_of_two();
  CHECK_FALSE(json::parse(ReplayRecorder(scene).to_json("a"))["bodies"][0].contains("spins"));
  scene.turning = true;
  scene.bodies[0].motion[0].angular_velocity = {0, 0, 0.1};
  ReplayRecorder recorder(scene);
  MotionPiece piece = scene.bodies[0].motion[0].restarted(11);
  piece.orientation = {0, 1, 0, 0};
  piece.angular_velocity = {1, 2, -3};
  recorder.on_motion(0, piece);
  const json data = json::parse(recorder.to_json("a"));
  CHECK(data["bodies"][0]["turn"] == json::parse("[0,0,0,1]"));
  CHECK(data["bodies"][0]["motion"] == json::parse("[[0,0,0,0,1,0,0],[1,1,0,0,1,0,0]]"));
  CHECK(data["bodies"][0]["spins"] == json::parse("[[0,0,0,1,0,0,0.1],[1,0,0,0,1,2,-3]]"));
  CHECK_FALSE(data["bodies"][1].contains("spins"));
}

TEST_CASE("replay: a piece that goes on turning as the one before is left out, and one that does not is kept") {
  Scene scene = scene_of_two();
  scene.turning = true;
  scene.bodies[0].motion[0].angular_velocity = {0, 0, 100};
  const auto pieces = [&](const Eigen::Vector3d& turns_by, const Eigen::Quaterniond& turned_by) {
    ReplayRecorder recorder(scene);
    MotionPiece piece = scene.bodies[0].motion[0].restarted(11);
    piece.orientation = turned_by * piece.orientation;
    piece.angular_velocity += turns_by;
    recorder.on_motion(0, piece);
    const json data = json::parse(recorder.to_json("a"));
    CHECK(data["bodies"][0]["spins"].size() == data["bodies"][0]["motion"].size());
    return data["bodies"][0]["spins"].size();
  };
  const Eigen::Quaterniond none = Eigen::Quaterniond::Identity();
  CHECK(pieces({0, 0, 0}, none) == 1);
  CHECK(pieces({0, 0, 1e-4}, none) == 1);
  CHECK(pieces({0, 0, 1e-2}, none) == 2);
  CHECK(pieces({0, 0, 0}, Eigen::Quaterniond(1, 1e-4, 0, 0).normalized()) == 1);
  CHECK(pieces({0, 0, 0}, Eigen::Quaterniond(1, 1e-2, 0, 0).normalized()) == 2);
}

TEST_CASE("replay: a title that is not UTF-8 is written as well as it can be") {
  const Scene scene = scene_of_two();
  const json data = json::parse(ReplayRecorder(scene).to_json("sc\xff.json"));
  CHECK(data["title"] == "sc\uFFFD.json");
}

TEST_CASE("replay: the page holds viewer, three.js and data") {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "build");
  std::filesystem::create_directories(folder / "examples/js/controls");
  folder.write("build/three.min.js", "THE LIBRARY");
  folder.write("examples/js/controls/OrbitControls.js", "THE CONTROLS");
  const std::string page = replay_page("THE DATA", folder / "");
  const std::size_t library = page.find("THE LIBRARY");
  const std::size_t controls = page.find("THE CONTROLS");
  const std::size_t data = page.find("THE DATA");
  CHECK(library < controls);
  CHECK(controls < data);
  CHECK(data < page.rfind("</html>"));
  CHECK(page.find("http") == std::string::npos);  // needs no network
}

TEST_CASE("replay: without three.js the package is named") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(replay_page("", folder / "none"), Catch::Contains("libjs-three"));
  CHECK_THROWS_WITH(replay_page("", ""), Catch::Contains("libjs-three"));
}

}  // namespace test_replay
