#include "io/body_table.hpp"
#include "io/scene_reader.hpp"
#include "tests/io/sample_scene.hpp"
#include "tests/io/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <hdf5.h>

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace test_body_table {

using namespace kds::io;
using Eigen::Vector3d;
using kds::io::tests::TemporaryFolder;

namespace {

BodyTable balls(std::size_t rows) {
  BodyTable table;
  for (std::size_t i = 0; i < rows; ++i) {
    const double x = static_cast<double>(i);
    table.position.emplace_back(10 * x, 0.1 * x, -x);
    table.velocity.emplace_back(1, 2, 3);
    table.radius.push_back(1 + 0.25 * x);
  }
  return table;
}

/// With every column but those that say another shape.
BodyTable full(std::size_t rows) {
  BodyTable table = balls(rows);
  table.acceleration.assign(rows, Vector3d(0, 0, -9.81));
  table.start.assign(rows, 0.125);
  table.orientation.assign(rows, Eigen::Vector4d(0.6, 0, 0.8, 0));
  table.angular_velocity.assign(rows, Vector3d(0, 0, 7));
  table.mass.assign(rows, 3);
  table.restitution.assign(rows, 0.5);
  table.friction.assign(rows, 0.25);
  table.tangential_restitution.assign(rows, -0.5);
  table.rolling_friction.assign(rows, 0.0625);
  table.fixed.assign(rows, 0);
  table.sensor.assign(rows, 0);
  table.fixed.back() = 1;
  table.sensor.front() = 1;
  return table;
}

constexpr const char* scene_of_balls = R"({"scene": 1, "end_time": 1, "tables": [{"file": "b.h5", "prefix": "b"}]})";

std::string error_of(const TemporaryFolder& folder, const std::string& scene) {
  try {
    parse_scene(scene, folder / "scene.json");
    return "no error";
  } catch (const SceneError& error) {
    std::string text = error.what();
    const std::string prefix = (folder / "").string();
    for (std::size_t at = 0; (at = text.find(prefix)) != std::string::npos;) text.erase(at, prefix.size());
    return text;
  }
}

/// The error of a scene whose table is this one; `keys` go into the scene.
std::string error_of(const BodyTable& table, const std::string& keys = "") {
  const TemporaryFolder folder;
  folder.write("b.h5", to_hdf5(table));
  folder.write("ring.obj", kds::io::tests::tetrahedron);
  return error_of(folder,
                  R"({"scene": 1, "end_time": 1, )" + keys + R"( "tables": [{"file": "b.h5", "prefix": "b"}]})");
}

/// Adds a dataset to a file, of a type that it may be stored in.
void add_dataset(const std::filesystem::path& file, const char* name, hid_t stored, hid_t given,
                 const std::vector<hsize_t>& extent, const void* data, bool compressed = false) {
  const hid_t f = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t space = H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr);
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  if (compressed) {
    H5Pset_chunk(properties, static_cast<int>(extent.size()), extent.data());
    H5Pset_deflate(properties, 6);
  }
  const hid_t set = H5Dcreate2(f, name, stored, space, H5P_DEFAULT, properties, H5P_DEFAULT);
  REQUIRE(H5Dwrite(set, given, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0);
  H5Dclose(set), H5Pclose(properties), H5Sclose(space), H5Fclose(f);
}

}  // namespace

TEST_CASE("body table: what is written is read back, to the last bit") {
  const TemporaryFolder folder;
  BodyTable table = full(7);
  table.half_extents.assign(7, Vector3d(1, 2, std::numeric_limits<double>::denorm_min()));
  table.shape.assign(7, -3);
  table.scale.assign(7, 1e300);
  const BodyTable read = read_body_table(folder.write("b.h5", to_hdf5(table)));
  const auto columns = [](const BodyTable& t) {
    return std::tie(t.position, t.velocity, t.acceleration, t.start, t.orientation, t.angular_velocity, t.radius,
                    t.half_extents, t.shape, t.scale, t.mass, t.restitution, t.friction, t.tangential_restitution,
                    t.rolling_friction, t.fixed, t.sensor);
  };
  CHECK(columns(read) == columns(table));
  CHECK(to_hdf5(read) == to_hdf5(table));
}

TEST_CASE("body table: columns of different lengths are not written") {
  BodyTable table = balls(3);
  table.radius.pop_back();
  CHECK_THROWS_WITH(to_hdf5(table), "radius: has 2 rows, and position has 3");
}

TEST_CASE("body table: rows are bodies of the scene, with all that columns say") {
  const TemporaryFolder folder;
  folder.write("b.h5", to_hdf5(full(3)));
  const Scene scene = parse_scene(scene_of_balls, folder / "scene.json");
  REQUIRE(scene.bodies.size() == 3);
  CHECK(scene.turning);
  CHECK(scene.begin_time == 0.125);
  const SceneBody& body = scene.bodies[2];
  CHECK(body.name == "b2");
  CHECK(std::get<kds::collision::Sphere>(body.shape).radius == 1.5);
  const MotionPiece& piece = body.motion.front();
  CHECK(piece.path.start == 0.125);
  CHECK(piece.path.coefficients[0] == Vector3d(20, 0.2, -2));
  CHECK(piece.path.coefficients[1] == Vector3d(1, 2, 3));
  CHECK(piece.path.coefficients[2] == Vector3d(0, 0, -9.81 / 2));
  CHECK(piece.orientation.coeffs() == Eigen::Vector4d(0, 0.8, 0, 0.6));
  CHECK(piece.angular_velocity == Vector3d(0, 0, 7));
  CHECK(body.mass == 3);
  CHECK(body.restitution == 0.5);
  CHECK(body.friction == 0.25);
  CHECK(body.tangential_restitution == -0.5);
  CHECK(body.rolling_friction == 0.0625);
  CHECK(body.fixed);
  CHECK_FALSE(body.sensor);
  CHECK(scene.bodies[0].sensor);
}

TEST_CASE("body table: bodies that are listed come first, and tables follow in their order") {
  const TemporaryFolder folder;
  folder.write("b.h5", to_hdf5(balls(2)));
  const Scene scene = parse_scene(R"({"scene": 1, "end_time": 1, "restitution": 0.75,
    "bodies": [{"name": "b2", "shape": {"sphere": {"radius": 9}}, "motion": [{"start": 0, "position": [[0,0,90]]}]}],
    "tables": [{"file": "b.h5", "prefix": "c"}, {"file": "b.h5", "prefix": "b"}]})",
                                  folder / "scene.json");
  std::vector<std::string> names;
  for (const SceneBody& body : scene.bodies) names.push_back(body.name);
  CHECK(names == std::vector<std::string>{"b2", "c0", "c1", "b0", "b1"});
  CHECK(scene.bodies[1].restitution == 0.75);
  CHECK(scene.bodies[1].mass == 1);
  CHECK_FALSE(scene.turning);
}

TEST_CASE("body table: shapes are the scene's, one for all or by number, and meshes have scales") {
  const TemporaryFolder folder;
  BodyTable table;
  table.position.assign(2, Vector3d::Zero());
  table.scale = {0.5, 3};
  table.shape = {1, 0};
  folder.write("b.h5", to_hdf5(table));
  folder.write("ring.obj", kds::io::tests::tetrahedron);
  const std::string head = R"({"scene": 1, "end_time": 1, "meshes": {"ring": {"file": "ring.obj"}}, "tables": [)";
  const std::string shapes =
      R"({"file": "b.h5", "prefix": "b", "shapes": [{"mesh": "ring"}, {"mesh": "ring", "scale": 2}]}]})";
  const Scene scene = parse_scene(head + shapes, folder / "scene.json");
  CHECK(std::get<kds::collision::MeshShape>(scene.bodies[0].shape).scale == 1);
  CHECK(std::get<kds::collision::MeshShape>(scene.bodies[1].shape).scale == 3);

  table.shape.clear();
  folder.write("b.h5", to_hdf5(table));
  const Scene same =
      parse_scene(head + R"({"file": "b.h5", "prefix": "b", "shape": {"mesh": "ring"}}]})", folder / "scene.json");
  CHECK(std::get<kds::collision::MeshShape>(same.bodies[1].shape).scale == 3);
  CHECK(error_of(folder, head + shapes) ==
        "scene.json: tables[0].shapes: needs a column shape in the file, which says who has which");
  CHECK(error_of(folder, head + R"({"file": "b.h5", "prefix": "b", "shape": {"sphere": {"radius": 1}}}]})") ==
        "scene.json: tables[0].rows[0].scale: is for meshes only");
}

TEST_CASE("body table: other programs' number types and layouts are read") {
  const TemporaryFolder folder;
  BodyTable table = balls(4);
  table.radius.clear();
  const auto file = folder.write("b.h5", to_hdf5(table));
  const std::array<float, 4> radius{0.5F, 1, 2, 3};
  const std::array<std::int32_t, 4> mass{1, 2, 3, 400};
  add_dataset(file, "radius", H5T_IEEE_F32BE, H5T_NATIVE_FLOAT, {4}, radius.data(), true);
  add_dataset(file, "mass", H5T_STD_U16LE, H5T_NATIVE_INT32, {4}, mass.data());
  const hid_t boolean = H5Tcreate(H5T_ENUM, sizeof(std::int8_t));  // as Python's h5py stores Booleans
  std::int8_t value = 0;
  H5Tenum_insert(boolean, "FALSE", &value);
  value = 1;
  H5Tenum_insert(boolean, "TRUE", &value);
  const std::array<std::int8_t, 4> fixed{0, 1, 0, 1};
  add_dataset(file, "fixed", boolean, boolean, {4}, fixed.data());
  H5Tclose(boolean);
  const BodyTable read = read_body_table(file);
  CHECK(read.radius == std::vector<double>{0.5, 1, 2, 3});
  CHECK(read.mass == std::vector<double>{1, 2, 3, 400});
  CHECK(read.fixed == std::vector<std::int8_t>{0, 1, 0, 1});
}

TEST_CASE("body table: each bad number is named with its row and column") {
  struct Case {
    std::function<void(BodyTable&)> damage;
    std::string error;
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Case> cases{
      {[](BodyTable& t) { t.position[2][1] = nan; }, "rows[2].position: is not a number"},
      {[](BodyTable& t) { t.velocity[1][0] = -1e31; }, "rows[1].velocity: must be at most 1e+30 in magnitude"},
      {[](BodyTable& t) { t.acceleration[0][2] = std::numeric_limits<double>::infinity(); },
       "rows[0].acceleration: must be at most 1e+30 in magnitude"},
      {[](BodyTable& t) { t.velocity[1][0] = 1e30, t.position[1][0] = 1e30; },
       "rows[1].position: may reach a magnitude of 1.875e+30 by t = 1; at most 1e+30 is supported"},
      {[](BodyTable& t) { t.radius[2] = 0; }, "rows[2].radius: must be > 0"},
      {[](BodyTable& t) { t.radius[2] = 1e-31; }, "rows[2].radius: must be at least 1e-30"},
      {[](BodyTable& t) { t.start[0] = nan; }, "rows[0].start: is not a number"},
      {[](BodyTable& t) { t.orientation[1][0] = 0; },
       "rows[1].orientation: must be a unit quaternion; its norm is 0.8"},
      {[](BodyTable& t) { t.angular_velocity[0][0] = nan; }, "rows[0].angular_velocity: is not a number"},
      {[](BodyTable& t) { t.mass[0] = -1; }, "rows[0].mass: must be > 0"},
      {[](BodyTable& t) { t.restitution[0] = 1.5; }, "rows[0].restitution: must be in [0, 1]"},
      {[](BodyTable& t) { t.friction[0] = -1; }, "rows[0].friction: must be >= 0"},
      {[](BodyTable& t) { t.tangential_restitution[0] = 2; }, "rows[0].tangential_restitution: must be in [-1, 1]"},
      {[](BodyTable& t) { t.rolling_friction[0] = -1; }, "rows[0].rolling_friction: must be >= 0"},
      {[](BodyTable& t) { t.fixed[1] = 2; }, "rows[1].fixed: must be 0 or 1"},
      {[](BodyTable& t) { t.sensor[1] = -1; }, "rows[1].sensor: must be 0 or 1"},
      {[](BodyTable& t) { t.radius.clear(), t.half_extents.assign(3, Vector3d(1, 0, 1)); },
       "rows[0].half_extents: must be > 0"}};
  for (const Case& each : cases) {
    BodyTable table = full(3);
    each.damage(table);
    CHECK(error_of(table) == "scene.json: tables[0]." + each.error);
  }
  BodyTable outside = balls(3);
  CHECK(error_of(outside, R"("domain": {"min": [-2,-2,-9], "max": [15,9,9], "walls": "reflect"},)") ==
        "scene.json: tables[0].rows[2].position: begins outside the reflecting walls: x = 20 with a bounding radius "
        "of 1.5, between -2 and 15");
  BodyTable rough = balls(3);
  rough.friction.assign(3, 0.5);
  CHECK(error_of(rough) ==
        "scene.json: tables[0].file: b.h5: has friction: bodies of this scene do not turn: none has "
        "an \"angular_velocity\" or an \"inertia\"");
}

TEST_CASE("body table: a table that cannot be what it should is named with what is wrong") {
  const TemporaryFolder folder;
  const auto file = folder / "b.h5";
  const auto error = [&] { return error_of(folder, scene_of_balls); };
  CHECK(error() == "scene.json: tables[0].file: b.h5: cannot be read: No such file or directory");
  folder.write("b.h5", "no table");
  CHECK(error() == "scene.json: tables[0].file: b.h5: is no HDF5 file, or is damaged");
  const std::string whole = to_hdf5(balls(300));
  folder.write("b.h5", whole.substr(0, whole.size() / 2));
  CHECK(error() == "scene.json: tables[0].file: b.h5: is no HDF5 file, or is damaged");
  const auto with = [&](const char* name, hid_t type, const std::vector<hsize_t>& extent) {
    folder.write("b.h5", to_hdf5(balls(2)));
    const std::array<double, 8> zeros{};
    add_dataset(file, name, type, type, extent, zeros.data());
    return error();
  };
  const std::string at = "scene.json: tables[0].file: b.h5: ";
  CHECK(with("colour", H5T_NATIVE_DOUBLE, {2}) == at + "colour: is no column of a table of bodies");
  CHECK(with("mass", H5T_NATIVE_DOUBLE, {3}) == at + "mass: has 3 rows, and position has 2");
  CHECK(with("mass", H5T_NATIVE_DOUBLE, {2, 1}) == at + "mass: must have the shape (rows)");
  CHECK(with("mass", H5T_NATIVE_DOUBLE, {}) == at + "mass: must have the shape (rows)");
  CHECK(with("mass", H5T_C_S1, {2}) == at + "mass: must hold numbers");
  CHECK(with("acceleration", H5T_NATIVE_DOUBLE, {2, 2}) == at + "acceleration: must have the shape (rows, 3)");
  CHECK(with("acceleration", H5T_NATIVE_DOUBLE, {2}) == at + "acceleration: must have the shape (rows, 3)");
  CHECK(with("acceleration", H5T_NATIVE_DOUBLE, {2, 2, 2}) == at + "acceleration: must have the shape (rows, 3)");
  CHECK(with("fixed", H5T_NATIVE_DOUBLE, {2}) == at + "fixed: must hold whole numbers");
  BodyTable none;
  none.radius = {};
  folder.write("b.h5", to_hdf5(none));
  CHECK(error() == at + "position: is missing, or has no rows");
  BodyTable plain = balls(2);
  plain.radius.clear();
  CHECK(error_of(plain) ==
        "scene.json: tables[0]: must have exactly one of \"shape\", \"shapes\", and of the columns "
        "radius and half_extents in its file");
}

TEST_CASE("body table: two bodies never get the same name") {
  const TemporaryFolder folder;
  folder.write("b.h5", to_hdf5(balls(12)));
  const auto error = [&](const std::string& name, const std::string& first, const std::string& second) {
    return error_of(folder, R"({"scene": 1, "end_time": 1, "bodies": [{"name": ")" + name +
                                R"(", "shape": {"sphere": {"radius": 1}}, "motion": [{"start": 0,
      "position": [[0,0,0]]}]}], "tables": [{"file": "b.h5", "prefix": ")" +
                                first + R"("}, {"file": "b.h5", "prefix": ")" + second + R"("}]})");
  };
  CHECK(error("a11", "a", "b") ==
        "scene.json: tables[0].prefix: gives a body the name \"a11\", which is that of bodies[0] too");
  CHECK(error("a12", "a", "b") == "no error");
  CHECK(error("a011", "a", "b") == "no error");
  CHECK(error("a", "a", "b") == "no error");
  const std::string same =
      "scene.json: tables[1].prefix: with the prefix of tables[0], two bodies could have the same name";
  CHECK(error("x", "a", "a") == same);
  CHECK(error("x", "a", "a1") == same);
  CHECK(error("x", "a1", "a") == same);
  CHECK(error("x", "a", "ab") == "no error");
}

TEST_CASE("body table: a small file that claims a great many rows is refused before memory is taken for them") {
  const TemporaryFolder folder;
  const auto path = folder / "b.h5";
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hsize_t extent = hsize_t{1} << 62, chunk = 16;
  const hid_t space = H5Screate_simple(1, &extent, nullptr);
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_chunk(properties, 1, &chunk);
  const hid_t set = H5Dcreate2(file, "radius", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, properties, H5P_DEFAULT);
  REQUIRE(set >= 0);
  H5Dclose(set), H5Pclose(properties), H5Sclose(space), H5Fclose(file);
  CHECK_THROWS_WITH(read_body_table(path), "radius: has fewer bytes than its rows need");
}

TEST_CASE("body table: a file that was cut short is refused, wherever it was cut") {
  const TemporaryFolder folder;
  const std::string whole = to_hdf5(full(5));
  for (std::size_t size = 0; size < whole.size(); size += 17) {
    folder.write("b.h5", whole.substr(0, size));
    CHECK(error_of(folder, scene_of_balls) != "no error");
  }
}

}  // namespace test_body_table
