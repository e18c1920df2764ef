#include "io/scene_reader.hpp"

#include <catch2/catch.hpp>

#include <string>

namespace test_scene_half_spaces {

using namespace kds::io;

namespace {

std::string error_of(const std::string& text, const std::string& file) {
  try {
    parse_scene(text, file);
    return "no error";
  } catch (const SceneError& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("scene reader: a half-space is fixed, and its normal of unit length") {
  const auto error = [](const std::string& normal, const std::string& more) {
    return error_of(R"({"scene": 1, "end_time": 1, "bodies": [{"name": "floor", "shape": {"half_space": {"normal": )" +
                        normal + R"(, "offset": 0}}, )" + more +
                        R"("motion": [{"start": 0, "position": [[0,0,0]]}]}]})",
                    "scene.json");
  };
  CHECK(error("[0, 0, 1]", R"("fixed": true, )") == "no error");
  const std::string free = "scene.json: bodies[0].fixed: a half-space has no mass: it has to be fixed";
  CHECK(error("[0, 0, 1]", "") == free);
  CHECK(error("[0, 0, 1]", R"("sensor": true, )") == free);
  CHECK(error("[0, 0, 1]", R"("inertia": 1, )") == free);  // in a scene that turns
  CHECK(error("[0, 0, 2]", R"("fixed": true, )") ==
        "scene.json: bodies[0].shape.half_space.normal: must be of unit length, to 1e-06");
}

TEST_CASE("scene reader: a half-space does not turn") {
  CHECK(error_of(R"({"scene": 1, "end_time": 1, "bodies": [
    {"name": "floor", "shape": {"half_space": {"normal": [0,0,1], "offset": 0}}, "fixed": true,
     "motion": [{"start": 0, "position": [[0,0,0]], "angular_velocity": [0,0,1]}]}]})",
                 "scene.json") == "scene.json: bodies[0].motion[0].angular_velocity: a half-space does not turn");
}

}  // namespace test_scene_half_spaces
