// Replays of worlds that no scene file describes.
#include "io/world_recorder.hpp"

#include "kds/framework/snapshot.hpp"
#include "tests/io/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <vector>

namespace test_world_recorder {
namespace {

using namespace kds::collision;
using kds::io::WorldRecorder;
using nlohmann::json;
using Line = World<1>::Motion;
using Eigen::Vector3d;

TEST_CASE("recorder: bodies that bounce, come later, are moved and are removed") {
  struct Told final : WorldListener<1> {
    int contacts = 0, walls = 0;
    void contact(World<1>&, const PairEvent&) override { ++contacts; }
    void wall(World<1>&, const WallEvent&) override { ++walls; }
  } told;
  WorldOptions options{.start_time = 1, .response = Response::elastic, .walls = Walls{{-9, -9, -9}, {9, 9, 9}}};
  WorldRecorder<Line> recorder(options, &told);
  World<1> world(options, &recorder);
  world.add_body({.shape = Sphere{1}, .motion = {Line::line({-4, 0, 0}, {1, 0, 0}, 1)}});
  const BodyId other = world.add_body({.shape = Sphere{1}, .motion = {Line::line({4, 0, 0}, {0, 0, 0}, 1)}});
  recorder.look(world);
  world.advance_to(8);  // They meet at 7.
  world.add_body({.shape = Box{{1, 1, 1}}, .motion = {Line::line({0, 5, 0}, {0, 0, 0}, 8)}, .fixed = true});
  recorder.look(world);
  world.remove_body(other);
  world.update_motion(0, Line::line({0, 0, 0}, {0, 0, 1}, 8));
  recorder.look(world);
  world.advance_to(20);  // The first one at the wall, at 16.
  CHECK(told.contacts == 1);
  CHECK(told.walls == 1);
  const json data = json::parse(recorder.to_json(world, "three bodies"));
  CHECK(data["begin"] == 1);
  CHECK(data["duration"] == 19);
  CHECK(data["domain"]["walls"] == true);
  REQUIRE(data["bodies"].size() == 3);
  CHECK(data["bodies"][0]["motion"] == json::parse("[[0,-4,0,0,1,0,0],[6,2,0,0],[7,0,0,0,0,0,1],[15,0,0,8,0,0,-1]]"));
  CHECK_FALSE(data["bodies"][0].contains("until"));
  CHECK(data["bodies"][1]["motion"] == json::parse("[[0,4,0,0],[6,4,0,0,1,0,0]]"));
  CHECK(data["bodies"][1]["until"] == 7);
  CHECK(data["bodies"][2]["motion"] == json::parse("[[7,0,5,0]]"));
  CHECK(data["bodies"][2]["fixed"] == true);
  CHECK(data["touches"] == json::parse("[[6,0,0,1,3,0,0,1,0,0]]"));
  CHECK(data["walls"] == json::parse("[[15,0,5,0,0,9,0,0,1]]"));
}

TEST_CASE("recorder: surfaces of a world as files, up to its clock") {
  const kds::io::tests::TemporaryFolder folder;
  WorldRecorder<Line> recorder({});
  World<1> world({}, &recorder);
  world.add_body({.shape = Sphere{1}, .motion = {Line::line({0, 0, 0}, {1, 0, 0})}});
  world.advance_to(2);
  recorder.write_vtk(world, (folder / "run.pvd").string(), 1);
  CHECK(std::filesystem::exists(folder / "run.frames/frame_2.vtp"));
  CHECK_FALSE(std::filesystem::exists(folder / "run.frames/frame_3.vtp"));
  CHECK_THAT(kds::io::tests::read_file(folder / "run.pvd"), Catch::Contains("timestep=\"2\""));
}

TEST_CASE("recorder: a body that a callback removes, and another that gets its slot") {
  struct Bullet final : WorldListener<1> {
    void contact(World<1>& world, const PairEvent& event) override {
      world.remove_body(event.b);
      world.add_body({.shape = Sphere{1}, .motion = {Line::line({0, 8, 0}, {0, 0, 0}, world.now())}});
    }
  } bullet;
  const WorldOptions options;
  WorldRecorder<Line> recorder(options, &bullet);
  World<1> world(options, &recorder);
  world.add_body({.shape = Sphere{1}, .motion = {Line::line({0, 0, 0}, {0, 0, 0})}});
  world.add_body({.shape = Sphere{1}, .motion = {Line::line({4, 0, 0}, {-1, 0, 0})}});
  world.advance_to(5);
  const json data = json::parse(recorder.to_json(world, "bullet"));
  REQUIRE(data["bodies"].size() == 3);
  CHECK(data["bodies"][1]["until"] == 2);
  CHECK(data["bodies"][2]["motion"] == json::parse("[[2,0,8,0]]"));
  CHECK(data["touches"] == json::parse("[[2,0,0,1,1,0,0,1,0,0]]"));
}

TEST_CASE("recorder: a page of bodies that turn") {
  using Motion = TurningWorld<1>::Motion;
  const WorldOptions options;
  WorldRecorder<Motion> recorder(options);
  TurningWorld<1> world(options, &recorder);
  Motion motion;
  motion.path = Line::line({1, 0, 0}, {0, 0, 0});
  motion.orientation = Eigen::Quaterniond::Identity();
  motion.angular_velocity = {0, 0, 2};
  world.add_body({.shape = Box{{1, 2, 3}}, .motion = {motion}});
  world.advance_to(3);
  const json data = json::parse(recorder.to_json(world, "turning"));
  CHECK(data["bodies"][0]["spins"] == json::parse("[[0,0,0,1,0,0,2]]"));
  if (kds::io::default_three_folder().empty()) return;
  CHECK(recorder.page(world, "turning").find("\"shape\":\"box\"") != std::string::npos);
}

TEST_CASE("recorder: half-spaces, alone and under a body, in every picture") {
  const kds::io::tests::TemporaryFolder folder;
  const bool alone = GENERATE(true, false);
  const WorldOptions options{.response = Response::elastic};
  WorldRecorder<World<2>::Motion> recorder(options);
  World<2> world(options, &recorder);
  using Path = World<2>::Motion;
  world.add_body({.shape = HalfSpace{{0, 0, 1}, 0}, .motion = {Path::line({0, 0, -1}, {0, 0, 0})}, .fixed = true});
  if (!alone) world.add_body({.shape = Sphere{1}, .motion = {Path::parabola({3, 0, 4}, {0, 0, 0}, {0, 0, -2})}});
  recorder.look(world);
  world.advance_to(3);
  const json data = json::parse(recorder.to_json(world, "floor"));
  REQUIRE(data["bodies"][0]["shape"] == 0);
  CHECK(data["bodies"][0]["motion"] == json::parse("[[0,0,0,-1]]"));
  // A square of the plane, in the coordinates of the body, below the other one.
  const std::vector<double> vertices = data["meshes"][0]["vertices"];
  REQUIRE(vertices.size() == 12);
  Vector3d middle = Vector3d::Zero();
  for (std::size_t i = 0; i < 12; ++i) middle[int(i % 3)] += vertices[i] / 4;
  for (std::size_t i = 2; i < 12; i += 3) CHECK(vertices[i] == 0);
  CHECK((middle - Vector3d(alone ? 0 : 3, 0, 0)).norm() < 1e-6);
  CHECK(json::parse(recorder.gltf(world, "floor"))["meshes"].size() == (alone ? 1 : 2));
  recorder.write_vtk(world, (folder / "run.pvd").string(), 1);
  CHECK(std::filesystem::exists(folder / "run.frames/frame_3.vtp"));
}

TEST_CASE("recorder: sensors are told from other bodies in every picture") {
  const WorldOptions options{.response = Response::elastic};
  WorldRecorder<Line> recorder(options);
  World<1> world(options, &recorder);
  const BodyId solid = world.add_body({.shape = Sphere{1}, .motion = {Line::line({0, 0, 0}, {1, 0, 0})}});
  world.add_body({.shape = Sphere{2}, .sensor = true, .attached_to = solid});
  world.add_body({.shape = Box{{1, 1, 1}}, .motion = {Line::line({5, 0, 0}, {0, 0, 0})}, .fixed = true});
  recorder.look(world);
  world.advance_to(2.5);
  const json data = json::parse(recorder.to_json(world, "alarm"));
  CHECK_FALSE(data["bodies"][0].contains("sensor"));
  CHECK(data["bodies"][1]["sensor"] == true);
  CHECK(data["bodies"][1]["motion"] == data["bodies"][0]["motion"]);
  CHECK(data["touches"] == json::parse("[[2,0,1,2,4,0,0,1,0,0]]"));
  const json gltf = json::parse(recorder.gltf(world, "alarm"));
  const auto look = [&](const char* name) {
    for (const json& node : gltf["nodes"]) {
      if (node["name"] != name) continue;
      const json& mesh = gltf["meshes"][node["mesh"].get<std::size_t>()];
      return gltf["materials"][mesh["primitives"][0]["material"].get<std::size_t>()];
    }
    return json();
  };
  CHECK_FALSE(look("body 0").contains("alphaMode"));
  for (const char* const clear : {"body 1", "body 2"}) {
    CHECK(look(clear)["alphaMode"] == "BLEND");
    CHECK(look(clear)["pbrMetallicRoughness"]["baseColorFactor"][3] < 0.5);
  }
  CHECK(look("body 1") != look("body 2"));
}

TEST_CASE("recorder: splines, whose pieces are told of, are drawn as they are") {
  using Curve = World<5>::Motion;
  const WorldOptions options{.response = Response::elastic, .report_pieces = true};
  WorldRecorder<Curve> recorder(options);
  World<5> world(options, &recorder);
  const Vector3d a(0, 0, 0), b(4, 2, 0), c(6, -2, 1), v(1, 0, 0), w(0, 2, 1), zero(0, 0, 0);
  const std::vector<Curve> pieces{Curve::quintic(a, v, zero, b, w, zero, 0, 2), Curve::cubic(b, w, c, v, 2, 3),
                                  Curve::line(c, v, 3)};
  world.add_body({.shape = Sphere{0.01}, .motion = {pieces[0], pieces[1], pieces[2]}});
  recorder.look(world);
  world.advance_to(4);
  const json data = json::parse(recorder.to_json(world, "curves"));
  const json& motion = data["bodies"][0]["motion"];
  REQUIRE(motion.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::vector<double> numbers = motion[i];
    REQUIRE(numbers.size() == 1 + 3 * std::vector<std::size_t>{6, 4, 2}[i]);
    CHECK(numbers[0] == pieces[i].start);
    for (std::size_t k = 1; k < numbers.size(); ++k) {
      const double coefficient = pieces[i].coefficients[(k - 1) / 3][int((k - 1) % 3)];
      CHECK(numbers[k] == Approx(coefficient).epsilon(1e-6).margin(1e-12));
    }
  }
}

TEST_CASE("recorder: a piece that differs only between its ends is drawn") {
  using Curve = World<4>::Motion;
  const WorldOptions options{.report_pieces = true};
  WorldRecorder<Curve> recorder(options);
  World<4> world(options, &recorder);
  // t (t - 1/2)^2 (t - 1) is 0 at both ends and in the middle.
  Curve wave{{Vector3d::Zero(), Vector3d(0, -0.25, 0), Vector3d(0, 1.25, 0), Vector3d(0, -2, 0), Vector3d(0, 1, 0)}, 1};
  world.add_body({.shape = Sphere{1}, .motion = {Curve::line({0, 0, 0}, {0, 0, 0}), wave}});
  recorder.look(world);
  world.advance_to(2);
  CHECK(json::parse(recorder.to_json(world, "wave"))["bodies"][0]["motion"].size() == 2);
}

TEST_CASE(
    "recorder: a motion that began earlier changes nothing of the past, and one that replaces another the future") {
  const WorldOptions options;
  WorldRecorder<Line> recorder(options);
  World<1> world(options, &recorder);
  world.add_body({.shape = Sphere{1}, .motion = {Line::line({0, 0, 0}, {1, 0, 0})}});
  world.add_body({.shape = Sphere{1}, .motion = {Line::line({0, 9, 0}, {0, 1, 0}, 6)}});  // to enter at 6
  recorder.look(world);
  world.advance_to(4);
  world.update_motion(0, Line::line({0, 0, 0}, {0, 0, 2}, 0));
  world.update_motion(1, Line::line({0, 5, 0}, {0, 0, 0}, 4));
  recorder.look(world);
  world.advance_to(8);
  const json data = json::parse(recorder.to_json(world, "rewritten"));
  CHECK(data["bodies"][0]["motion"] == json::parse("[[0,0,0,0,1,0,0],[4,0,0,8,0,0,2]]"));
  CHECK(data["bodies"][1]["motion"] == json::parse("[[4,0,5,0]]"));
}

TEST_CASE("recorder: a body that enters later is drawn from then on, and one body can be looked at") {
  const WorldOptions options;
  WorldRecorder<Line> recorder(options);
  World<1> world(options, &recorder);
  world.add_body({.shape = Sphere{1}, .motion = {Line::line({0, 9, 0}, {0, 1, 0}, 6)}});
  recorder.look(world);
  world.advance_to(2);
  const BodyId second = world.add_body({.shape = Sphere{1}, .motion = {Line::line({5, 0, 0}, {0, 0, 0}, 2)}});
  recorder.look(world, second);
  world.advance_to(4);
  world.remove_body(second);
  recorder.look(world, second);
  world.advance_to(8);
  const json data = json::parse(recorder.to_json(world, "later"));
  REQUIRE(data["bodies"].size() == 2);
  CHECK(data["bodies"][0]["motion"] == json::parse("[[6,0,9,0,0,1,0]]"));
  CHECK(data["bodies"][1]["motion"] == json::parse("[[2,5,0,0]]"));
  CHECK(data["bodies"][1]["until"] == 4);
}

TEST_CASE("recorder: a record begins again from the state that a world is restored to") {
  const WorldOptions options;
  WorldRecorder<Line> recorder(options);
  World<1> world(options, &recorder);
  world.add_body({.shape = Sphere{1}, .motion = {Line::line({0, 0, 0}, {1, 0, 0})}});
  world.advance_to(2);
  const auto saved = kds::save(world);
  world.update_motion(0, Line::line({2, 0, 0}, {0, 5, 0}, 2));
  world.add_body({.shape = Sphere{1}, .motion = {Line::line({0, 9, 0}, {0, 0, 0}, 2)}});
  recorder.look(world);
  world.advance_to(4);
  kds::restore(saved, world);
  recorder.start_again(world);
  world.advance_to(5);
  const json data = json::parse(recorder.to_json(world, "again"));
  CHECK(data["begin"] == 2);
  CHECK(data["duration"] == 3);
  REQUIRE(data["bodies"].size() == 1);
  CHECK(data["bodies"][0]["motion"] == json::parse("[[-2,0,0,0,1,0,0]]"));
}

}  // namespace
}  // namespace test_world_recorder
