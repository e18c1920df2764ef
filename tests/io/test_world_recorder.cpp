// Replays of worlds that no scene file describes.
#include "io/world_recorder.hpp"
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

}  // namespace
}  // namespace test_world_recorder
