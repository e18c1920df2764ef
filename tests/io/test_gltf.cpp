// Runs as glTF: what a player of animations would show is what the run was.
#include "io/gltf.hpp"

#include "collision/shapes/compound.hpp"
#include "collision/shapes/convex_hull.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "io/run.hpp"
#include "io/scene_reader.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <bit>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace test_gltf {
namespace {

using namespace kds::io;
using Eigen::Vector3d;
using nlohmann::json;

/// A document with its numbers.
class Loaded {
 public:
  explicit Loaded(const std::string& text) : root(json::parse(text)) {
    const std::string uri = root["buffers"][0]["uri"];
    const std::string start = "data:application/octet-stream;base64,";
    REQUIRE(uri.compare(0, start.size(), start) == 0);
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : uri.substr(start.size())) {
      if (c == '=') break;
      bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
      if ((count += 6) < 8) continue;
      count -= 8;
      bytes.push_back(static_cast<std::uint8_t>(bits >> count));
    }
    REQUIRE(bytes.size() == root["buffers"][0]["byteLength"]);
  }

  std::vector<float> floats(std::size_t accessor) const {
    const json& of = root["accessors"][accessor];
    REQUIRE(of["componentType"] == 5126);
    const json& view = root["bufferViews"][of["bufferView"].get<std::size_t>()];
    const std::size_t width = of["type"] == "SCALAR" ? 1 : of["type"] == "VEC3" ? 3 : 4;
    REQUIRE(view["byteLength"] == 4 * width * of["count"].get<std::size_t>());
    std::vector<float> result;
    for (std::size_t i = 0; i < width * of["count"].get<std::size_t>(); ++i) {
      std::uint32_t bits = 0;
      for (std::size_t k = 4; k-- > 0;) bits = bits << 8 | bytes[view["byteOffset"].get<std::size_t>() + 4 * i + k];
      result.push_back(std::bit_cast<float>(bits));
      CHECK(result.back() >= of["min"][i % width].get<float>());
      CHECK(result.back() <= of["max"][i % width].get<float>());
    }
    return result;
  }

  /// What a player shows at t: of the node of a name, "translation" and so on.
  std::vector<double> at(const std::string& name, const std::string& path, double t) const {
    std::size_t node = 0;
    while (root["nodes"][node]["name"] != name) ++node;
    for (const json& channel : root["animations"][0]["channels"]) {
      if (channel["target"]["node"] != node || channel["target"]["path"] != path) continue;
      const json& sampler = root["animations"][0]["samplers"][channel["sampler"].get<std::size_t>()];
      const auto times = floats(sampler["input"]), values = floats(sampler["output"]);
      const std::size_t width = values.size() / times.size();
      for (std::size_t i = 1; i < times.size(); ++i) CHECK(times[i - 1] < times[i]);
      std::size_t i = 0;
      while (i + 1 < times.size() && times[i + 1] <= t) ++i;
      const bool last = i + 1 == times.size() || t <= times[i] || sampler["interpolation"] == "STEP";
      const double part = last ? 0 : (t - times[i]) / (times[i + 1] - times[i]);
      std::vector<double> result;
      for (std::size_t k = 0; k < width; ++k) {
        const double from = values[width * i + k];
        result.push_back(part == 0 ? from : from + part * (values[width * (i + 1) + k] - from));
      }
      return result;
    }
    return root["nodes"][node][path].get<std::vector<double>>();
  }

  json root;
  std::vector<std::uint8_t> bytes;
};

Vector3d vector(const std::vector<double>& v) { return {v.at(0), v.at(1), v.at(2)}; }

Loaded exported(const Scene& scene, double rate = 60) {
  ReplayRecorder recorder(scene);
  run(scene, {}, recorder);
  return Loaded(to_gltf(scene, recorder.record(), "run", rate));
}

TEST_CASE("glTF: bodies on straight paths are where they were, contacts between") {
  const Scene scene = parse_scene(R"({"scene": 1, "end_time": 9, "response": "elastic",
    "domain": {"min": [-9,-9,-9], "max": [9,9,9], "walls": "open"}, "bodies": [
    {"name": "left", "shape": {"sphere": {"radius": 1}}, "motion": [{"start": 0, "position": [[-3,0,0], [1,0,0]]}]},
    {"name": "right", "shape": {"box": {"half_extents": [1,1,1]}}, "motion": [{"start": 0, "position": [[3,0,0], [-1,0,0]]}]},
    {"name": "late", "shape": {"capsule": {"radius": 0.25, "half_length": 1}},
     "motion": [{"start": 4, "position": [[0,0,3], [0,0,0.5]]}]}]})", "three");
  const Loaded loaded = exported(scene);
  for (double t = 0; t <= 9; t += 0.125) {  // They meet at 2.
    CAPTURE(t);
    const double back = t < 2 ? t : 4 - t;
    CHECK((vector(loaded.at("left", "translation", t)) - Vector3d(back - 3, 0, 0)).norm() < 1e-5);
    CHECK((vector(loaded.at("right", "translation", t)) - Vector3d(3 - back, 0, 0)).norm() < 1e-5);
    const Vector3d size = t < 4 ? Vector3d(0, 0, 0) : Vector3d(0.25, 0.25, 0.25);
    CHECK(vector(loaded.at("late", "scale", t)) == size);
  }
  CHECK(vector(loaded.at("right", "scale", 0)) == Vector3d(1, 1, 1));
  // z points up: the root turns it to y.
  const Eigen::Quaterniond root(loaded.root["nodes"][0]["rotation"][3], loaded.root["nodes"][0]["rotation"][0],
                                loaded.root["nodes"][0]["rotation"][1], loaded.root["nodes"][0]["rotation"][2]);
  CHECK((root * Vector3d(0, 0, 1) - Vector3d(0, 1, 0)).norm() < 1e-12);
  CHECK(loaded.root["nodes"][0]["children"].size() == 3);
  CHECK(loaded.root["meshes"].size() == 3);
}

TEST_CASE("glTF: accelerated paths and turns are sampled as often as asked for") {
  const Scene scene = parse_scene(R"({"scene": 1, "end_time": 4, "response": "none", "bodies": [
    {"name": "falls", "shape": {"box": {"half_extents": [1,1,1]}}, "motion": [
      {"start": 0, "position": [[0,0,0], [0,0,0], [0,0,-5]], "angular_velocity": [0,0,1.5]}]}]})", "one");
  for (const double rate : {10.0, 100.0}) {
    const Loaded loaded = exported(scene, rate);
    const double step = 1 / rate;
    for (double t = 0; t <= 4; t += 0.0625) {
      CAPTURE(rate, t);
      const double sagitta = 10 * step * step / 8;  // of a chord of the parabola
      CHECK(std::abs(vector(loaded.at("falls", "translation", t))[2] + 5 * t * t) < 1.01 * sagitta + 1e-5);
      const auto q = loaded.at("falls", "rotation", t);
      const Eigen::Quaterniond turned = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized();
      const Eigen::Quaterniond right(Eigen::AngleAxisd(1.5 * t, Vector3d::UnitZ()));
      CHECK(turned.angularDistance(right) < 1e-5 + 0.01 * step);
    }
  }
}

TEST_CASE("glTF: surfaces are closed and point outward, with all triangles of meshes, hulls and parts") {
  Scene scene;
  scene.end_time = 1;
  const auto add = [&](const kds::collision::Shape& shape) {
    SceneBody body{.name = std::to_string(scene.bodies.size()), .shape = shape};
    body.motion.emplace_back();
    body.motion[0].path = kds::certificates::PointMotion<2>{};
    scene.bodies.push_back(body);
  };
  add(kds::collision::Sphere{1});
  add(kds::collision::Box{{1, 1, 1}});
  add(kds::collision::Capsule{1, 2});
  add(kds::collision::convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  const std::vector<kds::collision::CompoundPart> parts{{kds::collision::Box{{1, 1, 1}}, {5, 0, 0}},
                                                        {kds::collision::Box{{0.5, 0.5, 0.5}}, {0, 0, 7}}};
  add(kds::collision::compound(parts));
  const Loaded loaded = exported(scene);
  constexpr double pi = 3.14159265358979;
  const std::vector<double> volumes{4 * pi / 3, 8, 4 * pi / 3 + 4 * pi, 1.0 / 6, 9};
  REQUIRE(loaded.root["meshes"].size() == 5);
  for (std::size_t i = 0; i < 5; ++i) {
    CAPTURE(i);
    const json& primitive = loaded.root["meshes"][i]["primitives"][0];
    const auto places = loaded.floats(primitive["attributes"]["POSITION"]);
    const json& indices = loaded.root["accessors"][primitive["indices"].get<std::size_t>()];
    const std::size_t offset = loaded.root["bufferViews"][indices["bufferView"].get<std::size_t>()]["byteOffset"];
    double volume = 0;
    for (std::size_t k = 0; k < indices["count"]; k += 3) {
      std::vector<Vector3d> corners;
      for (std::size_t c = k; c < k + 3; ++c) {
        std::uint32_t index = 0;
        for (std::size_t b = 4; b-- > 0;) index = index << 8 | loaded.bytes[offset + 4 * c + b];
        REQUIRE(3 * index + 2 < places.size());
        corners.emplace_back(places[3 * index], places[3 * index + 1], places[3 * index + 2]);
      }
      volume += corners[0].dot(corners[1].cross(corners[2])) / 6;
    }
    CHECK(volume == Approx(volumes[i]).epsilon(0.03));
  }
}

TEST_CASE("glTF: a mesh that bends has its keyframes as targets, one after the other") {
  Scene scene;
  scene.end_time = 3;
  const std::vector<Vector3d> flat{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  std::vector<Vector3d> bent = flat, back = flat;
  bent[2] = {0, 1, 4}, back[2] = {0, 2, 0};
  using kds::collision::MeshScript;
  SceneBody body{.name = "sheet",
                 .shape = kds::collision::BendingMesh{std::make_shared<const MeshScript>(
                     std::vector<MeshScript::Keyframe>{{0, flat}, {1, bent}, {3, back}},
                     std::vector<kds::collision::Mesh::Triangle>{{0, 1, 2}})}};
  body.motion.emplace_back();
  body.motion[0].path = kds::certificates::PointMotion<2>{};
  scene.bodies.push_back(body);
  ReplayRecorder recorder(scene);
  const Loaded loaded(to_gltf(scene, recorder.record(), "sheet"));
  const json& targets = loaded.root["meshes"][0]["primitives"][0]["targets"];
  REQUIRE(targets.size() == 2);
  CHECK(loaded.floats(targets[0]["POSITION"])[8] == 4);
  CHECK(loaded.floats(targets[1]["POSITION"])[7] == 1);
  const json& animation = loaded.root["animations"][0];
  CHECK(animation["channels"].back()["target"]["path"] == "weights");
  CHECK(loaded.floats(animation["samplers"].back()["input"]) == std::vector<float>{0, 1, 3});
  CHECK(loaded.floats(animation["samplers"].back()["output"]) == std::vector<float>{0, 0, 1, 0, 0, 1});
}

TEST_CASE("glTF: rates that make no sense are refused") {
  Scene scene;
  scene.end_time = 1;
  ReplayRecorder recorder(scene);
  for (const double rate : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    CHECK_THROWS_AS(to_gltf(scene, recorder.record(), "a", rate), std::invalid_argument);
  }
  scene.end_time = 1e12;
  scene.bodies.resize(1);
  CHECK_THROWS_AS(to_gltf(scene, recorder.record(), "a", 60), std::length_error);
}

}  // namespace
}  // namespace test_gltf
