// Runs as VTK series: what is in the files is the bodies of the run at the times of the frames.
#include "io/vtk.hpp"

#include "collision/shapes/compound.hpp"
#include "collision/shapes/mesh_script.hpp"
#include "io/run.hpp"
#include "io/scene_reader.hpp"
#include "tests/io/temporary_folder.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

namespace test_vtk {
namespace {

using namespace kds::io;
using Eigen::Vector3d;
using kds::io::tests::read_file;
using kds::io::tests::TemporaryFolder;

/// What follows `name="` in a text from a place on, up to the next quotation mark.
std::string attribute(const std::string& text, const std::string& name, std::size_t from = 0) {
  const std::size_t start = text.find(" " + name + "=\"", from);
  REQUIRE(start != std::string::npos);
  const std::size_t begin = start + name.size() + 3;
  return text.substr(begin, text.find('"', begin) - begin);
}

/// A frame, taken apart.
struct Frame {
  explicit Frame(const std::string& text) {
    // Every element that is opened is closed, in order.
    std::vector<std::string> open;
    for (std::size_t at = text.find('<', 1); at != std::string::npos; at = text.find('<', at + 1)) {
      const std::string tag = text.substr(at + 1, text.find('>', at) - at - 1);
      if (tag.ends_with('/')) continue;
      if (tag[0] != '/') {
        open.push_back(tag.substr(0, tag.find(' ')));
        continue;
      }
      REQUIRE(!open.empty());
      CHECK(open.back() == tag.substr(1));
      open.pop_back();
    }
    CHECK(open.empty());
    CHECK(attribute(text, "type", text.find("<VTKFile")) == "PolyData");
    CHECK(attribute(text, "header_type") == "UInt64");
    time = array<double>(text, "TimeValue", "Float64").at(0);
    places = array<float>(text, "Points", "Float32");
    corners = array<std::int32_t>(text, "connectivity", "Int32");
    body = array<std::int32_t>(text, "body", "Int32");
    velocities = array<float>(text, "velocity", "Float32");
    const auto ends = array<std::int32_t>(text, "offsets", "Int32");
    CHECK(attribute(text, "NumberOfPoints") == std::to_string(places.size() / 3));
    CHECK(attribute(text, "NumberOfPolys") == std::to_string(ends.size()));
    REQUIRE(corners.size() == 3 * ends.size());
    CHECK(body.size() == ends.size());
    CHECK(velocities.size() == corners.size());
    for (std::size_t i = 0; i < ends.size(); ++i) REQUIRE(ends[i] == static_cast<std::int32_t>(3 * (i + 1)));
    for (const std::int32_t corner : corners) REQUIRE((corner >= 0 && 3 * std::size_t(corner) < places.size()));
  }

  template <class Number>
  static std::vector<Number> array(const std::string& text, const std::string& name, const std::string& type) {
    const std::size_t at = text.find(" Name=\"" + name + "\"");
    REQUIRE(at != std::string::npos);
    const std::size_t element = text.rfind('<', at);
    CHECK(attribute(text, "type", element) == type);
    CHECK(attribute(text, "format", element) == "binary");
    const std::size_t begin = text.find('>', at) + 1;
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    std::uint32_t bits = 0;
    int count = 0;
    for (std::size_t i = begin; text[i] != '<' && text[i] != '='; ++i) {
      bits = bits << 6 | static_cast<std::uint32_t>(digits.find(text[i]));
      if ((count += 6) < 8) continue;
      count -= 8;
      bytes.push_back(static_cast<char>(bits >> count));
    }
    std::uint64_t length = 0;
    REQUIRE(bytes.size() >= sizeof length);
    std::memcpy(&length, bytes.data(), sizeof length);
    REQUIRE(bytes.size() == sizeof length + length);
    std::vector<Number> numbers(length / sizeof(Number));
    std::memcpy(numbers.data(), bytes.data() + sizeof length, length);
    return numbers;
  }

  Vector3d place(std::int32_t corner) const {
    const float* const p = &places[3 * std::size_t(corner)];
    return {p[0], p[1], p[2]};
  }
  /// Of a body: how many triangles it has, the volume that they enclose, and the mean of their corners.
  std::size_t triangles(int of) const { return std::size_t(std::count(body.begin(), body.end(), of)); }
  double volume(int of) const {
    double sum = 0;
    for (std::size_t i = 0; i < body.size(); ++i) {
      if (body[i] != of) continue;
      const Vector3d o = place(corners[3 * i]), a = place(corners[3 * i + 1]), b = place(corners[3 * i + 2]);
      sum += (o - middle(of)).dot((a - middle(of)).cross(b - middle(of))) / 6;
    }
    return sum;
  }
  Vector3d middle(int of) const {
    Vector3d low = Vector3d::Constant(1e9), high = -low;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (body[i / 3] != of) continue;
      low = low.cwiseMin(place(corners[i])), high = high.cwiseMax(place(corners[i]));
    }
    return (low + high) / 2;
  }
  Vector3d velocity(int of) const {
    const auto i = std::size_t(std::find(body.begin(), body.end(), of) - body.begin());
    REQUIRE(i < body.size());
    return {velocities[3 * i], velocities[3 * i + 1], velocities[3 * i + 2]};
  }

  double time = 0;
  std::vector<float> places, velocities;
  std::vector<std::int32_t> corners, body;
};

Scene three_bodies() {
  return parse_scene(R"({"scene": 1, "end_time": 9, "response": "elastic",
    "domain": {"min": [-9,-9,-9], "max": [9,9,9], "walls": "open"}, "bodies": [
    {"name": "left", "shape": {"sphere": {"radius": 1}}, "motion": [{"start": 0, "position": [[-3,0,0], [1,0,0]]}]},
    {"name": "right", "shape": {"box": {"half_extents": [1,1,1]}}, "motion": [{"start": 0, "position": [[3,0,0], [-1,0,0]]}]},
    {"name": "late", "shape": {"capsule": {"radius": 0.25, "half_length": 1}},
     "motion": [{"start": 4, "position": [[0,0,3], [0,0,0.5]]}]}]})",
                     "three");
}

TEST_CASE("VTK: a series has each frame once, and the bodies are in it where they were") {
  const TemporaryFolder folder;
  const Scene scene = three_bodies();
  ReplayRecorder recorder(scene);
  run(scene, {}, recorder);
  const std::string file = (folder / "a&b.pvd").string();
  {
    VtkSeries series(file);
    series.write(scene, recorder.record(), 4);
    CHECK_FALSE(std::filesystem::exists(file));
    CHECK_FALSE(std::filesystem::exists(folder / "a&b.frames"));
    series.close();
    series.commit();
  }
  const std::string list = read_file(file);
  CHECK(attribute(list, "type", list.find("<VTKFile")) == "Collection");
  std::size_t frames = 0;
  for (std::size_t at = list.find("<DataSet"); at != std::string::npos; at = list.find("<DataSet", at + 1), ++frames) {
    const double t = std::stod(attribute(list, "timestep", at));
    CAPTURE(t);
    CHECK(t == 0.25 * static_cast<double>(frames));
    std::string name = attribute(list, "file", at);
    name.replace(name.find("&amp;"), 5, "&");
    const Frame frame(read_file(folder / name));
    CHECK(frame.time == t);
    const double back = t < 2 ? t : 4 - t;  // they meet at 2
    CHECK((frame.middle(0) - Vector3d(back - 3, 0, 0)).norm() < 1e-5);
    CHECK((frame.middle(1) - Vector3d(3 - back, 0, 0)).norm() < 1e-5);
    CHECK(frame.velocity(0) == Vector3d(t < 2 ? 1 : -1, 0, 0));
    CHECK(frame.volume(1) == Approx(8));
    CHECK(frame.volume(0) == Approx(4 * 3.14159 / 3).epsilon(0.12));
    CHECK((frame.triangles(2) > 0) == (t >= 4));
    if (t >= 4) CHECK((frame.middle(2) - Vector3d(0, 0, 3 + 0.5 * (t - 4))).norm() < 1e-5);
  }
  CHECK(frames == 37);
  CHECK(std::distance(std::filesystem::directory_iterator(folder / "a&b.frames"), {}) == 37);

  // Written again, with fewer frames, none of the others is left.
  VtkSeries again(file);
  again.write(scene, recorder.record(), 0.1);
  again.commit();
  CHECK(std::distance(std::filesystem::directory_iterator(folder / "a&b.frames"), {}) == 2);
  CHECK(folder.file_count() == 2);
}

TEST_CASE("VTK: bodies turn, are removed, and bend, and compounds have all their parts") {
  Scene scene = parse_scene(R"({"scene": 1, "end_time": 4, "response": "none", "bodies": [
    {"name": "turns", "shape": {"box": {"half_extents": [2,1,1]}}, "motion": [
      {"start": 0, "position": [[0,0,0], [0,0,0], [0,0,-5]], "angular_velocity": [0,0,1.5]}]}]})",
                            "one");
  const std::vector<kds::collision::CompoundPart> parts{{kds::collision::Box{{1, 1, 1}}, {5, 0, 0}},
                                                        {kds::collision::Box{{0.5, 0.5, 0.5}}, {0, 0, 7}}};
  const auto add = [&](const kds::collision::Shape& shape) {
    SceneBody body{.name = std::to_string(scene.bodies.size()), .shape = shape};
    body.motion.emplace_back();
    scene.bodies.push_back(body);
  };
  add(kds::collision::compound(parts));
  const std::vector<Vector3d> flat{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  std::vector<Vector3d> bent = flat;
  bent[2] = {0, 1, 4};
  using kds::collision::MeshScript;
  add(kds::collision::BendingMesh{
      std::make_shared<const MeshScript>(std::vector<MeshScript::Keyframe>{{0, flat}, {2, bent}},
                                         std::vector<kds::collision::Mesh::Triangle>{{0, 1, 2}})});
  ReplayRecorder recorder(scene);
  Record record = recorder.record();
  record.on_removal(1, 3);
  const VtkFrames frames(scene, record);
  for (const double t : {0.0, 0.5, 1.0, 2.5, 3.0, 4.0}) {
    CAPTURE(t);
    const Frame frame(frames.at(t));
    // The corner (2, 1, 1) of the box is somewhere, turned.
    const Vector3d turned =
        Eigen::AngleAxisd(1.5 * t, Vector3d::UnitZ()) * Vector3d(2, 1, 1) + Vector3d(0, 0, -5 * t * t);
    double nearest = 1e9;
    for (std::size_t i = 0; i < frame.corners.size(); ++i) {
      if (frame.body[i / 3] == 0) nearest = std::min(nearest, (frame.place(frame.corners[i]) - turned).norm());
    }
    CHECK(nearest < 1e-5);
    CHECK((frame.velocity(0) - Vector3d(0, 0, -10 * t)).norm() < 1e-5);
    CHECK(frame.triangles(1) == (t < 3 ? 24u : 0u));
    if (t < 3) CHECK(frame.volume(1) == Approx(9));
    REQUIRE(frame.triangles(2) == 1);
    CHECK(frame.place(frame.corners[frame.corners.size() - 1])[2] == Approx(std::min(2 * t, 4.0)));
  }
  CHECK(frames.corners() == 3 * (12 + 24 + 1));
}

TEST_CASE("VTK: what cannot be written is refused, and what was there stays") {
  const TemporaryFolder folder;
  const Scene scene = three_bodies();
  ReplayRecorder recorder(scene);
  CHECK_THROWS_WITH(VtkSeries((folder / "run.vtp").string()), Catch::Contains("ends in .pvd"));
  CHECK_THROWS_AS(VtkSeries(".pvd"), std::invalid_argument);
  const std::string file = folder.write("run.pvd", "before").string();
  for (const double rate : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    VtkSeries series(file);
    CHECK_THROWS_AS(series.write(scene, recorder.record(), rate), std::invalid_argument);
  }
  VtkSeries(file).write(scene, recorder.record(), 2);
  {
    VtkSeries series(file);
    CHECK_THROWS_AS(series.write(scene, recorder.record(), 1e12), std::length_error);
  }
  CHECK(read_file(file) == "before");
  CHECK(folder.file_count() == 1);
  std::filesystem::create_directory(folder / "run.frames");
  folder.write("run.frames/frame_0.vtp", "");
  CHECK_NOTHROW(VtkSeries(file));
  folder.write("run.frames/frame_x.vtp", "");
  CHECK_THROWS_WITH(VtkSeries(file),
                    Catch::Contains("run.frames: folder: there is more in it than frames: frame_x.vtp"));
  std::filesystem::remove_all(folder / "run.frames");
  folder.write("run.frames", "");
  CHECK_THROWS_AS(VtkSeries(file), OutputError);
}

}  // namespace
}  // namespace test_vtk
